//! Planners: from a wish to the edits that grant it.

mod divide;
mod moving;
mod remove;

pub use divide::{divide_edge, join_edges};
pub use moving::move_point;
pub use remove::remove_point;

use crate::EditError;

/// A refusal with what is wrong and what to do.
fn impossible(message: impl Into<String>, hint: impl Into<String>) -> EditError {
    EditError::Impossible {
        message: message.into(),
        hint: hint.into(),
    }
}
