//! Format and sizes that a pattern is written in.

use serde::{Deserialize, Serialize};
use toile_interchange::Format;
use toile_pattern::SizeSelection;

/// How a pattern is written in a format of another program.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WriteOptions {
    /// The format; `None`: the one that the file's name ends in.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub format: Option<Format>,
    /// Whether all sizes are written into one file. Without it the chosen size is written, or the base size.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub all_sizes: bool,
}

impl WriteOptions {
    /// The sizes that are written; `None`: those that the format takes by itself.
    pub(crate) fn sizes(&self) -> Option<SizeSelection> {
        self.all_sizes.then_some(SizeSelection::All)
    }
}
