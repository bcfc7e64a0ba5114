//! Arcs that continue the end of a curve smoothly. The direction at the end is stored as a formula if the
//! curve is a line, an arc or a spline, so that the arc stays smooth when things move.

use super::Reading;
use super::composed::{formula, point, written};
use super::refusal::{Unanswered, refuse};
use super::slots::Answer;
use crate::canvas::placed::{Placed, Spec};
use toile_geometry::Vec2;
use toile_pattern::{
    CurveId, CurveRule, EdgeId, EditError, Evaluation, Number, PanelId, PointId, SheetId, Want,
    plan,
};

/// The curve that an edge of a panel follows, with the curve's sheet and the point on it nearest to `at`
/// (m).
pub(super) fn curve_of(
    reading: &Reading<'_>,
    (panel, edge, at): (PanelId, EdgeId, Vec2),
) -> Option<(SheetId, CurveId, Vec2)> {
    let pattern = reading.evaluation.pattern();
    let curve = pattern.owner_of(panel, edge.into())?.edge(edge)?.curve;
    let (sheet, _) = pattern.curve(curve)?;
    Some((sheet.id, curve, at))
}

/// The end of a curve nearer to a point (m).
///
/// # Errors
/// The curve cannot be drawn.
pub(super) fn end_near(
    reading: &Reading<'_>,
    (sheet, curve): (SheetId, CurveId),
    at: Vec2,
) -> Result<Answer, String> {
    let evaluation = reading.evaluation;
    let lost = || "the curve cannot be drawn: mend its formulas first".to_owned();
    let path = evaluation.curve(curve).ok_or_else(lost)?;
    let along = path.nearest(at).map_or(0.0, |place| place.along);
    let end = usize::from(along > 0.5 * path.length());
    let (_, found) = evaluation.pattern().curve(curve).ok_or_else(lost)?;
    let point = found.ends[end];
    let placed = Placed {
        sheet,
        at: evaluation.point(point).ok_or_else(lost)?,
        spec: Spec::Point(point),
        words: String::new(),
    };
    Ok(Answer::End(placed, curve, end))
}

/// Direction in which a curve would run on beyond one of its ends: the direction of the tangent there (rad).
///
/// # Errors
/// The curve does not exist or has no direction there.
pub(super) fn leaving(
    evaluation: &Evaluation,
    curve: CurveId,
    end: usize,
) -> Result<Number, EditError> {
    let lost = || refuse("the curve has no direction there", "click another curve");
    let (_, found) = evaluation.pattern().curve(curve).ok_or_else(lost)?;
    let name = |id: PointId| point(evaluation, id);
    let (own, other) = (found.ends[end], found.ends[1 - end]);
    let apart = |a: PointId, b: PointId| {
        let (a, b) = (evaluation.point(a)?, evaluation.point(b)?);
        Some((b - a).norm() > 1e-9)
    };
    let chord = || format!("angle({}, {})", name(other), name(own));
    let text = match &found.rule {
        CurveRule::Line => Some(chord()),
        CurveRule::Arc { bulge } => {
            let swept = plan::angle_of(evaluation, bulge);
            let swept = written(evaluation, &swept, Want::Angle);
            // Traversed backwards, beyond its start, the arc turns in the opposite direction.
            let sign = if end == 1 { '+' } else { '-' };
            Some(format!("{} {sign} {swept} / 2", chord()))
        }
        CurveRule::Spline { handles, .. } if apart(handles[end], own) == Some(true) => {
            Some(format!("angle({}, {})", name(handles[end]), name(own)))
        }
        _ => None,
    };
    match text {
        Some(text) => formula(evaluation, &text),
        None => {
            let path = evaluation.curve(curve).ok_or_else(lost)?;
            let near = 1e-6 * path.length();
            let at = |along: f64| Some(path.point(path.at_length(along)?));
            let places = match end {
                0 => (at(near), at(0.0)),
                _ => (at(path.length() - near), at(path.length())),
            };
            let (Some(from), Some(to)) = places else {
                return Err(lost());
            };
            let way = to - from;
            Ok(Number::Value(way.y.atan2(way.x)))
        }
    }
}

/// End point, with its construction, of an arc that continues the end of a curve smoothly, from a typed
/// radius and swept angle.
///
/// # Errors
/// A number is missing or has no value.
pub(super) fn turned_place(
    from: Option<&Answer>,
    [radius, angle]: [Option<Number>; 2],
    reading: &Reading<'_>,
) -> Result<(Vec2, Spec), Unanswered> {
    let Some(Answer::End(start, curve, end)) = from else {
        return Err("click the end of a curve first".into());
    };
    let missing = |field| Unanswered {
        field: Some(field),
        words: "type radius and angle (Tab between them), or click where the arc ends".into(),
    };
    let radius = radius.ok_or_else(|| missing(0))?;
    let angle = angle.ok_or_else(|| missing(1))?;
    let evaluation = reading.evaluation;
    let leaving = leaving(evaluation, *curve, *end).map_err(|error| error.to_string())?;
    // The direction of the chord differs from the tangent by half the swept angle.
    let [leaving, turn] = [&leaving, &angle].map(|n| written(evaluation, n, Want::Angle));
    let direction = format!("{leaving} + {turn} / 2");
    let wide = written(evaluation, &radius, Want::Length);
    let chord = format!("2 * {wide} * abs(sin({turn} / 2))");
    let made = |text: &str| formula(evaluation, text).map_err(|error| error.to_string());
    let (distance, angle) = (made(&chord)?, made(&direction)?);
    let value = |number: &Number, want, field| {
        let value = evaluation.number(number, want);
        value.ok_or_else(|| missing(field))
    };
    let (far, turned) = (
        value(&distance, Want::Length, 0)?,
        value(&angle, Want::Angle, 1)?,
    );
    let at = start.at + Vec2::new(turned.cos(), turned.sin()) * far;
    Ok((at, Spec::FromLast { distance, angle }))
}
