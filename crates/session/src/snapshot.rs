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

    /// A snapshot that knows the commands that led to it and how long they took, for an export that writes them down.
    pub fn snapshot_to_export(&self) -> Self {
        Self {
            journal: self.journal.clone(),
            timing: self.timing.clone(),
            ..self.snapshot()
        }
    }

    /// Takes over the markers that a snapshot has laid meanwhile, as far as they still hold. A drape it has made is
    /// not taken over: the garment on show is exported as it was pulled.
    pub fn adopt_export(&mut self, mut snapshot: Self) {
        snapshot.derived.drape = None;
        self.adopt(snapshot);
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
