//! The skin in a pose: every vertex goes with up to six joints.

use crate::curve::smooth_step;
use crate::{Joint, JointFrames, Mannequin, Pose};
use nalgebra::{Quaternion, UnitQuaternion};
use rayon::prelude::*;
use toile_geometry::{TriangleMesh, Vec3};

/// How much of a vertex goes with each of some joints; the shares add up to one.
pub(crate) type Shares = Vec<(Joint, f64)>;

/// How the skin hangs on the joints.
#[derive(Clone, Debug, Default)]
pub(crate) struct Skinning {
    shares: Vec<Shares>,
}

/// Half the way over which skin passes from one bone to the next, over stature: at elbows, wrists
/// and ankles, at knees, and in the trunk.
const SMALL: f64 = 0.026;
const KNEE: f64 = 0.035;
const SPINE: f64 = 0.04;

/// A chain of joints with the place of each along it [m] and half the width of its passage [m].
struct Chain(Vec<(Joint, f64, f64)>);

impl Chain {
    /// Shares at a place along the chain: everything beyond a joint's passage goes with it.
    fn shares(&self, place: f64, weight: f64, into: &mut Shares) {
        let mut rest = weight;
        for (k, &(joint, _, _)) in self.0.iter().enumerate() {
            let passed = match self.0.get(k + 1) {
                Some(&(_, at, half)) => smooth_step(0.5 + 0.5 * (place - at) / half),
                None => 0.0,
            };
            let own = rest * (1.0 - passed);
            if own > 0.0 {
                into.push((joint, own));
            }
            rest *= passed;
        }
    }
}

impl Skinning {
    /// Hangs the skin at rest on the joints: along the bones by the place of the vertex beside
    /// them, at shoulders and hips by how far it follows the limb.
    pub(crate) fn new(body: &Mannequin, arm: &[f64], leg: &[f64]) -> Self {
        if body.form().is_some() {
            // A dress form does not bend.
            let rigid = vec![(Joint::HumanoidRoot, 1.0)];
            let shares = vec![rigid; body.skin().positions.len()];
            return Self { shares };
        }
        let skeleton = body.skeleton();
        let height = body.levels().crown;
        let at = |joint: Joint| skeleton.centre(joint);
        let spine = Chain(
            [
                Joint::Sacroiliac,
                Joint::Vl5,
                Joint::Vt6,
                Joint::Vc4,
                Joint::Skullbase,
            ]
            .map(|joint| {
                (
                    joint,
                    at(joint).y,
                    if joint < Joint::Vc4 { SPINE } else { SMALL } * height,
                )
            })
            .into(),
        );
        let shoulder = at(Joint::LShoulder);
        let along = (at(Joint::LWrist) - shoulder).normalize();
        let arms = Chain(
            [Joint::LShoulder, Joint::LElbow, Joint::LWrist]
                .map(|joint| (joint, (at(joint) - shoulder).dot(&along), SMALL * height))
                .into(),
        );
        let legs = Chain(
            [
                (Joint::LHip, KNEE),
                (Joint::LKnee, KNEE),
                (Joint::LAnkle, 0.6 * SMALL),
            ]
            .map(|(joint, half)| (joint, -at(joint).y, half * height))
            .into(),
        );
        let (toe, half) = (at(Joint::LMidtarsal), 0.014 * height);
        let shares = body
            .skin()
            .positions
            .iter()
            .zip(arm.iter().zip(leg))
            .map(|(p, (&arm, &leg))| {
                let right = p.x < 0.0;
                let q = Vec3::new(p.x.abs(), p.y, p.z);
                let mut shares = Shares::new();
                spine.shares(q.y, 1.0 - arm - leg, &mut shares);
                arms.shares((q - shoulder).dot(&along), arm, &mut shares);
                let first = shares.len();
                legs.shares(-q.y, leg, &mut shares);
                // The toes go with the instep.
                let toes = smooth_step(0.5 + 0.5 * (q.z - toe.z) / half);
                let foot = shares[first..]
                    .iter()
                    .position(|share| share.0 == Joint::LAnkle);
                if let Some(k) = foot.filter(|_| toes > 0.0) {
                    let whole = shares[first + k].1;
                    shares[first + k].1 = whole * (1.0 - toes);
                    shares.push((Joint::LMidtarsal, whole * toes));
                }
                shares.retain(|share| share.1 > 0.0);
                if p.x == 0.0 {
                    return on_both_sides(&shares);
                }
                if right {
                    for share in &mut shares {
                        share.0 = share.0.mirrored();
                    }
                }
                shares
            })
            .collect();
        Self { shares }
    }

    /// The joints a vertex goes with.
    pub(crate) fn of(&self, vertex: usize) -> &[(Joint, f64)] {
        &self.shares[vertex]
    }
}

/// Shares of a vertex in the middle: what goes with a left limb goes half with the right one.
fn on_both_sides(shares: &[(Joint, f64)]) -> Shares {
    let half = |&(joint, share): &(Joint, f64)| match joint.mirrored() == joint {
        true => vec![(joint, share)],
        false => vec![(joint, 0.5 * share), (joint.mirrored(), 0.5 * share)],
    };
    shares.iter().flat_map(half).collect()
}

/// A rigid motion as a dual quaternion: the turn, and half the shift times the turn.
#[derive(Clone, Copy)]
struct Dual {
    real: Quaternion<f64>,
    dual: Quaternion<f64>,
}

impl Mannequin {
    /// The joints each vertex of the skin goes with and its shares, which add up to one.
    pub fn shares(&self, vertex: usize) -> &[(Joint, f64)] {
        self.skinning().of(vertex)
    }

    /// The skin in a pose: dual quaternions of the joints blended by each vertex's shares, which
    /// keep a limb's thickness where it bends (Kavan, Collins, Zara, O'Sullivan 2008).
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

    /// How a joint moves what is fixed to it, from rest into a pose.
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

    /// Whether a triangle of the skin lies where skin folds when joints bend, and may touch itself:
    /// within 0.075 of the stature of the crotch or of a hip, knee, shoulder or elbow at rest, or
    /// where the skin passes from the trunk to a limb.
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

/// A place moved by a blend of rigid motions.
fn blended(shares: &[(Joint, f64)], duals: &[Dual; Joint::COUNT], p: Vec3) -> Vec3 {
    let Some(&(first, _)) = shares.iter().max_by(|a, b| a.1.total_cmp(&b.1)) else {
        return p;
    };
    let base = duals[first as usize].real;
    let zero = Quaternion::new(0.0, 0.0, 0.0, 0.0);
    let (mut real, mut dual) = (zero, zero);
    for &(joint, share) in shares {
        let d = duals[joint as usize];
        // Of a turn's two quaternions the one on the same side.
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
