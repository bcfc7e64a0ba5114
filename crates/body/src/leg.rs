//! A leg that reaches for the ground: hip, knee and ankle turned so that the foot stands at a given place.

use crate::{Joint, Pose, Skeleton};
use nalgebra::UnitQuaternion;
use toile_geometry::Vec3;

/// Joints of the left leg from the hip down.
pub(crate) const LEFT_LEG: [Joint; 4] =
    [Joint::LHip, Joint::LKnee, Joint::LAnkle, Joint::LMidtarsal];
/// Joints of the right leg from the hip down.
pub(crate) const RIGHT_LEG: [Joint; 4] =
    [Joint::RHip, Joint::RKnee, Joint::RAnkle, Joint::RMidtarsal];

/// Largest share of its length to which a leg stretches: beyond it the knee would lock and jump.
pub(crate) const REACH: f64 = 0.997;

/// Position of a foot: its ankle (m), and the pitch by which the heel is raised above the toes (rad).
#[derive(Clone, Copy, Debug)]
pub(crate) struct FootPlace {
    pub ankle: Vec3,
    pub pitch: f64,
    /// Angle by which the toes are bent up against the foot (rad).
    pub toes: f64,
}

/// Length from the hip to the ankle of the stretched leg (m).
pub(crate) fn length(skeleton: &Skeleton, leg: [Joint; 4]) -> f64 {
    let [hip, knee, ankle, _] = leg.map(|joint| skeleton.centre(joint));
    (knee - hip).norm() + (ankle - knee).norm()
}

/// Turns the joints of a leg so that its ankle comes to a place, or as near to the place as the leg reaches,
/// with the knee bent forward and the foot pointing straight ahead. The joints above the leg keep their
/// rotations of `pose`.
pub(crate) fn stand(skeleton: &Skeleton, pose: &mut Pose, leg: [Joint; 4], foot: &FootPlace) {
    let [hip, knee, ankle, toes] = leg;
    for joint in leg {
        pose.set(joint, UnitQuaternion::identity());
    }
    let above = skeleton.frames(pose);
    let hip_from_body = above.body_from_joint(hip).inverse();
    let mut to = (hip_from_body * nalgebra::Point3::from(foot.ankle)).coords;
    let (thigh, shank) = (skeleton.offset(knee), skeleton.offset(ankle));
    let most = REACH * (thigh.norm() + shank.norm());
    if to.norm() > most {
        to *= most / to.norm();
    }
    let bend = knee_angle(thigh, shank, to.norm());
    let about = |axis: Vec3, angle: f64| UnitQuaternion::new(axis * angle);
    let reached = thigh + about(Vec3::x(), bend) * shank;
    // First a turn about x that gives the ankle its depth (z), then a sideways turn about z.
    let across = reached.y.hypot(reached.z);
    let swing = (to.z / across).clamp(-1.0, 1.0).asin() - (reached.z / across).asin();
    // The leg points down: a turn forward about x is negative.
    let swung = about(Vec3::x(), -swing) * reached;
    let aside = to.y.atan2(to.x) - swung.y.atan2(swung.x);
    pose.set(hip, about(Vec3::z(), aside) * about(Vec3::x(), -swing));
    pose.set(knee, about(Vec3::x(), bend));
    let frames = skeleton.frames(pose);
    let shank_turn = frames.body_from_joint(knee).rotation;
    pose.set(ankle, shank_turn.inverse() * about(Vec3::x(), foot.pitch));
    pose.set(toes, about(Vec3::x(), -foot.toes));
}

/// Bend of the knee (rad) with which hip and ankle are a distance (m) apart.
fn knee_angle(thigh: Vec3, shank: Vec3, distance: f64) -> f64 {
    // |thigh + R shank|^2 = distance^2 with R a turn about x: p cos + q sin = s.
    let p = 2.0 * (thigh.y * shank.y + thigh.z * shank.z);
    let q = 2.0 * (thigh.z * shank.y - thigh.y * shank.z);
    let s =
        distance * distance - thigh.norm_squared() - shank.norm_squared() - 2.0 * thigh.x * shank.x;
    let size = p.hypot(q);
    let middle = q.atan2(p);
    middle + (s / size).clamp(-1.0, 1.0).acos()
}
