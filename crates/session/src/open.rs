//! Opens patterns, markers and measurements; the format is recognised from the content.
//!
//! # Decided with
//! - [`toile_interchange::FileKind`], [`crate::input::read_file`]: kinds of files; pipes and standard input;
//! - [`toile_interchange::read_document`], [`toile_interchange::read_garmentcode`]: formats of patterns;
//! - [`crate::tools::convert`]: formats that are written, by ending;
//! - [`crate::stored_marker::nest_marker`]: markers are stored in Toile's own format alone;
//! - [`crate::mesh_file::open_mesh`], [`crate::bodies::body_of`]: meshes; files of bodies;
//! - [`crate::fitting::files_to_try_on`]: files that a pattern names.
//!
//! By hand: a new format in `looks_like_garmentcode` and `read_pattern_text`, in crate `cli` (`arguments.rs`,
//! `FormatName`) and in the window (`app/file_choice.rs`). The window saves Toile's own format alone
//! (`app/files.rs`).

use crate::SessionError;
use crate::input::{is_pipe, read_file};
use crate::placed_panels::PanelOrigin;
use std::path::{Path, PathBuf};
use toile_body::Description;
use toile_interchange::{
    ExpectedKind, FileError, Fitting, FormatError, MarkerFile, SizeChoice, read_document,
    read_garmentcode, read_mannequin, read_marker_json, read_sized_measurements,
};
use toile_measure::Measurements;
use toile_pattern::Pattern;

/// The path that stands for the sample pattern inside the program.
pub const SAMPLE: &str = "sample:t-shirt";

/// Patterns inside the program: the path that stands for each, and its name.
pub const SAMPLES: &[(&str, &str)] = &[
    (SAMPLE, "T-shirt"),
    ("sample:gathered-skirt", "Gathered skirt"),
    ("sample:trousers", "Trousers"),
    ("sample:poncho", "Poncho"),
    ("sample:dress", "Dress"),
];

/// Texts of the sample patterns, in the order of [`SAMPLES`].
const SAMPLE_TEXTS: &[&str] = &[
    include_str!("../../../patterns/t-shirt.toile.json"),
    include_str!("../../../patterns/gathered-skirt.toile.json"),
    include_str!("../../../patterns/trousers.toile.json"),
    include_str!("../../../patterns/poncho.toile.json"),
    include_str!("../../../patterns/dress.toile.json"),
];

/// Whether a path stands for a pattern inside the program.
pub(crate) fn is_sample(path: &Path) -> bool {
    sample(path).is_some()
}

fn sample(path: &Path) -> Option<&'static str> {
    let at = SAMPLES
        .iter()
        .position(|known| path.to_str() == Some(known.0))?;
    SAMPLE_TEXTS.get(at).copied()
}

/// Formats of patterns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PatternFormat {
    /// Toile's own format.
    Native,
    /// A GarmentCode specification.
    GarmentCode,
}

/// A pattern read from a file.
#[derive(Clone, Debug)]
pub struct Opened {
    /// The pattern.
    pub pattern: Pattern,
    /// Fitting of the garment.
    pub fitting: Fitting,
    /// Format of the file.
    pub format: PatternFormat,
    /// Notes on parts that were left out or assumed, with their places.
    pub notes: Vec<String>,
}

/// Reads a pattern file. A pattern without a name is named after its file; panels that the file plainly
/// places round another point than the floor are raised to stand on the floor, with a note.
///
/// # Errors
/// The file cannot be read, or is not a pattern.
pub fn open_pattern(path: &Path) -> Result<Opened, SessionError> {
    open_pattern_from(path, PanelOrigin::Automatic)
}

/// Reads a pattern file whose panels are placed round an origin: see [`open_pattern`].
///
/// # Errors
/// Those of [`open_pattern`].
pub(crate) fn open_pattern_from(path: &Path, origin: PanelOrigin) -> Result<Opened, SessionError> {
    let text = match sample(path) {
        Some(text) => text.to_owned(),
        None => read_input(path, ExpectedKind::Pattern)?,
    };
    let mut opened = read_pattern_text(&text).map_err(|error| SessionError::Format {
        path: PathBuf::from(path),
        error,
    })?;
    if opened.pattern.name.is_empty() {
        opened.pattern.name = stem(path);
    }
    opened.notes.extend(origin.settle(&mut opened.pattern));
    Ok(opened)
}

