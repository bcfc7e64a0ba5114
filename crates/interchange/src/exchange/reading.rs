//! Patterns read from bytes.

use super::{Companion, Format, Guess, Loss, ReadOption, ReadOptions};
use crate::dxf::{read_dxf, rule_table_names};
use crate::native::{Fitting, PatternFile};
use crate::svg::{SvgReading, read_svg};
use crate::valentina::{ValentinaReading, measurement_file, read_valentina};
use crate::{ExpectedKind, FileKind, FormatError, read_document, read_garmentcode};
use toile_pattern::Pattern;

/// A pattern that was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// The pattern.
    pub pattern: Pattern,
    /// Fitting of the garment; files of other programs have none.
    pub fitting: Fitting,
    /// Format of the file.
    pub format: Format,
    /// Decisions on what the file leaves open.
    pub guesses: Vec<Guess>,
    /// Contents of the file that were left out.
    pub losses: Vec<Loss>,
    /// Notes on contents that were taken otherwise than they stand there, with their places.
    pub notes: Vec<String>,
}

impl Reading {
    /// A reading without guesses, losses and notes.
    fn plain(pattern: Pattern, format: Format) -> Self {
        Self {
            pattern,
            fitting: Fitting::default(),
            format,
            guesses: Vec::new(),
            losses: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// All notes in words: those of the format, then guesses and losses.
    pub fn words(&self) -> Vec<String> {
        let notes = self.notes.iter().cloned();
        let guesses = self.guesses.iter().map(ToString::to_string);
        let losses = self.losses.iter().map(|loss| format!("left out: {loss}"));
        notes.chain(guesses).chain(losses).collect()
    }
}

/// Names that the file which a pattern needs beside itself may have, with the folders that it names them in; the
/// first that is there is meant. `name` is that of the pattern's own file.
pub fn companion_names(bytes: &[u8], name: &str) -> Vec<String> {
    match FileKind::of(bytes).and_then(Format::of_kind) {
        Some(Format::Valentina | Format::Seamly) => {
            let named = text(bytes).ok().and_then(measurement_file);
            named.into_iter().collect()
        }
        Some(Format::DxfAama | Format::DxfAstm) => rule_table_names(bytes, name),
        Some(Format::Native | Format::GarmentCode | Format::Svg) | None => Vec::new(),
    }
}

/// Reads a pattern of any format that is known here, with the files that belong to it.
///
/// # Errors
/// The bytes are of another kind, named with the command that takes it; or they are damaged: the fault, its
/// place and a remedy.
pub fn read(
    bytes: &[u8],
    options: &ReadOptions,
    companions: &[Companion],
) -> Result<Reading, FormatError> {
    let format = match options.format {
        Some(format) => format,
        None => {
            ExpectedKind::Pattern.check(bytes)?;
            let kind = FileKind::of(bytes);
            let known = kind.and_then(Format::of_kind);
            if kind.is_none() && !begins_as_json(bytes) {
                return Err(ExpectedKind::Pattern.unknown());
            }
            // A damaged file goes to the native reader, which says where it is damaged.
            known.unwrap_or(if looks_like_garmentcode(bytes) {
                Format::GarmentCode
            } else {
                Format::Native
            })
        }
    };
    refuse_unused(format, options, companions)?;
    match format {
        Format::Native => {
            let PatternFile {
                pattern,
                fitting,
                notes,
            } = read_document(text(bytes)?)?;
            Ok(Reading {
                fitting,
                notes: notes.iter().map(ToString::to_string).collect(),
                ..Reading::plain(pattern, format)
            })
        }
        Format::Svg => {
            let SvgReading {
                pattern,
                fitting,
                guesses,
                losses,
                notes,
            } = read_svg(text(bytes)?, options)?;
            Ok(Reading {
                fitting,
                guesses,
                losses,
                notes,
                ..Reading::plain(pattern, format)
            })
        }
        Format::DxfAama | Format::DxfAstm => {
            let reading = read_dxf(bytes, options, companions)?;
            // What is asked for holds against the signs of the file.
            Ok(Reading {
                guesses: reading.guesses,
                losses: reading.losses,
                ..Reading::plain(reading.pattern, options.format.unwrap_or(reading.format))
            })
        }
        Format::Valentina | Format::Seamly => {
            let ValentinaReading {
                pattern,
                guesses,
                losses,
                notes,
            } = read_valentina(text(bytes)?, companions)?;
            Ok(Reading {
                guesses,
                losses,
                notes,
                ..Reading::plain(pattern, format)
            })
        }
        Format::GarmentCode => {
            let reading = read_garmentcode(text(bytes)?)?;
            Ok(Reading {
                notes: reading.notes.iter().map(ToString::to_string).collect(),
                ..Reading::plain(reading.pattern, format)
            })
        }
    }
}

/// Whether a file begins as JSON does.
fn begins_as_json(bytes: &[u8]) -> bool {
    let text = String::from_utf8_lossy(bytes);
    let text = text.trim_start_matches('\u{feff}').trim_start();
    text.starts_with(['{', '['])
}

/// Whether damaged JSON is rather a GarmentCode specification than a native file.
fn looks_like_garmentcode(bytes: &[u8]) -> bool {
    let text = String::from_utf8_lossy(bytes);
    !text.contains("\"toile\"") && text.contains("\"panels\"")
}

/// Refuses answers to questions that a format does not ask.
fn refuse_unused(
    format: Format,
    options: &ReadOptions,
    companions: &[Companion],
) -> Result<(), FormatError> {
    let is_given = |option: &ReadOption| match option {
        ReadOption::Format => options.format.is_some(),
        ReadOption::Unit => options.unit.is_some(),
        ReadOption::Inside => options.allowance_inside.is_some(),
        ReadOption::With => !companions.is_empty(),
    };
    let given = ReadOption::ALL.iter().copied().filter(is_given);
    match given.into_iter().find(|option| !format.takes(*option)) {
        None => Ok(()),
        Some(option) => Err(FormatError::new(
            "the options",
            format!(
                "{option} is given, and files of {} have no use for it",
                format.title()
            ),
            format!("leave {option} out"),
        )),
    }
}

/// The text of a file in UTF-8, without the mark that editors on Windows begin it with.
fn text(bytes: &[u8]) -> Result<&str, FormatError> {
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let before = &bytes[..error.valid_up_to()];
        let line = 1 + before.iter().filter(|&&byte| byte == b'\n').count();
        FormatError::new(
            format!("line {line}"),
            "the text is not UTF-8",
            "save it as UTF-8",
        )
    })?;
    Ok(text.trim_start_matches('\u{feff}'))
}
