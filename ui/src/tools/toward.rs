//! Places given by a distance and the pointer's direction.

use super::{Pointer, Reading, along};
use crate::canvas::placed::{Placed, Spec, rounded};
use toile_geometry::Vec2;
use toile_pattern::{Number, Want};

/// Angular step while Shift is held (degrees).
const TURN: f64 = 15.0;
/// Distance to the left of or below the last place, beyond which the pointer makes a typed width or height
/// negative (pixels).
const BEYOND: f64 = 12.0;

/// The place `free` moved to the nearest direction from the last place in steps of 15 degrees.
pub(super) fn turned(last: &Placed, pointer: &Pointer, free: Placed) -> Placed {
    let way = free.at - last.at;
    let step = TURN.to_radians();
    let angle = (way.y.atan2(way.x) / step).round() * step;
    let unit = Vec2::new(angle.cos(), angle.sin());
    let far = way.dot(&unit);
    let far = match pointer.modifiers.command {
        true => far,
        false => rounded(far, 0.001),
    };
    Placed {
        sheet: last.sheet,
        at: last.at + unit * far,
        spec: Spec::FromLast {
            distance: Number::Value(far),
            angle: Number::Value(angle),
        },
        words: format!("at {:.0}\u{b0}", angle.to_degrees()),
    }
}

/// Makes a typed width or height negative if the pointer is left of or below the last place. `way` is the
/// offset of the pointer from that place in the direction of the number (m), `pixel` the size of a pixel (m).
/// A negative number stays as it is.
pub(super) fn to_side(
    number: Number,
    way: f64,
    (pixel, reading): (f64, &Reading<'_>),
) -> Result<Number, String> {
    let value = reading.evaluation.number(&number, Want::Length);
    match way < -BEYOND * pixel && value.is_some_and(|value| value > 0.0) {
        true => along::negated(&number, reading).map_err(|error| error.to_string()),
        false => Ok(number),
    }
}
