//! Format and sizes that a pattern is written in.

use serde::{Deserialize, Serialize};
use toile_interchange::Format;
use toile_pattern::{Pattern, SizeSelection};

/// How a pattern is written in a format of another program.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct WriteOptions {
    /// The format; `None`: the one that the file's name ends in.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub format: Option<Format>,
    /// Whether all sizes are written into one file. Without it the chosen size is written, or the base size.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub all_sizes: bool,
}

impl WriteOptions {
    /// A whole pattern in a format: in all sizes, where one file holds them.
    pub fn whole(format: Format, pattern: &Pattern) -> Self {
        Self {
            format: Some(format),
            all_sizes: format.holds_sizes() && !pattern.sizes.is_empty(),
        }
    }

    /// The sizes that are written; `None`: those that the format takes by itself.
    pub(crate) fn sizes(&self) -> Option<SizeSelection> {
        self.all_sizes.then_some(SizeSelection::All)
    }
}
