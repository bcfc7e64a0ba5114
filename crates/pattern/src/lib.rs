//! The pattern document: panels, seams, formulas, edits, diagnostics.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod apply;
mod check;
mod describe;
mod diagnostic;
mod difference;
mod document;
mod draft;
mod edit;
mod evaluate;
mod fabric;
mod formula;
mod ids;
mod number;
mod numbers;
mod panel_edit;
mod place;
mod resolve;
mod resolver;
mod sewing;
mod shape;
mod split;
mod suggest;

pub use check::check_draft;
pub use diagnostic::{Code, Diagnostic, Place, Severity};
pub use difference::difference;
pub use document::*;
pub use draft::*;
pub use edit::{Edit, EditError, PanelEdit};
pub use formula::{FORMULA_DEPTH, FORMULA_LENGTH, Formula, FormulaError};
pub use ids::*;
pub use number::Number;
pub use sewing::*;
pub use suggest::nearest;
