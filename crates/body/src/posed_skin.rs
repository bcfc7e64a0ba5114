//! The skin of a body in a pose.

use crate::{Joint, JointFrames, Mannequin, Pose};
use nalgebra::{Quaternion, UnitQuaternion};
use rayon::prelude::*;
use toile_geometry::{TriangleMesh, Vec3};

/// A rigid motion as a dual quaternion: the turn, and half the shift times the turn.
#[derive(Clone, Copy)]
struct Dual {
    real: Quaternion<f64>,
    dual: Quaternion<f64>,
}

impl Mannequin {
    /// The joints that a vertex of the skin follows, with weights that add up to one.
    pub fn shares(&self, vertex: usize) -> &[(Joint, f64)] {
        self.skinning().of(vertex)
    }

    /// The skin in a pose. Dual quaternions of the joints are blended by the weights of each vertex, which
    /// keeps a limb's thickness where it bends (Kavan, Collins, Zara, O'Sullivan 2008).
    pub fn posed_skin(&self, pose: &Pose) -> TriangleMesh {
        let frames = self.skeleton.frames(pose);
        let duals = Joint::ALL.map(|joint| self.motion_of(&frames, joint));
        let (rest, skinning) = (self.skin(), self.skinning());
        let mut positions = rest.positions.clone();
        positions
            .par_iter_mut()
            .with_min_len(1024)
            .enumerate()
            .for_each(|(v, p)| {
                *p = blended(skinning.of(v), &duals, *p);
            });
        TriangleMesh {
            positions,
            triangles: rest.triangles.clone(),
        }
    }

    /// The motion of a joint from rest into a pose.
    fn motion_of(&self, frames: &JointFrames, joint: Joint) -> Dual {
        let frame = frames.body_from_joint(joint);
        let turn = frame.rotation;
        let shift = frame.translation.vector - turn * self.skeleton.centre(joint);
        let real = *turn.quaternion();
        Dual {
            real,
            dual: Quaternion::from_imag(shift) * real * 0.5,
        }
    }

    /// Whether a triangle of the skin lies where skin folds when joints bend, and may touch itself: within
    /// 0.075 of the stature of the crotch or of a hip, knee, shoulder or elbow at rest, or where the skin
    /// passes from the trunk to a limb.
    pub fn is_crease(&self, triangle: usize) -> bool {
        const NEAR: f64 = 0.075;
        use Joint::{LElbow, LHip, LKnee, LShoulder, RElbow, RHip, RKnee, RShoulder};
        let reach = NEAR * self.levels().crown;
        let folding = [
            LHip, LKnee, LShoulder, LElbow, RHip, RKnee, RShoulder, RElbow,
        ];
        let limb = |joint: Joint| joint.mirrored() != joint;
        self.skin().triangles[triangle].iter().any(|&v| {
            let p = self.skin().positions[v as usize];
            let near = |joint: &Joint| (self.skeleton.centre(*joint) - p).norm() < reach;
            let on_limbs: f64 = self
                .skinning()
                .of(v as usize)
                .iter()
                .filter(|s| limb(s.0))
                .map(|s| s.1)
                .sum();
            let groin = (self.landmarks.crotch - p).norm() < reach;
            groin || folding.iter().any(near) || (0.03..0.97).contains(&on_limbs)
        })
    }
}

/// A point moved by a blend of rigid motions.
fn blended(shares: &[(Joint, f64)], duals: &[Dual; Joint::COUNT], p: Vec3) -> Vec3 {
    let Some(&(first, _)) = shares.iter().max_by(|a, b| a.1.total_cmp(&b.1)) else {
        return p;
    };
    let base = duals[first as usize].real;
    let zero = Quaternion::new(0.0, 0.0, 0.0, 0.0);
    let (mut real, mut dual) = (zero, zero);
    for &(joint, share) in shares {
        let d = duals[joint as usize];
        // Of the two quaternions of a turn, the one in the hemisphere of `base`.
        let share = if d.real.dot(&base) < 0.0 {
            -share
        } else {
            share
        };
        real += d.real * share;
        dual += d.dual * share;
    }
    let length = real.norm();
    let turn = UnitQuaternion::new_unchecked(real / length);
    let shift = (dual / length) * turn.quaternion().conjugate() * 2.0;
    turn * p + shift.imag()
}
