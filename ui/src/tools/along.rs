//! Distances along edges and curves, from whichever end is nearer.

use super::Reading;
use super::refusal::refuse;
use toile_geometry::Vec2;
use toile_pattern::{EdgeId, EditError, Mark, Number, PanelId, Want, plan};

/// The mark at a distance along an edge of a panel, from its corner nearer to a place of the sheet
/// [m]; and where that is [m].
///
/// # Errors
/// The edge is not there or cannot be drawn; it is shorter than that.
pub(super) fn mark_along(
    reading: &Reading<'_>,
    (panel, edge, near): (PanelId, EdgeId, Vec2),
    distance: Number,
) -> Result<(Mark, Vec2), EditError> {
    let evaluation = reading.evaluation;
    let gone = || refuse("the edge is gone", "click another");
    let owner = evaluation.pattern().panel(panel).ok_or_else(gone)?;
    let (_, ends) = plan::edge_ends(evaluation, owner, edge)?;
    let path = evaluation.edge(edge);
    let path = path.ok_or_else(|| refuse("the edge cannot be drawn", "mend its formulas first"))?;
    let value = evaluation.number(&distance, Want::Length);
    let is_on = |value: &f64| (0.0..=path.length()).contains(value);
    let value = value.filter(is_on).ok_or_else(|| {
        refuse(
            "the edge does not reach so far from its corner",
            "type a distance of zero or more that is no longer than the edge",
        )
    })?;
    let is_last = path
        .nearest(near)
        .is_some_and(|place| place.along > 0.5 * path.length());
    let (from, distance, value) = match is_last {
        false => (ends[0], distance, value),
        true => (ends[1], negated(&distance, reading)?, path.length() - value),
    };
    let at = path
        .at_length(value)
        .map_or(near, |place| path.point(place));
    Ok((Mark::Along { from, distance }, at))
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
