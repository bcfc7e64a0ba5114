//! Errors of making, drawing and writing markers.

use toile_interchange::FormatError;
use toile_nesting::NestingError;

/// The reason why a marker was not made, drawn or written.
#[derive(Debug, thiserror::Error)]
pub enum MarkerError {
    /// The pieces cannot be laid.
    #[error("marker: {0}")]
    Nesting(NestingError),
    /// An option names something that does not exist.
    #[error("there is no {kind} {name:?}; {hint}")]
    Unknown {
        /// Kind of the thing, as in "fabric".
        kind: &'static str,
        /// Name that was given.
        name: String,
        /// The names that exist.
        hint: String,
    },
    /// Options that contradict each other.
    #[error("{0}")]
    Conflict(String),
    /// A given number is out of range.
    #[error("{what} is {value}; {hint}")]
    Number {
        /// Meaning of the number.
        what: &'static str,
        /// Value that was given.
        value: f64,
        /// The valid values.
        hint: &'static str,
    },
    /// A piece of a pattern has no cut line.
    #[error("{pattern}: {fault}")]
    Piece {
        /// Name of the pattern.
        pattern: String,
        /// The piece and its fault.
        fault: String,
    },
    /// A marker cannot be written in a format.
    #[error("cannot write {file}: {error}")]
    Write {
        /// Name of the file.
        file: &'static str,
        /// The fault.
        error: FormatError,
    },
    /// The search was told to stop.
    #[error("cancelled")]
    Cancelled,
}

impl MarkerError {
    /// Whether the input is at fault, not the processing.
    pub fn is_bad_input(&self) -> bool {
        !matches!(
            self,
            Self::Nesting(NestingError::Unsound(_) | NestingError::Cancelled)
                | Self::Write { .. }
                | Self::Cancelled
        )
    }
}

impl From<NestingError> for MarkerError {
    fn from(error: NestingError) -> Self {
        match error {
            NestingError::Cancelled => Self::Cancelled,
            refused @ (NestingError::NoItems
            | NestingError::TooManyPieces(_)
            | NestingError::Search(_)
            | NestingError::TooManyShapes { .. }
            | NestingError::Strip(_)
            | NestingError::Refused(_)
            | NestingError::Unsound(_)) => Self::Nesting(refused),
        }
    }
}
