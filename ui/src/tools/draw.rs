//! Tools that draw points, curves and whole shapes on a sheet.

use super::composed::{formula, point, written};
use super::planning::{Planning, places, put_rule, rule_at};
use super::refusal::refuse;
use super::slots::{Answer, Fields, Plan, Slot, SlotKind, SlotTool};
use super::{Reading, along};
use crate::canvas::placed::{Placed, Spec};
use crate::canvas::selection::Item;
use toile_geometry::Vec2;
use toile_pattern::{
    CurveId, CurveRule, EditError, Number, PointId, PointRule, Want,
    plan::{self, Chain, CurveShape, Holes, NewPanel},
};

/// Draws a point: at coordinates, on a curve, at an intersection or beside another point.
pub static POINT: SlotTool = SlotTool {
    command: "Point",
    slots: &[Slot {
        hint: "Click where the point is to be",
        kind: SlotKind::Named(Fields::Usual),
    }],
    plan: |answers, reading| {
        let mut planning = Planning::new(reading);
        let points = planning.points(&places(answers))?;
        drawn(planning, points, answers)
    },
};

/// Draws a point at a distance and an angle from another point; the new point follows the other one.
pub static POINT_FROM: SlotTool = SlotTool {
    command: "Point from",
    slots: &[
        Slot {
            hint: "Click the point to measure from",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Click where the new point is to be",
            kind: SlotKind::Named(Fields::Usual),
        },
    ],
    plan: |answers, reading| {
        let given = places(answers);
        let (from, to) = (given[0], given[1]);
        // A free place is stored as an offset from the other point, too.
        let way = to.at - from.at;
        let beside = Placed {
            spec: Spec::BesideLast {
                x: way.x.into(),
                y: way.y.into(),
            },
            ..to.clone()
        };
        let to = match to.spec {
            Spec::New(PointRule::At { .. }) => &beside,
            _ => to,
        };
        let mut planning = Planning::new(reading);
        let points = planning.points(&[from, to])?;
        drawn(planning, points, answers)
    },
};

/// The plan that gives the last of some points the typed name, and selects that point.
fn drawn(
    mut planning: Planning,
    points: Vec<PointId>,
    answers: &[Answer],
) -> Result<Plan, EditError> {
    let made = points.last().copied();
    if let (Some(point), Some(Answer::Named(_, Some(name)))) = (made, answers.last()) {
        planning.run(|evaluation| Ok((plan::rename(evaluation, point.into(), name)?, ())))?;
    }
    Ok(planning.done("Draw point", made.map(Item::Point)))
}

/// The typed name of the drawn part.
pub(super) fn name(answers: &[Answer]) -> Option<&str> {
    match answers.last()? {
        Answer::Named(_, name) | Answer::Places(_, _, name) | Answer::Inside(_, _, name) => {
            name.as_deref()
        }
        _ => None,
    }
}

/// Draws a straight line; the next line begins at its end.
pub static LINE: SlotTool = SlotTool {
    command: "Line",
    slots: &[
        Slot {
            hint: "Click where the line starts",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Click where it ends",
            kind: SlotKind::Named(Fields::Usual),
        },
    ],
    plan: |answers, reading| {
        let mut planning = Planning::new(reading);
        let given = places(answers);
        let points = planning.points(&given)?;
        let ends = [points[0], points[1]];
        let sheet = given[0].sheet;
        let curve = planning.run(|evaluation| {
            let shape = CurveShape::Rule(CurveRule::Line);
            plan::add_curve(evaluation, (sheet, name(answers)), ends, shape)
        })?;
        let end = Placed {
            spec: Spec::Point(ends[1]),
            ..given[1].clone()
        };
        let mut done = planning.done("Draw line", [Item::Curve(curve)]);
        done.again = vec![Answer::Place(end)];
        Ok(done)
    },
};

/// Draws lines through several places; a click on the first place closes them.
pub static POLYGON: SlotTool = SlotTool {
    command: "Polygon",
    slots: &[Slot {
        hint: "Click the corners in order, the first once more to close",
        kind: SlotKind::Places,
    }],
    plan: |answers, reading| {
        let Some(Answer::Places(_, closes, _)) = answers.first() else {
            return Err(refuse("nothing was given", "click at least two places"));
        };
        let mut planning = Planning::new(reading);
        let given = places(answers);
        let points = planning.points(&given)?;
        let sheet = given[0].sheet;
        let count = points.len();
        let mut curves = Vec::new();
        let lines = if *closes { count } else { count - 1 };
        for k in 0..lines {
            let ends = [points[k], points[(k + 1) % count]];
            // The name goes to the panel, or to a single line; several lines get the name with a running
            // number.
            let name = match name(answers) {
                Some(name) if !closes && lines == 1 => Some(name.to_owned()),
                Some(name) if !closes => Some(format!("{name} {}", k + 1)),
                _ => None,
            };
            let curve = planning.run(|evaluation| {
                let shape = CurveShape::Rule(CurveRule::Line);
                plan::add_curve(evaluation, (sheet, name.as_deref()), ends, shape)
            })?;
            curves.push(curve);
        }
        if *closes {
            let panel = planning.run(|evaluation| {
                plan::trace_panel(
                    evaluation,
                    sheet,
                    Chain::Curves(&curves),
                    NewPanel {
                        name: name(answers),
                        ..NewPanel::default()
                    },
                )
            })?;
            return Ok(planning.done("Draw panel", [Item::Panel(panel)]));
        }
        Ok(planning.done("Draw lines", curves.into_iter().map(Item::Curve)))
    },
};

