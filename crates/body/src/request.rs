//! The measurements a mannequin is made from, completed and checked.
//!
//! # Decided with
//! - [`toile_measure::Build`], [`toile_measure::Origin`]: what is missing is predicted from what was asked;
//! - [`crate::request::CLOSER`]: narrower ranges;
//! - [`crate::conflict`] (`RULES`, `LOOPS`): measurements that no body has together, and which one gives way;
//! - [`crate::shape`]: a shape whose levels are out of order;
//! - [`crate::error::BodyError`]: refusals in words;
//! - [`crate::solve`], [`crate::deviation::Deviation`], [`crate::mannequin::Mannequin::conflicts`]
//!   (`deviation.rs`): the size solved; measurements asked for and not met.
//!
//! By hand: these lists name measurements.

use crate::conflict::{Conflict, conflicts, gives_way};
use crate::girths::Girth;
use crate::{BodyError, Figure};
use toile_measure::{Measurements, Origin, UnitKind, definition};

/// The requested measurements of a body, with predictions of the others.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Request {
    /// Requested and predicted measurements.
    pub(crate) table: Measurements,
    /// Contradictions among the requested measurements.
    pub(crate) conflicts: Vec<Conflict>,
}

/// Limits of a length as a share of stature: wider than any body, so that only errors of unit or typing are
/// refused.
const LENGTH: [f64; 2] = [0.004, 2.2];
/// Limits of an angle (rad): wider than on any body, for the same reason.
const ANGLE: [f64; 2] = [-0.2, 1.3];
/// Limits of the angle of the arms below the horizontal (rad): from 0, arms straight out to the sides, which
/// many programs use.
const ARM_POSE: [f64; 2] = [0.0, 1.4];
/// Limits of the stature (m): from dolls to giants.
const STATURE: [f64; 2] = [0.12, 6.0];

/// Narrower limits as a share of stature of the most important measurements.
const CLOSER: [(&str, [f64; 2]); 17] = [
    ("head_l", [0.09, 0.35]),
    ("neck_w", [0.05, 0.20]),
    ("shoulder_w", [0.12, 0.38]),
    ("bust", [0.30, 1.2]),
    ("vert_bust_line", [0.05, 0.25]),
    ("underbust", [0.28, 1.2]),
    ("waist", [0.22, 1.3]),
    ("waist_line", [0.12, 0.38]),
    ("hips", [0.32, 1.3]),
    ("hips_line", [0.04, 0.25]),
    ("crotch_hip_diff", [0.01, 0.14]),
    ("leg_circ", [0.15, 0.7]),
    ("arm_length", [0.2, 0.5]),
    ("wrist", [0.05, 0.18]),
    ("neck", [0.1, 0.5]),
    ("head", [0.15, 0.75]),
    ("upper_arm", [0.07, 0.45]),
];

impl Request {
    /// Whether levels and lengths over the bust are all requested and do not contradict each other; then the
    /// length along the skin below the bust determines how far the bust stands out.
    pub(crate) fn follows_skin(&self) -> bool {
        let all = [
            "bust_to_underbust",
            "bust_line",
            "waist_to_underbust",
            "hps_to_waist_front",
        ];
        all.iter().all(|name| self.is_asked(name))
            && !gives_way("bust_to_underbust", &self.conflicts)
    }

    /// Completes and checks a table.
    pub(crate) fn read(asked: &Measurements, figure: Figure) -> Result<Self, BodyError> {
        // A value that was predicted for another body is not a request.
        let mut table = Measurements::new();
        for (name, measured) in asked.iter().filter(|(_, m)| m.origin == Origin::Asked) {
            table
                .set(name, measured.value, Origin::Asked)
                .map_err(|error| BodyError::Description(error.to_string()))?;
        }
        let table = table.completed(figure.build());
        let stature = table.get("height").unwrap_or(1.7);
        check("height", stature, STATURE, "m")?;
        for (name, measured) in table.iter() {
            let Some(known) = definition(name) else {
                continue;
            };
            if measured.origin == Origin::Predicted || known.name == "height" {
                continue;
            }
            match known.kind {
                UnitKind::Angle => {
                    let limits = match known.name {
                        "arm_pose_angle" => ARM_POSE,
                        _ => ANGLE,
                    };
                    // Files give angles in degrees.
                    let limits = limits.map(f64::to_degrees);
                    check(known.name, measured.value.to_degrees(), limits, "degrees")?;
                }
                UnitKind::Length => {
                    let row = CLOSER.iter().find(|row| row.0 == known.name);
                    let limits = row.map_or(LENGTH, |row| row.1).map(|x| x * stature);
                    check(known.name, measured.value, limits, "m")?;
                }
            }
        }
        if let (Some(neck), Some(shoulders)) = (table.get("neck_w"), table.get("shoulder_w"))
            && neck + 0.03 * stature > shoulders
        {
            return Err(BodyError::Contradiction {
                first: "neck_w",
                second: "shoulder_w",
                remedy: "the shoulders must be wider than the neck by 0.03 of the height or more: \
                         lessen neck_w",
            });
        }
        let conflicts = conflicts(&table);
        Ok(Self { table, conflicts })
    }

    /// A value of the completed table (m) or (rad).
    pub(crate) fn get(&self, name: &str) -> f64 {
        self.table.get(name).unwrap_or_default()
    }

    /// Whether a measurement is requested.
    pub(crate) fn is_asked(&self, name: &str) -> bool {
        self.table
            .measured(name)
            .is_some_and(|m| m.origin == Origin::Asked)
    }

    /// Requested or predicted girth (m); `None` if the template's own girth is kept.
    pub(crate) fn girth(&self, girth: Girth) -> Option<f64> {
        self.table.get(girth.name())
    }
}

fn check(
    name: &'static str,
    value: f64,
    [low, high]: [f64; 2],
    unit: &'static str,
) -> Result<(), BodyError> {
    if (low..=high).contains(&value) {
        return Ok(());
    }
    let rounded = |x: f64| (x * 1e3).round() / 1e3;
    Err(BodyError::OutOfRange {
        name,
        // Degrees as the file has them, without the rounding error of the conversion to radians.
        value: (value * 1e9).round() / 1e9,
        low: rounded(low),
        high: rounded(high),
        unit,
    })
}
