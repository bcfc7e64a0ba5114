//! Distances along edges, from whichever end is nearer.

use super::Reading;
use super::refusal::refuse;
use toile_geometry::Vec2;
use toile_pattern::plan::{self, FinishedEdge};
use toile_pattern::{EdgeId, EditError, Mark, Number, PanelId, Want};

/// The mark at a distance along an edge of a panel as it is finished, from its corner nearer to a place
/// of the sheet [m]; and where that is [m].
///
/// # Errors
/// The edge is not there or cannot be drawn; it is shorter than that.
pub(super) fn mark_along(
    reading: &Reading<'_>,
    (panel, edge, near): (PanelId, EdgeId, Vec2),
    distance: Number,
) -> Result<(Mark, Vec2), EditError> {
    let evaluation = reading.evaluation;
    let edge = plan::finished_edge(evaluation, panel, edge)?;
    let value = evaluation.number(&distance, Want::Length);
    let is_on = |value: &f64| (0.0..=edge.length).contains(value);
    let value = value.filter(is_on).ok_or_else(|| {
        refuse(
            "the edge does not reach so far from its corner",
            "type a distance of zero or more that is no longer than the edge",
        )
    })?;
    let (end, distance, along) = match end_near(&edge, near) {
        0 => (0, distance, value),
        _ => (1, negated(&distance, reading)?, edge.length - value),
    };
    let mark = plan::mark_along(evaluation, &edge, (end, &distance))?;
    Ok((mark, edge.place(along).unwrap_or(near)))
}

/// How far from the first corner of an edge what is put near a place lies [m]: in the middle if that is
/// near, else on a whole millimetre from the nearer corner.
pub(super) fn tidy(edge: &FinishedEdge, near: Vec2) -> f64 {
    let (along, length) = (edge.nearest(near), edge.length);
    if (along - 0.5 * length).abs() < 0.004_f64.min(0.1 * length) {
        return 0.5 * length;
    }
    let whole = |along: f64| crate::canvas::placed::rounded(along, 0.001).clamp(0.0, length);
    match along > 0.5 * length {
        true => length - whole(length - along),
        false => whole(along),
    }
}

/// How far from the nearer end of an edge what is put near a place lies [m], and where that is [m].
pub(super) fn told(
    reading: &Reading<'_>,
    (panel, edge, near): (PanelId, EdgeId, Vec2),
) -> Option<(f64, Vec2)> {
    let edge = plan::finished_edge(reading.evaluation, panel, edge).ok()?;
    let along = tidy(&edge, near);
    Some((along.min(edge.length - along), edge.place(along)?))
}

/// The corner of an edge that is nearer to a place, along the edge: 0 the first, 1 the second.
fn end_near(edge: &FinishedEdge, near: Vec2) -> usize {
    match edge.nearest(near) > 0.5 * edge.length {
        true => 1,
        false => 0,
    }
}

/// The number with its sign changed; a formula stays one.
pub(super) fn negated(number: &Number, reading: &Reading<'_>) -> Result<Number, EditError> {
    match number.as_formula() {
        None => {
            let value = reading.evaluation.number(number, Want::Length);
            Ok(Number::Value(-value.unwrap_or(0.0)))
        }
        Some(formula) => {
            let names = reading.evaluation.names();
            let text = format!("-({})", formula.text(names));
            toile_pattern::Formula::parse(&text, names)
                .map(Number::Formula)
                .map_err(|error| refuse(&error.message, &error.hint))
        }
    }
}
