//! The one history: steps with labels, undone and done again by cheap snapshots.
//!
//! # Decided with
//! - [`crate::session::Session::change`] (`perform.rs`), [`crate::session::Session::travel`] (`perform.rs`),
//!   [`crate::session::Session::begin`] (`perform.rs`): a step recorded, undone or redone; the history
//!   emptied;
//! - [`crate::session::Session::commit`] (`gesture.rs`): a drag is one step;
//! - [`crate::recovery::PastStep`]: steps kept for recovery;
//! - [`toile_pattern::Ids`]: ids, which are not given again after an undo.
//!
//! In the window: `app/perform.rs`, `tables/history.rs`, and for a marker `app/marker_drop.rs`.

use crate::Project;
use std::collections::VecDeque;

/// Largest number of steps in the history.
const MAX_STEPS: usize = 1000;
/// Largest number of steps that are restored after a crash.
const MAX_RESTORED_STEPS: usize = 50;

/// A step of the history with a snapshot of the project: of the state before the step if the step can be
/// undone, of the state after the step if it can be redone.
#[derive(Clone, Debug)]
pub struct HistoryStep {
    /// Number of the step, unique in the session.
    pub(crate) number: u64,
    pub(crate) label: String,
    pub(crate) project: Project,
}

/// Steps that can be undone, and steps that can be redone.
#[derive(Clone, Debug, Default)]
pub(crate) struct History {
    past: VecDeque<HistoryStep>,
    future: Vec<HistoryStep>,
    /// Number of steps ever recorded.
    count: u64,
}

impl History {
    /// The empty history of another document; its steps get numbers that no step had before.
    pub fn begun_anew(self) -> Self {
        Self {
            count: self.count,
            ..Self::default()
        }
    }

    /// Records a step that leads away from the project `before`.
    pub fn record(&mut self, before: Project, label: &str) {
        self.future.clear();
        if self.past.len() == MAX_STEPS {
            self.past.pop_front();
        }
        self.count += 1;
        self.past.push_back(HistoryStep {
            number: self.count,
            label: label.to_owned(),
            project: before,
        });
    }

    /// Undoes the last step and returns the project before it; [`History::redo`] brings `now` back.
    pub fn undo(&mut self, now: &Project) -> Option<Project> {
        let step = self.past.pop_back()?;
        self.future.push(HistoryStep {
            project: now.clone(),
            ..step.clone()
        });
        Some(step.project)
    }

    /// Redoes the step undone last and returns the project after it.
    pub fn redo(&mut self, now: &Project) -> Option<Project> {
        let step = self.future.pop()?;
        self.past.push_back(HistoryStep {
            project: now.clone(),
            ..step.clone()
        });
        Some(step.project)
    }

    /// Label of the step that would be undone.
    pub fn can_undo(&self) -> Option<&str> {
        self.past.back().map(|step| &*step.label)
    }

    /// Label of the step that would be redone.
    pub fn can_redo(&self) -> Option<&str> {
        self.future.last().map(|step| &*step.label)
    }

    /// The newest steps that can be undone, the newest first: as many as are restored after a crash.
    pub fn to_keep(&self) -> Vec<HistoryStep> {
        self.past
            .iter()
            .rev()
            .take(MAX_RESTORED_STEPS)
            .cloned()
            .collect()
    }

    /// Labels of the steps that can be undone, the oldest first.
    pub fn past(&self) -> impl Iterator<Item = &str> {
        self.past.iter().map(|step| &*step.label)
    }

    /// Labels of the steps that can be redone, the next first.
    pub fn future(&self) -> impl Iterator<Item = &str> {
        self.future.iter().rev().map(|step| &*step.label)
    }
}
