//! Why a command failed.

use std::path::PathBuf;
use toile_drape::DrapeError;
use toile_interchange::{FileError, FormatError};
use toile_marker::MarkerError;

/// Why a command was not done. The project is unchanged.
#[derive(Debug, thiserror::Error)]
pub enum SessionError {
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A file is not what it should be.
    #[error("{}: {error}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// What is wrong where.
        error: FormatError,
    },
    /// Something made cannot be written in a format.
    #[error("cannot write {file}: {error}")]
    Write {
        /// Name of the file.
        file: &'static str,
        /// What is wrong.
        error: FormatError,
    },
    /// The pattern has faults that keep the garment from being made.
    #[error("{source_name}: {}", faults.join("\n"))]
    Faults {
        /// The pattern's file or name.
        source_name: String,
        /// Each fault with its place and remedy.
        faults: Vec<String>,
    },
    /// An edit was refused.
    #[error("{0}")]
    Edit(#[from] toile_pattern::EditError),
    /// A choice names something that is not there.
    #[error("there is no {kind} {name:?}; {hint}")]
    Unknown {
        /// What kind of thing, as in "size".
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
    /// A measurement that nobody has.
    #[error("the measurement {name} is {value} m; give a length above 0")]
    Measurement {
        /// Its name.
        name: String,
        /// The value given (m).
        value: f64,
    },
    /// No mannequin can be made.
    #[error("mannequin: {0}")]
    Body(#[from] toile_body::BodyError),
    /// The pieces cannot be meshed or placed.
    #[error("{0}")]
    Assembly(#[from] toile_assembly::AssemblyError),
    /// The pieces cannot be laid.
    #[error("{0}")]
    Marker(MarkerError),
    /// The garment cannot be sewn or draped.
    #[error("{0}")]
    Drape(DrapeError),
    /// The garment falls off the body whichever way it is put on.
    #[error(
        "the garment falls off the body: it was put on {tried}; give it a waist, straps or shoulders that hold it, or say where its panels are worn"
    )]
    FallsOff {
        /// How it was put on, and that it fell.
        tried: String,
    },
    /// A picture cannot be drawn.
    #[error("picture: {0}")]
    Picture(#[from] toile_picture::PictureError),
    /// A command has nothing to work on.
    #[error("there is nothing to {action}; {hint}")]
    Nothing {
        /// What was asked, as in "undo".
        action: &'static str,
        /// What to do first.
        hint: &'static str,
    },
    /// A line of a journal cannot be read.
    #[error("journal, line {line}: {what}; each line is one command as JSON")]
    Journal {
        /// Line, from 1.
        line: usize,
        /// What is wrong.
        what: String,
    },
    /// The watcher asked to stop.
    #[error("cancelled")]
    Cancelled,
}

impl SessionError {
    /// The garment falls off, put on so and, where there is another way, so again.
    pub(crate) fn falls_off(first: &str, second: Option<&str>) -> Self {
        let tried = match second {
            Some(second) => format!("{first}, then {second}, and fell within a second both times"),
            None => format!("{first}, and fell within a second"),
        };
        Self::FallsOff { tried }
    }

    /// Whether what was given is at fault, and not the work on it.
    pub fn is_bad_input(&self) -> bool {
        match self {
            Self::File(error) => error.action == "read",
            Self::Drape(error) => matches!(
                error,
                DrapeError::Mesh { .. }
                    | DrapeError::EmptyTriangle { .. }
                    | DrapeError::Material { .. }
                    | DrapeError::Scene { .. }
            ),
            Self::Marker(error) => error.is_bad_input(),
            Self::Write { .. } | Self::Picture(_) | Self::Cancelled => false,
            Self::Format { .. }
            | Self::Faults { .. }
            | Self::Edit(_)
            | Self::Unknown { .. }
            | Self::Conflict(_)
            | Self::Number { .. }
            | Self::Measurement { .. }
            | Self::Body(_)
            | Self::Assembly(_)
            | Self::FallsOff { .. }
            | Self::Nothing { .. }
            | Self::Journal { .. } => true,
        }
    }

    /// Whether the garment fell off the body while it was draped.
    pub(crate) fn has_left_body(&self) -> bool {
        matches!(self, Self::Drape(DrapeError::LeftBody { .. }))
    }
}

impl From<MarkerError> for SessionError {
    fn from(error: MarkerError) -> Self {
        match matches!(error, MarkerError::Cancelled) {
            true => Self::Cancelled,
            false => Self::Marker(error),
        }
    }
}

impl From<DrapeError> for SessionError {
    fn from(error: DrapeError) -> Self {
        match matches!(error, DrapeError::Cancelled) {
            true => Self::Cancelled,
            false => Self::Drape(error),
        }
    }
}
