//! The motion from one pose to another, at rest at both ends, slow enough for cloth on the skin to follow.

use crate::{Clip, Joint, Mannequin, Pose};
use toile_geometry::Vec3;

/// Largest speed of the skin of trunk, arms and legs (m/s); hands, feet and head, which carry no garment, may
/// be faster.
const FASTEST_SKIN: f64 = 1.0;
/// Shortest duration of the motion (s).
const SHORTEST: f64 = 0.4;
/// Number of poses per second (1/s).
const RATE: f64 = 240.0;

/// Share of the motion done at a share of its time, with the least jerk: no speed and no acceleration at both
/// ends (Flash and Hogan 1985).
pub(crate) fn least_jerk(share: f64) -> f64 {
    let s = share.clamp(0.0, 1.0);
    s * s * s * (10.0 - 15.0 * s + 6.0 * s * s)
}

impl Clip {
    /// The motion from one pose to another, each joint turning the short way with the least jerk, in 0.4 s,
    /// or longer if otherwise any skin except that of hands, feet and head moved faster than 1 m/s. Shifts of
    /// the root are in leg lengths.
    pub fn lead_in(body: &Mannequin, from: &Pose, to: &Pose) -> Self {
        let skeleton = body.skeleton();
        let skin_at = |share: f64| {
            let mut pose = from.blended(to, share);
            pose.shift *= skeleton.leg_length();
            body.posed_skin(&pose).positions
        };
        let bare = |v: &usize| {
            let at_end = |joint: Joint| {
                joint.follows(Joint::LWrist)
                    || joint.follows(Joint::RWrist)
                    || joint.follows(Joint::LAnkle)
                    || joint.follows(Joint::RAnkle)
                    || joint.follows(Joint::Vc4)
            };
            body.shares(*v).iter().any(|&(joint, _)| at_end(joint))
        };
        let clad: Vec<usize> = (0..body.skin().positions.len())
            .filter(|v| !bare(v))
            .collect();
        // Largest speed of clothed skin per unit of the share of the motion that is done (m).
        const PARTS: usize = 16;
        let mut fastest = 0.0_f64;
        let mut before = skin_at(0.0);
        for part in 1..=PARTS {
            let now = skin_at(part as f64 / PARTS as f64);
            let way = |&v: &usize| (now[v] - before[v]).norm() * PARTS as f64;
            fastest = clad.iter().map(way).fold(fastest, f64::max);
            before = now;
        }
        // The peak speed of a least-jerk motion is 15/8 of its mean speed.
        let duration = (1.875 * fastest / FASTEST_SKIN).max(SHORTEST);
        let count = (duration * RATE).ceil().max(1.0) as usize;
        let between = (1..count).map(|k| from.blended(to, least_jerk(k as f64 / count as f64)));
        let ends = [from, to].map(|end| std::iter::once(end.clone()));
        let [first, last] = ends;
        Self {
            step: 1.0 / RATE,
            poses: first.chain(between).chain(last).collect(),
            is_loop: false,
            advance: Vec3::zeros(),
        }
    }
}
