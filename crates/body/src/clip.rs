//! Clips: poses over time, as frames of a motion or one round of a loop, and what lies between two poses.

use crate::{Joint, Pose, Skeleton};
use nalgebra::UnitQuaternion;
use toile_geometry::Vec3;

/// Poses at even time steps. Distances of the root are in leg lengths (hip to floor), so that a motion fits
/// every size.
#[derive(Clone, Debug, PartialEq)]
pub struct Clip {
    /// Time from one pose to the next (s).
    pub step: f64,
    /// The poses; the shift of the root is divided by the leg length (1).
    pub poses: Vec<Pose>,
    /// Whether the first pose follows the last one.
    pub is_loop: bool,
    /// Distance over the ground in one round of a loop on the spot, divided by the leg length (1): when the
    /// figure is moved by this distance, the standing foot stands still. Zero if the poses themselves move
    /// the root.
    pub advance: Vec3,
}

impl Clip {
    /// Duration (s); of a loop including the step back to the first pose.
    pub fn duration(&self) -> f64 {
        let gaps = match self.is_loop {
            true => self.poses.len(),
            false => self.poses.len().saturating_sub(1),
        };
        self.step * gaps as f64
    }

    /// The pose at a time (s), slerped between frames. Before the start of a clip that is no loop it is the
    /// first pose, after the end the last. The shift of the root is divided by the leg length.
    pub fn at(&self, time: f64) -> Pose {
        let count = self.poses.len();
        if count == 0 || !time.is_finite() || self.step <= 0.0 {
            return self.poses.first().cloned().unwrap_or_default();
        }
        let frame = time / self.step;
        let (low, share) = match self.is_loop {
            true => (
                frame.floor().rem_euclid(count as f64),
                frame - frame.floor(),
            ),
            false => {
                let held = frame.clamp(0.0, (count - 1) as f64);
                (held.floor(), held - held.floor())
            }
        };
        let low = (low as usize).min(count - 1);
        let high = match self.is_loop {
            true => (low + 1) % count,
            false => (low + 1).min(count - 1),
        };
        self.poses[low].blended(&self.poses[high], share)
    }

    /// Distance over the ground from the start of a loop to a time (s), divided by the leg length (1).
    pub fn travelled(&self, time: f64) -> Vec3 {
        match self.duration() {
            duration if duration > 0.0 => self.advance * (time / duration),
            _ => Vec3::zeros(),
        }
    }

    /// The pose of a skeleton at a time (s), with the root's position in metres.
    pub fn pose_for(&self, skeleton: &Skeleton, time: f64) -> Pose {
        let mut pose = self.at(time);
        pose.shift *= skeleton.leg_length();
        pose
    }

    /// A loop between this one (`share` 0) and `other` (`share` 1), taken at the same share of their rounds.
    /// The loops must have matched phases, such as those of [`Clip::walk`] and [`Clip::run`]; durations are
    /// interpolated too.
    pub fn between(&self, other: &Self, share: f64) -> Self {
        let share = share.clamp(0.0, 1.0);
        let count = self.poses.len().max(other.poses.len()).max(1);
        let duration = self.duration() + (other.duration() - self.duration()) * share;
        let poses = (0..count)
            .map(|k| {
                let phase = k as f64 / count as f64;
                let [a, b] = [self, other].map(|m| m.at(phase * m.duration()));
                a.blended(&b, share)
            })
            .collect();
        Self {
            step: duration / count as f64,
            poses,
            is_loop: self.is_loop && other.is_loop,
            advance: self.advance + (other.advance - self.advance) * share,
        }
    }
}

impl Pose {
    /// The pose between this one (`share` 0) and `other` (`share` 1) by linear blending: each joint's
    /// rotation vector is evenly mixed, as between frames and animations in Rudomin et al. (2002). Joints
    /// turn neither evenly nor the short way; only for comparison with [`Pose::blended`].
    #[must_use]
    pub fn blended_linearly(&self, other: &Self, share: f64) -> Self {
        let mut pose = Self::rest();
        for joint in Joint::ALL {
            let [a, b] = [self, other].map(|pose| pose.rotation(joint).scaled_axis());
            pose.set(joint, UnitQuaternion::new(a + (b - a) * share));
        }
        pose.shift = self.shift + (other.shift - self.shift) * share;
        pose
    }

    /// The pose between this one (`share` 0) and `other` (`share` 1): each joint turns the short way round
    /// (Shoemake 1985), the root moves evenly.
    #[must_use]
    pub fn blended(&self, other: &Self, share: f64) -> Self {
        let mut pose = Self::rest();
        for joint in Joint::ALL {
            let (a, b) = (self.rotation(joint), other.rotation(joint));
            let turn = a
                .try_slerp(&b, share, 1e-12)
                .unwrap_or(if share < 0.5 { a } else { b });
            pose.set(joint, turn);
        }
        pose.shift = self.shift + (other.shift - self.shift) * share;
        pose
    }
}
