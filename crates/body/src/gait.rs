//! Our own clips: walk and run by the waves of their joint angles, and two standing poses.

use crate::{Clip, Joint, Pose, Skeleton};
use nalgebra::UnitQuaternion;
use std::f64::consts::TAU;
use toile_geometry::Vec3;

impl Clip {
    /// A walk of our own: one stride of 1.1 s, on the spot; the left heel strikes at phase 0.
    pub fn walk(skeleton: &Skeleton) -> Self {
        Self::cycle(skeleton, &WALK)
    }

    /// A run of our own: one stride of 0.72 s, on the spot, the phase as of [`Clip::walk`].
    pub fn run(skeleton: &Skeleton) -> Self {
        Self::cycle(skeleton, &RUN)
    }

    fn cycle(skeleton: &Skeleton, gait: &Gait) -> Self {
        const FRAMES: usize = 32;
        Self {
            step: gait.duration / FRAMES as f64,
            poses: (0..FRAMES)
                .map(|k| gait.pose(skeleton, k as f64 / FRAMES as f64))
                .collect(),
            is_loop: true,
        }
    }
}

/// A wave over a stride: mean, then cosine and sine of once and twice round [rad].
type Wave = [f64; 5];

/// A gait by the waves of its angles; the right side is half a stride later.
struct Gait {
    duration: f64,
    /// Flexion forward of hip and of knee, ankle upward, elbow; shoulder forward.
    hip: Wave,
    knee: Wave,
    ankle: Wave,
    elbow: Wave,
    shoulder: Wave,
    /// Turn of pelvis against chest, lean forward [rad], rise of the root over the leg [1].
    twist: f64,
    lean: f64,
    bounce: Wave,
}

/// Hip, knee and ankle follow the usual courses of level walking (Winter 1991), as two harmonics.
const WALK: Gait = Gait {
    duration: 1.1,
    hip: [0.12, 0.36, -0.08, 0.0, 0.04],
    knee: [0.36, -0.02, -0.34, -0.24, 0.16],
    ankle: [0.0, -0.02, 0.12, 0.06, -0.06],
    elbow: [0.30, -0.12, 0.0, 0.0, 0.0],
    shoulder: [0.02, -0.30, 0.0, 0.0, 0.0],
    twist: 0.07,
    lean: 0.03,
    bounce: [-0.02, 0.0, 0.0, -0.016, 0.0],
};

const RUN: Gait = Gait {
    duration: 0.72,
    hip: [0.30, 0.52, -0.16, 0.0, 0.06],
    knee: [0.74, -0.18, -0.56, -0.15, 0.10],
    ankle: [0.0, 0.04, 0.20, 0.10, -0.04],
    elbow: [1.15, -0.16, 0.0, 0.0, 0.0],
    shoulder: [-0.05, -0.48, 0.0, 0.0, 0.0],
    twist: 0.12,
    lean: 0.12,
    bounce: [-0.01, 0.0, 0.0, 0.0, 0.035],
};

fn wave(w: &Wave, phase: f64) -> f64 {
    let [once, twice] = [TAU * phase, 2.0 * TAU * phase];
    w[0] + w[1] * once.cos() + w[2] * once.sin() + w[3] * twice.cos() + w[4] * twice.sin()
}

impl Gait {
    fn pose(&self, skeleton: &Skeleton, phase: f64) -> Pose {
        let about = |axis: Vec3, angle: f64| UnitQuaternion::new(axis * angle);
        let mut pose = Pose::rest();
        let twist = self.twist * (TAU * phase).cos();
        pose.set(Joint::Sacroiliac, about(Vec3::y(), -twist));
        pose.set(
            Joint::Vl5,
            about(Vec3::y(), 2.0 * twist) * about(Vec3::x(), self.lean),
        );
        pose.set(
            Joint::Vc4,
            about(Vec3::y(), -twist) * about(Vec3::x(), -self.lean),
        );
        let sides = [
            [
                Joint::LHip,
                Joint::LKnee,
                Joint::LAnkle,
                Joint::LShoulder,
                Joint::LElbow,
            ],
            [
                Joint::RHip,
                Joint::RKnee,
                Joint::RAnkle,
                Joint::RShoulder,
                Joint::RElbow,
            ],
        ];
        for (side, [hip, knee, ankle, shoulder, elbow]) in sides.into_iter().enumerate() {
            let sign = if side == 0 { 1.0 } else { -1.0 };
            let phase = phase + 0.5 * side as f64;
            // Legs are brought under the body from where they stand apart at rest.
            let foot = skeleton.centre(ankle) - skeleton.centre(hip);
            let apart = (foot.x * sign / foot.y.abs()).atan();
            let closer = about(Vec3::z(), -0.35 * sign * apart);
            pose.set(hip, about(Vec3::x(), -wave(&self.hip, phase)) * closer);
            pose.set(knee, about(Vec3::x(), wave(&self.knee, phase).max(0.0)));
            pose.set(ankle, about(Vec3::x(), -wave(&self.ankle, phase)));
            // Arms hang from where they are held off at rest, but not against the trunk.
            let arm = skeleton.centre(elbow) - skeleton.centre(shoulder);
            let down = (-arm.y).atan2(arm.x * sign);
            let hang = about(Vec3::z(), -sign * (skeleton.hang() - down).max(0.0));
            pose.set(
                shoulder,
                about(Vec3::x(), -wave(&self.shoulder, phase)) * hang,
            );
            // The elbow bends about the axis across the hanging arm, as it lies in the arm at rest.
            let across = hang.inverse() * Vec3::x();
            pose.set(elbow, about(across, -wave(&self.elbow, phase).max(0.0)));
        }
        pose.shift = Vec3::new(0.0, wave(&self.bounce, phase), 0.0);
        pose
    }
}
