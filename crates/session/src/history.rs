//! The one history: steps with labels, undone and done again by cheap snapshots.

use crate::Project;
use std::collections::VecDeque;

/// Most steps kept.
const MAX_STEPS: usize = 1000;
/// Most steps that are there again after a crash.
const MAX_RESTORED_STEPS: usize = 50;

/// One step: the project on the other side of it.
#[derive(Clone, Debug)]
pub struct HistoryStep {
    /// Its own number: no other step of the session has the same.
    pub(crate) number: u64,
    pub(crate) label: String,
    pub(crate) project: Project,
}

/// Steps that can be taken back, and those that can be done again.
#[derive(Clone, Debug, Default)]
pub(crate) struct History {
    past: VecDeque<HistoryStep>,
    future: Vec<HistoryStep>,
    /// How many steps there ever were.
    count: u64,
}

impl History {
    /// The empty history of another document: its steps have numbers that none had before.
    pub fn begun_anew(self) -> Self {
        Self {
            count: self.count,
            ..Self::default()
        }
    }

    /// Notes a step from `before`.
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

    /// The project before the last step; `now` can be had back by [`History::redo`].
    pub fn undo(&mut self, now: &Project) -> Option<Project> {
        let step = self.past.pop_back()?;
        self.future.push(HistoryStep {
            project: now.clone(),
            ..step.clone()
        });
        Some(step.project)
    }

    /// The project after the step last taken back.
    pub fn redo(&mut self, now: &Project) -> Option<Project> {
        let step = self.future.pop()?;
        self.past.push_back(HistoryStep {
            project: now.clone(),
            ..step.clone()
        });
        Some(step.project)
    }

    /// Label of the step that would be taken back.
    pub fn can_undo(&self) -> Option<&str> {
        self.past.back().map(|step| &*step.label)
    }

    /// Label of the step that would be done again.
    pub fn can_redo(&self) -> Option<&str> {
        self.future.last().map(|step| &*step.label)
    }

    /// The last steps that can be taken back, the newest first: as many as are there again after a crash.
    pub fn to_keep(&self) -> Vec<HistoryStep> {
        self.past
            .iter()
            .rev()
            .take(MAX_RESTORED_STEPS)
            .cloned()
            .collect()
    }

    /// Labels of the steps that can be taken back, the oldest first.
    pub fn past(&self) -> impl Iterator<Item = &str> {
        self.past.iter().map(|step| &*step.label)
    }

    /// Labels of the steps that can be done again, the next first.
    pub fn future(&self) -> impl Iterator<Item = &str> {
        self.future.iter().rev().map(|step| &*step.label)
    }
}
