//! Guides: lines across the table to draw against. They are no part of any piece.

use super::Pattern;
use crate::GuideId;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A line across the whole table, level or upright.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Guide {
    /// Its id.
    pub id: GuideId,
    /// Which way it runs.
    pub runs: GuideRun,
    /// Where it lies on the table [m]: its height if horizontal, else how far to the right.
    pub at: f64,
}

/// Which way a guide runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GuideRun {
    /// From left to right.
    Horizontal,
    /// From below upward.
    Vertical,
}

impl GuideRun {
    /// Which coordinate all places of such a guide share: 1 (y) if horizontal, 0 (x) if vertical.
    pub fn axis(self) -> usize {
        match self {
            Self::Horizontal => 1,
            Self::Vertical => 0,
        }
    }

    /// Its name.
    pub fn words(self) -> &'static str {
        match self {
            Self::Horizontal => "horizontal guide",
            Self::Vertical => "vertical guide",
        }
    }
}

impl Pattern {
    /// The guide with that id.
    pub fn guide(&self, id: GuideId) -> Option<&Arc<Guide>> {
        self.guides.iter().find(|guide| guide.id == id)
    }

    /// What a guide is called: which way it runs, and its number among those that run so.
    pub fn guide_words(&self, id: GuideId) -> Option<String> {
        let runs = self.guide(id)?.runs;
        let mut alike = self.guides.iter().filter(|guide| guide.runs == runs);
        let number = alike.position(|guide| guide.id == id)? + 1;
        Some(format!("{} {number}", runs.words()))
    }
}
