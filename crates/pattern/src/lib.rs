//! The pattern document: sheets, panels, seams, formulas; edits, evaluation, diagnostics.
#![cfg_attr(test, allow(clippy::unwrap_used))]
#![cfg_attr(not(test), deny(clippy::wildcard_enum_match_arm))]

mod body_part;
mod check;
mod describe;
mod diagnostic;
mod document;
mod draft;
mod drafting;
mod edit;
mod evaluate;
mod fabric;
pub mod fields;
mod formula;
mod grade_rule;
mod ids;
mod kinks;
mod mark;
mod name;
mod number;
mod orientation;
pub mod plan;
mod press;
mod size_selection;
mod stage;
mod suggest;
pub mod walk;
mod want;

pub use body_part::{BodyPart, Facing};
pub use check::{SEAM_TOLERANCE, check_draft};
pub use diagnostic::{Code, Diagnostic, Place, Severity};
pub use document::*;
pub use draft::*;
pub use edit::{Edit, EditError, Entity, Head, SheetHead};
pub use evaluate::{Evaluation, Node, Update, Wearer};
pub use fabric::Fabric;
pub use formula::{
    Completion, FORMULA_DEPTH, FORMULA_LENGTH, Formula, FormulaError, Names, Token, is_unit,
};
pub use grade_rule::{GradeRule, Graded, MAX_GRADE_RULE};
pub use ids::*;
pub use mark::Mark;
pub use name::*;
pub use number::Number;
pub use press::press_arrows;
pub use size_selection::SizeSelection;
pub use stage::{Stage, StageDart, StageEdge, StageLine, StageNotch};
pub use suggest::nearest;
pub use want::Want;
