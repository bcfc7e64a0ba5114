//! What is written in a format, and the files that it becomes.

use super::Loss;
use crate::native::Fitting;
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
