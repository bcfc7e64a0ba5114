//! Axes of the parts of a body, and the levels garments hang on.

use crate::levels::Level;
use crate::{Joint, Mannequin, Part};
use toile_geometry::Vec3;

/// The axis of one part of the body.
#[derive(Clone, Debug, PartialEq)]
pub struct PartAxis {
    /// The part.
    pub part: Part,
    /// Points from the root outward: trunk from the crotch to the neck, head from the neck to the
    /// crown, arm from the shoulder joint to the wrist, leg from the hip joint to the ankle (m).
    pub axis: Vec<Vec3>,
}

/// Heights above the floor (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyLevels {
    /// Top of the head.
    pub crown: f64,
    /// Side of the neck.
    pub neck: f64,
    /// Outer end of the shoulder.
    pub shoulder: f64,
    /// Fullest bust or chest.
    pub chest: f64,
    /// Natural waist.
    pub waist: f64,
    /// Fullest hip.
    pub hip: f64,
    /// Crotch.
    pub crotch: f64,
}

impl Mannequin {
    /// The axes of the body's parts, in the order of [`Part::ALL`]: all six; of a dress form only the trunk
    /// and the root of the neck.
    pub fn parts(&self) -> Vec<PartAxis> {
        let l = &self.landmarks;
        let form = self.form();
        let has = |part: &Part| form.is_none() || matches!(part, Part::Trunk | Part::Head);
        let at = |joint: Joint| self.skeleton.centre(joint);
        let limb = |joints: [Joint; 3]| joints.map(at).to_vec();
        let whole = |part: Part| match part {
            Part::Trunk => l.spine.to_vec(),
            Part::Head => vec![l.spine[4], at(Joint::Skullbase), l.crown],
            Part::LeftArm => limb([Joint::LShoulder, Joint::LElbow, Joint::LWrist]),
            Part::RightArm => limb([Joint::RShoulder, Joint::RElbow, Joint::RWrist]),
            Part::LeftLeg => limb([Joint::LHip, Joint::LKnee, Joint::LAnkle]),
            Part::RightLeg => limb([Joint::RHip, Joint::RKnee, Joint::RAnkle]),
        };
        let top = form.map(|form| Vec3::new(0.0, form.top, at(Joint::Skullbase).z));
        (Part::ALL.into_iter().filter(has))
            .map(|part| PartAxis {
                part,
                axis: match (part, top) {
                    (Part::Head, Some(top)) => vec![l.spine[4], top],
                    _ => whole(part),
                },
            })
            .collect()
    }

    /// Heights of the levels that garments hang on.
    pub fn levels(&self) -> BodyLevels {
        let l = &self.landmarks;
        BodyLevels {
            crown: self.form().map_or(l.crown.y, |form| form.top),
            neck: l.neck_sides[0].y,
            shoulder: l.shoulder_tips[0].y,
            chest: self.levels.at(Level::Bust),
            waist: self.levels.at(Level::Waist),
            hip: self.levels.at(Level::Hips),
            crotch: l.crotch.y,
        }
    }
}
