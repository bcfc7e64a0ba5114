//! Why a marker could not be made.

use toile_interchange::FormatError;
use toile_nesting::NestingError;

/// Why a marker was not made, drawn or written.
#[derive(Debug, thiserror::Error)]
pub enum MarkerError {
    /// The pieces cannot be laid.
    #[error("marker: {0}")]
    Nesting(NestingError),
    /// A choice names something that is not there.
    #[error("there is no {kind} {name:?}; {hint}")]
    Unknown {
        /// What kind of thing, as in "fabric".
        kind: &'static str,
        /// The name given.
        name: String,
        /// What there is instead.
        hint: String,
    },
    /// Things asked for that do not go together.
    #[error("{0}")]
    Conflict(String),
    /// A number given makes no sense.
    #[error("{what} is {value}; {hint}")]
    Number {
        /// What it is.
        what: &'static str,
        /// The value given.
        value: f64,
        /// What would be right.
        hint: &'static str,
    },
    /// A piece of a pattern has no cut line.
    #[error("{pattern}: {fault}")]
    Piece {
        /// Name of the pattern.
        pattern: String,
        /// The piece and what is wrong with it.
        fault: String,
    },
    /// A marker cannot be written in a format.
    #[error("cannot write {file}: {error}")]
    Write {
        /// Name of the file.
        file: &'static str,
        /// What is wrong.
        error: FormatError,
    },
    /// The search was told to stop.
    #[error("cancelled")]
    Cancelled,
}

impl MarkerError {
    /// Whether what was given is at fault, and not the work on it.
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
