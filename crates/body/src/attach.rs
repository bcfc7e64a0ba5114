//! Primitives fixed to joints.

use crate::{Joint, Pose, Primitive, Skeleton};
use nalgebra::Rotation3;
use toile_geometry::{Rigid, Vec3};

/// A primitive that moves rigidly with a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttachedPrimitive {
    /// The joint it is fixed to: the nearer end, seen from the root, of the bone it lies round.
    pub joint: Joint,
    /// The primitive, its centre and rotation in the joint's frame.
    pub local: Primitive,
}

impl AttachedPrimitive {
    /// Fixes a primitive, given in the body's frame at rest, to a joint of a skeleton.
    pub(crate) fn new(joint: Joint, primitive: &Primitive, skeleton: &Skeleton) -> Self {
        let centre = Vec3::from(primitive.centre) - skeleton.centre(joint);
        Self {
            joint,
            local: Primitive {
                centre: centre.into(),
                ..*primitive
            },
        }
    }

    /// The primitive in the body's frame, where its joint's frame is given.
    pub fn placed(&self, body_from_joint: &Rigid) -> Primitive {
        let centre = body_from_joint * nalgebra::Point3::from(self.local.centre);
        let turn = body_from_joint.rotation;
        // At rest nothing is turned: the very numbers stay.
        let rotation = if turn == nalgebra::UnitQuaternion::identity() {
            self.local.rotation
        } else {
            (Rotation3::from(turn) * self.local.rotation())
                .scaled_axis()
                .into()
        };
        Primitive {
            centre: centre.coords.into(),
            rotation,
            ..self.local
        }
    }
}

/// Primitives in the body's frame in a pose.
pub(crate) fn posed(
    primitives: &[AttachedPrimitive],
    skeleton: &Skeleton,
    pose: &Pose,
) -> Vec<Primitive> {
    let frames = skeleton.frames(pose);
    primitives
        .iter()
        .map(|primitive| primitive.placed(frames.body_from_joint(primitive.joint)))
        .collect()
}
