//! Planners: from a wish to the edits that grant it.

mod additions;
mod align;
mod chain;
mod construct;
mod divide;
mod face;
mod figure;
mod lookup;
mod moving;
mod names;
mod remove;
mod select;
mod trace;
mod transform;

pub use align::{Alignment, Axis, align, distribute};
pub use chain::Chain;
pub use construct::{CurveShape, add_curve, add_point, add_sheet};
pub use divide::{divide_edge, join_edges};
pub use figure::{Figure, FirstCorner, add_polygon, add_rectangle};
pub use moving::move_point;
pub use remove::remove_point;
pub use select::points_of;
pub use trace::{Holes, NewPanel, add_line, remove_line, trace_face, trace_panel};
pub use transform::{Affine, Moved, move_points, transform_points};

use crate::EditError;

/// A refusal with what is wrong and what to do.
fn impossible(message: impl Into<String>, hint: impl Into<String>) -> EditError {
    EditError::Impossible {
        message: message.into(),
        hint: hint.into(),
    }
}
