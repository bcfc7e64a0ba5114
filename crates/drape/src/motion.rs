//! Prescribed rigid motion by keys in time, linear between them.

use nalgebra::Rotation3;
use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;

/// The position of a body at one time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MotionKey {
    /// The time (s), ascending from key to key.
    pub time: f64,
    /// Translation from the position as loaded (m).
    pub translation: Vec3,
    /// Rotation about the pivot: axis times angle (rad), which may exceed a full turn.
    pub rotation: Vec3,
}

/// A rigid motion. Translation and rotation vector are linear between two keys, so the angular velocity is constant
/// where the axis is; before the first key and after the last the body is at rest.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// The centre of rotation, as loaded (m).
    pub pivot: Vec3,
    /// The keys.
    pub keys: Vec<MotionKey>,
}

/// A rigid transformation x -> R x + s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// R.
    pub rotation: Rotation3<f64>,
    /// s (m).
    pub shift: Vec3,
}

impl Pose {
    /// Image of a point (m).
    pub fn apply(&self, point: Vec3) -> Vec3 {
        self.rotation * point + self.shift
    }

    /// The point with a given image (m).
    pub fn undo(&self, image: Vec3) -> Vec3 {
        self.rotation
            .inverse_transform_vector(&(image - self.shift))
    }
}

impl Motion {
    /// The pose at a time (s).
    pub fn pose(&self, time: f64) -> Pose {
        let (translation, rotation_vector) = self.at(time);
        let rotation = Rotation3::from_scaled_axis(rotation_vector);
        Pose {
            rotation,
            shift: self.pivot + translation - rotation * self.pivot,
        }
    }

    /// The translation at a time (s), (m).
    pub fn translation(&self, time: f64) -> Vec3 {
        self.at(time).0
    }

    /// Translation (m) and rotation vector (rad) at a time.
    fn at(&self, time: f64) -> (Vec3, Vec3) {
        let next = self.keys.partition_point(|key| key.time <= time);
        let Some(after) = self.keys.get(next) else {
            return self.keys.last().map_or_else(
                || (Vec3::zeros(), Vec3::zeros()),
                |key| (key.translation, key.rotation),
            );
        };
        let Some(before) = next.checked_sub(1).map(|k| self.keys[k]) else {
            return (after.translation, after.rotation);
        };
        let share = (time - before.time) / (after.time - before.time);
        let between = |a: Vec3, b: Vec3| a + (b - a) * share;
        (
            between(before.translation, after.translation),
            between(before.rotation, after.rotation),
        )
    }

    /// The first defect, in words; none in a valid motion.
    pub fn defect(&self) -> Option<String> {
        if self.keys.is_empty() {
            return Some("it has no key".to_owned());
        }
        let finite = |v: &Vec3| v.iter().all(|x| x.is_finite());
        for (k, key) in self.keys.iter().enumerate() {
            let sound = key.time.is_finite() && finite(&key.translation) && finite(&key.rotation);
            if !sound || !finite(&self.pivot) {
                return Some(format!("key {k} has a number that is not finite"));
            }
            if k > 0 && key.time <= self.keys[k - 1].time {
                return Some(format!("key {k} is not later than the one before"));
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(time: f64, x: f64, turn: f64) -> MotionKey {
        MotionKey {
            time,
            translation: Vec3::new(x, 0.0, 0.0),
            rotation: Vec3::new(0.0, turn, 0.0),
        }
    }

    #[test]
    fn a_body_turns_steadily_about_its_pivot_and_stands_outside_its_keys() {
        let motion = Motion {
            pivot: Vec3::new(1.0, 0.0, 0.0),
            keys: vec![key(1.0, 0.0, 0.0), key(3.0, 2.0, 20.0)],
        };
        let edge = Vec3::new(1.5, 0.0, 0.0);
        assert_eq!(motion.pose(0.0).apply(edge), edge);
        for time in [1.0, 1.7, 2.2, 3.0, 9.0] {
            let share = ((time - 1.0) / 2.0f64).clamp(0.0, 1.0);
            let (sine, cosine) = (20.0 * share).sin_cos();
            let expected = Vec3::new(1.0 + 2.0 * share + 0.5 * cosine, 0.0, -0.5 * sine);
            let pose = motion.pose(time);
            assert!((pose.apply(edge) - expected).norm() < 1e-12, "{time}");
            assert!((pose.undo(pose.apply(edge)) - edge).norm() < 1e-12);
        }
    }

    #[test]
    fn keys_that_go_back_in_time_or_are_no_numbers_are_named() {
        let motion = |keys: Vec<MotionKey>| Motion {
            pivot: Vec3::zeros(),
            keys,
        };
        assert!(motion(vec![key(0.0, 0.0, 0.0)]).defect().is_none());
        for wrong in [
            vec![],
            vec![key(1.0, 0.0, 0.0), key(1.0, 1.0, 0.0)],
            vec![key(f64::NAN, 0.0, 0.0)],
            vec![key(0.0, f64::INFINITY, 0.0)],
        ] {
            assert!(motion(wrong).defect().is_some());
        }
    }
}
