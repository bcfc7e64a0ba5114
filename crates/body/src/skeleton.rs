//! The articulated skeleton: a tree of joints with their frames at rest, posed by a rotation of
//! each joint.
//!
//! # Decided with
//! - [`toile_measure::CATALOGUE`], [`crate::request`], [`crate::shape_from_scales`]: the angle of the arms: a
//!   measurement, with its limits, made part of the shape;
//! - [`crate::hang`]: how far arms hang;
//! - [`crate::posed_skin`], [`crate::skinning`]: the skin in a pose;
//! - [`crate::joint::Joint`], [`crate::bones`]: names of joints; their places;
//! - [`crate::gait`], [`crate::clip::Clip`], [`crate::lead_in`]: clips, blending, the way into a clip;
//! - [`crate::clearing`], [`crate::leg`]: limbs kept apart; feet on the ground;
//! - [`crate::player::Player`]: which clip is played.

use crate::Joint;
use nalgebra::{Translation3, UnitQuaternion};
use toile_geometry::{Rigid, Vec3};

/// The joints of one body in their rest positions. A joint's frame at rest has its origin in the joint and
/// axes parallel to the body's, as in H-Anim; data fixed to a joint are given in that frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Skeleton {
    /// Centres of the joints at rest (m).
    rest: [Vec3; Joint::COUNT],
    /// Steepest angle below the horizontal at which straight arms clear the body (rad).
    hang: f64,
}

/// A rotation of every joint about its own centre, in its own frame. The identity is the rest pose: arms held
/// off at the requested angle, legs apart.
#[derive(Clone, Debug, PartialEq)]
pub struct Pose {
    rotations: [UnitQuaternion<f64>; Joint::COUNT],
    /// Shift of the root from its rest position (m).
    pub shift: Vec3,
}

impl Default for Pose {
    fn default() -> Self {
        Self {
            rotations: [UnitQuaternion::identity(); Joint::COUNT],
            shift: Vec3::zeros(),
        }
    }
}

impl Pose {
    /// The rest pose.
    pub fn rest() -> Self {
        Self::default()
    }

    /// Whether the pose is the rest pose.
    pub fn is_rest(&self) -> bool {
        *self == Self::rest()
    }

    /// The pose with the rotation of one joint replaced.
    #[must_use]
    pub fn with(mut self, joint: Joint, rotation: UnitQuaternion<f64>) -> Self {
        self.rotations[joint as usize] = rotation;
        self
    }

    /// Sets the rotation of one joint.
    pub fn set(&mut self, joint: Joint, rotation: UnitQuaternion<f64>) {
        self.rotations[joint as usize] = rotation;
    }

    /// Rotation of a joint.
    pub fn rotation(&self, joint: Joint) -> UnitQuaternion<f64> {
        self.rotations[joint as usize]
    }
}

/// The frames of all joints in one pose.
#[derive(Clone, Debug, PartialEq)]
pub struct JointFrames {
    body_from_joint: [Rigid; Joint::COUNT],
}

impl JointFrames {
    /// The map from a joint's frame to the body's (m).
    pub fn body_from_joint(&self, joint: Joint) -> &Rigid {
        &self.body_from_joint[joint as usize]
    }

    /// Centre of the joint (m).
    pub fn centre(&self, joint: Joint) -> Vec3 {
        self.body_from_joint[joint as usize].translation.vector
    }
}

impl Skeleton {
    pub(crate) fn new(rest: [Vec3; Joint::COUNT]) -> Self {
        let hang = crate::hang::STEEPEST;
        Self { rest, hang }
    }

    /// The skeleton with the angle at which straight arms hang (rad).
    pub(crate) fn hanging(self, hang: f64) -> Self {
        Self { hang, ..self }
    }

    /// The steepest angle below the horizontal at which straight arms clear the body (rad).
    pub fn hang(&self) -> f64 {
        self.hang
    }

    /// The joints with their rest positions (m), each after its parent.
    pub fn joints(&self) -> impl Iterator<Item = (Joint, Vec3)> + '_ {
        Joint::ALL.into_iter().zip(self.rest)
    }

    /// Centre of a joint at rest (m).
    pub fn centre(&self, joint: Joint) -> Vec3 {
        self.rest[joint as usize]
    }

    /// Vector from the centre of the parent joint to a joint's centre, at rest (m); for the root from the
    /// body's origin.
    pub fn offset(&self, joint: Joint) -> Vec3 {
        let parent = joint.parent().map(|parent| self.centre(parent));
        self.centre(joint) - parent.unwrap_or_default()
    }

    /// Height of the hip joints above the floor (m).
    pub fn leg_length(&self) -> f64 {
        self.centre(Joint::LHip).y
    }

    /// The frames at rest.
    pub fn rest_frames(&self) -> JointFrames {
        JointFrames {
            body_from_joint: self.rest.map(|c| Rigid::translation(c.x, c.y, c.z)),
        }
    }

    /// The frames in a pose, by forward kinematics from the root outward:
    /// `body_from_joint = body_from_parent * translation(offset) * rotation`.
    pub fn frames(&self, pose: &Pose) -> JointFrames {
        let mut frames = self.rest_frames();
        for joint in Joint::ALL {
            let step =
                Rigid::from_parts(Translation3::from(self.offset(joint)), pose.rotation(joint));
            frames.body_from_joint[joint as usize] = match joint.parent() {
                Some(parent) => frames.body_from_joint[parent as usize] * step,
                None => Rigid::from(Translation3::from(pose.shift)) * step,
            };
        }
        frames
    }
}
