//! What was asked for and what the skin has.

use crate::marks::UNDERBUST;
use crate::solve::THIGH_DROP;
use crate::tape::{girth, girth_across};
use crate::{Joint, Mannequin, Part};

/// One measurement: asked for, and got on the skin by our own tape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// The measurement's name.
    pub name: &'static str,
    /// Asked for [m] or [rad].
    pub asked: f64,
    /// Taken from the skin [m] or [rad].
    pub got: f64,
}

impl Gap {
    /// Got less asked [m] or [rad].
    pub fn gap(&self) -> f64 {
        self.got - self.asked
    }
}

impl Mannequin {
    /// Every measurement the body was made from, as asked and as the finished skin has it. Girths
    /// are the convex hull of a section: horizontal, for the wrist across the arm.
    pub fn measure(&self) -> Vec<Gap> {
        let (q, l) = (&self.request, &self.landmarks);
        let mesh = self.skin();
        let tape = |part: Part, level: f64| girth(mesh, &self.parts, part, level);
        let (tip, neck) = (l.shoulder_tips[0], l.neck_sides[0]);
        let wrist = self.skeleton.centre(Joint::LWrist);
        let along = (wrist - self.skeleton.centre(Joint::LShoulder)).normalize();
        let floor = mesh.bounds().map_or(0.0, |[low, _]| low.y);
        let waist = q.waist_level();
        let row = |name, asked, got| Gap { name, asked, got };
        vec![
            row("height", q.height, l.crown.y - floor),
            row("head_l", q.head, l.crown.y - l.nape.y),
            row("neck_w", q.neck_width, 2.0 * neck.x),
            row("shoulder_w", q.shoulder_width, 2.0 * tip.x),
            row(
                "shoulder_incl",
                q.shoulder_slope,
                (neck.y - tip.y).atan2(tip.x - neck.x),
            ),
            row("bust", q.bust, tape(Part::Trunk, q.bust_level())),
            row(
                "vert_bust_line",
                q.bust_depth,
                l.nape.y - l.bust_points[0].y,
            ),
            row(
                "underbust",
                q.underbust,
                tape(Part::Trunk, q.bust_level() - UNDERBUST * q.height),
            ),
            row("waist", q.waist, tape(Part::Trunk, waist)),
            row("waist_line", q.waist_line, l.nape.y - l.waist.y),
            row("hips", q.hips, tape(Part::Trunk, q.hip_level())),
            row("hips_line", q.hips_line, l.waist.y - l.hips.y),
            row("crotch_hip_diff", q.crotch_drop, l.hips.y - l.crotch.y),
            row(
                "leg_circ",
                q.thigh,
                tape(Part::LeftLeg, q.crotch_level() - THIGH_DROP * q.height),
            ),
            row("arm_length", q.arm_length, (wrist - tip).dot(&along)),
            row("arm_pose_angle", q.arm_angle, (-along.y).atan2(along.x)),
            row(
                "wrist",
                q.wrist,
                girth_across(mesh, &self.parts, Part::LeftArm, [wrist, along]),
            ),
        ]
    }
}