/// Draws a smooth curve through several places; its handles can be moved afterwards.
pub static SPLINE: SlotTool = SlotTool {
    command: "Curve",
    slots: &[Slot {
        hint: "Click where the curve goes, Enter ends it",
        kind: SlotKind::Places,
    }],
    plan: |answers, reading| {
        let mut planning = Planning::new(reading);
        let given = places(answers);
        let (first, last) = (given[0], given[given.len() - 1]);
        // If the last place is relative, its base may be a knot of this curve, which does not exist yet.
        let free = Placed::free(last.sheet, last.at);
        let is_relative = matches!(last.spec, Spec::FromLast { .. } | Spec::BesideLast { .. });
        let end = match is_relative {
            true => &free,
            false => last,
        };
        let ends = planning.points(&[first, end])?;
        let shape = smooth(&given.iter().map(|placed| placed.at).collect::<Vec<_>>());
        let curve = planning.run(|evaluation| {
            let named = (first.sheet, name(answers));
            plan::add_curve(evaluation, named, [ends[0], ends[1]], shape)
        })?;
        let before = keep_places(&mut planning, curve, (ends[0], &given[1..given.len() - 1]))?;
        if is_relative {
            put_rule(&mut planning, ends[1], rule_at(last, Some(before)))?;
        }
        Ok(planning.done("Draw curve", [Item::Curve(curve)]))
    },
};

/// Gives the knots of a spline the constructions of the places `given`, each relative to the knot before,
/// and the first relative to the point `first`; returns the last knot, or `first` if there are no knots.
fn keep_places(
    planning: &mut Planning,
    curve: CurveId,
    (first, given): (PointId, &[&Placed]),
) -> Result<PointId, EditError> {
    let found = planning.evaluation().pattern().curve(curve);
    let knots = match found.map(|(_, curve)| &curve.rule) {
        Some(CurveRule::Spline { knots, .. }) => knots.clone(),
        _ => Vec::new(),
    };
    let mut before = first;
    for (knot, placed) in knots.iter().zip(given) {
        put_rule(planning, knot.point, rule_at(placed, Some(before)))?;
        before = knot.point;
    }
    Ok(before)
}

/// A spline through places. Inner handles are parallel to the chord between the neighbouring places, and a
/// third of the distance to the neighbour long (Catmull and Rom 1974); both end handles point to the
/// neighbour's handle.
fn smooth(places: &[Vec2]) -> CurveShape {
    let count = places.len();
    let tangent = |k: usize| (places[k + 1] - places[k - 1]) * 0.5;
    let reach = |k: usize, to: usize| (places[to] - places[k]).norm() / 3.0;
    let along = |k: usize, to: usize, sign: f64| {
        let way = tangent(k).try_normalize(1e-12).unwrap_or_default();
        places[k] + way * (sign * reach(k, to))
    };
    let knots: Vec<[Vec2; 3]> = (1..count - 1)
        .map(|k| [along(k, k - 1, -1.0), places[k], along(k, k + 1, 1.0)])
        .collect();
    let (start, end) = (places[0], places[count - 1]);
    let first = knots.first().map_or(end, |knot| knot[0]);
    let last = knots.last().map_or(start, |knot| knot[2]);
    let toward = |from: Vec2, to: Vec2, length: f64| {
        from + (to - from).try_normalize(1e-12).unwrap_or_default() * length
    };
    CurveShape::Spline {
        handles: [
            toward(start, first, reach(0, 1)),
            toward(end, last, reach(count - 1, count - 2)),
        ],
        knots,
    }
}

