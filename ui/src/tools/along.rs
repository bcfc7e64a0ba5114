//! Distances along edges, from whichever end is nearer.

use super::Reading;
use super::refusal::refuse;
use toile_geometry::Vec2;
use toile_pattern::plan::{self, FinishedEdge};
use toile_pattern::{
    CornerName, EdgeId, EditError, Evaluation, Formula, Mark, Name, Number, OperationKind, Panel,
    PanelId, Pattern, Want,
};

/// The mark at a distance along an edge of a panel as it is finished, from its corner nearer to a place
/// of the sheet (m); and where that is (m).
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
    let end = end_near(&edge, near);
    let along = match end {
        0 => value,
        _ => edge.length - value,
    };
    let mark = mark_from(evaluation, &edge, (end, &distance))?;
    Ok((mark, edge.place(along).unwrap_or(near)))
}

/// How far from the first corner of an edge what is put near a place lies (m): in the middle if that is
/// near, else on a whole millimetre from the nearer corner.
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

/// How far from the nearer end of an edge what is put near a place lies (m), and where that is (m).
pub(super) fn told(
    reading: &Reading<'_>,
    (panel, edge, near): (PanelId, EdgeId, Vec2),
) -> Option<(f64, Vec2)> {
    let edge = plan::finished_edge(reading.evaluation, panel, edge).ok()?;
    let along = tidy(&edge, near);
    Some((along.min(edge.length - along), edge.place(along)?))
}

/// What lies no farther from the middle of an edge is in the middle (m).
fn middle(edge: &FinishedEdge) -> f64 {
    0.004_f64.min(0.1 * edge.length)
}

/// The corner of an edge that is nearer to a place, along the edge: 0 the first, 1 the second. Of one in the
/// middle it is the first.
pub(super) fn end_near(edge: &FinishedEdge, near: Vec2) -> usize {
    match edge.nearest(near) > 0.5 * edge.length + middle(edge) {
        true => 1,
        false => 0,
    }
}

/// The number with its sign changed; a formula stays one.
pub(super) fn negated(number: &Number, reading: &Reading<'_>) -> Result<Number, EditError> {
    scaled(reading.evaluation, number, -1.0)
}

/// A number so many times; a formula stays one, and what was added to it by hand stays added.
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
        // The sign that an earlier change put before it is taken away again.
        -1.0 => match text.strip_prefix("-(").and_then(|t| t.strip_suffix(')')) {
            Some(inner) => read(inner).or_else(|_| read(&format!("-({text})"))),
            None => read(&format!("-({text})")),
        },
        factor => read(&format!("({text}) * {factor}")),
    };
    parsed.map_err(|error| refuse(&error.message, &error.hint))
}

/// The mark at a distance from an end of an edge of a panel as it is finished, into the edge: 0 the first, 1 the
/// second.
pub(super) fn mark_from(
    evaluation: &Evaluation,
    edge: &FinishedEdge,
    (end, distance): (usize, &Number),
) -> Result<Mark, EditError> {
    let sign = if end == 0 { 1.0 } else { -1.0 };
    let distance = scaled(evaluation, distance, sign)?;
    plan::mark_along(evaluation, edge, (end, &distance))
}

/// What a corner of a panel is called; the end of its fold is its centre. Nothing of one that a step made.
pub fn corner_words(pattern: &Pattern, panel: &Panel, name: CornerName) -> Option<String> {
    if is_on_fold(panel, name) {
        return Some("the centre".to_owned());
    }
    match name {
        Name::Drawn(id) => Some(pattern.point(id)?.1.name.clone()),
        Name::Made { .. } => None,
    }
}

/// Whether a corner is an end of the panel's fold, which is its centre.
pub fn is_on_fold(panel: &Panel, name: CornerName) -> bool {
    panel.operations.iter().any(|step| match &step.kind {
        OperationKind::Fold { ends, .. } => ends.contains(&Mark::Corner(name)),
        _ => false,
    })
}

/// An end of an edge in words: its corner, and the edge it meets there.
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
