//! Planners: each turns a request into edits.
//!
//! # Decided with
//! - [`crate::plan::construct`], [`crate::plan::figure`], [`crate::plan::additions`]: points, curves and
//!   figures drawn;
//! - [`crate::plan::face`], [`crate::plan::chain`], [`crate::plan::crossings`], [`crate::plan::trace`]:
//!   curves round a tap or along a trace; the panel made of them;
//! - [`crate::plan::moving`], [`crate::plan::formula_change`], [`crate::plan::transform`],
//!   [`crate::plan::align`](mod@crate::plan::align): one point moved; many moved, turned, lined up;
//! - [`crate::plan::operations`], [`crate::plan::reshape`], [`crate::plan::split`]: operations put on panels;
//! - [`crate::plan::seam`], [`crate::plan::notch`], [`crate::plan::matched`], [`crate::plan::on_stage`],
//!   [`crate::plan::along`]: seams and notches; edges as they are finished, distances along them;
//! - [`crate::plan::suggest_seams`](mod@crate::plan::suggest_seams): partners of edges that are not sewn;
//! - [`crate::plan::fragment`], [`crate::plan::paste`](mod@crate::plan::paste), [`crate::plan::names`]: parts
//!   copied and pasted, with free names;
//! - [`crate::plan::divide`], [`crate::plan::rename`](mod@crate::plan::rename), [`crate::plan::remove`]:
//!   edges divided, parts renamed and removed;
//! - [`crate::plan::grade`]: grade rules of points;
//! - [`crate::plan::numbers`], [`crate::plan::typed`], [`crate::plan::sizes`], [`crate::plan::marker`],
//!   [`crate::plan::guide`]: numbers set and typed; sizes, markers, guides.
//!
//! Asked by tools of the window (`tools/mod.rs`), its commands (`app/arrange.rs`, `app/sewing.rs`) and
//! `inspector.rs`.

mod additions;
mod align;
mod along;
mod bare;
mod bind;
mod chain;
mod construct;
mod crossings;
mod divide;
mod fabric;
mod face;
mod figure;
mod finished;
mod formula_change;
mod fragment;
mod grade;
mod guide;
mod lookup;
mod marker;
mod marks;
mod matched;
mod moving;
mod names;
mod notch;
mod numbers;
mod on_panel;
mod on_stage;
mod operations;
mod paste;
mod remove;
mod rename;
mod reshape;
mod seam;
mod select;
mod sizes;
mod split;
mod suggest_seams;
mod swept;
mod trace;
mod transform;
mod typed;

pub use crate::fields::{NumberAddress, NumberEntry};
pub use align::{Alignment, Axis, align, distribute};
pub use along::{FinishedEdge, finished_edge, mark_along};
pub use chain::Chain;
pub use construct::{CurveShape, add_curve, add_point, add_sheet, bend_curve, move_sheets};
pub use crossings::mark_crossings;
pub use divide::{divide_edge, join_edges};
pub use fabric::{FabricFigure, add_fabric, remove_fabric, set_fabric, set_fabric_figure};
pub use figure::{Figure, FirstCorner, add_polygon, add_rectangle};
pub use finished::{FinishedLength, finished_length};
pub use formula_change::{FormulaChange, move_point_by};
pub use fragment::{Fragment, FragmentKind, Outside, OutsideValue, copy};
pub use grade::{
    SizeShift, copy_rule, even_shifts, give_rule, jumps, mirror_rule, points_of_rule, rule_of,
    rule_shifts, rules_of_sizes, set_rule_shift, ungrade,
};
pub use guide::{add_guide, move_guide, remove_guides};
pub use marker::{
    add_marker, flip_pieces, lock_pieces, move_pieces, place_marker, place_pieces, remove_marker,
    remove_marker_roll, set_marker_cloth, set_marker_fabric, set_marker_order, set_marker_rules,
    set_matched_marks, take_off_pieces, turn_pieces,
};
pub use marks::{NearMark, nearest_mark};
pub use matched::{
    Opposite, PanelNotch, add_matched_notches, is_upside_down, opposites, turns_over, twin,
};
pub use moving::move_point;
pub use notch::{NotchRow, add_notch, add_notches, move_notch, remove_notch, set_notch_kind};
pub use numbers::{
    adjust_number, clear_number, number_at, number_entry, numbers_of, set_number,
    set_number_in_size,
};
pub use on_panel::{line_across, open_sheet};
pub use on_stage::{EdgePart, edge_ends, edge_parts, outline_of};
pub use operations::{add_operation, move_operation, remove_operation, set_operation};
pub use paste::{PasteTarget, Pasted, duplicate, insert_pattern, paste};
pub use remove::{remove_parts, remove_point};
pub use rename::rename;
pub use reshape::{
    PivotWish, PleatWish, SpreadWish, even_cuts, pivot_dart, pleat_panel, spread_panel,
};
pub use seam::{SeamSide, SewnEdge, flip_side, remove_seam, sew};
pub use select::points_of;
pub use sizes::{
    add_size, add_variable, remove_size, rename_pattern, set_base_size, set_measurement, set_unit,
};
pub use split::{Joined, SplitPanel, SplitWish, split_panel};
pub use suggest_seams::{
    MAX_SUGGESTED_EDGES, SeamSuggestions, SuggestedPair, SuggestedSeam, accept_seams, suggest_seams,
};
pub use swept::{angle_of, bulge_of};
pub use trace::{Holes, NewPanel, add_line, remove_line, trace_face, trace_panel};
pub use transform::{Affine, Moved, move_points, transform_points};
pub use typed::{number_shown, number_text, read_number};

use crate::EditError;

/// An error for a request that cannot be done: description of the fault, and advice.
fn impossible(message: impl Into<String>, hint: impl Into<String>) -> EditError {
    EditError::Impossible {
        message: message.into(),
        hint: hint.into(),
    }
}
