//! Distances along edges, from the nearer end.

use super::Reading;
use super::refusal::refuse;
use toile_geometry::Vec2;
use toile_pattern::plan::{self, FinishedEdge};
use toile_pattern::{
    CornerName, EdgeId, EditError, Evaluation, Formula, Mark, Name, Number, OperationKind, Panel,
    PanelId, Pattern, Want,
};

/// The mark at a distance along a finished edge of a panel, counted from the corner nearer to a point
/// `near` of the sheet (m); and the place of the mark (m).
///
/// # Errors
/// The edge does not exist, cannot be drawn, or is shorter than the distance.
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
    let end = end_near(&edge, near);
    let along = match end {
        0 => value,
        _ => edge.length - value,
    };
    let mark = mark_from(evaluation, &edge, (end, &distance))?;
    Ok((mark, edge.place(along).unwrap_or(near)))
}

/// Rounded distance of a mark from the first corner of an edge, for a mark placed near a point (m): half
/// the length of the edge near the middle, else a whole millimetre from the nearer corner.
pub(super) fn tidy(edge: &FinishedEdge, near: Vec2) -> f64 {
    let (along, length) = (edge.nearest(near), edge.length);
    if (along - 0.5 * length).abs() < middle(edge) {
        return 0.5 * length;
    }
    let whole = |along: f64| crate::canvas::placed::rounded(along, 0.001).clamp(0.0, length);
    match along > 0.5 * length {
        true => length - whole(length - along),
        false => whole(along),
    }
}

/// For a mark placed near a point (m): rounded distance of the mark from the nearer end of the edge, and
/// place of the mark (m).
pub(super) fn told(
    reading: &Reading<'_>,
    (panel, edge, near): (PanelId, EdgeId, Vec2),
) -> Option<(f64, Vec2)> {
    let edge = plan::finished_edge(reading.evaluation, panel, edge).ok()?;
    let along = tidy(&edge, near);
    Some((along.min(edge.length - along), edge.place(along)?))
}

/// Distance from the middle of an edge within which a mark snaps to the middle (m).
fn middle(edge: &FinishedEdge) -> f64 {
    0.004_f64.min(0.1 * edge.length)
}

/// The end of an edge that is nearer to a point, measured along the edge: 0 the first, 1 the second; also 0
/// if the point is near the middle.
pub(super) fn end_near(edge: &FinishedEdge, near: Vec2) -> usize {
    match edge.nearest(near) > 0.5 * edge.length + middle(edge) {
        true => 1,
        false => 0,
    }
}

/// A number with the opposite sign; a formula stays a formula.
pub(super) fn negated(number: &Number, reading: &Reading<'_>) -> Result<Number, EditError> {
    scaled(reading.evaluation, number, -1.0)
}

/// A number times a factor; a formula stays a formula, and an adjustment added to it stays an adjustment.
///
/// # Errors
/// The formula would be too long or too deep.
pub fn scaled(evaluation: &Evaluation, number: &Number, factor: f64) -> Result<Number, EditError> {
    Ok(match number {
        Number::Value(value) => Number::Value(value * factor),
        Number::Formula(formula) => Number::Formula(scaled_formula(evaluation, formula, factor)?),
        Number::Adjusted { formula, by } => Number::Adjusted {
            formula: scaled_formula(evaluation, formula, factor)?,
            by: by * factor,
        },
        Number::PerSize { usual, sizes } => Number::PerSize {
            usual: Box::new(scaled(evaluation, usual, factor)?),
            sizes: sizes.iter().map(|(size, v)| (*size, v * factor)).collect(),
        },
    })
}

fn scaled_formula(
    evaluation: &Evaluation,
    formula: &Formula,
    factor: f64,
) -> Result<Formula, EditError> {
    let names = evaluation.names();
    let text = formula.text(names);
    let read = |text: &str| Formula::parse(text, names);
    let parsed = match factor {
        1.0 => Ok(formula.clone()),
        // A minus sign that an earlier change of sign put in front is removed again.
        -1.0 => match text.strip_prefix("-(").and_then(|t| t.strip_suffix(')')) {
            Some(inner) => read(inner).or_else(|_| read(&format!("-({text})"))),
            None => read(&format!("-({text})")),
        },
        factor => read(&format!("({text}) * {factor}")),
    };
    parsed.map_err(|error| refuse(&error.message, &error.hint))
}

/// The mark at a distance from one end of a finished edge, toward the other end; `end` is 0 for the first
/// end, 1 for the second.
pub(super) fn mark_from(
    evaluation: &Evaluation,
    edge: &FinishedEdge,
    (end, distance): (usize, &Number),
) -> Result<Mark, EditError> {
    let sign = if end == 0 { 1.0 } else { -1.0 };
    let distance = scaled(evaluation, distance, sign)?;
    plan::mark_along(evaluation, edge, (end, &distance))
}

/// Name of a corner of a panel, or "the centre" for an end of its fold; `None` for a corner made by an
/// operation.
pub fn corner_words(pattern: &Pattern, panel: &Panel, name: CornerName) -> Option<String> {
    if is_on_fold(panel, name) {
        return Some("the centre".to_owned());
    }
    match name {
        Name::Drawn(id) => Some(pattern.point(id)?.1.name.clone()),
        Name::Made { .. } => None,
    }
}

/// Whether a corner is an end of the panel's fold, which is the centre of the panel.
pub fn is_on_fold(panel: &Panel, name: CornerName) -> bool {
    panel.operations.iter().any(|step| match &step.kind {
        OperationKind::Fold { ends, .. } => ends.contains(&Mark::Corner(name)),
        _ => false,
    })
}

/// Description of an end of an edge: the corner there, and the edge that meets the given one at that
/// corner.
pub(super) fn end_words(
    evaluation: &Evaluation,
    edge: (&FinishedEdge, EdgeId),
    end: usize,
) -> Option<String> {
    let (finished, id) = edge;
    let pattern = evaluation.pattern();
    let panel = pattern.panel(finished.panel)?;
    let name = finished.ends[end];
    let corner = corner_words(pattern, panel, name)?;
    let owner = pattern.owner_of(finished.panel, id.into())?;
    let mut others = owner.edges().filter(|other| other.id != id);
    let meets = others.find(|other| other.ends.map(Name::Drawn).contains(&name));
    Some(match meets {
        Some(other) => format!("{corner}, where it meets {}", other.name),
        None => corner,
    })
}