/// Reads a `marker.json`.
///
/// # Errors
/// The file cannot be read, or is no marker.
pub fn open_marker(path: &Path) -> Result<MarkerFile, SessionError> {
    read_marker_json(&read_input(path, ExpectedKind::Marker)?).map_err(|error| {
        SessionError::Format {
            path: path.to_owned(),
            error,
        }
    })
}

/// Reads the description in a mannequin file.
///
/// # Errors
/// The file cannot be read.
pub fn open_mannequin(path: &Path) -> Result<Description, SessionError> {
    read_mannequin(&read_input(path, ExpectedKind::Mannequin)?).map_err(|error| {
        SessionError::Format {
            path: path.to_owned(),
            error,
        }
    })
}

/// Reads a whole file that should be of a kind.
///
/// # Errors
/// The file is missing or cannot be read, or is plainly of another kind.
pub(crate) fn read_bytes(path: &Path, expected: ExpectedKind) -> Result<Vec<u8>, SessionError> {
    let bytes = read_file(path)?;
    expected
        .check(&bytes)
        .map_err(|error| SessionError::Format {
            path: PathBuf::from(path),
            error,
        })?;
    Ok(bytes)
}

/// Reads a whole text file that should be of a kind.
///
/// # Errors
/// The file is missing or cannot be read, is plainly of another kind, or is not text in UTF-8.
pub fn read_input(path: &Path, expected: ExpectedKind) -> Result<String, SessionError> {
    let bytes = read_bytes(path, expected)?;
    let mut text = String::from_utf8(bytes).map_err(|error| {
        let cause = std::io::Error::new(std::io::ErrorKind::InvalidData, error.utf8_error());
        FileError::from_io("read", path, &cause)
    })?;
    // Editors on Windows begin UTF-8 with a mark that JSON does not allow.
    if text.starts_with('\u{feff}') {
        text.remove(0);
    }
    Ok(text)
}

/// A file's name without folder and endings, as a title.
fn stem(path: &Path) -> String {
    if is_pipe(path) {
        return "pattern".to_owned();
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name = name.split('.').next().unwrap_or_default();
    let name = name.strip_suffix("_specification").unwrap_or(name);
    let words: String = name.replace(['_', '-'], " ").chars().take(60).collect();
    match words.trim() {
        "" => "pattern".to_owned(),
        words => words.to_owned(),
    }
}

/// Reads a pattern of either format.
///
/// # Errors
/// The text is not a pattern; with its place and a remedy.
pub fn read_pattern_text(text: &str) -> Result<Opened, FormatError> {
    if looks_like_garmentcode(text) {
        let reading = read_garmentcode(text)?;
        return Ok(Opened {
            pattern: reading.pattern,
            fitting: Fitting::default(),
            format: PatternFormat::GarmentCode,
            notes: reading.notes.iter().map(ToString::to_string).collect(),
        });
    }
    let file = read_document(text)?;
    Ok(Opened {
        pattern: file.pattern,
        fitting: file.fitting,
        format: PatternFormat::Native,
        notes: file.notes.iter().map(ToString::to_string).collect(),
    })
}

/// A GarmentCode file has a `pattern` with `panels`; a native one says `toile`.
fn looks_like_garmentcode(text: &str) -> bool {
    #[derive(serde::Deserialize)]
    struct Head {
        toile: Option<serde::de::IgnoredAny>,
        pattern: Option<serde::de::IgnoredAny>,
    }
    // A damaged native file goes to the native reader, which says where it is damaged.
    match serde_json::from_str::<Head>(text) {
        Ok(head) => head.toile.is_none() && head.pattern.is_some(),
        Err(_) => !text.contains("\"toile\"") && text.contains("\"panels\""),
    }
}

/// Reads a table of body measurements: native JSON, GarmentCode YAML, Seamly, Valentina or
/// FreeSewing. A table for several sizes is read in the chosen size. Also returns notes on the size
/// taken and on parts that were left out.
///
/// # Errors
/// The file cannot be read, is not such a table, or does not have the size.
pub fn open_measurements(
    path: &Path,
    choice: SizeChoice,
) -> Result<(Measurements, Vec<String>), SessionError> {
    let text = read_input(path, ExpectedKind::Measurements)?;
    read_sized_measurements(&text, choice).map_err(|error| SessionError::Format {
        path: PathBuf::from(path),
        error,
    })
}
