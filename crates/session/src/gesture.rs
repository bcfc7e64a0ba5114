//! Gestures: edits that are shown while a drag or a tool goes on, and taken over when it ends.

use crate::session::Gesture;
use crate::{Command, Event, Project, Session, SessionError, Silent};
use toile_pattern::Edit;

impl Session {
    /// Shows the result of edits of the project's pattern. They replace the edits that the present
    /// gesture showed before; nothing goes to the history until [`Session::commit`].
    ///
    /// # Errors
    /// The edits cannot be made; the previous state is still shown.
    pub fn preview(&mut self, edits: &[Edit]) -> Result<(), SessionError> {
        let base = self.gesture.as_ref().map_or(&self.project, |g| &g.base);
        let next = base.edited(edits)?;
        let base = self.project.clone();
        let derived = &self.derived;
        let gesture = self.gesture.get_or_insert_with(|| Gesture {
            base,
            derived: derived.clone(),
            edits: Vec::new(),
        });
        gesture.edits = edits.to_vec();
        self.show(next);
        Ok(())
    }

    /// Whether a gesture is being previewed.
    pub fn is_previewing(&self) -> bool {
        self.gesture.is_some()
    }

    /// Commits the present gesture as one step of the history and one command of the journal. Does nothing
    /// without a gesture.
    ///
    /// # Errors
    /// The edits cannot be made, which [`Session::preview`] would have said.
    pub fn commit(&mut self, label: &str) -> Result<Vec<Event>, SessionError> {
        let Some(edits) = self.cancel() else {
            return Ok(Vec::new());
        };
        let label = label.to_owned();
        self.execute(Command::Edit { edits, label }, &mut Silent)
    }

    /// Ends the present gesture without committing it, and returns its edits.
    pub fn cancel(&mut self) -> Option<Vec<Edit>> {
        let gesture = self.gesture.take()?;
        // The present evaluation stays: its next update undoes the difference. All other values are those of
        // before the gesture.
        self.derived = gesture.derived.with_evaluation_of(&self.derived);
        self.project = gesture.base;
        self.revision += 1;
        Some(gesture.edits)
    }

    fn show(&mut self, next: Project) {
        self.derived.forget_draft();
        self.project = next;
        self.revision += 1;
    }
}
