//! The options that answer what a pattern file leaves open.

use serde::{Serialize, Serializer};
use std::fmt;
use strum::VariantArray;

/// An option of reading. Each answers one question that a reader otherwise decides by a guess.
#[derive(Clone, Copy, Debug, PartialEq, Eq, VariantArray)]
pub enum ReadOption {
    /// The format of the file.
    Format,
    /// The unit of its coordinates.
    Unit,
    /// The distance from the cut line inwards to the sew line.
    Inside,
    /// A file that belongs to the pattern.
    With,
}

impl ReadOption {
    /// All options.
    pub const ALL: &[Self] = Self::VARIANTS;

    /// The option on the command line.
    pub fn word(self) -> &'static str {
        match self {
            Self::Format => "--from",
            Self::Unit => "--unit",
            Self::Inside => "--inside",
            Self::With => "--with",
        }
    }
}

impl fmt::Display for ReadOption {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}

impl Serialize for ReadOption {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.word())
    }
}
