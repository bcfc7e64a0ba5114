//! Opens patterns, markers and measurements; the format is recognised from the content.
//!
//! # Decided with
//! - [`toile_interchange::FileKind`], [`crate::input::read_file`]: kinds of files; pipes and standard input;
//! - [`toile_interchange::read`], [`toile_interchange::Format`]: patterns read; formats of patterns;
//! - [`crate::convert()`]: patterns written;
//! - [`crate::stored_marker::nest_marker`]: markers are stored in Toile's own format alone;
//! - [`crate::mesh_file::open_mesh`], [`crate::bodies::body_of`]: meshes; files of bodies;
//! - [`crate::fitting::files_to_try_on`]: files that a pattern names.

use crate::SessionError;
use crate::input::{is_pipe, read_file};
use crate::placed_panels::PanelOrigin;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use toile_body::Description;
use toile_interchange::{
    Companion, ExpectedKind, FileError, FileKind, Format, FormatError, MarkerFile, ReadOptions,
    Reading, SizeChoice, companion_names, read, read_mannequin, read_marker_json,
    read_sized_measurements,
};
use toile_measure::Measurements;

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

/// How a pattern file is read: answers to what it leaves open, and the files that belong to it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct OpenOptions {
    /// Answers to what the file leaves open.
    #[serde(flatten)]
    pub reading: ReadOptions,
    /// Files that belong to the pattern: a table of grade rules, or of measurements.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub with: Vec<PathBuf>,
}

impl OpenOptions {
    /// Whether nothing is said beside the file.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// Use of a file that is dropped on a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileUse {
    /// A pattern to open.
    Pattern,
    /// Measurements or a mannequin of the wearer.
    Wearer,
    /// A fabric to cut from.
    Fabric,
    /// A file of another kind.
    Other,
}

/// Use of a file, by its content.
///
/// # Errors
/// The file cannot be read.
pub fn file_use(path: &Path) -> Result<FileUse, SessionError> {
    let kind = FileKind::of(&read_file(path)?);
    Ok(match kind {
        Some(FileKind::Measurements | FileKind::Mannequin) => FileUse::Wearer,
        Some(FileKind::Fabric) => FileUse::Fabric,
        Some(kind) if Format::of_kind(kind).is_some() => FileUse::Pattern,
        Some(_) | None => FileUse::Other,
    })
}

/// Reads a pattern file. A pattern without a name is named after its file; panels that the file plainly
/// places round another point than the floor are raised to stand on the floor, with a note.
///
/// # Errors
/// The file cannot be read, or is not a pattern.
pub fn open_pattern(path: &Path) -> Result<Reading, SessionError> {
    let opened = open_pattern_from(path, PanelOrigin::Automatic, &OpenOptions::default())?;
    Ok(opened.reading)
}

/// A pattern that was opened, and the files that were read with it.
pub(crate) struct OpenedPattern {
    pub reading: Reading,
    /// Tables of grade rules or measurements that belong to it.
    pub companions: Vec<PathBuf>,
}

/// Reads a pattern file as options say, with its panels placed round an origin: see [`open_pattern`].
///
/// # Errors
/// Those of [`open_pattern`]; an option that the format has no use for.
pub(crate) fn open_pattern_from(
    path: &Path,
    origin: PanelOrigin,
    options: &OpenOptions,
) -> Result<OpenedPattern, SessionError> {
    let bytes = match sample(path) {
        Some(text) => text.as_bytes().to_vec(),
        None => read_file(path)?,
    };
    let companions = companions(path, &bytes, &options.with);
    opened_from((path, &bytes), companions, (origin, &options.reading))
}

/// Reads the bytes of a pattern with the files that belong to it; `path` names them in errors.
pub(crate) fn opened_from(
    (path, bytes): (&Path, &[u8]),
    companions: Vec<PathBuf>,
    (origin, options): (PanelOrigin, &ReadOptions),
) -> Result<OpenedPattern, SessionError> {
    let read_whole = |file: &PathBuf| {
        Ok(Companion {
            name: file
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned(),
            bytes: read_file(file)?,
        })
    };
    let contents: Result<Vec<Companion>, SessionError> =
        companions.iter().map(read_whole).collect();
    let mut reading = read(bytes, options, &contents?).map_err(|error| SessionError::Format {
        path: PathBuf::from(path),
        error,
    })?;
    if reading.pattern.name.is_empty() {
        reading.pattern.name = stem(path);
    }
    reading.notes.extend(origin.settle(&mut reading.pattern));
    Ok(OpenedPattern {
        reading,
        companions,
    })
}

/// The files that belong to a pattern: those given, else the one that it names, or that has its name, where it
/// lies in its folder or where it says. A file that it names and that is not there is left to the reader.
fn companions(path: &Path, bytes: &[u8], given: &[PathBuf]) -> Vec<PathBuf> {
    if !given.is_empty() {
        return given.to_vec();
    }
    if is_sample(path) || is_pipe(path) {
        return Vec::new();
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let found = |named: String| {
        // Files of other systems name folders with backslashes.
        let named = named.replace('\\', "/");
        let own = named.rsplit('/').next().unwrap_or_default();
        let mut places = [folder.join(own), folder.join(&named)].into_iter();
        places.find(|place| place.is_file())
    };
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let mut names = companion_names(bytes, &name).into_iter();
    names.find_map(found).into_iter().collect()
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

/// Reads a pattern from a text, in any format.
///
/// # Errors
/// The text is not a pattern; with its place and a remedy.
pub fn read_pattern_text(text: &str) -> Result<Reading, FormatError> {
    read(text.as_bytes(), &ReadOptions::default(), &[])
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
