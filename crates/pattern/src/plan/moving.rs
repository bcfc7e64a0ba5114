//! Moves a point without losing its construction: formulas stay and get an adjustment, constructed points
//! keep their construction.

use super::impossible;
use crate::stage::{MarkValue, Placed};
use crate::{
    Edit, EditError, Entity, Evaluation, LineName, Mark, Name, Number, Point, PointId, PointRule,
    Sheet, Want,
};
use std::f64::consts::TAU;
use std::sync::Arc;
use toile_geometry::{Path, Vec2};

/// Plans to move a point to `to` (m) as drawn now.
///
/// A number that is a value is set; a formula keeps its text and gets an adjustment. A point constructed from
/// others keeps its construction and gets other numbers in it, so a point on a curve or a line moves along it
/// to the place nearest to `to`.
///
/// # Errors
/// The point is missing, cannot be drawn, or is determined by other points alone.
pub fn move_point(
    evaluation: &Evaluation,
    point: PointId,
    to: Vec2,
) -> Result<Vec<Edit>, EditError> {
    if !(to.x.is_finite() && to.y.is_finite()) {
        return Err(EditError::NotFinite("the new place".into()));
    }
    let found = evaluation.pattern().point(point);
    let (sheet, found) = found.ok_or_else(|| EditError::Missing(point.to_string()))?;
    let now = at(evaluation, point)?;
    let rule = moved(evaluation, (sheet, &found.rule), now, to)?;
    let moved = Point {
        rule,
        ..(**found).clone()
    };
    Ok(vec![Edit::Put(Entity::Point(sheet.id, Arc::new(moved)))])
}

fn at(evaluation: &Evaluation, point: PointId) -> Result<Vec2, EditError> {
    let place = evaluation.point(point);
    place.ok_or_else(|| impossible("the point cannot be drawn", "mend its formulas first"))
}

fn direction(evaluation: &Evaluation, [base, tip]: [PointId; 2]) -> Result<Vec2, EditError> {
    let direction = at(evaluation, tip)? - at(evaluation, base)?;
    if direction.norm() > 1e-12 {
        return Ok(direction);
    }
    Err(impossible(
        "the two points it is constructed from are in the same place",
        "move them apart",
    ))
}

/// The rule with which a point of a sheet moves from its position `now` to `to` (m), or as near to `to` as
/// the kind of rule allows.
pub(super) fn moved(
    evaluation: &Evaluation,
    (sheet, old): (&Sheet, &PointRule),
    now: Vec2,
    to: Vec2,
) -> Result<PointRule, EditError> {
    let shift = to - now;
    Ok(match old {
        PointRule::At { x, y } => PointRule::At {
            x: added(x, shift.x),
            y: added(y, shift.y),
        },
        PointRule::Offset { base, x, y } => PointRule::Offset {
            base: *base,
            x: added(x, shift.x),
            y: added(y, shift.y),
        },
        PointRule::Polar {
            base,
            angle,
            distance,
        } => {
            let centre = at(evaluation, *base)?;
            let (before, after) = (now - centre, to - centre);
            let turn = after.y.atan2(after.x) - before.y.atan2(before.x);
            PointRule::Polar {
                base: *base,
                angle: added(angle, turn - TAU * (turn / TAU).round()),
                distance: added(distance, after.norm() - before.norm()),
            }
        }
        PointRule::Between {
            base,
            tip,
            along,
            aside,
        } => {
            let direction = direction(evaluation, [*base, *tip])?;
            let left = Vec2::new(-direction.y, direction.x);
            let square = direction.norm_squared();
            PointRule::Between {
                base: *base,
                tip: *tip,
                along: added(along, shift.dot(&direction) / square),
                aside: added(aside, shift.dot(&left) / square),
            }
        }
        PointRule::Toward {
            base,
            tip,
            distance,
        } => {
            let unit = direction(evaluation, [*base, *tip])?.normalize();
            PointRule::Toward {
                base: *base,
                tip: *tip,
                distance: added(distance, shift.dot(&unit)),
            }
        }
        PointRule::OnCurve { curve, share } => {
            let (shift, length) = along_curve(evaluation, *curve, now, to)?;
            PointRule::OnCurve {
                curve: *curve,
                share: added(share, shift / length),
            }
        }
        PointRule::AlongCurve { curve, distance } => {
            let (shift, _) = along_curve(evaluation, *curve, now, to)?;
            PointRule::AlongCurve {
                curve: *curve,
                distance: added(distance, shift),
            }
        }
        PointRule::Crossing { .. }
        | PointRule::CurveCrossing { .. }
        | PointRule::LineCrossing { .. } => {
            return Err(impossible(
                "the point lies where two lines cross",
                "move the points that the lines go through",
            ));
        }
        PointRule::Foot { .. } => {
            return Err(impossible(
                "the point is the foot of a perpendicular",
                "move the points it is made from",
            ));
        }
        PointRule::OnLineAt {
            line,
            centre,
            distance,
            ..
        } => {
            let unit = direction(evaluation, *line)?.normalize();
            let centre_at = at(evaluation, *centre)?;
            let goal = now + unit * shift.dot(&unit);
            let longer = (goal - centre_at).norm() - (now - centre_at).norm();
            PointRule::OnLineAt {
                line: *line,
                centre: *centre,
                distance: added(distance, longer),
                far: (goal - centre_at).dot(&unit) > 0.0,
            }
        }
        PointRule::TwoDistances {
            centres,
            distances: [first, second],
            ..
        } => {
            let way = direction(evaluation, *centres)?;
            let [a, b] = [at(evaluation, centres[0])?, at(evaluation, centres[1])?];
            let longer = |centre: Vec2| (to - centre).norm() - (now - centre).norm();
            PointRule::TwoDistances {
                centres: *centres,
                distances: [added(first, longer(a)), added(second, longer(b))],
                left: way.perp(&(to - a)) > 0.0,
            }
        }
        PointRule::Mark { line, at } => PointRule::Mark {
            line: *line,
            at: moved_mark(evaluation, (sheet, *line, at), [now, to])?,
        },
        PointRule::Mirrored { .. } => {
            return Err(impossible(
                "the point is the mirror image of another",
                "move the other point",
            ));
        }
    })
}

