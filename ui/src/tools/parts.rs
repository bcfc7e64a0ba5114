//! Tools that move, turn, mirror and scale the selection, and one that measures.

use super::planning::places;
use super::refusal::refuse;
use super::slots::{Answer, Fields, Plan, Slot, SlotKind, SlotTool};
use super::{Pointer, Reading, number};
use toile_geometry::Vec2;
use toile_pattern::plan::{self, Affine};
use toile_pattern::{EditError, PartId, Want};

/// Moves the selection from one place to another.
pub static MOVE: SlotTool = SlotTool {
    command: "Move",
    slots: &[
        Slot {
            hint: "Click where to take hold of what is selected",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Click where that place goes",
            kind: SlotKind::Place(Fields::Usual),
        },
    ],
    plan: |answers, reading| {
        let given = places(answers);
        let way = given[1].at - given[0].at;
        transformed(reading, &Affine::translation(way), "Move")
    },
};

/// Rotates the selection about a place.
pub static TURN: SlotTool = SlotTool {
    command: "Turn",
    slots: &[
        Slot {
            hint: "Click the place to turn about",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Type by how much, counter-clockwise",
            kind: SlotKind::Number {
                label: "angle",
                want: Want::Angle,
                usual: 0.0,
                live: Some(direction),
            },
        },
    ],
    plan: |answers, reading| {
        let [Answer::Place(about), Answer::Number(angle)] = answers else {
            return Err(refuse("nothing was given", "click the place to turn about"));
        };
        let angle = value(reading, angle, Want::Angle)?;
        transformed(reading, &Affine::rotation(about.at, angle), "Turn")
    },
};

/// Mirrors the selection in the line through two places.
pub static MIRROR_PARTS: SlotTool = SlotTool {
    command: "Mirror",
    slots: &[
        Slot {
            hint: "Click a place on the mirror line",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Click another place on it",
            kind: SlotKind::Place(Fields::Usual),
        },
    ],
    plan: |answers, reading| {
        let given = places(answers);
        let line = [given[0].at, given[1].at];
        if (line[1] - line[0]).norm() < 1e-9 {
            return Err(refuse(
                "the mirror line has no direction",
                "click another place",
            ));
        }
        transformed(reading, &Affine::reflection(line), "Mirror")
    },
};

/// Scales the selection about a place.
pub static SCALE: SlotTool = SlotTool {
    command: "Scale",
    slots: &[
        Slot {
            hint: "Click the place that stays",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Type how many times as large",
            kind: SlotKind::Number {
                label: "factor",
                want: Want::Plain,
                usual: 1.0,
                live: None,
            },
        },
    ],
    plan: |answers, reading| {
        let [Answer::Place(about), Answer::Number(factor)] = answers else {
            return Err(refuse("nothing was given", "click the place that stays"));
        };
        let factor = value(reading, factor, Want::Plain)?;
        if factor.abs() < 1e-6 {
            return Err(refuse(
                "nothing can be scaled to nothing",
                "type a factor as 1.1 or 0.9",
            ));
        }
        transformed(reading, &Affine::scaling(about.at, [factor; 2]), "Scale")
    },
};

/// Shows the distance and direction from one place to another. Does not change the document.
pub static MEASURE: SlotTool = SlotTool {
    command: "Measure",
    slots: &[
        Slot {
            hint: "Click where to measure from",
            kind: SlotKind::Place(Fields::Usual),
        },
        Slot {
            hint: "Click where to measure to",
            kind: SlotKind::Place(Fields::Usual),
        },
    ],
    plan: |answers, reading| {
        let given = places(answers);
        let way = given[1].at - given[0].at;
        let unit = reading.evaluation.pattern().unit;
        let length = |length: f64| number::show(length, Want::Length, unit);
        Ok(Plan {
            edits: Vec::new(),
            label: format!(
                "{} at {}: {} across, {} up",
                length(way.norm()),
                number::show(way.y.atan2(way.x), Want::Angle, unit),
                length(way.x),
                length(way.y),
            ),
            select: reading.selection.clone(),
            again: Vec::new(),
            told: None,
        })
    },
};

/// Direction from the given place to the pointer (rad), in whole degrees; with Shift in steps of 15
/// degrees.
fn direction(answers: &[Answer], pointer: &Pointer) -> f64 {
    let about = places(answers).first().map_or_else(Vec2::zeros, |p| p.at);
    let way = pointer.at - about;
    let step = if pointer.modifiers.shift {
        15.0
    } else {
        1.0_f64
    };
    let step = step.to_radians();
    (way.y.atan2(way.x) / step).round() * step
}

fn value(
    reading: &Reading<'_>,
    number: &toile_pattern::Number,
    want: Want,
) -> Result<f64, EditError> {
    let value = reading.evaluation.number(number, want);
    value.ok_or_else(|| refuse("the formula has no value", "mend it, or type a number"))
}

/// The plan that transforms the selected parts by an affine map.
fn transformed(reading: &Reading<'_>, map: &Affine, label: &str) -> Result<Plan, EditError> {
    let parts: Vec<PartId> = reading
        .selection
        .items()
        .iter()
        .map(|item| item.part())
        .collect();
    let points = plan::points_of(reading.evaluation, &parts);
    if points.is_empty() {
        return Err(refuse(
            "nothing is selected that could be moved",
            "select points, edges, curves or panels first",
        ));
    }
    let moved = plan::transform_points(reading.evaluation, &points, map)?;
    Ok(Plan {
        edits: moved.edits,
        label: label.to_owned(),
        select: reading.selection.clone(),
        again: Vec::new(),
        told: None,
    })
}
