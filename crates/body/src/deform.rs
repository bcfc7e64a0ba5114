//! Primitives that change with a joint: "deformable" ones of Volino, Magnenat-Thalmann, Shen and
//! Thalmann (1996), whose axis lengths, centre and orientation go with one joint's angle.

use crate::{BodyError, Joint, Pose, Primitive};
use nalgebra::{Rotation3, UnitQuaternion};
use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;

/// Change of a primitive with the angle of its reference joint: linear between keys, held before the first
/// and after the last; turns are slerped (Shoemake 1985).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Deformation {
    /// The reference joint.
    pub joint: Joint,
    /// Axis of the angle, in the joint's frame: only the twist about it counts (1).
    pub axis: [f64; 3],
    /// Keys in ascending order of angle. At the angle zero, the rest pose, they must leave the primitive
    /// unchanged.
    pub keys: Vec<DeformationKey>,
}

/// Changes of a primitive at one angle of its reference joint.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeformationKey {
    /// The joint's angle (rad).
    pub angle: f64,
    /// Shift of the centre, in the frame of the joint that the primitive is fixed to (m).
    #[serde(default)]
    pub shift: [f64; 3],
    /// Semi-axes divided by those at rest (1).
    #[serde(default = "as_they_are")]
    pub stretch: [f64; 3],
    /// Turn relative to the rest pose, as axis times angle (rad).
    #[serde(default)]
    pub turn: [f64; 3],
}

fn as_they_are() -> [f64; 3] {
    [1.0; 3]
}

/// Largest number of keys of a deformation: more than any joint's range needs.
const MAX_KEYS: usize = 16;

impl Deformation {
    /// Angle of the reference joint in a pose: its twist about the axis, from -pi to pi (rad).
    pub fn angle(&self, pose: &Pose) -> f64 {
        let turn = pose.rotation(self.joint);
        let about = turn.imag().dot(&self.unit_axis());
        // q and -q are the same turn.
        let sign = if turn.w < 0.0 { -1.0 } else { 1.0 };
        2.0 * (sign * about).atan2(sign * turn.w)
    }

    fn unit_axis(&self) -> Vec3 {
        Vec3::from(self.axis)
            .try_normalize(1e-12)
            .unwrap_or_default()
    }

    /// A primitive as it is changed at an angle of the reference joint (rad).
    pub fn at(&self, primitive: &Primitive, angle: f64) -> Primitive {
        let (shift, stretch, turn) = self.between(angle);
        let rotation = match turn == UnitQuaternion::identity() {
            true => primitive.rotation,
            false => (Rotation3::from(turn) * primitive.rotation())
                .scaled_axis()
                .into(),
        };
        Primitive {
            centre: std::array::from_fn(|k| primitive.centre[k] + shift[k]),
            radii: std::array::from_fn(|k| primitive.radii[k] * stretch[k]),
            rotation,
            ..*primitive
        }
    }

    fn between(&self, angle: f64) -> ([f64; 3], [f64; 3], UnitQuaternion<f64>) {
        let turn = |key: &DeformationKey| UnitQuaternion::new(Vec3::from(key.turn));
        let count = self.keys.len();
        if count == 0 {
            return ([0.0; 3], [1.0; 3], UnitQuaternion::identity());
        }
        let next = self.keys.partition_point(|key| key.angle <= angle);
        if next == 0 || next == count {
            let key = &self.keys[next.min(count - 1)];
            return (key.shift, key.stretch, turn(key));
        }
        let [a, b] = [&self.keys[next - 1], &self.keys[next]];
        let share = (angle - a.angle) / (b.angle - a.angle);
        let mix = |u: [f64; 3], v: [f64; 3]| std::array::from_fn(|k| u[k] + (v[k] - u[k]) * share);
        let (from, to) = (turn(a), turn(b));
        (
            mix(a.shift, b.shift),
            mix(a.stretch, b.stretch),
            from.try_slerp(&to, share, 1e-12).unwrap_or(from),
        )
    }

    /// The deformation of the mirrored primitive.
    pub fn mirrored(&self) -> Self {
        let [a, b, c] = self.axis;
        Self {
            joint: self.joint.mirrored(),
            axis: [a, -b, -c],
            keys: self
                .keys
                .iter()
                .map(|key| {
                    let ([x, y, z], [u, v, w]) = (key.shift, key.turn);
                    DeformationKey {
                        shift: [-x, y, z],
                        turn: [u, -v, -w],
                        ..*key
                    }
                })
                .collect(),
        }
    }

    /// Refuses values that make no sense.
    pub(crate) fn check(&self) -> Result<(), BodyError> {
        let bad = |what: &str| Err(BodyError::Description(format!("a deformation {what}")));
        if self.unit_axis() == Vec3::zeros() || !self.axis.iter().all(|x| x.is_finite()) {
            return bad("has an axis of no direction: give one, as in [1, 0, 0]");
        }
        if self.keys.is_empty() || self.keys.len() > MAX_KEYS {
            return bad("has no keys or more than 16: give some");
        }
        let numbers = |k: &DeformationKey| [k.shift, k.turn].concat();
        let sound = |k: &DeformationKey| {
            k.angle.abs() <= std::f64::consts::PI
                && numbers(k).iter().all(|x| x.abs() < 10.0)
                && k.stretch.iter().all(|x| (0.05..=20.0).contains(x))
        };
        if !self.keys.iter().all(sound) {
            return bad(
                "has a key beyond half a turn, 10 m or 0.05 to 20 times the size: correct it",
            );
        }
        if self.keys.windows(2).any(|w| w[1].angle <= w[0].angle) {
            return bad("has keys whose angles do not rise: sort them");
        }
        let (shift, stretch, turn) = self.between(0.0);
        let still = shift.iter().all(|x| x.abs() < 1e-9)
            && stretch.iter().all(|x| (x - 1.0).abs() < 1e-9)
            && turn.angle() < 1e-9;
        if !still {
            return bad("changes the rest pose: add a key at angle 0 that changes nothing");
        }
        Ok(())
    }
}
