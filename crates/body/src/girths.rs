//! Every girth a body is solved for: its place on the template and the scale it sets.

use crate::Part;
use crate::bands::Near;
use crate::levels::{Level, Levels};
use crate::template_marks::{Plane, TemplateMarks};
use crate::warp::{Follow, Warp};
use toile_geometry::Vec3;

/// A girth, from the head down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Girth {
    Head,
    Neck,
    HighBust,
    Bust,
    Underbust,
    Waist,
    HighHips,
    Hips,
    Thigh,
    LowerThigh,
    Knee,
    Calf,
    Ankle,
    Heel,
    UpperArm,
    Elbow,
    Forearm,
    Wrist,
}

/// The place of a girth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Site {
    /// Level round the trunk.
    Trunk(Level),
    /// Level round the left leg, at a height of the template [m].
    Leg(f64),
    /// Across the left arm, at a distance from the shoulder joint of the template [m].
    Arm(f64),
    /// A plane of the template.
    Plane(Part, Plane),
}

/// Depth below the crotch at which the thigh is measured, over stature.
pub(crate) const THIGH_DROP: f64 = 0.012;

/// How far from its middle a girth of neck or head may lie, and how far up and down its triangles
/// are looked for besides [m].
const HEAD_REACH: [f64; 2] = [0.13, 0.05];

impl Girth {
    pub(crate) const COUNT: usize = 18;
    pub(crate) const ALL: [Girth; Self::COUNT] = {
        use Girth::*;
        [
            Head, Neck, HighBust, Bust, Underbust, Waist, HighHips, Hips, Thigh, LowerThigh, Knee,
            Calf, Ankle, Heel, UpperArm, Elbow, Forearm, Wrist,
        ]
    };

    /// The measurement's name.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Girth::Head => "head",
            Girth::Neck => "neck",
            Girth::HighBust => "high_bust",
            Girth::Bust => "bust",
            Girth::Underbust => "underbust",
            Girth::Waist => "waist",
            Girth::HighHips => "high_hips",
            Girth::Hips => "hips",
            Girth::Thigh => "leg_circ",
            Girth::LowerThigh => "lower_thigh",
            Girth::Knee => "knee",
            Girth::Calf => "calf",
            Girth::Ankle => "ankle",
            Girth::Heel => "heel",
            Girth::UpperArm => "upper_arm",
            Girth::Elbow => "elbow",
            Girth::Forearm => "forearm",
            Girth::Wrist => "wrist",
        }
    }

    /// Where it lies on a template; the thigh's place follows the crotch.
    pub(crate) fn site(self, marks: &TemplateMarks) -> Site {
        match self {
            Girth::Head => Site::Plane(Part::Head, marks.head),
            Girth::Neck => Site::Plane(Part::Head, marks.neck),
            Girth::HighBust => Site::Trunk(Level::HighBust),
            Girth::Bust => Site::Trunk(Level::Bust),
            Girth::Underbust => Site::Trunk(Level::Underbust),
            Girth::Waist => Site::Trunk(Level::Waist),
            Girth::HighHips => Site::Trunk(Level::HighHips),
            Girth::Hips => Site::Trunk(Level::Hips),
            Girth::Thigh => Site::Leg(marks.crotch),
            Girth::LowerThigh => Site::Leg(marks.lower_thigh),
            Girth::Knee => Site::Leg(marks.knee),
            Girth::Calf => Site::Leg(marks.calf),
            Girth::Ankle => Site::Leg(marks.ankle),
            Girth::Heel => Site::Plane(Part::LeftLeg, marks.heel),
            Girth::UpperArm => Site::Arm(marks.upper_arm),
            Girth::Elbow => Site::Arm(marks.elbow),
            Girth::Forearm => Site::Arm(marks.forearm),
            Girth::Wrist => Site::Arm(marks.wrist),
        }
    }

    /// The part it lies on, and its plane on the body: a point and a unit normal.
    pub(crate) fn plane(
        self,
        marks: &TemplateMarks,
        levels: &Levels,
        warp: &Warp,
    ) -> (Part, [Vec3; 2]) {
        let level = |part, y: f64| (part, [Vec3::new(0.0, y, 0.0), Vec3::y()]);
        match self.site(marks) {
            Site::Trunk(at) => level(Part::Trunk, levels.at(at)),
            Site::Leg(_) if self == Girth::Thigh => {
                let drop = THIGH_DROP * levels.at(Level::Crown);
                level(Part::LeftLeg, levels.at(Level::Crotch) - drop)
            }
            Site::Leg(y) => level(Part::LeftLeg, warp.level_of(y)),
            Site::Arm(distance) => (Part::LeftArm, warp.arm_plane(distance)),
            Site::Plane(part, plane) => {
                let follow = match part {
                    Part::LeftLeg => Follow { arm: 0.0, leg: 1.0 },
                    _ => Follow::default(),
                };
                let at = |p: Vec3| warp.apply(p, follow);
                let [a, b, c] = plane.map(at);
                let normal = (b - a).cross(&(c - a)).normalize();
                (part, [a, if normal.y < 0.0 { -normal } else { normal }])
            }
        }
    }

    /// Where on the template its triangles are to be looked for.
    pub(crate) fn near(self, marks: &TemplateMarks, plane: [Vec3; 2], warp: &Warp) -> Near {
        match self.site(marks) {
            // Up there the ends of the shoulders are moved besides.
            Site::Trunk(Level::HighBust) => warp.near(plane[0].y, 0.08),
            Site::Trunk(_) => warp.near(plane[0].y, 0.04),
            Site::Leg(_) if self == Girth::Thigh => warp.near(plane[0].y, 0.08),
            Site::Leg(y) if self == Girth::Ankle => Near::level(y, 0.05),
            Site::Leg(y) => Near::level(y, 0.03),
            Site::Arm(distance) => Near::Arm([distance - 0.05, distance + 0.05]),
            Site::Plane(Part::Head, [a, b, c]) => {
                // No farther from its middle than any neck or head is wide.
                let normal = (b - a).cross(&(c - a));
                let slope = normal.z.hypot(normal.x) / normal.y.abs().max(1e-9);
                Near::level(a.y, HEAD_REACH[0] * slope + HEAD_REACH[1])
            }
            Site::Plane(_, points) => {
                let heights = points.map(|p| p.y);
                let low = heights.iter().copied().fold(f64::INFINITY, f64::min);
                let high = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                Near::Level([low - 0.12, high + 0.12])
            }
        }
    }
}
