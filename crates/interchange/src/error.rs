//! The two errors of this crate: a file that cannot be handled, and text that cannot be read.

use std::path::{Path, PathBuf};

/// A file that could not be read or written. The message tells which file, why, and the remedy.
#[derive(Debug, thiserror::Error)]
#[error("cannot {action} {}: {cause}; {hint}", path.display())]
pub struct FileError {
    /// The action that failed, as in "write".
    pub action: &'static str,
    /// The file or folder.
    pub path: PathBuf,
    /// The error message of the operating system, or the fault of the path.
    pub cause: String,
    /// Remedy for the user.
    pub hint: &'static str,
}

impl FileError {
    /// An error of the operating system, with the remedy for its kind.
    pub fn from_io(action: &'static str, path: &Path, error: &std::io::Error) -> Self {
        use std::io::ErrorKind;
        // The last arm stands for all other kinds of errors, also those that later versions of Rust may add.
        #[expect(
            clippy::wildcard_enum_match_arm,
            reason = "the system may tell kinds that nobody knows yet"
        )]
        let hint = match error.kind() {
            ErrorKind::NotFound => "check the spelling of the path",
            ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
                "choose a folder you may write to, or change its permissions"
            }
            ErrorKind::StorageFull | ErrorKind::QuotaExceeded => {
                "free some space or choose another disk"
            }
            ErrorKind::IsADirectory => "name a file, not a folder",
            ErrorKind::NotADirectory | ErrorKind::AlreadyExists => {
                "a file stands where a folder is needed: rename it or choose another folder"
            }
            ErrorKind::InvalidData => {
                "the file is not text in UTF-8: check that it is the right one"
            }
            _ => "check the path and the disk, then try again",
        };
        Self {
            action,
            path: path.to_owned(),
            cause: error.to_string(),
            hint,
        }
    }
}

/// Text or bytes that do not have the expected format: the fault, the place and the remedy.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {what}; {hint}")]
pub struct FormatError {
    /// Place in the input, as in "line 12" or "panels.front.edges\[3\]".
    pub place: String,
    /// The fault at this place.
    pub what: String,
    /// Remedy for the user.
    pub hint: String,
}

impl FormatError {
    /// An error at a place.
    pub fn new(place: impl Into<String>, what: impl Into<String>, hint: impl Into<String>) -> Self {
        Self {
            place: place.into(),
            what: what.into(),
            hint: hint.into(),
        }
    }
}

/// Reads a whole text file.
///
/// # Errors
/// The file is missing, cannot be read, or is not UTF-8.
pub fn read_text(path: &Path) -> Result<String, FileError> {
    std::fs::read_to_string(path).map_err(|error| FileError::from_io("read", path, &error))
}
