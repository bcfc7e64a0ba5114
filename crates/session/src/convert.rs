//! Converts patterns between formats.
//!
//! # Decided with
//! - [`crate::open::open_pattern_from`]: the pattern read, with what the file leaves open;
//! - [`crate::write_pattern`]: the pattern written.
//!
//! Options: crate `cli`, `convert_command.rs`.

use crate::event::FoundInFile;
use crate::fitting::OpenedProject;
use crate::write_pattern::{WrittenPattern, format_of, write_pattern};
use crate::{OpenOptions, PanelOrigin, Project, SessionError};
use std::path::Path;
use toile_interchange::Format;
use toile_pattern::SizeSelection;

/// How a pattern is converted.
#[derive(Clone, Debug, Default)]
pub struct ConvertOptions {
    /// How the input is read.
    pub open: OpenOptions,
    /// Format to write; `None`: the one that the output's name ends in.
    pub to: Option<Format>,
    /// Point of the body that the input places its panels round.
    pub origin: PanelOrigin,
    /// Sizes to write in a format that holds shapes; `None`: the size that the file keeps, else the base size.
    pub sizes: Option<SizeSelection>,
}

/// A pattern that was converted.
#[derive(Clone, Debug)]
pub struct Converted {
    /// Format of the input, with what reading it found out.
    pub read: FoundInFile,
    /// Notes on the reading in words, guesses and losses too.
    pub notes: Vec<String>,
    /// What was written.
    pub written: WrittenPattern,
}

/// Reads a pattern and writes it in a format. Panels that the input places in space, round an origin, are
/// written as they stand on the floor.
///
/// # Errors
/// The input cannot be read; the output has a name of no format, or of another one than asked for, or cannot
/// be written; the garment has faults, and the format holds shapes.
pub fn convert(
    from: &Path,
    to: &Path,
    options: &ConvertOptions,
) -> Result<Converted, SessionError> {
    let format = format_of(to, options.to)?;
    let OpenedProject {
        project,
        notes,
        found,
    } = Project::open_from(from, options.origin, &options.open)?;
    Ok(Converted {
        read: found,
        notes,
        written: write_pattern(&project, to, format, options.sizes.as_ref())?,
    })
}
