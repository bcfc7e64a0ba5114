//! The skin in a pose: every vertex goes with up to six joints.

use crate::curve::smooth_step;
use crate::{Joint, Skeleton};
use toile_geometry::Vec3;

/// Weight of each joint that a vertex follows; the weights add up to one.
pub(crate) type Shares = Vec<(Joint, f64)>;

/// The weights of all vertices of the skin.
#[derive(Clone, Debug, Default)]
pub(crate) struct Skinning {
    shares: Vec<Shares>,
}

/// Half the length over which skin passes from one bone to the next at elbows, wrists and neck, as a share of
/// stature.
const SMALL: f64 = 0.026;
/// The same at knees.
const KNEE: f64 = 0.035;
/// The same in the trunk.
const SPINE: f64 = 0.04;

/// A chain of joints, each with its position along the chain and half the length over which skin passes to it
/// from the joint before (m).
struct Chain(Vec<(Joint, f64, f64)>);

impl Chain {
    /// Adds to `into` the weights of a vertex at a position along the chain (m); they add up to `weight`.
    /// Beyond the passage to a joint the vertex follows this joint and no longer those before it.
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
    /// Weights of vertices that all follow the root: for a dress form, which does not bend.
    pub(crate) fn rigid(count: usize) -> Self {
        let shares = vec![vec![(Joint::HumanoidRoot, 1.0)]; count];
        Self { shares }
    }

    /// Weights of the skin at rest of a body of a height (m): along the bones by the position of the vertex
    /// beside them, at shoulders and hips by the shares with which it follows arm and leg.
    pub(crate) fn new(
        (skeleton, height): (&Skeleton, f64),
        skin: &[Vec3],
        [arm, leg]: [&[f64]; 2],
    ) -> Self {
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
        let shares = skin
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
                // The toes follow the instep.
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

    /// Joints and weights of a vertex.
    pub(crate) fn of(&self, vertex: usize) -> &[(Joint, f64)] {
        &self.shares[vertex]
    }
}

/// Weights of a vertex in the median plane: the weight of a left limb is divided between both sides.
fn on_both_sides(shares: &[(Joint, f64)]) -> Shares {
    let half = |&(joint, share): &(Joint, f64)| match joint.mirrored() == joint {
        true => vec![(joint, share)],
        false => vec![(joint, 0.5 * share), (joint.mirrored(), 0.5 * share)],
    };
    shares.iter().flat_map(half).collect()
}
