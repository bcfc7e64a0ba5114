//! Three sample tables, so that the program has someone to dress without any file.
//!
//! Round figures for average adults, lengths to 5 mm and angles to half a degree; ways over the
//! bust, depth of the armholes, inclination of the hips and distance of the buttocks' points follow
//! from the others and stand as our figures of that size have them. The arms are held 45 degrees
//! below the horizontal.

use crate::{Measurements, Origin, UnitKind, definition};

/// Name, then woman, man and either: lengths (mm), angles (half degrees).
const ROWS: &[(&str, [u32; 3])] = &[
    ("height", [1660, 1790, 1720]),
    ("head_l", [255, 275, 265]),
    ("neck_w", [180, 205, 190]),
    ("shoulder_w", [345, 385, 365]),
    ("shoulder_incl", [42, 45, 43]),
    ("armscye_depth", [125, 127, 127]),
    ("bust", [975, 1030, 1000]),
    ("bust_line", [266, 246, 262]),
    ("bust_points", [160, 180, 170]),
    ("vert_bust_line", [210, 215, 210]),
    ("underbust", [805, 930, 860]),
    ("back_width", [460, 505, 475]),
    ("waist", [805, 890, 845]),
    ("waist_line", [360, 385, 370]),
    ("waist_over_bust_line", [423, 417, 424]),
    ("waist_back_width", [380, 405, 390]),
    ("hips", [1040, 1030, 1035]),
    ("hips_line", [225, 245, 235]),
    ("hip_back_width", [555, 540, 550]),
    ("hip_inclination", [20, 12, 15]),
    ("bum_points", [149, 117, 162]),
    ("crotch_hip_diff", [80, 100, 90]),
    ("leg_circ", [605, 600, 600]),
    ("arm_length", [515, 570, 540]),
    ("arm_pose_angle", [90, 90, 90]),
    ("wrist", [160, 175, 165]),
];

impl Measurements {
    /// An average adult woman.
    pub fn adult_woman() -> Self {
        sample(0)
    }

    /// An average adult man.
    pub fn adult_man() -> Self {
        sample(1)
    }

    /// An average adult.
    pub fn adult() -> Self {
        sample(2)
    }
}

fn sample(column: usize) -> Measurements {
    let mut table = Measurements::new();
    for (name, values) in ROWS {
        let kind = definition(name).map_or(UnitKind::Length, |known| known.kind);
        let value = match kind {
            UnitKind::Length => f64::from(values[column]) / 1000.0,
            UnitKind::Angle => (f64::from(values[column]) / 2.0).to_radians(),
        };
        table
            .set(name, value, Origin::Asked)
            .expect("names and values of this file are valid");
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CATALOGUE;

    #[test]
    fn samples_have_the_first_26_measurements_at_bodily_sizes() {
        for table in [
            Measurements::adult_woman(),
            Measurements::adult_man(),
            Measurements::adult(),
        ] {
            assert_eq!(table.len(), 26);
            for known in &CATALOGUE[..26] {
                let value = table.get(known.name).unwrap();
                match known.kind {
                    UnitKind::Length => assert!((0.07..2.0).contains(&value)),
                    UnitKind::Angle => assert!((0.1..0.8).contains(&value)),
                }
            }
            let get = |name| table.get(name).unwrap();
            assert!(get("waist") < get("hips") && get("underbust") < get("bust"));
            assert!(get("back_width") < get("bust") && get("hip_back_width") < get("hips"));
        }
    }
}
