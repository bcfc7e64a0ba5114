//! Numbers made of others: values where all of them are values, else formulas, so that what was typed stays.

use super::refusal::refuse;
use toile_pattern::{EditError, Evaluation, Formula, Number, PartReference, PointId, Want, plan};

/// A number as a formula writes it where it is part of another, in parentheses.
pub(super) fn written(evaluation: &Evaluation, number: &Number, want: Want) -> String {
    format!("({})", plan::number_text(evaluation, number, want))
}

/// A point as a formula writes it.
pub(super) fn point(evaluation: &Evaluation, id: PointId) -> String {
    evaluation.names().print_part(&PartReference::Point(id))
}

/// The number that a formula is.
///
/// # Errors
/// It is no formula, as where names are too long.
pub(super) fn formula(evaluation: &Evaluation, text: &str) -> Result<Number, EditError> {
    let read = Formula::parse(text, evaluation.names());
    read.map(Number::Formula)
        .map_err(|error| refuse(&error.message, &error.hint))
}
