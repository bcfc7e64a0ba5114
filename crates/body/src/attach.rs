//! Primitives fixed to joints.

use crate::deform::Deformation;
use crate::{Joint, JointFrames, Pose, Primitive, Skeleton};
use nalgebra::Rotation3;
use toile_geometry::Vec3;

/// A primitive that moves with a joint, rigidly or also changing with the angle of a reference joint.
#[derive(Clone, Debug, PartialEq)]
pub struct AttachedPrimitive {
    /// The joint that the primitive is fixed to. By default this is the end of a bone: of the bone that the
    /// primitive lies round, the end nearer to the root.
    pub joint: Joint,
    /// The primitive, its centre and rotation in the joint's frame.
    pub local: Primitive,
    /// Change with the angle of a reference joint; `None` for a rigid primitive.
    pub deformation: Option<Deformation>,
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
            deformation: None,
        }
    }

    /// The primitive in the body's frame, in a pose with these joint frames.
    pub fn placed(&self, frames: &JointFrames, pose: &Pose) -> Primitive {
        let local = match &self.deformation {
            Some(deformation) => deformation.at(&self.local, deformation.angle(pose)),
            None => self.local,
        };
        let body_from_joint = frames.body_from_joint(self.joint);
        let centre = body_from_joint * nalgebra::Point3::from(local.centre);
        let turn = body_from_joint.rotation;
        // At rest no joint is turned: the numbers stay exactly the same.
        let rotation = if turn == nalgebra::UnitQuaternion::identity() {
            local.rotation
        } else {
            (Rotation3::from(turn) * local.rotation())
                .scaled_axis()
                .into()
        };
        Primitive {
            centre: centre.coords.into(),
            rotation,
            ..local
        }
    }
}

/// The primitives as they lie in the body's frame in a pose.
pub(crate) fn posed(
    primitives: &[AttachedPrimitive],
    skeleton: &Skeleton,
    pose: &Pose,
) -> Vec<Primitive> {
    let frames = skeleton.frames(pose);
    primitives
        .iter()
        .map(|primitive| primitive.placed(&frames, pose))
        .collect()
}
