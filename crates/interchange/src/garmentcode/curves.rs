//! Edge curvatures of GarmentCode as curves, and back.

use super::json::At;
use crate::FormatError;
use serde_json::{Value, json};
use toile_geometry::{Curve, Vec2};

/// The coordinates in which control points are given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Coordinates {
    /// In the frame of the edge: along the edge and to its left, as fractions of the edge's length.
    Relative,
    /// In the panel's plane, in file units.
    Absolute,
}

/// Reads the curvature of the edge from `start` to `end` (m); `metres` is the size of a file unit (m).
pub(super) fn read_curve(
    curvature: Option<&At>,
    [start, end]: [Vec2; 2],
    coordinates: Coordinates,
    metres: f64,
    notes: &mut Vec<FormatError>,
) -> Result<Curve, FormatError> {
    let Some(curvature) = curvature else {
        return Ok(Curve::Line { start, end });
    };
    let along = end - start;
    let left = Vec2::new(-along.y, along.x);
    let place = |at: &At| -> Result<Vec2, FormatError> {
        let [u, v] = at.numbers::<2>()?;
        Ok(match coordinates {
            Coordinates::Relative => start + along * u + left * v,
            Coordinates::Absolute => Vec2::new(u, v) * metres,
        })
    };
    if curvature.value.is_array() {
        return Ok(Curve::Quadratic {
            start,
            control: place(curvature)?,
            end,
        });
    }
    let kind = curvature.field("type")?;
    let params = curvature.field("params")?;
    curvature.unknown_fields(&["type", "params"], notes);
    let points =
        || -> Result<Vec<Vec2>, FormatError> { params.items()?.iter().map(place).collect() };
    match kind.text()? {
        "quadratic" => match points()?[..] {
            [control] => Ok(Curve::Quadratic {
                start,
                control,
                end,
            }),
            _ => Err(params.error("a quadratic curve has one control point", "give [[u, v]]")),
        },
        "cubic" => match points()?[..] {
            [first, second] => Ok(Curve::Cubic {
                start,
                controls: [first, second],
                end,
            }),
            _ => Err(params.error(
                "a cubic curve has two control points",
                "give [[u, v], [u, v]]",
            )),
        },
        "circle" => {
            let [radius, large, right] = params.numbers::<3>()?;
            circle(
                [start, end],
                radius * metres,
                [large != 0.0, right != 0.0],
                &params,
                notes,
            )
        }
        other => Err(kind.error(
            format!("\"{other}\" is not a kind of curve known here"),
            "use quadratic, cubic or circle",
        )),
    }
}

/// An arc by its radius. The flags tell whether it is the larger of the two arcs, and whether it bulges to
/// the right of the direction from start to end.
fn circle(
    [start, end]: [Vec2; 2],
    radius: f64,
    [large, right]: [bool; 2],
    params: &At,
    notes: &mut Vec<FormatError>,
) -> Result<Curve, FormatError> {
    let half_chord = 0.5 * (end - start).norm();
    if radius <= 0.0 {
        return Err(params.error("the radius of a circle is not positive", "give a length"));
    }
    let mut sine = half_chord / radius;
    if sine > 1.0 {
        if sine > 1.0 + 1e-6 {
            notes.push(params.error(
                "the radius is less than half the chord: a half circle is taken",
                "check the radius; it is in the units of the file",
            ));
        }
        sine = 1.0;
    }
    let half_sweep = if large {
        std::f64::consts::PI - sine.asin()
    } else {
        sine.asin()
    };
    let bulge = (0.5 * half_sweep).tan();
    Ok(Curve::Arc {
        start,
        end,
        bulge: if right { bulge } else { -bulge },
    })
}

/// Curvature of a curve in relative coordinates; `None` for a straight line. `metres` is the size of a file
/// unit (m).
pub(super) fn write_curve(curve: &Curve, metres: f64) -> Option<Value> {
    let (start, end) = (curve.start(), curve.end());
    let along = end - start;
    let left = Vec2::new(-along.y, along.x);
    let square = along.norm_squared();
    let relative = |p: Vec2| {
        let d = p - start;
        json!([d.dot(&along) / square, d.dot(&left) / square])
    };
    match *curve {
        Curve::Line { .. } => None,
        Curve::Quadratic { control, .. } => {
            Some(json!({ "type": "quadratic", "params": [relative(control)] }))
        }
        Curve::Cubic { controls, .. } => Some(json!({
            "type": "cubic",
            "params": [relative(controls[0]), relative(controls[1])],
        })),
        Curve::Arc { bulge, .. } => {
            if bulge == 0.0 {
                return None;
            }
            let half_sweep = 2.0 * bulge.abs().atan();
            let radius = 0.5 * along.norm() / half_sweep.sin();
            let large = u8::from(half_sweep > std::f64::consts::FRAC_PI_2);
            let right = u8::from(bulge > 0.0);
            Some(json!({ "type": "circle", "params": [radius / metres, large, right] }))
        }
    }
}