/// Draws a rectangle, and traces a panel on it.
pub static RECTANGLE: SlotTool = SlotTool {
    command: "Rectangle",
    slots: &[
        Slot {
            hint: "Click a corner of the rectangle",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Click the opposite corner",
            kind: SlotKind::Named(Fields::Size),
        },
    ],
    plan: |answers, reading| {
        let mut planning = Planning::new(reading);
        let given = places(answers);
        let (from, to) = (given[0], given[1]);
        let corner = planning.point(from, None)?;
        let size = match &to.spec {
            Spec::BesideLast { x, y } => [x.clone(), y.clone()],
            Spec::New(PointRule::At { x, y }) if x.as_formula().or(y.as_formula()).is_some() => {
                let evaluation = planning.evaluation();
                let name = point(evaluation, corner);
                let side = |axis: &str, to: &Number| {
                    let to = written(evaluation, to, Want::Length);
                    formula(evaluation, &format!("{to} - {axis}({name})"))
                };
                [side("x", x)?, side("y", y)?]
            }
            _ => [to.at.x - from.at.x, to.at.y - from.at.y].map(Number::Value),
        };
        let figure = planning.run(|evaluation| {
            let corner = (plan::FirstCorner::Point(corner), size);
            let panel = NewPanel {
                name: name(answers),
                ..NewPanel::default()
            };
            plan::add_rectangle(evaluation, from.sheet, corner, Some(panel))
        })?;
        let panel = figure.panel.map(Item::Panel);
        Ok(planning.done("Draw rectangle", panel))
    },
};

/// Makes a panel of the closed lines round a place.
pub static TRACE: SlotTool = SlotTool {
    command: "Trace",
    slots: &[Slot {
        hint: "Click inside closed lines to make a panel of them",
        kind: SlotKind::Inside,
    }],
    plan: |answers, reading| {
        let Some(Answer::Inside(sheet, at, _)) = answers.first() else {
            return Err(refuse("nothing was given", "click inside closed lines"));
        };
        let mut planning = Planning::new(reading);
        let panel = planning.run(|evaluation| {
            let panel = NewPanel {
                name: name(answers),
                ..NewPanel::default()
            };
            plan::trace_face(evaluation, *sheet, (*at, Holes::Cut), panel)
        })?;
        Ok(planning.done("Trace panel", [Item::Panel(panel)]))
    },
};

/// Draws a point along a curve, at a distance from the nearer end of the curve.
pub static ALONG: SlotTool = SlotTool {
    command: "Point along",
    slots: &[
        Slot {
            hint: "Click a curve nearer to the end to measure from",
            kind: SlotKind::Curve,
        },
        Slot {
            hint: "Click how far along it the point is",
            kind: SlotKind::Number {
                label: "distance",
                want: Want::Length,
                usual: 0.05,
                live: None,
            },
        },
    ],
    plan: |answers, reading| {
        let [Answer::Curve(sheet, curve, at), Answer::Number(distance)] = answers else {
            return Err(refuse("nothing was given", "click a curve"));
        };
        let path = reading
            .evaluation
            .curve(*curve)
            .ok_or_else(|| refuse("the curve cannot be drawn", "mend its formulas first"))?;
        let place = path.nearest(*at).map_or(0.0, |place| place.along);
        // A negative distance counts from the far end of the curve.
        let distance = match place > 0.5 * path.length() {
            false => distance.clone(),
            true => along::negated(distance, reading)?,
        };
        let rule = PointRule::AlongCurve {
            curve: *curve,
            distance,
        };
        let mut planning = Planning::new(reading);
        let point = planning.run(|evaluation| plan::add_point(evaluation, *sheet, None, rule))?;
        Ok(planning.done("Draw point on curve", [Item::Point(point)]))
    },
};

/// Draws the foot of the perpendicular from a point to the line through two other points.
pub static FOOT: SlotTool = SlotTool {
    command: "Perpendicular",
    slots: &[
        Slot {
            hint: "Click the point to drop a perpendicular from",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Click a point of the line",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Click another point of the line",
            kind: SlotKind::Place(Fields::Usual),
        },
    ],
    plan: |answers, reading| {
        let made = |[base, from, to]: [PointId; 3]| PointRule::Foot {
            base,
            line: [from, to],
        };
        constructed(answers, reading, made, "Draw perpendicular")
    },
};

/// Draws the mirror image of a point in the line through two other points.
pub static MIRROR: SlotTool = SlotTool {
    command: "Mirror point",
    slots: &[
        Slot {
            hint: "Click the point to mirror",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Click a point of the mirror line",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Click another point of the mirror line",
            kind: SlotKind::Place(Fields::Usual),
        },
    ],
    plan: |answers, reading| {
        let made = |[base, from, to]: [PointId; 3]| PointRule::Mirrored {
            base,
            line: [from, to],
        };
        constructed(answers, reading, made, "Mirror point")
    },
};

/// The plan that draws a point constructed from three other points.
fn constructed(
    answers: &[Answer],
    reading: &Reading<'_>,
    rule: impl FnOnce([PointId; 3]) -> PointRule,
    label: &str,
) -> Result<Plan, EditError> {
    let mut planning = Planning::new(reading);
    let given = places(answers);
    let points = planning.points(&given)?;
    let rule = rule([points[0], points[1], points[2]]);
    let sheet = given[0].sheet;
    let point = planning.run(|evaluation| plan::add_point(evaluation, sheet, None, rule))?;
    Ok(planning.done(label, [Item::Point(point)]))
}
