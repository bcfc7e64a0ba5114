//! Why a command failed.
//!
//! # Decided with
//! - [`toile_interchange::FormatError`], [`toile_interchange::FileError`]: errors of files;
//! - [`toile_drape::DrapeError`], [`toile_assembly::AssemblyError`], [`toile_body::BodyError`]: errors of
//!   simulation, meshing and bodies;
//! - [`toile_marker::MarkerError`], [`toile_picture::PictureError`]: errors of markers and pictures;
//! - [`crate::error::SessionError::falls_off`], [`crate::derived::Derived::drape_otherwise`]: a garment that
//!   falls off however it is put on.
//!
//! By hand: `is_bad_input` names the errors of the drape that are bad input. Exit status: crate `cli`,
//! `output.rs`.

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
    /// A file has a wrong format or content.
    #[error("{}: {error}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// The fault and its place.
        error: FormatError,
    },
    /// A result cannot be written in its format.
    #[error("cannot write {file}: {error}")]
    Write {
        /// Name of the file.
        file: &'static str,
        /// The fault.
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
    /// A command names something that does not exist.
    #[error("there is no {kind} {name:?}; {hint}")]
    Unknown {
        /// Kind of thing, as in "size".
        kind: &'static str,
        /// The name given.
        name: String,
        /// Names that exist, or another remedy.
        hint: String,
    },
    /// Requests that do not go together, or cannot be met; with the remedy.
    #[error("{0}")]
    Conflict(String),
    /// A number is out of range.
    #[error("{what} is {value}; {hint}")]
    Number {
        /// Name of the quantity, with its unit.
        what: &'static str,
        /// The value given.
        value: f64,
        /// Numbers that are valid.
        hint: &'static str,
    },
    /// A measurement that no body has.
    #[error("the measurement {name} is {value} m; give a length above 0")]
    Measurement {
        /// Name of the measurement.
        name: String,
        /// The value given (m).
        value: f64,
    },
    /// No mannequin can be made from the measurements or the description of a body.
    #[error("mannequin: {0}")]
    Body(#[from] toile_body::BodyError),
    /// The pieces cannot be meshed or placed.
    #[error("{0}")]
    Assembly(#[from] toile_assembly::AssemblyError),
    /// The pieces cannot be laid on the fabric.
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
        /// Words for the ways in which the garment was put on and fell off.
        tried: String,
    },
    /// A picture cannot be drawn.
    #[error("picture: {0}")]
    Picture(#[from] toile_picture::PictureError),
    /// A command such as Undo has nothing to act on.
    #[error("there is nothing to {action}; {hint}")]
    Nothing {
        /// Action that was asked for, as in "undo".
        action: &'static str,
        /// Step to take first.
        hint: &'static str,
    },
    /// A line of a journal cannot be read or written.
    #[error("journal, line {line}: {what}; each line is one command as JSON")]
    Journal {
        /// Line, from 1.
        line: usize,
        /// The fault.
        what: String,
    },
    /// A job of a batch was not done, for a reason that is none of its own.
    #[error("job {id} was not done: {why}")]
    Job {
        /// Name of the job.
        id: String,
        /// The reason, with the remedy.
        why: String,
    },
    /// The watcher asked to stop.
    #[error("cancelled")]
    Cancelled,
}

impl SessionError {
    /// Error of a garment that falls off, put on in a first way and, if there is one, in a second way.
    pub(crate) fn falls_off(first: &str, second: Option<&str>) -> Self {
        let tried = match second {
            Some(second) => format!("{first}, then {second}, and fell within a second both times"),
            None => format!("{first}, and fell within a second"),
        };
        Self::FallsOff { tried }
    }

    /// Whether the user's input caused the error, and not the work on it.
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
            Self::Write { .. } | Self::Picture(_) | Self::Job { .. } | Self::Cancelled => false,
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
