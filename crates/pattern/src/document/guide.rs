//! Guides: lines across the table to draw against. They are no part of any piece.

use super::Pattern;
use crate::fields::{Clash, Told, key};
use crate::{GuideId, fields};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use strum::EnumIter;

/// A line across the whole table, level or upright.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Guide {
    /// Identifier of the guide.
    pub id: GuideId,
    /// Direction of the guide.
    pub runs: GuideRun,
    /// Place of the guide on the table (m): height of a horizontal guide, distance to the right of a vertical
    /// one.
    pub at: f64,
}

fields!(Guide, |self, v| {
    let Self { id, runs, at } = self;
    v.own(id);
    v.flat(runs);
    v.value(key(runs.key()).length(), at);
});

/// Direction of a guide.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, EnumIter, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GuideRun {
    /// From left to right.
    #[default]
    Horizontal,
    /// From bottom to top.
    Vertical,
}

// The field for the place of a guide, `x` or `y`, also gives its direction, so the direction has no field.
fields!(
    GuideRun,
    |self, _v| {},
    kinds: |runs| Told::Field(runs.key()),
    clash: Clash {
        usual: Some(0),
        ..Clash::default()
    },
);

impl GuideRun {
    /// Name of the file field for the place of a guide with this direction.
    fn key(self) -> &'static str {
        match self {
            Self::Horizontal => "y",
            Self::Vertical => "x",
        }
    }

    /// Index of the coordinate that all points of a guide with this direction share: 1 (y) if horizontal, 0
    /// (x) if vertical.
    pub fn axis(self) -> usize {
        match self {
            Self::Horizontal => 1,
            Self::Vertical => 0,
        }
    }

    /// Name of a guide with this direction, for messages.
    pub fn words(self) -> &'static str {
        match self {
            Self::Horizontal => "horizontal guide",
            Self::Vertical => "vertical guide",
        }
    }
}

impl Pattern {
    /// The guide with this id.
    pub fn guide(&self, id: GuideId) -> Option<&Arc<Guide>> {
        self.guides.iter().find(|guide| guide.id == id)
    }

    /// Name of a guide for messages: its direction, and its number among the guides of that direction.
    pub fn guide_words(&self, id: GuideId) -> Option<String> {
        let runs = self.guide(id)?.runs;
        let mut alike = self.guides.iter().filter(|guide| guide.runs == runs);
        let number = alike.position(|guide| guide.id == id)? + 1;
        Some(format!("{} {number}", runs.words()))
    }
}
