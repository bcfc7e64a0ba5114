//! Names of measurements in other programs.

/// FreeSewing's names (mm), slopes in degrees, with the catalogue's.
pub const FREESEWING: &[(&str, &str)] = &[
    ("ankle", "ankle"),
    ("biceps", "upper_arm"),
    ("bustFront", "front_width"),
    ("bustPointToUnderbust", "bust_to_underbust"),
    ("bustSpan", "bust_points"),
    ("chest", "bust"),
    ("crossSeam", "crotch_length"),
    ("crossSeamFront", "crotch_length_front"),
    ("crotchDepth", "crotch_depth"),
    ("head", "head"),
    ("heel", "heel"),
    ("highBust", "high_bust"),
    ("highBustFront", "high_bust_front"),
    ("hips", "high_hips"),
    ("hpsToBust", "bust_line"),
    ("hpsToWaistBack", "hps_to_waist_back"),
    ("hpsToWaistFront", "hps_to_waist_front"),
    ("inseam", "inside_leg"),
    ("knee", "knee"),
    ("neck", "neck"),
    ("seat", "hips"),
    ("seatBack", "hip_back_width"),
    ("shoulderSlope", "shoulder_incl"),
    ("shoulderToElbow", "shoulder_to_elbow"),
    ("shoulderToShoulder", "shoulder_to_shoulder"),
    ("shoulderToWrist", "arm_length"),
    ("underbust", "underbust"),
    ("upperLeg", "leg_circ"),
    ("waist", "waist"),
    ("waistBack", "waist_back_width"),
    ("waistToArmpit", "waist_to_armpit"),
    ("waistToFloor", "waist_height"),
    ("waistToHips", "waist_to_high_hips"),
    ("waistToKnee", "waist_to_knee"),
    ("waistToSeat", "hips_line"),
    ("waistToUnderbust", "waist_to_underbust"),
    ("waistToUpperLeg", "waist_to_crotch"),
    ("wrist", "wrist"),
];

/// Seamly's and Valentina's names with the catalogue's; what is not here keeps its own name.
pub const SEAMLY: &[(&str, &str)] = &[
    ("across_back_b", "across_back"),
    ("across_chest_f", "across_front"),
    ("arm_shoulder_tip_to_elbow", "shoulder_to_elbow"),
    ("arm_shoulder_tip_to_wrist", "arm_length"),
    ("arm_upper_circ", "upper_arm"),
    ("arm_wrist_circ", "wrist"),
    ("arm_lower_circ", "forearm"),
    ("arm_elbow_circ", "elbow"),
    ("bust_arc_b", "back_width"),
    ("bust_arc_f", "front_width"),
    ("bust_circ", "bust"),
    ("bustpoint_to_bustpoint", "bust_points"),
    ("bustpoint_to_neck_side", "bust_line"),
    ("crotch_length", "crotch_length"),
    ("crotch_length_f", "crotch_length_front"),
    ("foot_length", "foot_length"),
    ("hand_length", "hand_length"),
    ("head_circ", "head"),
    ("head_crown_to_neck_back", "head_l"),
    ("head_length", "head_height"),
    ("height", "height"),
    ("height_armpit", "armpit_height"),
    ("height_bustpoint", "bust_height"),
    ("height_hip", "hip_height"),
    ("height_knee", "knee_height"),
    ("height_neck_back", "nape_height"),
    ("height_shoulder_tip", "shoulder_height"),
    ("height_waist_back", "waist_height"),
    ("height_waist_side", "waist_height"),
    ("height_waist_side_to_hip", "hips_line"),
    ("highbust_arc_f", "high_bust_front"),
    ("highbust_circ", "high_bust"),
    ("highhip_circ", "high_hips"),
    ("hip_arc_b", "hip_back_width"),
    ("hip_circ", "hips"),
    ("leg_ankle_diag_circ", "heel"),
    ("leg_ankle_high_circ", "ankle"),
    ("leg_calf_circ", "calf"),
    ("leg_crotch_to_floor", "inside_leg"),
    ("leg_knee_circ", "knee"),
    ("leg_thigh_upper_circ", "leg_circ"),
    ("leg_waist_side_to_floor", "outside_leg"),
    ("leg_waist_side_to_knee", "waist_to_knee"),
    ("lowbust_circ", "underbust"),
    ("neck_back_to_waist_b", "waist_line"),
    ("neck_circ", "neck_base"),
    ("neck_mid_circ", "neck"),
    ("neck_side_to_waist_b", "hps_to_waist_back"),
    ("neck_side_to_waist_f", "hps_to_waist_front"),
    ("neck_side_to_waist_bustpoint_f", "waist_over_bust_line"),
    ("neck_width", "neck_w"),
    ("rise_length_side_sitting", "crotch_depth"),
    ("shoulder_length", "shoulder_length"),
    ("shoulder_slope_neck_side_angle", "shoulder_incl"),
    ("shoulder_tip_to_shoulder_tip_b", "shoulder_to_shoulder"),
    ("waist_arc_b", "waist_back_width"),
    ("waist_circ", "waist"),
    ("waist_to_highhip_f", "waist_to_high_hips"),
    ("waist_to_hip_f", "hips_line"),
];

/// The catalogue's name in a list of another program's names.
pub fn translated(list: &[(&'static str, &'static str)], name: &str) -> Option<&'static str> {
    list.iter().find(|row| row.0 == name).map(|row| row.1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::definition;
    use std::collections::BTreeSet;

    #[test]
    fn every_name_leads_to_the_catalogue_once() {
        for list in [FREESEWING, SEAMLY] {
            let names: BTreeSet<&str> = list.iter().map(|row| row.0).collect();
            assert_eq!(names.len(), list.len());
            for (_, own) in list {
                assert_eq!(definition(own).map(|known| known.name), Some(*own));
            }
        }
        let own: BTreeSet<&str> = FREESEWING.iter().map(|row| row.1).collect();
        assert_eq!(own.len(), FREESEWING.len());
        assert_eq!(translated(FREESEWING, "chest"), Some("bust"));
        assert_eq!(translated(SEAMLY, "chest"), None);
    }
}
