//! A tool that draws circles, rings and sectors as panels: circular skirts, flounces, collars.

use super::Reading;
use super::arc::about;
use super::composed::{formula, written};
use super::planning::{Planning, places};
use super::refusal::refuse;
use super::slots::{Answer, Fields, Slot, SlotKind, SlotTool};
use crate::canvas::selection::Item;
use std::f64::consts::{PI, TAU};
use toile_pattern::{
    CurveId, CurveRule, EditError, LineKind, Number, PanelId, PointId, PointRule, SheetId, Want,
    plan::{self, Chain, CurveShape, NewPanel},
};

/// Draws a circle, a ring or a sector of a ring, and traces a panel on it.
pub static RING: SlotTool = SlotTool {
    command: "Circle",
    slots: &[
        Slot {
            hint: "Click the centre of the circle",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Type the radius of the inner edge, as of a waist; 0 for a whole circle",
            kind: SlotKind::Number {
                label: "inner radius",
                want: Want::Length,
                usual: 0.0,
                live: None,
            },
        },
        Slot {
            hint: "Type how long it is from the inner edge, or the centre, to the outer edge",
            kind: SlotKind::Number {
                label: "length",
                want: Want::Length,
                usual: 0.1,
                live: None,
            },
        },
        Slot {
            hint: "Type how far it goes round: 90 is a quarter, 360 all round",
            kind: SlotKind::Number {
                label: "angle",
                want: Want::Angle,
                usual: TAU,
                live: None,
            },
        },
    ],
    plan: |answers, reading| {
        let [
            Answer::Place(centre),
            Answer::Number(inner),
            Answer::Number(length),
            Answer::Number(angle),
        ] = answers
        else {
            return Err(refuse("nothing was given", "click the centre"));
        };
        let values = [
            value(reading, ("inner radius", inner), Want::Length)?,
            value(reading, ("length", length), Want::Length)?,
            value(reading, ("angle", angle), Want::Angle)?,
        ];
        is_possible(values)?;
        let mut planning = Planning::new(reading);
        let middle = planning.points(&places(answers)[..1])?[0];
        let evaluation = planning.evaluation();
        let outer = match (inner, length) {
            (Number::Value(inner), Number::Value(length)) => Number::Value(inner + length),
            _ => {
                let [near, long] = [inner, length].map(|n| written(evaluation, n, Want::Length));
                formula(evaluation, &format!("{near} + {long}"))?
            }
        };
        let inner = (values[0] > 0.0).then_some(inner);
        let centre = (centre.sheet, middle);
        let panel = match values[2] < TAU - 1e-9 {
            true => sector(&mut planning, centre, (inner, &outer), angle),
            false => disc(&mut planning, centre, (inner, &outer)),
        }?;
        Ok(planning.done("Draw circle", [Item::Panel(panel)]))
    },
};

fn value(
    reading: &Reading<'_>,
    (label, number): (&str, &Number),
    want: Want,
) -> Result<f64, EditError> {
    let value = reading.evaluation.number(number, want);
    value.ok_or_else(|| refuse(&format!("the {label} has no value"), "type another"))
}

fn is_possible([inner, length, angle]: [f64; 3]) -> Result<(), EditError> {
    if inner < 0.0 {
        return Err(refuse("the inner radius is below zero", "type 0 or more"));
    }
    if length < 1e-6 {
        return Err(refuse("the length is not above zero", "type a length"));
    }
    if !(1e-3..=TAU + 1e-9).contains(&angle) {
        return Err(refuse(
            "the angle is not between 0 and 360 degrees",
            "type an angle as 90, 180 or 360",
        ));
    }
    Ok(())
}

/// The sheet of a shape, and the centre point on it.
type Centre = (SheetId, PointId);

/// Makes a point to the right of the centre, at the distance `radius`.
fn beside(
    planning: &mut Planning,
    (sheet, middle): Centre,
    radius: &Number,
) -> Result<PointId, EditError> {
    let rule = PointRule::Polar {
        base: middle,
        angle: Number::Value(0.0),
        distance: radius.clone(),
    };
    planning.run(|evaluation| plan::add_point(evaluation, sheet, None, rule))
}

