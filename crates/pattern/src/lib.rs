//! The pattern document: panels, seams, formulas, edits, diagnostics.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod diagnostic;
mod document;
mod draft;
mod evaluate;
mod formula;
mod ids;
mod number;
mod sewing;

pub use diagnostic::{Code, Diagnostic, Place, Severity};
pub use document::*;
pub use draft::*;
pub use formula::{FORMULA_DEPTH, FORMULA_LENGTH, Formula, FormulaError};
pub use ids::*;
pub use number::Number;
pub use sewing::*;
