//! Circles and arcs of ellipses, for which splines stand.

use super::build::{Build, Slot, reference};
use super::kinds::{LENGTH, Quantity};
use super::splines::{Handled, Made, handle, spline};
use super::things::PointThing;
use crate::exchange::Loss;
use roxmltree::Node;
use std::f64::consts::{FRAC_PI_2, TAU};
use toile_geometry::Vec2;
use toile_pattern::{Number, PointRule};

/// Number of cubic curves that stand for a circle or an arc of an ellipse.
const PIECES: usize = 8;
/// Number of steps in which the length of an arc of an ellipse is summed up.
const STEPS: usize = 2000;

/// A whole turn round a centre.
pub(super) struct Round<'a> {
    pub centre: PointThing,
    pub radius: &'a Slot,
    /// Direction of its start from the centre.
    pub start: &'a Slot,
    /// The swept angle, negative if it runs clockwise (rad).
    pub turn: f64,
}

/// Names radius and directions of an arc for formulas.
pub(super) fn name_round(build: &mut Build, name: &str, radius: &Slot, [start, end]: [&Slot; 2]) {
    build.name_length(format!("Radius{name}"), &radius.text, radius.value);
    for (number, slot) in [(1, start), (2, end)] {
        let of_angle = format!("Angle{number}{name}");
        build.name_value(of_angle, &slot.text, Quantity::Angle, slot.value);
    }
}

/// A number of a formula, or its value if nothing in it can change.
fn number(build: &Build, is_fixed: bool, text: &str, value: f64) -> Result<Number, String> {
    match is_fixed {
        true => Ok(Number::Value(value)),
        false => build.formula(text),
    }
}

/// Makes a full circle as a spline.
pub(super) fn full_circle(build: &mut Build, node: Node<'_, '_>, round: &Round<'_>) -> Made {
    let Round {
        centre,
        radius,
        start,
        turn,
    } = *round;
    let id = reference(node, "id")?;
    let name = format!("Arc_{}_{id}", build.file_name(centre));
    let step = turn / PIECES as f64;
    let reach = 4.0 / 3.0 * (step / 4.0).tan();
    let turned = |build: &Build, by: f64| -> Result<Slot, String> {
        let is_fixed = start.number.value().is_some();
        let text = format!("({} + {}deg)", start.text, by.to_degrees());
        let value = start.value + by;
        Ok(Slot {
            number: number(build, is_fixed, &text, value)?,
            text,
            value,
        })
    };
    let mut points = Vec::new();
    for k in 0..=PIECES {
        let at = turned(build, step * k as f64)?;
        let told = format!("{name} {k}");
        let distance = (radius.number.clone(), radius.value);
        let point = handle(build, &told, centre, &at, distance);
        let ahead = turned(build, step * k as f64 + FRAC_PI_2)?;
        let mut beside = [point; 2];
        for (side, beside) in beside.iter_mut().enumerate() {
            let share = if side == 0 { -reach } else { reach };
            let text = format!("{} * {share}", radius.text);
            let is_fixed = radius.number.value().is_some();
            let value = radius.value * share;
            let distance = (number(build, is_fixed, &text, value)?, value);
            let told = format!("{name} {k} {}", if side == 0 { "before" } else { "after" });
            *beside = handle(build, &told, point, &ahead, distance);
        }
        let [before, after] = beside;
        points.push(Handled {
            point,
            before,
            after,
        });
    }
    let made = spline(build, &name, &points)?;
    name_round(build, &name, radius, [start, start]);
    build.circles.insert(made.id, (centre, radius.clone()));
    Ok(made)
}

/// An arc of an ellipse for the base size.
struct Ellipse {
    /// Half axes (m).
    axes: [f64; 2],
    /// The angle at its start whose cosine and sine give a place as shares of the half axes (rad).
    from: f64,
    /// Growth of that angle along the arc (rad).
    swept: f64,
}

impl Ellipse {
    /// Such an angle of the place in a direction (rad).
    fn parameter(axes: [f64; 2], direction: f64) -> f64 {
        (direction.sin() / axes[1]).atan2(direction.cos() / axes[0])
    }

    /// The growth at which the arc has a length, no more than a whole turn (rad).
    fn swept_by(axes: [f64; 2], from: f64, length: f64) -> f64 {
        let step = TAU / STEPS as f64 * length.signum();
        let mut rest = length.abs();
        for k in 0..STEPS {
            let (sin, cos) = (from + step * (k as f64 + 0.5)).sin_cos();
            let way = (axes[0] * sin).hypot(axes[1] * cos) * step.abs();
            if way >= rest {
                return step * (k as f64 + rest / way);
            }
            rest -= way;
        }
        step * STEPS as f64
    }
}

