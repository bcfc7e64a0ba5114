//! Planners: from a wish to the edits that grant it.

mod additions;
mod chain;
mod construct;
mod divide;
mod face;
mod figure;
mod lookup;
mod moving;
mod names;
mod remove;
mod trace;

pub use chain::Chain;
pub use construct::{CurveShape, add_curve, add_point, add_sheet};
pub use divide::{divide_edge, join_edges};
pub use figure::{Figure, FirstCorner, add_polygon, add_rectangle};
pub use moving::move_point;
pub use remove::remove_point;
pub use trace::{Holes, NewPanel, add_line, remove_line, trace_face, trace_panel};

use crate::EditError;

/// A refusal with what is wrong and what to do.
fn impossible(message: impl Into<String>, hint: impl Into<String>) -> EditError {
    EditError::Impossible {
        message: message.into(),
        hint: hint.into(),
    }
}
