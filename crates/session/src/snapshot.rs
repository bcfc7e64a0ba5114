//! Snapshots: a session without history, for work on another thread.

use crate::Session;

impl Session {
    /// A copy of the session with the project and all values derived from it so far, without history and
    /// journal. Cheap.
    pub fn snapshot(&self) -> Self {
        Self {
            project: self.project.clone(),
            revision: self.revision,
            derived: self.derived.clone(),
            ..Self::default()
        }
    }

    /// A snapshot that also has the journal and the times that its commands took, for an export that writes
    /// them.
    pub fn snapshot_to_export(&self) -> Self {
        Self {
            journal: self.journal.clone(),
            timing: self.timing.clone(),
            ..self.snapshot()
        }
    }

    /// Adopts the values that a snapshot has derived since it was made, as far as they are still valid. A
    /// drape made by the snapshot is not adopted: the drape of this session may have been pulled by hand.
    pub fn adopt_export(&mut self, mut snapshot: Self) {
        snapshot.derived.drape = None;
        self.adopt(snapshot);
    }

    /// Adopts the values that a snapshot has derived since it was made, as far as they are still valid.
    pub fn adopt(&mut self, snapshot: Self) {
        if snapshot.project == self.project {
            self.derived.adopt(snapshot.derived);
        } else {
            self.derived.adopt_mannequin(snapshot.derived);
        }
    }
}
