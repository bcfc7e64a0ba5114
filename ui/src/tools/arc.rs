//! Tools that draw arcs: through a place, about a centre, and tangent to the end of a curve. An arc keeps
//! its construction: formulas, and the points it goes through.

use super::Pointer;
use super::composed::{formula, point, written};
use super::draw::name;
use super::planning::{Planning, places};
use super::refusal::refuse;
use super::slots::{Answer, Fields, Plan, Slot, SlotKind, SlotTool};
use super::tangent::leaving;
use crate::canvas::placed::{Placed, Spec};
use crate::canvas::selection::Item;
use std::f64::consts::{PI, TAU};
use toile_geometry::Vec2;
use toile_pattern::{
    CurveRule, EditError, Number, PointId, PointRule, SheetId, Want,
    plan::{self, CurveShape},
};

/// An arc through a place.
pub static ARC: SlotTool = SlotTool {
    command: "Arc",
    slots: &[
        Slot {
            hint: "Click where the arc starts",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Click where it ends",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Click a place it goes through",
            kind: SlotKind::Named(Fields::Usual),
        },
    ],
    plan: |answers, reading| {
        let mut planning = Planning::new(reading);
        let given = places(answers);
        let points = planning.points(&given[..2])?;
        let ends = [points[0], points[1]];
        let shape = through(&mut planning, ends, given[2])?;
        drawn(planning, (given[0].sheet, name(answers)), ends, shape)
    },
};

/// An arc between two points through a place. If the place is an existing or typed point, the arc follows
/// that point when things move.
///
/// # Errors
/// The point cannot be made.
pub(super) fn through(
    planning: &mut Planning,
    ends: [PointId; 2],
    placed: &Placed,
) -> Result<CurveShape, EditError> {
    let is_typed = match &placed.spec {
        Spec::New(PointRule::At { x, y }) => [x, y].iter().any(|n| n.as_formula().is_some()),
        _ => true,
    };
    if !is_typed {
        return Ok(CurveShape::ArcThrough(placed.at));
    }
    let by = planning.point(placed, Some(ends[1]))?;
    let evaluation = planning.evaluation();
    let place = |id| evaluation.point(id);
    let apart = |id| Some((place(id)? - place(by)?).norm() > 1e-9);
    if ends.iter().any(|end| apart(*end) != Some(true)) {
        // The place lies on an end, so that there is no arc: the check of the arc reports the error.
        return Ok(CurveShape::ArcThrough(placed.at));
    }
    let [start, end, by] = [ends[0], ends[1], by].map(|id| point(evaluation, id));
    // By the inscribed angle theorem, the chords at a point of an arc differ in direction by half the
    // swept angle.
    let angle = format!("2 * (angle({by}, {end}) - angle({start}, {by}))");
    let angle = formula(evaluation, &angle)?;
    Ok(CurveShape::Rule(CurveRule::Arc {
        bulge: swept(planning, &angle)?,
    }))
}

/// The number stored for an arc (bulge: tangent of a quarter of the swept angle). The angle need be known
/// only up to multiples of two full turns, which do not change the bulge.
fn swept(planning: &Planning, angle: &Number) -> Result<Number, EditError> {
    let text = plan::number_text(planning.evaluation(), angle, Want::Angle);
    formula(planning.evaluation(), &format!("tan(({text}) / 4)"))
}

fn drawn(
    mut planning: Planning,
    named: (SheetId, Option<&str>),
    ends: [PointId; 2],
    shape: CurveShape,
) -> Result<Plan, EditError> {
    let curve = planning.run(|evaluation| plan::add_curve(evaluation, named, ends, shape))?;
    Ok(planning.done("Draw arc", [Item::Curve(curve)]))
}

