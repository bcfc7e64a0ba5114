//! The catalogue: name, meaning and procedure of each measurement.
//!
//! # Decided with
//! - [`crate::further::FURTHER`]: measurements that no body is made by;
//! - [`crate::predict::Build`], [`crate::predict`] (`TRUNK_LENGTHS`, `GIRTH_LIKE`): a guess where one is
//!   missing;
//! - [`crate::children`] (`ROWS`, `GIRTHS`): the same for children;
//! - [`crate::samples`] (`ROWS`), [`crate::survey::NAMES`]: sample bodies; means and correlations of adults;
//! - [`crate::foreign::FREESEWING`], [`crate::foreign::SEAMLY`]: names in other programs;
//! - [`crate::table::Origin`]: whether a value was asked for or predicted.
//!
//! By hand: a new measurement stands in each of these lists that it belongs to; further in crates `body`
//! (`measured.rs`, `scan_girths.rs`, `request.rs`), `interchange` (`measurements_garmentcode.rs`, degrees)
//! and in the window (`tables.rs`, new sizes).

use crate::further::FURTHER;
use crate::measurement::{Definition, UnitKind, angle, length};

/// The measurement of that name or alias, if the catalogue knows it.
pub fn definition(name: &str) -> Option<&'static Definition> {
    let all = || CATALOGUE.iter().chain(FURTHER);
    all()
        .find(|known| known.name == name)
        .or_else(|| all().find(|known| known.aliases.contains(&name)))
}

/// Whether a name or alias is that of an angle; names that the catalogue does not know are lengths.
pub fn is_angle(name: &str) -> bool {
    definition(name).is_some_and(|known| known.kind == UnitKind::Angle)
}

