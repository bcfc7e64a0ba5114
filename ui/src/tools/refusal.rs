//! Refusals of tools.

use super::{Pointer, Reading};
use crate::canvas::selection::Item;
use toile_pattern::EditError;

/// Why a slot of a tool cannot be answered.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Unanswered {
    /// The field at fault, if it is one that is typed.
    pub field: Option<usize>,
    /// What is wrong, and what to do.
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

/// A refusal with what is wrong and what to do.
pub(super) fn refuse(message: &str, hint: &str) -> EditError {
    EditError::Impossible {
        message: message.into(),
        hint: hint.into(),
    }
}

/// Where an edge is asked for, to be sewn or for something else, and there is none: a line inside a panel
/// is told by its name.
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
