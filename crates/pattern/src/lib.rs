//! The pattern document: panels, seams, formulas, edits, diagnostics.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod draft;
mod ids;

pub use draft::*;
pub use ids::*;
