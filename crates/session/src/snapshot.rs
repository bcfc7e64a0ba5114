//! Snapshots: a session without history, for work on another thread.

use crate::Session;

impl Session {
    /// A session of the same project with the values derived from it already, without history and
    /// journal. Cheap.
    pub fn snapshot(&self) -> Self {
        Self {
            project: self.project.clone(),
            revision: self.revision,
            derived: self.derived.clone(),
            ..Self::default()
        }
    }

    /// A snapshot that knows the commands that led to it and how long they took, for an export that writes
    /// them down.
    pub fn snapshot_to_export(&self) -> Self {
        Self {
            journal: self.journal.clone(),
            timing: self.timing.clone(),
            ..self.snapshot()
        }
    }

    /// Adopts the values that a snapshot has derived meanwhile, as far as they are still valid; not a drape
    /// that it has made: the garment on show is exported as it was pulled.
    pub fn adopt_export(&mut self, mut snapshot: Self) {
        snapshot.derived.drape = None;
        self.adopt(snapshot);
    }

    /// Adopts the values that a snapshot has derived meanwhile, as far as they are still valid.
    pub fn adopt(&mut self, snapshot: Self) {
        if snapshot.project == self.project {
            self.derived.adopt(snapshot.derived);
        } else {
            self.derived.adopt_mannequin(snapshot.derived);
        }
    }
}
