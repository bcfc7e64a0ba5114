//! Path of a scene file, and errors about its content.

use crate::SessionError;
use std::path::{Path, PathBuf};
use toile_interchange::FormatError;

/// A scene file, from whose folder other files are named.
#[derive(Clone, Copy)]
pub(crate) struct ScenePlace<'a>(pub &'a Path);

impl ScenePlace<'_> {
    /// A file that the scene names.
    pub fn beside(self, name: &str) -> PathBuf {
        self.0.parent().unwrap_or(Path::new(".")).join(name)
    }

    /// Error for a fault of the scene file.
    pub fn error(self, error: FormatError) -> SessionError {
        SessionError::Format {
            path: self.0.to_owned(),
            error,
        }
    }

    /// Error for a fault of the scene file: place, fault and remedy.
    pub fn wrong(self, place: String, what: String, remedy: &str) -> SessionError {
        self.error(FormatError::new(place, what, remedy))
    }
}
