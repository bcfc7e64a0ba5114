//! The map from a template to a body of given measurements.
//!
//! Trunk and head: `(x, y, z) -> (x s_l(y), Y(y), z s_f(y))`, so that with `s_l = s_f` a section
//! and the tape round it scale exactly. Legs and arms: the same about their own axes. Between the
//! parts the maps are blended over a few rings of the skin.

use crate::curve::Monotone;
use crate::rings::at_length;
use crate::template::Template;
use nalgebra::Matrix3;
use toile_geometry::Vec3;

/// What the shape of a body depends on, all for one template. Heights come in pairs: on the
/// template and on the body [m].
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Shape {
    /// Heights from the floor up.
    pub(crate) levels: Vec<[f64; 2]>,
    /// Lateral scale of trunk and head over template height.
    pub(crate) lateral: Vec<[f64; 2]>,
    /// Frontal scale of trunk and head over template height.
    pub(crate) frontal: Vec<[f64; 2]>,
    /// Scale of the leg about its axis over template height.
    pub(crate) leg: Vec<[f64; 2]>,
    /// Scale of the arm about its axis over template distance from the shoulder joint.
    pub(crate) arm: Vec<[f64; 2]>,
    /// Scale of the arm along its axis.
    pub(crate) arm_length: f64,
    /// Angle of the arm below the horizontal [rad].
    pub(crate) arm_angle: f64,
    /// Ratio of statures, body to template.
    pub(crate) global: f64,
    /// Sideways scale of the legs' axes.
    pub(crate) stance: f64,
    /// Template depth that becomes z = 0 [m].
    pub(crate) depth: f64,
}

/// How far a point follows a limb instead of the trunk.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Follow {
    pub(crate) arm: f64,
    pub(crate) leg: f64,
}

/// The map, for points of the left half, x >= 0.
pub(crate) struct Warp {
    level: Monotone,
    lateral: Monotone,
    frontal: Monotone,
    leg: Monotone,
    arm: Monotone,
    shape: Shape,
    leg_axis: [Vec3; 3],
    shoulder: Vec3,
    arm_from: [Vec3; 2],
    arm_to: [Vec3; 2],
}

impl Warp {
    pub(crate) fn new(template: &Template, shape: Shape) -> Self {
        let j = template.joints;
        let shoulder = Vec3::from(j.shoulder);
        let along = (Vec3::from(j.wrist) - shoulder).normalize();
        let target = Vec3::new(shape.arm_angle.cos(), -shape.arm_angle.sin(), 0.0);
        Self {
            level: Monotone::new(shape.levels.clone()),
            lateral: Monotone::new(shape.lateral.clone()),
            frontal: Monotone::new(shape.frontal.clone()),
            leg: Monotone::new(shape.leg.clone()),
            arm: Monotone::new(shape.arm.clone()),
            leg_axis: [j.hip, j.knee, j.ankle].map(Vec3::from),
            shoulder,
            arm_from: [along, Vec3::z().cross(&along)],
            arm_to: [target, Vec3::z().cross(&target)],
            shape,
        }
    }

    fn trunk(&self, p: Vec3) -> Vec3 {
        Vec3::new(
            p.x * self.lateral.at(p.y),
            self.level.at(p.y),
            (p.z - self.shape.depth) * self.frontal.at(p.y),
        )
    }

    /// The axis of the leg at a height.
    fn leg_axis_at(&self, y: f64) -> Vec3 {
        let [hip, knee, ankle] = self.leg_axis;
        let line = |a: Vec3, b: Vec3| a + (b - a) * ((a.y - y) / (a.y - b.y));
        if y > knee.y {
            line(hip, knee)
        } else if y > ankle.y {
            line(knee, ankle)
        } else {
            at_length(&[ankle], 0.0)
        }
    }

    fn leg(&self, p: Vec3) -> Vec3 {
        let axis = self.leg_axis_at(p.y);
        let scale = self.leg.at(p.y);
        Vec3::new(
            axis.x * self.shape.stance + (p.x - axis.x) * scale,
            self.level.at(p.y),
            (axis.z - self.shape.depth) * self.shape.global + (p.z - axis.z) * scale,
        )
    }

    fn arm(&self, p: Vec3) -> Vec3 {
        let offset = p - self.shoulder;
        let distance = offset.dot(&self.arm_from[0]);
        let scale = self.arm.at(distance);
        self.trunk(self.shoulder)
            + self.arm_to[0] * (distance * self.shape.arm_length)
            + self.arm_to[1] * (offset.dot(&self.arm_from[1]) * scale)
            + Vec3::z() * (offset.z * scale)
    }

    /// The place on the body of a place on the template.
    pub(crate) fn apply(&self, p: Vec3, follow: Follow) -> Vec3 {
        let mut mapped = self.trunk(p);
        if follow.arm > 0.0 {
            mapped += (self.arm(p) - mapped) * follow.arm;
        }
        if follow.leg > 0.0 {
            mapped += (self.leg(p) - mapped) * follow.leg;
        }
        mapped
    }

    /// Derivative of [`Warp::apply`] by central differences.
    pub(crate) fn derivative(&self, p: Vec3, follow: Follow) -> Matrix3<f64> {
        let step = 1e-4;
        let column = |axis: Vec3| {
            (self.apply(p + axis * step, follow) - self.apply(p - axis * step, follow))
                / (2.0 * step)
        };
        Matrix3::from_columns(&[column(Vec3::x()), column(Vec3::y()), column(Vec3::z())])
    }
}