/// Every measurement the program knows, from the head down. The first 26 are those of
/// GarmentCode's body tables, under the same names.
pub const CATALOGUE: &[Definition] = &[
    length(
        "height",
        "Height",
        "Vertical distance from the floor to the crown, standing upright without shoes.",
        &["stature", "body_height"],
    ),
    length(
        "head_l",
        "Head and neck length",
        "Vertical distance from the crown down to the base of the neck at the back.",
        &["head_length"],
    ),
    length(
        "neck_w",
        "Neck width",
        "Straight distance between the points where the neck meets the shoulders, left to right.",
        &["neck_width"],
    ),
    length(
        "shoulder_w",
        "Shoulder width",
        "Straight distance between the outer ends of the shoulders, left to right.",
        &["shoulder_width", "biacromial_breadth"],
    ),
    angle(
        "shoulder_incl",
        "Shoulder slope",
        "Angle below the horizontal at which the shoulder falls from neck to shoulder end.",
        &["shoulder_slope", "shoulder_inclination"],
    ),
    length(
        "armscye_depth",
        "Armhole depth",
        "Vertical distance from the end of the shoulder down to the level of the armpit.",
        &["armhole_depth", "scye_depth_from_shoulder"],
    ),
    length(
        "bust",
        "Bust or chest girth",
        "Largest horizontal girth of the chest under the arms.",
        &[
            "chest",
            "bust_circ",
            "chest_circ",
            "bust_girth",
            "chest_girth",
        ],
    ),
    length(
        "bust_line",
        "Neck to bust point",
        "Distance over the body from the side of the neck down to the bust point.",
        &["neck_to_bust_point", "hps_to_bust_front"],
    ),
    length(
        "bust_points",
        "Bust point distance",
        "Straight distance between the two bust points.",
        &["bust_span", "bust_point_to_bust_point"],
    ),
    length(
        "vert_bust_line",
        "Bust depth below the neck",
        "Vertical distance from the side of the neck down to the level of the bust points.",
        &["bust_depth"],
    ),
    length(
        "underbust",
        "Under-bust girth",
        "Horizontal girth just below the breasts, or below the chest muscle.",
        &["under_bust", "underbust_girth", "high_waist_girth"],
    ),
    length(
        "back_width",
        "Back part of the bust girth",
        "The part of the bust girth that lies behind the side lines, side to side over the back.",
        &["bust_arc_b"],
    ),
    length(
        "waist",
        "Waist girth",
        "Smallest horizontal girth between hips and ribs: the natural waist.",
        &["waist_circ", "waist_girth", "natural_waist"],
    ),
    length(
        "waist_line",
        "Neck to waist, back",
        "Distance down the back from the base of the neck to the waist.",
        &["back_waist_length", "neck_to_waist_back"],
    ),
    length(
        "waist_over_bust_line",
        "Neck to waist over the bust",
        "Distance over the body from the side of the neck, over the bust point, to the waist.",
        &["front_waist_length"],
    ),
    length(
        "waist_back_width",
        "Back part of the waist girth",
        "The part of the waist girth that lies behind the side lines, side to side over the back.",
        &["waist_arc_b"],
    ),
    length(
        "hips",
        "Hip girth",
        "Largest horizontal girth between waist and crotch.",
        &["hip", "hip_circ", "hip_girth", "seat", "seat_circ"],
    ),
    length(
        "hips_line",
        "Waist to hips",
        "Vertical distance from the waist down to the fullest part of the buttocks.",
        &["waist_to_hips", "waist_to_seat"],
    ),
    length(
        "hip_back_width",
        "Back part of the hip girth",
        "The part of the hip girth that lies behind the side lines, side to side over the back.",
        &["hip_arc_b"],
    ),
    angle(
        "hip_inclination",
        "Hip slope",
        "Angle from the vertical at which the side of the body opens from the waist to the hips.",
        &["hip_slope"],
    ),
    length(
        "bum_points",
        "Buttock point distance",
        "Straight distance between the most prominent points of the two buttocks.",
        &["buttock_span"],
    ),
    length(
        "crotch_hip_diff",
        "Hips to crotch",
        "Vertical distance from the fullest part of the buttocks down to the crotch.",
        &["hips_to_crotch"],
    ),
    length(
        "leg_circ",
        "Thigh girth",
        "Horizontal girth of one leg just below the crotch.",
        &["thigh", "thigh_circ", "thigh_girth", "upper_leg"],
    ),
    length(
        "arm_length",
        "Arm length",
        "Distance from the end of the shoulder to the wrist bone, the arm hanging almost straight.",
        &["shoulder_to_wrist", "sleeve_length"],
    ),
    angle(
        "arm_pose_angle",
        "Arm pose",
        "Angle below the horizontal at which the arms are held while the body is dressed.",
        &["arm_angle"],
    ),
    length(
        "wrist",
        "Wrist girth",
        "Smallest girth of the arm above the hand, over the wrist bone.",
        &["wrist_circ", "wrist_girth"],
    ),
    length(
        "neck",
        "Neck girth",
        "Smallest girth of the neck below the larynx, square to its axis.",
        &["neck_circ", "neck_girth", "neck_mid_girth"],
    ),
    length(
        "neck_base",
        "Neck base girth",
        "Girth round the root of the neck, through its side points and the hollow in front.",
        &["neck_base_girth"],
    ),
    length(
        "head",
        "Head girth",
        "Largest horizontal girth of the head above the ears.",
        &["head_circ", "head_girth"],
    ),
    length(
        "shoulder_length",
        "Shoulder length",
        "Distance over the shoulder from the side of the neck to the end of the shoulder.",
        &["shoulder_to_shoulder_neck"],
    ),
    length(
        "across_back",
        "Across back",
        "Distance over the back between the rear armpit folds.",
        &["across_back_width", "back_breadth"],
    ),
    length(
        "across_front",
        "Across front",
        "Distance over the chest between the front armpit folds.",
        &["across_chest", "across_front_width"],
    ),
    length(
        "upper_arm",
        "Upper arm girth",
        "Largest girth of the upper arm, square to its axis, the muscle relaxed.",
        &["biceps", "bicep", "upper_arm_circ", "upper_arm_girth"],
    ),
    length(
        "elbow",
        "Elbow girth",
        "Girth over the elbow, the arm bent at a right angle.",
        &["elbow_circ", "elbow_girth"],
    ),
    length(
        "inside_leg",
        "Inside leg",
        "Vertical distance from the crotch to the floor.",
        &["inseam", "inside_leg_height", "crotch_height"],
    ),
    length(
        "outside_leg",
        "Outside leg",
        "Distance from the waist at the side, over the hip, straight down to the floor.",
        &["outseam", "waist_to_floor"],
    ),
    length(
        "crotch_length",
        "Crotch length",
        "Distance from the front of the waist between the legs to the back of the waist.",
        &["total_crotch_length", "cross_seam"],
    ),
    length(
        "knee",
        "Knee girth",
        "Horizontal girth over the middle of the kneecap.",
        &["knee_circ", "knee_girth"],
    ),
    length(
        "calf",
        "Calf girth",
        "Largest horizontal girth of the lower leg.",
        &["calf_circ", "calf_girth"],
    ),
    length(
        "ankle",
        "Ankle girth",
        "Smallest girth of the leg above the ankle bones.",
        &["ankle_circ", "ankle_girth"],
    ),
];

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn names_and_aliases_are_unique_and_snake_case() {
        let mut seen = BTreeSet::new();
        for known in CATALOGUE.iter().chain(FURTHER) {
            for name in std::iter::once(&known.name).chain(known.aliases) {
                assert!(seen.insert(*name), "{name} is in the catalogue twice");
                assert!(name.chars().all(|c| c.is_ascii_lowercase() || c == '_'));
                assert_eq!(definition(name), Some(known));
            }
            assert!(known.meaning.ends_with('.'));
        }
        assert_eq!(definition("elephant"), None);
    }
}
