//! The maps of arm and leg from a template to a body: scaled about their own axes.

use crate::curve::{Monotone, smooth_step};
use crate::shape::{ArmShape, Shape};
use crate::template::Joints;
use crate::template_marks::TemplateMarks;
use toile_geometry::Vec3;

/// Length down the thigh over which the form of the leg's top fades out, as a share of stature.
const LEG_TOP: f64 = 0.09;

/// The map of the left arm.
#[derive(Clone)]
pub(crate) struct ArmWarp {
    /// Scale about the axis over the template's distance from the shoulder joint.
    scale: Monotone,
    /// Distance from the shoulder joint on the body, by the distance on the template (m).
    pub(crate) length: Monotone,
    /// The shoulder joint of the template (m).
    pub(crate) shoulder: Vec3,
    /// Unit vectors on the template along the arm, and upwards across it.
    from: [Vec3; 2],
    /// Unit vectors on the body along the arm, and upwards across it.
    pub(crate) to: [Vec3; 2],
}

impl ArmWarp {
    pub(crate) fn new(joints: &Joints, shape: &ArmShape) -> Self {
        let shoulder = Vec3::from(joints.shoulder);
        let along = (Vec3::from(joints.wrist) - shoulder).normalize();
        let angle = shape.angle;
        let target = Vec3::new(angle.cos(), -angle.sin(), 0.0);
        Self {
            scale: Monotone::new(shape.scale.clone()),
            length: Monotone::new(shape.length.clone()),
            shoulder,
            from: [along, Vec3::z().cross(&along)],
            to: [target, Vec3::z().cross(&target)],
        }
    }

    /// Point that a point of the template is mapped to on a body with its shoulder joint at `shoulder` (m).
    pub(crate) fn apply(&self, p: Vec3, shoulder: Vec3) -> Vec3 {
        let offset = p - self.shoulder;
        let distance = offset.dot(&self.from[0]);
        let scale = self.scale.at(distance);
        shoulder
            + self.to[0] * self.length.at(distance)
            + self.to[1] * (offset.dot(&self.from[1]) * scale)
            + Vec3::z() * (offset.z * scale)
    }
}

/// The map of the left leg.
#[derive(Clone)]
pub(crate) struct LegWarp {
    /// Scale about the axis over template height.
    scale: Monotone,
    /// Joints of hip, knee and ankle of the template (m).
    axis: [Vec3; 3],
    /// Sideways scale of the position of the axis (1).
    stance: f64,
    /// Factor by which the top of the leg is broader and less deep (1).
    top_breadth: f64,
    /// Ratio of statures, body to template.
    stature_ratio: f64,
    marks: TemplateMarks,
}

impl LegWarp {
    pub(crate) fn new(joints: &Joints, marks: &TemplateMarks, shape: &Shape) -> Self {
        Self {
            scale: Monotone::new(shape.leg.scale.clone()),
            axis: [joints.hip, joints.knee, joints.ankle].map(Vec3::from),
            stance: shape.leg.stance,
            top_breadth: shape.leg.top_breadth,
            stature_ratio: shape.stature_ratio,
            marks: *marks,
        }
    }

    /// The axis of the leg at a height.
    fn axis_at(&self, y: f64) -> Vec3 {
        let [hip, knee, ankle] = self.axis;
        let line = |a: Vec3, b: Vec3| a + (b - a) * ((a.y - y) / (a.y - b.y));
        if y > knee.y {
            line(hip, knee)
        } else if y > ankle.y {
            line(knee, ankle)
        } else {
            ankle
        }
    }

    /// Point that a point of the template is mapped to; its height on the body is given (m).
    pub(crate) fn apply(&self, p: Vec3, height: f64) -> Vec3 {
        let m = &self.marks;
        let axis = self.axis_at(p.y);
        let scale = self.scale.at(p.y);
        // The form of the hips at the crotch fades out downwards.
        let top = smooth_step(1.0 - (m.crotch.height - p.y) / (LEG_TOP * m.crown));
        let breadth = 1.0 + (self.top_breadth - 1.0) * top;
        Vec3::new(
            axis.x * self.stance + (p.x - axis.x) * scale * breadth,
            height,
            (axis.z - m.trunk.middle_depth) * self.stature_ratio + (p.z - axis.z) * scale / breadth,
        )
    }
}
