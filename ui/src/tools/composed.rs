//! Numbers composed of others: values if all of them are values, else formulas, so that typed formulas
//! are kept.

use super::refusal::refuse;
use toile_pattern::{EditError, Evaluation, Formula, Number, PartReference, PointId, Want, plan};

/// Text of a number as part of a longer formula, in parentheses.
pub(super) fn written(evaluation: &Evaluation, number: &Number, want: Want) -> String {
    format!("({})", plan::number_text(evaluation, number, want))
}

/// Text of a point in a formula.
pub(super) fn point(evaluation: &Evaluation, id: PointId) -> String {
    evaluation.names().print_part(&PartReference::Point(id))
}

/// Parses the text of a formula.
///
/// # Errors
/// The text is not a valid formula, as when names make it too long.
pub(super) fn formula(evaluation: &Evaluation, text: &str) -> Result<Number, EditError> {
    let read = Formula::parse(text, evaluation.names());
    read.map(Number::Formula)
        .map_err(|error| refuse(&error.message, &error.hint))
}
