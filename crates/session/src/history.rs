//! The one history: steps with labels, undone and done again by cheap snapshots.

use crate::Project;

/// Most steps kept.
const MOST_STEPS: usize = 1000;

/// One step: the project on the other side of it.
#[derive(Clone, Debug)]
struct Step {
    label: String,
    drag: Option<u64>,
    project: Project,
}

/// Steps that can be taken back, and those that can be done again.
#[derive(Clone, Debug, Default)]
pub(crate) struct History {
    past: Vec<Step>,
    future: Vec<Step>,
}

impl History {
    /// Notes a step from `before`. A step of the same drag as the last one becomes part of it.
    pub fn record(&mut self, before: Project, label: &str, drag: Option<u64>) {
        self.future.clear();
        let same_drag = drag.is_some() && self.past.last().is_some_and(|last| last.drag == drag);
        if same_drag {
            return;
        }
        if self.past.len() == MOST_STEPS {
            self.past.remove(0);
        }
        self.past.push(Step {
            label: label.to_owned(),
            drag,
            project: before,
        });
    }

    /// The project before the last step; `now` can be had back by [`History::redo`].
    pub fn undo(&mut self, now: &Project) -> Option<Project> {
        let step = self.past.pop()?;
        self.future.push(Step {
            project: now.clone(),
            label: step.label,
            drag: None,
        });
        Some(step.project)
    }

    /// The project after the step last taken back.
    pub fn redo(&mut self, now: &Project) -> Option<Project> {
        let step = self.future.pop()?;
        self.past.push(Step {
            project: now.clone(),
            label: step.label,
            drag: None,
        });
        Some(step.project)
    }

    /// Label of the step that would be taken back.
    pub fn can_undo(&self) -> Option<&str> {
        self.past.last().map(|step| &*step.label)
    }

    /// Label of the step that would be done again.
    pub fn can_redo(&self) -> Option<&str> {
        self.future.last().map(|step| &*step.label)
    }
}
