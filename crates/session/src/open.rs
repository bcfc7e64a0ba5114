//! Patterns from files: the format is seen from the content.

use crate::SessionError;
use std::path::{Path, PathBuf};
use toile_interchange::{FormatError, read_garmentcode, read_text};
use toile_pattern::Pattern;

/// The path that stands for the sample pattern inside the program.
pub const SAMPLE: &str = "sample:t-shirt";

/// Formats of patterns that are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PatternFormat {
    /// Toile's own.
    Native,
    /// A GarmentCode specification.
    GarmentCode,
}

/// A pattern read from a file.
#[derive(Clone, Debug)]
pub struct Opened {
    /// The pattern.
    pub pattern: Pattern,
    /// What the file was.
    pub format: PatternFormat,
    /// What was left out or assumed, with its place.
    pub notes: Vec<FormatError>,
}

/// Reads a pattern file.
///
/// # Errors
/// The file cannot be read, or is not a pattern.
pub fn open_pattern(path: &Path) -> Result<Opened, SessionError> {
    read_pattern_text(&read_text(path)?).map_err(|error| SessionError::Format {
        path: PathBuf::from(path),
        error,
    })
}

/// Reads a pattern of either format.
///
/// # Errors
/// The text is not a pattern; with its place and a remedy.
pub fn read_pattern_text(text: &str) -> Result<Opened, FormatError> {
    let reading = read_garmentcode(text)?;
    Ok(Opened {
        pattern: reading.pattern,
        format: PatternFormat::GarmentCode,
        notes: reading.notes,
    })
}
