//! Tools that strike distances with a compass: a point on a line at a distance from a third point, and a
//! point at distances from two others. The pointer chooses between both places.

use super::Pointer;
use super::composed::{formula, point};
use super::draw::name;
use super::planning::{Planning, places};
use super::refusal::refuse;
use super::slots::{Answer, Fields, Slot, SlotKind, SlotTool};
use crate::canvas::placed::{Placed, Spec, rounded};
use crate::canvas::selection::Item;
use toile_geometry::Vec2;
use toile_pattern::{EditError, Number, PointId, PointRule, Want, plan};

/// Step of distances that the pointer gives (m).
const STEP: f64 = 0.001;
/// Distance of the first compass before the pointer gives one (m).
const USUAL: f64 = 0.1;

/// A point on the line through two points, at a distance from a third.
pub static ON_LINE: SlotTool = SlotTool {
    command: "Compass on line",
    slots: &[
        Slot {
            hint: "Click a point of the line",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Click another point of the line",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Click the point to measure from",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Click where the line is met, or type the distance and point to that side",
            kind: SlotKind::Named(Fields::Radius),
        },
    ],
    plan: |answers, reading| {
        let given = places(answers);
        let [from, to, centre, met] = given[..] else {
            return Err(refuse("nothing was given", "click a point of the line"));
        };
        let mut planning = Planning::new(reading);
        let points = planning.points(&given[..3])?;
        let way = along([from, to])?;
        let to_centre = centre.at - from.at;
        let distance = match given_distance(&planning, points[2], met)? {
            Some(distance) => distance,
            None => {
                let foot = from.at + way * way.dot(&(met.at - from.at));
                let least = way.perp(&to_centre).abs();
                let value = rounded((foot - centre.at).norm(), STEP);
                Number::Value(value.max(least))
            }
        };
        let rule = PointRule::OnLineAt {
            line: [points[0], points[1]],
            centre: points[2],
            distance,
            far: way.dot(&(met.at - centre.at)) > 0.0,
        };
        let (sheet, name) = (from.sheet, name(answers));
        let made = planning.run(|evaluation| plan::add_point(evaluation, sheet, name, rule))?;
        Ok(planning.done("Draw point on line", [Item::Point(made)]))
    },
};

/// A point at distances from two points.
pub static TWO: SlotTool = SlotTool {
    command: "Two compasses",
    slots: &[
        Slot {
            hint: "Click the first point to measure from",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Click the second point to measure from",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Click how far it is from the first point",
            kind: SlotKind::Number {
                label: "distance from the first",
                want: Want::Length,
                usual: USUAL,
                live: Some(from_first),
            },
        },
        Slot {
            hint: "Click where both meet, or type the distance from the second and point to that side",
            kind: SlotKind::Named(Fields::Radius),
        },
    ],
    plan: |answers, reading| {
        let given = places(answers);
        let ([first, second, met], Some(Answer::Number(radius))) = (&given[..], answers.get(2))
        else {
            return Err(refuse("nothing was given", "click the first point"));
        };
        let mut planning = Planning::new(reading);
        let centres = planning.points(&given[..2])?;
        let way = second.at - first.at;
        let other = match given_distance(&planning, centres[1], met)? {
            Some(distance) => distance,
            None => {
                let evaluation = planning.evaluation();
                let radius = evaluation.number(radius, Want::Length);
                let radius = radius.unwrap_or(USUAL).abs();
                // The nearest distance at which both circles meet.
                let (least, most) = ((way.norm() - radius).abs(), way.norm() + radius);
                let value = rounded((met.at - second.at).norm(), STEP);
                Number::Value(value.clamp(least, most))
            }
        };
        let rule = PointRule::TwoDistances {
            centres: [centres[0], centres[1]],
            distances: [radius.clone(), other],
            left: way.perp(&(met.at - first.at)) > 0.0,
        };
        let (sheet, name) = (first.sheet, name(answers));
        let made = planning.run(|evaluation| plan::add_point(evaluation, sheet, name, rule))?;
        Ok(planning.done("Draw point by two distances", [Item::Point(made)]))
    },
};

/// Direction of the line through two places.
///
/// # Errors
/// They are in one place.
fn along([from, to]: [&Placed; 2]) -> Result<Vec2, EditError> {
    let way = (to.at - from.at).try_normalize(1e-12);
    way.ok_or_else(|| {
        refuse(
            "both points of the line are in one place",
            "choose two points that are apart",
        )
    })
}

/// The distance from a centre that was typed, or that of a point which was clicked. `None`: the pointer gives
/// one.
///
/// # Errors
/// The formula is too long.
fn given_distance(
    planning: &Planning,
    centre: PointId,
    met: &Placed,
) -> Result<Option<Number>, EditError> {
    match &met.spec {
        Spec::FromLast { distance, .. } => Ok(Some(distance.clone())),
        Spec::Point(id) if *id != centre => {
            let evaluation = planning.evaluation();
            let names = [centre, *id].map(|id| point(evaluation, id)).join(", ");
            formula(evaluation, &format!("distance({names})")).map(Some)
        }
        _ => Ok(None),
    }
}

/// Distance of the pointer from the first point (m).
fn from_first(answers: &[Answer], pointer: &Pointer) -> f64 {
    let given = places(answers);
    let far = given.first().map(|first| (pointer.at - first.at).norm());
    match far.map(|far| rounded(far, STEP)) {
        Some(far) if far > 0.0 => far,
        _ => USUAL,
    }
}