/// Draws a curve with a name if the name is free, else named after the ends of the curve.
fn curve(
    planning: &mut Planning,
    (sheet, name): (SheetId, &str),
    ends: [PointId; 2],
    rule: CurveRule,
) -> Result<CurveId, EditError> {
    planning.run(|evaluation| {
        let drawn = evaluation.pattern().sheet(sheet);
        let is_free = drawn.is_some_and(|sheet| sheet.curve_named(name).is_none());
        let shape = CurveShape::Rule(rule);
        plan::add_curve(evaluation, (sheet, is_free.then_some(name)), ends, shape)
    })
}

/// Draws a sector of a ring, counter-clockwise from the direction to the right of the centre, and traces a
/// panel on it. Without an inner radius the sector reaches to the centre.
fn sector(
    planning: &mut Planning,
    centre: Centre,
    (inner, outer): (Option<&Number>, &Number),
    angle: &Number,
) -> Result<PanelId, EditError> {
    let (sheet, middle) = centre;
    let bulge = plan::bulge_of(planning.evaluation(), angle)?;
    let mut corners = |radius: Option<&Number>| match radius {
        None => Ok([middle, middle]),
        Some(radius) => {
            let start = beside(planning, centre, radius)?;
            Ok([start, about(planning, [middle, start], angle)?])
        }
    };
    let (near, far) = (corners(inner)?, corners(Some(outer))?);
    let arc = || CurveRule::Arc {
        bulge: bulge.clone(),
    };
    let mut curves = vec![
        curve(
            planning,
            (sheet, "start"),
            [near[0], far[0]],
            CurveRule::Line,
        )?,
        curve(planning, (sheet, "outer"), far, arc())?,
        curve(planning, (sheet, "end"), [far[1], near[1]], CurveRule::Line)?,
    ];
    if inner.is_some() {
        let back = negated(planning, &bulge)?;
        let ends = [near[1], near[0]];
        let rule = CurveRule::Arc { bulge: back };
        curves.push(curve(planning, (sheet, "inner"), ends, rule)?);
    }
    traced(planning, sheet, &curves)
}

fn negated(planning: &Planning, number: &Number) -> Result<Number, EditError> {
    match number {
        Number::Value(value) => Ok(Number::Value(-value)),
        _ => {
            let evaluation = planning.evaluation();
            let text = written(evaluation, number, Want::Plain);
            formula(evaluation, &format!("-{text}"))
        }
    }
}

/// Draws a circle of two half circles, with a hole of two half circles if there is an inner radius, and
/// traces a panel.
fn disc(
    planning: &mut Planning,
    centre: Centre,
    (inner, outer): (Option<&Number>, &Number),
) -> Result<PanelId, EditError> {
    let (sheet, middle) = centre;
    let mut circle = |radius: &Number, names: [&str; 2]| {
        let start = beside(planning, centre, radius)?;
        let across = about(planning, [middle, start], &Number::Value(PI))?;
        let half = |planning: &mut Planning, name, ends| {
            let bulge = Number::Value(1.0);
            curve(planning, (sheet, name), ends, CurveRule::Arc { bulge })
        };
        Ok([
            half(planning, names[0], [start, across])?,
            half(planning, names[1], [across, start])?,
        ])
    };
    let outer = circle(outer, ["outer", "outer 2"])?;
    let inner = inner.map(|radius| circle(radius, ["inner", "inner 2"]));
    let panel = traced(planning, sheet, &outer)?;
    if let Some(inner) = inner.transpose()? {
        planning.run(|evaluation| {
            let kind = (LineKind::Hole, None);
            plan::add_line(evaluation, panel, kind, Chain::Curves(&inner))
        })?;
    }
    Ok(panel)
}

fn traced(
    planning: &mut Planning,
    sheet: SheetId,
    curves: &[CurveId],
) -> Result<PanelId, EditError> {
    planning.run(|evaluation| {
        let chain = Chain::Curves(curves);
        plan::trace_panel(evaluation, sheet, chain, NewPanel::default())
    })
}
