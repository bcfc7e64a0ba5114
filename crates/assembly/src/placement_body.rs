//! The body as needed for placement: surface, axes of its parts, heights.

use toile_geometry::{SurfaceTree, Vec3};
use toile_pattern::BodyPart;

/// The body a garment is placed on. This crate is independent of the body crate: the session fills this in
/// from a mannequin or from any closed mesh.
pub struct PlacementBody<'a> {
    /// The closed surface of the skin, with outward normals.
    pub skin: &'a SurfaceTree,
    /// Axes of the parts that the body has, in the order of [`BodyPart`]: a dress form has trunk and neck.
    pub limbs: Vec<Limb>,
    /// Heights of landmarks above the floor (m).
    pub levels: Levels,
}

impl PlacementBody<'_> {
    /// Whether the body has a part.
    pub(crate) fn has(&self, part: BodyPart) -> bool {
        self.limbs.iter().any(|limb| limb.part == part)
    }
}

/// Name of a body part in a sentence.
pub(crate) fn part_words(part: BodyPart) -> &'static str {
    match part {
        BodyPart::Trunk => "the trunk",
        BodyPart::Head => "the head",
        BodyPart::LeftArm => "the left arm",
        BodyPart::RightArm => "the right arm",
        BodyPart::LeftLeg => "the left leg",
        BodyPart::RightLeg => "the right leg",
    }
}

/// The axis of one body part.
#[derive(Clone, Debug)]
pub struct Limb {
    /// The body part.
    pub part: BodyPart,
    /// Points of the axis from the root outward (m): trunk from the crotch up to the neck, head from the neck
    /// up, arm from the shoulder joint to the wrist, leg from the hip joint to the ankle.
    pub axis: Vec<Vec3>,
}

/// Heights above the floor at which garments hang (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Levels {
    /// Crown of the head.
    pub crown: f64,
    /// Base of the neck at the side, where a collar or shoulder seam starts.
    pub neck: f64,
    /// Outer end of the shoulder.
    pub shoulder: f64,
    /// Fullest chest or bust.
    pub chest: f64,
    /// Natural waist.
    pub waist: f64,
    /// Fullest hip.
    pub hip: f64,
    /// Crotch.
    pub crotch: f64,
}
