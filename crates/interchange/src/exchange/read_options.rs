//! Answers to what a pattern file leaves open, and the files that belong to it.

use super::Format;
use serde::{Deserialize, Serialize};
use toile_pattern::DisplayUnit;

/// Answers to what a file may leave open; without them the reader decides, and returns its decisions as
/// [`Guess`](crate::Guess)es.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ReadOptions {
    /// The format, in place of the one that the content shows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub format: Option<Format>,
    /// Unit of the file's coordinates, in place of the one that the file states or its size suggests.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<DisplayUnit>,
    /// Distance from the outline inwards to the sew line (m), in a file that has cut lines alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub allowance_inside: Option<f64>,
}

/// A further file that a pattern needs: a table of grade rules or of measurements.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Companion {
    /// Its file name, for messages.
    pub name: String,
    /// Its content.
    pub bytes: Vec<u8>,
}
