//! The measurements a mannequin is made from, read and checked.

use crate::BodyError;
use toile_measure::Measurements;

/// Everything asked of a body [m], [rad].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Request {
    pub(crate) height: f64,
    pub(crate) head: f64,
    pub(crate) neck_width: f64,
    pub(crate) shoulder_width: f64,
    pub(crate) shoulder_slope: f64,
    pub(crate) bust: f64,
    pub(crate) bust_depth: f64,
    pub(crate) underbust: f64,
    pub(crate) waist: f64,
    pub(crate) waist_line: f64,
    pub(crate) hips: f64,
    pub(crate) hips_line: f64,
    pub(crate) crotch_drop: f64,
    pub(crate) thigh: f64,
    pub(crate) arm_length: f64,
    pub(crate) arm_angle: f64,
    pub(crate) wrist: f64,
}

/// Name, smallest, usual and largest value. Lengths [m], then angles [rad]. The limits are wider
/// than any adult, so that only slips of unit or typing are refused.
const LENGTHS: &[(&str, [f64; 3])] = &[
    ("height", [1.2, 1.70, 2.4]),
    ("head_l", [0.15, 0.26, 0.45]),
    ("neck_w", [0.10, 0.19, 0.32]),
    ("shoulder_w", [0.22, 0.36, 0.62]),
    ("bust", [0.55, 1.0, 1.9]),
    ("vert_bust_line", [0.10, 0.21, 0.40]),
    ("underbust", [0.50, 0.86, 1.8]),
    ("waist", [0.42, 0.84, 2.0]),
    ("waist_line", [0.22, 0.37, 0.60]),
    ("hips", [0.60, 1.03, 2.0]),
    ("hips_line", [0.10, 0.23, 0.40]),
    ("crotch_hip_diff", [0.03, 0.09, 0.22]),
    ("leg_circ", [0.30, 0.60, 1.1]),
    ("arm_length", [0.33, 0.54, 0.85]),
    ("wrist", [0.10, 0.165, 0.28]),
];
const ANGLES: &[(&str, [f64; 3])] = &[
    ("shoulder_incl", [0.05, 0.38, 0.8]),
    ("arm_pose_angle", [0.5, 0.79, 1.2]),
];

impl Request {
    /// Reads a table.
    pub(crate) fn read(table: &Measurements) -> Result<Self, BodyError> {
        let get = |name: &str| read_one(table, name);
        let request = Self {
            height: get("height")?,
            head: get("head_l")?,
            neck_width: get("neck_w")?,
            shoulder_width: get("shoulder_w")?,
            shoulder_slope: get("shoulder_incl")?,
            bust: get("bust")?,
            bust_depth: get("vert_bust_line")?,
            underbust: get("underbust")?,
            waist: get("waist")?,
            waist_line: get("waist_line")?,
            hips: get("hips")?,
            hips_line: get("hips_line")?,
            crotch_drop: get("crotch_hip_diff")?,
            thigh: get("leg_circ")?,
            arm_length: get("arm_length")?,
            arm_angle: get("arm_pose_angle")?,
            wrist: get("wrist")?,
        };
        request.check()
    }

    fn check(self) -> Result<Self, BodyError> {
        let contradiction = |first, second, remedy| BodyError::Contradiction {
            first,
            second,
            remedy,
        };
        let crotch = self.nape() - self.waist_line - self.hips_line - self.crotch_drop;
        if crotch < 0.36 * self.height {
            return Err(contradiction(
                "height",
                "hips_line",
                "height less head_l, waist_line, hips_line and crotch_hip_diff leaves legs shorter \
                 than 0.36 of the height: lessen one of them",
            ));
        }
        if self.bust_depth + 0.05 * self.height > self.waist_line {
            return Err(contradiction(
                "vert_bust_line",
                "waist_line",
                "the bust level must lie above the waist by 0.05 of the height or more: lessen \
                 vert_bust_line",
            ));
        }
        if self.neck_width + 0.06 > self.shoulder_width {
            return Err(contradiction(
                "neck_w",
                "shoulder_w",
                "the shoulders must be at least 0.06 m wider than the neck: lessen neck_w",
            ));
        }
        if self.thigh > 0.8 * self.hips {
            return Err(contradiction(
                "leg_circ",
                "hips",
                "a thigh cannot have over 0.8 of the hip girth: lessen leg_circ",
            ));
        }
        Ok(self)
    }

    /// Height of the base of the neck at the back [m].
    pub(crate) fn nape(&self) -> f64 {
        self.height - self.head
    }

    /// Height of the waist [m].
    pub(crate) fn waist_level(&self) -> f64 {
        self.nape() - self.waist_line
    }

    /// Height of the fullest hip [m].
    pub(crate) fn hip_level(&self) -> f64 {
        self.waist_level() - self.hips_line
    }

    /// Height of the crotch [m].
    pub(crate) fn crotch_level(&self) -> f64 {
        self.hip_level() - self.crotch_drop
    }

    /// Height of the fullest bust [m].
    pub(crate) fn bust_level(&self) -> f64 {
        self.nape() - self.bust_depth
    }
}

fn read_one(table: &Measurements, name: &str) -> Result<f64, BodyError> {
    let find = |rows: &'static [(&'static str, [f64; 3])]| rows.iter().find(|row| row.0 == name);
    let (unit, row) = match find(LENGTHS) {
        Some(row) => ("m", row),
        None => ("rad", find(ANGLES).expect("every name read has its limits")),
    };
    let (name, [low, usual, high]) = *row;
    let Some(value) = table.get(name) else {
        let example = format!("{usual} {unit}");
        return Err(BodyError::Missing { name, example });
    };
    if !(low..=high).contains(&value) {
        return Err(BodyError::OutOfRange {
            name,
            value,
            low,
            high,
            unit,
        });
    }
    Ok(value)
}
