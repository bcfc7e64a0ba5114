//! The native formats: readable, versioned JSON.
//!
//! A pattern file (`*.toile.json`) declares its unit once. Bare numbers in it are lengths in that unit or
//! angles in degrees; texts are formulas. Parts are referred to by id, in formulas by name.
//!
//! # Decided with
//! - [`toile_pattern::fields`](mod@toile_pattern::fields): which fields a part has, said once for all;
//! - [`crate::native::part_reader`], [`crate::native::part_writer`]: readers and writers of any part by its
//!   fields;
//! - [`crate::native::reader`], [`crate::native::writer`], [`crate::native::units`]: ids, names, numbers in
//!   the file's unit;
//! - [`crate::native::read`], [`crate::native::write`]: the root of the file;
//! - [`crate::native::fitting::Fitting`], [`crate::native::read_fitting`], [`crate::native::write_fitting`]:
//!   how a garment is tried on;
//! - [`crate::native::item::Item::note_unknown`], [`crate::native::json::parse`]: unknown fields told; damage
//!   refused with its place;
//! - [`crate::native::VERSION`], [`crate::native::check_version`]: versions that are read.
//!
//! By hand: `VERSION` is raised when an older program would misread a file; the fields of a fitting.

mod fitting;
pub(crate) mod item;
pub(crate) mod json;
mod measurements;
mod part_reader;
mod part_writer;
mod read;
mod read_fitting;
mod reader;
mod units;
mod write;
mod write_fitting;
mod writer;

pub use fitting::{FABRIC_WIDTHS, Fitting, FittingFabric, FittingLayer, FittingWearer};

use crate::FormatError;
use item::Item;
use toile_pattern::{Diagnostic, Pattern};

/// The version of the format that is written and read.
const VERSION: u32 = 2;

/// The content of a pattern file: the pattern and the fitting of its garment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PatternFile {
    /// The pattern.
    pub pattern: Pattern,
    /// The fitting of the garment.
    pub fitting: Fitting,
    /// Notes on unknown fields.
    pub notes: Vec<Diagnostic>,
}

/// Reads the pattern of a file in the native format (`*.toile.json`).
///
/// # Errors
/// Those of [`read_document`].
pub fn read_pattern(text: &str) -> Result<(Pattern, Vec<Diagnostic>), FormatError> {
    let file = read_document(text)?;
    Ok((file.pattern, file.notes))
}

/// Writes a pattern in the native format. Reading it back gives the same pattern.
///
/// # Errors
/// The pattern has an invalid part name or a number that is not finite. Documents changed only through edits
/// have neither.
pub fn write_pattern(pattern: &Pattern) -> Result<String, FormatError> {
    write_document(pattern, &Fitting::default())
}

/// Writes a pattern and the fitting of its garment in the native format. Reading gives back both.
///
/// # Errors
/// Those of [`write_pattern`].
pub fn write_document(pattern: &Pattern, tried_on: &Fitting) -> Result<String, FormatError> {
    write::write(pattern, |writer| write_fitting::fitting(writer, tried_on))
}

/// Reads a file in the native format (`*.toile.json`).
///
/// Fields unknown to this version are named in the diagnostics; everything else that is not understood is
/// refused with line, column, path and remedy.
///
/// # Errors
/// The text is not JSON, is not a pattern of this version, or refers to parts it does not have.
pub fn read_document(text: &str) -> Result<PatternFile, FormatError> {
    let node = json::parse(text)?;
    let root = Item::root(&node);
    let mut notes = Vec::new();
    check_version(&root)?;
    let (pattern, fitting) = read::read(&root, read_fitting::fitting, &mut notes)?;
    Ok(PatternFile {
        pattern,
        fitting,
        notes,
    })
}

/// Refuses a file that does not hold a pattern of this version.
fn check_version(root: &Item<'_>) -> Result<(), FormatError> {
    let object = root.fields()?;
    let Some(version) = object.get("toile") else {
        return Err(root.error(
            "the file does not say that it is one of Toile's",
            "its first field is \"toile\": 2; for other formats name the format",
        ));
    };
    let number = version.count()?;
    if number == 1 {
        return Err(version.error(
            "the file is of version 1, which was never released and is not read any more",
            "convert it with the program that wrote it, or export it from there as GarmentCode",
        ));
    }
    if number != VERSION {
        return Err(version.error(
            format!("the file is of version {number}, this program reads up to {VERSION}"),
            "use a newer program, or save the file for this version",
        ));
    }
    let kind = object.need("kind")?;
    if kind.text()? != "pattern" {
        return Err(kind.error(
            format!("the file holds a {:?}", kind.text()?),
            "give a file of kind \"pattern\"",
        ));
    }
    Ok(())
}