/// Makes an arc of an ellipse as a spline: radii stay formulas where its directions are those of its axes.
pub(super) fn elliptic(build: &mut Build, node: Node<'_, '_>) -> Made {
    let centre = build.point(node, "center")?;
    let radii = [
        build.number(node, "radius1", LENGTH)?,
        build.number(node, "radius2", LENGTH)?,
    ];
    let start = build.number(node, "angle1", Quantity::Angle)?;
    let turned = match node.attribute("rotationAngle") {
        Some(_) => Some(build.number(node, "rotationAngle", Quantity::Angle)?),
        None => None,
    };
    let axes = [radii[0].value, radii[1].value];
    if !axes.iter().all(|axis| *axis > 0.0) {
        return Err("its radius is not above 0".to_owned());
    }
    let from = Ellipse::parameter(axes, start.value);
    let by_length = node.has_attribute("length") && !node.has_attribute("angle2");
    let (swept, end) = match by_length {
        true => {
            let length = build.number(node, "length", LENGTH)?;
            (Ellipse::swept_by(axes, from, length.value), None)
        }
        false => {
            let end = build.number(node, "angle2", Quantity::Angle)?;
            let swept = (Ellipse::parameter(axes, end.value) - from).rem_euclid(TAU);
            let swept = if swept <= 1e-9 { swept + TAU } else { swept };
            (swept, Some(end))
        }
    };
    let ellipse = Ellipse { axes, from, swept };
    let is_along_axis = |slot: &Slot| {
        let quarters = slot.value / FRAC_PI_2;
        slot.number.value().is_some() && (quarters - quarters.round()).abs() <= 1e-9
    };
    let is_turned_alike = turned
        .as_ref()
        .is_none_or(|slot| slot.number.value().is_some());
    let follows =
        is_turned_alike && is_along_axis(&start) && end.as_ref().is_some_and(is_along_axis);
    let tilt = turned.as_ref().map_or(0.0, |slot| slot.value);
    let id = reference(node, "id")?;
    let name = format!("ElArc_{}_{id}", build.file_name(centre));
    let points = points(build, &name, (centre, &radii, tilt), &ellipse, follows)?;
    let why = match follows {
        true => "a spline stands for it, that is off by less than a hundredth of a millimetre",
        false => "a spline stands for it, as it is in the base size",
    };
    build
        .losses
        .push(Loss::at(name.clone(), "an elliptic arc", why));
    let made = spline(build, &name, &points)?;
    for (k, radius) in radii.iter().enumerate() {
        build.name_length(format!("Radius{}{name}", k + 1), &radius.text, radius.value);
    }
    let angles = [
        ("Angle1", Some(&start)),
        ("Angle2", end.as_ref()),
        ("Rotation", turned.as_ref()),
    ];
    for (what, slot) in angles {
        if let Some(slot) = slot {
            build.name_value(
                format!("{what}{name}"),
                &slot.text,
                Quantity::Angle,
                slot.value,
            );
        }
    }
    Ok(made)
}

fn points(
    build: &mut Build,
    name: &str,
    (centre, radii, tilt): (PointThing, &[Slot; 2], f64),
    ellipse: &Ellipse,
    follows: bool,
) -> Result<Vec<Handled>, String> {
    let step = ellipse.swept / PIECES as f64;
    let reach = 4.0 / 3.0 * (step / 4.0).tan();
    let (tilt_sin, tilt_cos) = tilt.sin_cos();
    let [a, b] = ellipse.axes;
    // A place by its shares of both half axes.
    let add = |build: &mut Build, what: String, [u, v]: [f64; 2]| -> Result<PointThing, String> {
        let shares = [[u * tilt_cos, -v * tilt_sin], [u * tilt_sin, v * tilt_cos]];
        let [x, y] = shares.map(|[of_a, of_b]| a * of_a + b * of_b);
        let at = centre.at + Vec2::new(x, y);
        let rule = match follows {
            false => PointRule::at(at.x, at.y),
            true => {
                let [x, y] = shares.map(|[of_a, of_b]| {
                    let text = format!("{} * {of_a} + {} * {of_b}", radii[0].text, radii[1].text);
                    build.formula(&text)
                });
                PointRule::Offset {
                    base: centre.id,
                    x: x?,
                    y: y?,
                }
            }
        };
        Ok(build.add_point(&what, rule, at))
    };
    let mut made = Vec::new();
    for k in 0..=PIECES {
        let (sin, cos) = (ellipse.from + step * k as f64).sin_cos();
        let way = [-sin * reach, cos * reach];
        made.push(Handled {
            point: add(build, format!("{name} {k}"), [cos, sin])?,
            before: add(
                build,
                format!("{name} before {k}"),
                [cos - way[0], sin - way[1]],
            )?,
            after: add(
                build,
                format!("{name} after {k}"),
                [cos + way[0], sin + way[1]],
            )?,
        });
    }
    Ok(made)
}
