//! Snapshots: a session without history, for work on another thread.

use crate::Session;

impl Session {
    /// A session of the same project with what is derived from it already, without history and
    /// journal. Cheap.
    pub fn snapshot(&self) -> Self {
        Self {
            project: self.project.clone(),
            revision: self.revision,
            derived: self.derived.clone(),
            ..Self::default()
        }
    }

    /// Takes over what a snapshot has derived meanwhile, as far as it still holds.
    pub fn adopt(&mut self, snapshot: Self) {
        if snapshot.project == self.project {
            self.derived.adopt(snapshot.derived);
        } else {
            self.derived.adopt_mannequin(snapshot.derived);
        }
    }
}
