//! Patterns written into the bytes of files.

use super::contents::losses;
use super::{Content, Format, Loss};
use crate::native::Fitting;
use crate::{FormatError, write_document, write_garmentcode};
use toile_pattern::{Draft, Pattern};

/// A draft of a pattern in one size.
#[derive(Clone, Debug)]
pub struct SizedDraft {
    /// Name of the size; `None` for a pattern without sizes.
    pub size: Option<String>,
    /// The draft.
    pub draft: Draft,
}

/// What is written: the document, and its drafts for formats that hold shapes.
#[derive(Clone, Copy, Debug)]
pub struct WriteSource<'a> {
    /// The document.
    pub pattern: &'a Pattern,
    /// The fitting of its garment, with paths as the file is to have them.
    pub fitting: &'a Fitting,
    /// Drafts in the sizes to write, the base size first. Empty for the native format.
    pub drafts: &'a [SizedDraft],
}

/// A file to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// Ending of its name, as in ".json".
    pub ending: &'static str,
    /// Its content.
    pub bytes: Vec<u8>,
}

/// A pattern in a format.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Writing {
    /// The files; the first one is the pattern.
    pub files: Vec<Written>,
    /// Contents that the format has no place for.
    pub losses: Vec<Loss>,
}

/// Writes a pattern in a format.
///
/// # Errors
/// A value that the format cannot hold, such as a number that is not finite; or no draft for a format that
/// holds shapes.
pub fn write(source: &WriteSource<'_>, format: Format) -> Result<Writing, FormatError> {
    let whole = losses(source.pattern, format);
    let one = |text: String, further: Vec<Loss>| {
        let bytes = text.into_bytes();
        let ending = format.ending();
        Writing {
            files: vec![Written { ending, bytes }],
            losses: whole.into_iter().chain(further).collect(),
        }
    };
    match format {
        Format::Native => Ok(one(
            write_document(source.pattern, source.fitting)?,
            Vec::new(),
        )),
        Format::DxfAama | Format::DxfAstm => Err(FormatError::new(
            "the format",
            format!("{} is read, and not written yet", format.title()),
            format!("write {}", Format::written_words()),
        )),
        Format::GarmentCode => {
            let base = source.drafts.first().ok_or_else(|| {
                FormatError::new("the pattern", "it has no draft", "mend its faults first")
            })?;
            let writing = write_garmentcode(&base.draft);
            let mut further = writing.lost;
            // The size that is tried on is the one that is written.
            let besides = Fitting {
                size: None,
                ..source.fitting.clone()
            };
            if besides != Fitting::default() {
                further.push(Loss::of(
                    Content::Fitting,
                    1,
                    "the format has no place for it",
                ));
            }
            Ok(one(writing.text, further))
        }
    }
}
