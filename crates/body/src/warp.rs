//! The map from a template to a body of given measurements: trunk and head, arms and legs each have
//! their own, blended where they meet over a few rings of the skin.

use crate::bands::Near;
use crate::girths::Girth;
use crate::shape::Shape;
use crate::template::Template;
use crate::template_marks::{CROTCH_PLACES, TemplateMarks};
use crate::warp_limbs::{ArmWarp, LegWarp};
use crate::warp_trunk::TrunkWarp;
use nalgebra::Matrix3;
use toile_geometry::Vec3;

/// Shares with which a point follows a limb instead of the trunk.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Follow {
    pub(crate) arm: f64,
    pub(crate) leg: f64,
}

impl Follow {
    /// Follows only the arm.
    pub(crate) const ARM: Self = Self { arm: 1.0, leg: 0.0 };
    /// Follows only the leg.
    pub(crate) const LEG: Self = Self { arm: 0.0, leg: 1.0 };
}

/// The map, for points of the left half, x >= 0.
#[derive(Clone)]
pub(crate) struct Warp {
    trunk: TrunkWarp,
    arm: ArmWarp,
    leg: LegWarp,
    /// Positions of shoulder, elbow and wrist (m); `None` unless the map is the identity.
    still: Option<[Vec3; 3]>,
    /// Lowest point of the crotch on the template (m).
    crotch: Vec3,
}

impl Warp {
    pub(crate) fn new(template: &Template, marks: &TemplateMarks, shape: Shape) -> Self {
        let joints = &template.joints;
        let lowest = marks.crotch_depth(CROTCH_PLACES / 2);
        Self {
            arm: ArmWarp::new(joints, &shape.arm),
            leg: LegWarp::new(joints, marks, &shape),
            trunk: TrunkWarp::new(marks, shape),
            still: None,
            crotch: Vec3::new(0.0, marks.crotch.height, lowest),
        }
    }

    /// The identity map.
    pub(crate) fn still(template: &Template, marks: &TemplateMarks) -> Self {
        let j = template.joints;
        let [shoulder, elbow, wrist] = [j.shoulder, j.elbow, j.wrist].map(Vec3::from);
        let along = wrist - shoulder;
        let arm = [along.norm(), (-along.y).atan2(along.x)];
        Self {
            still: Some([shoulder, elbow, wrist]),
            ..Self::new(template, marks, Shape::of_template(marks, arm))
        }
    }

    /// Whether the map is the identity.
    pub(crate) fn is_still(&self) -> bool {
        self.still.is_some()
    }

    /// Point of the body that a point of the template is mapped to.
    pub(crate) fn apply(&self, p: Vec3, follow: Follow) -> Vec3 {
        if self.is_still() {
            return p;
        }
        let mut mapped = self.trunk.apply(p);
        if follow.arm > 0.0 {
            mapped += (self.arm.apply(p, self.shoulder()) - mapped) * follow.arm;
        }
        if follow.leg > 0.0 {
            mapped += (self.leg.apply(p, self.trunk.height(p)) - mapped) * follow.leg;
        }
        mapped
    }

    /// Depth of the side lines of a girth, which divide it into front and back (m).
    pub(crate) fn side_of(&self, girth: Girth) -> f64 {
        self.trunk.shape().trunk.side_depth[girth]
    }

    /// Depth of the crotch point on the body (m).
    pub(crate) fn crotch_point(&self) -> f64 {
        let offset = self.trunk.shape().crotch.point_offset;
        self.apply(self.crotch, Follow::default()).z + offset
    }

    /// Least and largest sideways scale of any point of trunk and head (1).
    pub(crate) fn sideways(&self) -> [f64; 2] {
        match self.is_still() {
            true => [1.0; 2],
            false => self.trunk.sideways(),
        }
    }

    /// Height on the template that corresponds to a height on the body (m).
    pub(crate) fn template_level(&self, height: f64) -> f64 {
        self.trunk.template_level(height)
    }

    /// Range of heights on the template of the triangles that may cross a height on the body (m): about
    /// `reach` (m) up and down from the level that corresponds to it.
    pub(crate) fn near(&self, height: f64, reach: f64) -> Near {
        self.trunk.near(height, reach)
    }

    /// The shoulder joint on the body (m).
    fn shoulder(&self) -> Vec3 {
        self.trunk.apply(self.arm.shoulder)
    }

    /// The plane across the arm at a template distance from the shoulder joint: a point of the axis and the
    /// axis's direction.
    pub(crate) fn arm_plane(&self, distance: f64) -> [Vec3; 2] {
        if let Some([shoulder, elbow, wrist]) = self.still {
            // Across the bone, at the point with this distance along the straight line from shoulder to
            // wrist.
            let straight = (wrist - shoulder).normalize();
            let at = (elbow - shoulder).dot(&straight);
            let (from, to, before) = match distance < at {
                true => (shoulder, elbow, 0.0),
                false => (elbow, wrist, at),
            };
            let along = (to - from).normalize();
            let way = (distance - before) / along.dot(&straight).max(0.1);
            return [from + along * way, along];
        }
        let along = self.arm.to[0] * self.arm.length.at(distance);
        [self.shoulder() + along, self.arm.to[0]]
    }

    /// Distance along the template's arm that corresponds to a distance along the body's arm (m).
    pub(crate) fn arm_distance(&self, along: f64) -> f64 {
        match self.is_still() {
            true => along,
            false => self.arm.length.inverse(along),
        }
    }

    /// Distance of a point along the body's arm from the shoulder joint (m).
    pub(crate) fn along_arm(&self, p: Vec3) -> f64 {
        let [shoulder, along] = match self.still {
            Some([shoulder, _, wrist]) => [shoulder, (wrist - shoulder).normalize()],
            None => self.arm_plane(0.0),
        };
        (p - shoulder).dot(&along)
    }

    /// Images of three axes of a primitive at a point: half the vector between the images of the two ends of
    /// each axis.
    pub(crate) fn carried_axes(&self, p: Vec3, axes: Matrix3<f64>, follow: Follow) -> Matrix3<f64> {
        let column = |k: usize| {
            let axis = axes.column(k).into_owned();
            (self.apply(p + axis, follow) - self.apply(p - axis, follow)) * 0.5
        };
        Matrix3::from_columns(&[column(0), column(1), column(2)])
    }
}