/// A mark of the panel stage that a sheet lies on, moved along its line by the distance between the place
/// nearest to `now` and the place nearest to `to` (m).
fn moved_mark(
    evaluation: &Evaluation,
    (sheet, line, mark): (&Sheet, LineName, &Mark),
    [now, to]: [Vec2; 2],
) -> Result<Mark, EditError> {
    let pattern = evaluation.pattern();
    let (corners, number) = match mark {
        Mark::Corner(Name::Made { by, .. }) => {
            let mut panels = pattern.panels.iter();
            let found = panels.find_map(|panel| Some((panel, panel.step_of(*by)?)));
            let words = found.map_or_else(String::new, |(panel, step)| {
                let made = &panel.operations[step - 1];
                let name = &made.name;
                format!(
                    ": operation {step}, {name:?}, of panel {:?} made it",
                    panel.name
                )
            });
            return Err(impossible(
                format!("the point lies at a corner that was not drawn{words}"),
                "change the numbers of that operation",
            ));
        }
        Mark::Corner(Name::Drawn(_)) => {
            return Err(impossible(
                "the point lies at a corner of the panel",
                "move that corner on the panel's own sheet",
            ));
        }
        Mark::Notch(_) => {
            return Err(impossible("the point lies at a notch", "move the notch"));
        }
        Mark::Along { from, distance } => ([*from; 2], distance),
        Mark::Between { ends, share } => (*ends, share),
    };
    let lost = || impossible("its panel cannot be drawn", "mend that first");
    let (of, after) = sheet.on.ok_or_else(lost)?;
    let stage = evaluation.stage(of, after).ok_or_else(lost)?;
    let edges = stage.lines.iter().filter(|l| l.name == line && l.half == 0);
    let edges = edges
        .flat_map(|line| &line.edges)
        .filter(|edge| edge.half == 0);
    let path = Path::new(edges.map(|edge| edge.curve).collect());
    let along = |at: Vec2| path.nearest(at).map(|place| place.along);
    let shift = along(to).zip(along(now)).map(|(to, now)| to - now);
    let mut shift = shift.ok_or_else(lost)?;
    // On a closed line the mark moves the shorter way round.
    if shift.abs() > 0.5 * path.length() {
        shift -= path.length().copysign(shift);
    }
    let corner = |k: usize| Placed::Mark(MarkValue::Corner(corners[k]));
    Ok(match mark {
        Mark::Along { from, .. } => Mark::Along {
            from: *from,
            distance: added(number, shift),
        },
        Mark::Notch(_) | Mark::Between { .. } | Mark::Corner(_) => {
            let span = stage.stretch(line, [corner(0), corner(1)], |edge| edge.half == 0);
            let span = span.map_err(|_| lost())?;
            let length = stage.stretch_length(0, &span).max(1e-12);
            let now = evaluation.number(number, Want::Plain).ok_or_else(lost)?;
            let share = (now + shift / length).clamp(0.0, 1.0);
            Mark::Between {
                ends: corners,
                share: added(number, share - now),
            }
        }
    })
}

/// Distance along a curve from the place nearest to `now` to the place nearest to `to` (m), and the curve's
/// length (m).
fn along_curve(
    evaluation: &Evaluation,
    curve: crate::CurveId,
    now: Vec2,
    to: Vec2,
) -> Result<(f64, f64), EditError> {
    let path = evaluation.curve(curve);
    let path = path.ok_or_else(|| impossible("its curve cannot be drawn", "mend it first"))?;
    let place = |p: Vec2| path.nearest(p).map_or(0.0, |place| place.along);
    Ok((place(to) - place(now), path.length().max(1e-12)))
}

/// A number with a shift added to its value (m), (rad) or plain, in all sizes.
pub(super) fn added(number: &Number, shift: f64) -> Number {
    match number {
        Number::Value(value) => Number::Value(value + shift),
        Number::Formula(_) if shift == 0.0 => number.clone(),
        Number::Formula(formula) => Number::Adjusted {
            formula: formula.clone(),
            by: shift,
        },
        Number::Adjusted { formula, by } if (by + shift).abs() < 1e-12 => {
            Number::Formula(formula.clone())
        }
        Number::Adjusted { formula, by } => Number::Adjusted {
            formula: formula.clone(),
            by: by + shift,
        },
        Number::PerSize { usual, sizes } => Number::PerSize {
            usual: Box::new(added(usual, shift)),
            sizes: sizes
                .iter()
                .map(|(size, value)| (*size, value + shift))
                .collect(),
        },
    }
}
