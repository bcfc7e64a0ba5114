//! Refusals of tools.

use super::{Pointer, Reading};
use crate::canvas::selection::Item;
use toile_pattern::EditError;

/// Reason why a slot of a tool has no valid answer.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Unanswered {
    /// Index of the field with the error; `None` if the error is not in a typed text.
    pub field: Option<usize>,
    /// The error, and the remedy.
    pub words: String,
}

impl<W: Into<String>> From<W> for Unanswered {
    fn from(words: W) -> Self {
        Self {
            field: None,
            words: words.into(),
        }
    }
}

/// An error with a message and a remedy.
pub(super) fn refuse(message: &str, hint: &str) -> EditError {
    EditError::Impossible {
        message: message.into(),
        hint: hint.into(),
    }
}

/// Message for a missing edge under the pointer; `sews` says whether the edge is to be sewn. If a line
/// inside a panel is there instead, the message names it.
pub(super) fn no_edge(sews: bool, at: Option<&Pointer>, reading: &Reading<'_>) -> String {
    let mut items = at.iter().flat_map(|at| &at.hits).map(|hit| hit.item);
    let line = items.find(|item| matches!(item, Item::Line(..)));
    let Some(line) = line.and_then(|line| line.words(reading.evaluation.pattern())) else {
        return "there is no edge of a panel here: click on one".into();
    };
    let rest = match sews {
        true => {
            "only edges of outlines and holes are sewn; mark with the line where a pocket goes, and \
             sew it on by hand"
        }
        false => "click an edge of an outline or a hole",
    };
    format!("{line} lies inside the panel: {rest}")
}