/// An arc about a centre, by its radius and the angle it sweeps.
pub static CENTRE_ARC: SlotTool = SlotTool {
    command: "Arc about centre",
    slots: &[
        Slot {
            hint: "Click the centre of the arc",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Click where the arc starts",
            kind: SlotKind::Place(Fields::Radius),
        },
        Slot {
            hint: "Click how far it goes round; negative is clockwise",
            kind: SlotKind::Number {
                label: "angle",
                want: Want::Angle,
                usual: PI / 2.0,
                live: Some(round),
            },
        },
    ],
    plan: |answers, reading| {
        let Some(Answer::Number(angle)) = answers.get(2) else {
            return Err(refuse("nothing was given", "click the centre"));
        };
        let mut planning = Planning::new(reading);
        let given = places(answers);
        let points = planning.points(&given[..2])?;
        let [centre, start] = [points[0], points[1]];
        let end = about(&mut planning, [centre, start], angle)?;
        let shape = CurveShape::Rule(CurveRule::Arc {
            bulge: plan::bulge_of(planning.evaluation(), angle)?,
        });
        let sheet = given[0].sheet;
        let mut done = drawn(planning, (sheet, None), [start, end], shape)?;
        let again = Placed {
            spec: Spec::Point(centre),
            ..given[0].clone()
        };
        // The next arc reuses the centre.
        done.again = vec![Answer::Place(again)];
        Ok(done)
    },
};

/// Makes a point at the distance of `start` from `centre`, rotated from `start` about the centre by an
/// angle.
///
/// # Errors
/// The point cannot be made.
pub(super) fn about(
    planning: &mut Planning,
    [centre, start]: [PointId; 2],
    angle: &Number,
) -> Result<PointId, EditError> {
    let evaluation = planning.evaluation();
    let turn = written(evaluation, angle, Want::Angle);
    let names = [centre, start].map(|id| point(evaluation, id)).join(", ");
    let rule = PointRule::Polar {
        base: centre,
        angle: formula(evaluation, &format!("angle({names}) + {turn}"))?,
        distance: formula(evaluation, &format!("distance({names})"))?,
    };
    let sheet = evaluation
        .pattern()
        .point(centre)
        .map(|(sheet, _)| sheet.id);
    let sheet = sheet.ok_or_else(|| refuse("the centre is not there", "click another place"))?;
    planning.run(|evaluation| plan::add_point(evaluation, sheet, None, rule))
}

/// Angle about the centre from the start of an arc to the pointer, rounded to whole degrees (rad).
fn round(answers: &[Answer], pointer: &Pointer) -> f64 {
    let given = places(answers);
    let [centre, start, ..] = given[..] else {
        return PI / 2.0;
    };
    let turned = |at: Vec2| (at - centre.at).y.atan2((at - centre.at).x);
    let step = if pointer.modifiers.shift {
        15.0
    } else {
        1.0_f64
    };
    let step = step.to_radians();
    let angle = ((turned(pointer.at) - turned(start.at)) / step).round() * step;
    let angle = angle - TAU * (angle / TAU).round();
    // While the pointer is at the start of the arc it gives no angle: a quarter turn is used.
    match angle.abs() < 0.5 * step {
        true => PI / 2.0,
        false => angle,
    }
}

/// An arc that continues the end of a curve smoothly.
pub static TANGENT_ARC: SlotTool = SlotTool {
    command: "Tangent arc",
    slots: &[
        Slot {
            hint: "Click a curve near the end the arc goes on from",
            kind: SlotKind::End,
        },
        Slot {
            hint: "Click where the arc ends",
            kind: SlotKind::Named(Fields::Turn),
        },
    ],
    plan: |answers, reading| {
        let Some(Answer::End(_, curve, end)) = answers.first() else {
            return Err(refuse("nothing was given", "click a curve near its end"));
        };
        let mut planning = Planning::new(reading);
        let given = places(answers);
        let points = planning.points(&given)?;
        let ends = [points[0], points[1]];
        let evaluation = planning.evaluation();
        let leaving = leaving(evaluation, *curve, *end)?;
        let leaving = written(evaluation, &leaving, Want::Angle);
        let [from, to] = ends.map(|id| point(evaluation, id));
        // Half the swept angle lies between the tangent and the chord.
        let angle = format!("2 * (angle({from}, {to}) - {leaving})");
        let angle = formula(evaluation, &angle)?;
        let shape = CurveShape::Rule(CurveRule::Arc {
            bulge: swept(&planning, &angle)?,
        });
        drawn(planning, (given[0].sheet, name(answers)), ends, shape)
    },
};
