//! The planes in which a tape goes round our own bodies.

use crate::Part;
use crate::bands::{Near, neck_height};
use crate::definitions::{Cut, NECK_TILT};
use crate::girths::Girth;
use crate::levels::{Level, Levels};
use crate::template_marks::{ARM_BEGINS, ARM_MIDDLES, ARM_STEP, TemplateMarks};
use crate::warp::{Follow, Warp};
use toile_geometry::Vec3;

/// A part of a body, the plane across it (a point and a unit normal), and the range of the template in which
/// to search for triangles that cross the plane.
pub(crate) struct CutPlane {
    pub(crate) part: Part,
    pub(crate) plane: [Vec3; 2],
    pub(crate) near: Near,
}

/// Largest difference in height between a plane and the first corner of a triangle that crosses it (m).
const REACH: f64 = 0.04;
/// The same at thighs, and at levels of the trunk given by lengths (m): there points of one height on the
/// template get different heights on the body.
const FAR: f64 = 0.08;
/// The same round the head above the ears, where rows of the skin are no farther apart than this (m).
const HEAD: f64 = 0.025;
/// The same along the normal of a tape round the neck (m): on the template, a tape round a thick neck has
/// another tilt.
const NECK: f64 = 0.045;

/// The same along the arm for a tape across it (m): such a tape may be tilted against the rings of the skin.
const ARM: f64 = 0.04;

/// Half the length over which the direction of an arm is computed from the centres of its sections (m).
const ARM_WAY: f64 = 0.065;

/// Centre of the section of the template's arm at a distance from the shoulder joint (m).
fn arm_middle(marks: &TemplateMarks, distance: f64) -> Vec3 {
    let place = (distance / marks.arm.wrist - ARM_BEGINS) / ARM_STEP;
    let before = (place.floor().max(0.0) as usize).min(ARM_MIDDLES - 2);
    let [a, b] = [before, before + 1].map(|k| marks.arm.middles[k]);
    a + (b - a) * (place - before as f64).clamp(0.0, 1.0)
}

/// Position of the section of neck or limb that sets the scale of a girth, as [`Cut`] counts it (m).
pub(crate) fn scale_place(girth: Girth, marks: &TemplateMarks, warp: &Warp) -> Option<f64> {
    let on_arm = |distance: f64| warp.along_arm(warp.arm_plane(distance)[0]);
    let on_leg = |y: f64| warp.apply(Vec3::y() * y, Follow::LEG).y;
    Some(match girth {
        Girth::Neck => 0.0,
        Girth::UpperArm => on_arm(marks.arm.upper_arm),
        Girth::Forearm => on_arm(marks.arm.forearm),
        Girth::Wrist => on_arm(marks.arm.wrist),
        Girth::LowerThigh => on_leg(marks.leg.lower_thigh),
        Girth::Knee => on_leg(marks.leg.knee),
        Girth::Calf => on_leg(marks.leg.calf),
        Girth::Ankle => on_leg(marks.leg.ankle),
        _ => return None,
    })
}

impl CutPlane {
    /// The plane of a cut at the position `place` (m), a height or a distance along the arm as [`Cut`] says.
    pub(crate) fn of(cut: Cut, place: f64, marks: &TemplateMarks, warp: &Warp) -> Self {
        match cut {
            Cut::Trunk => Self::level(Part::Trunk, place, warp.near(place, REACH)),
            Cut::Head => Self::level(Part::Head, place, warp.near(place, HEAD)),
            Cut::Leg => {
                let reach = match warp.template_level(place) < marks.leg.lower_thigh {
                    true => REACH,
                    false => FAR,
                };
                Self::level(Part::LeftLeg, place, warp.near(place, reach))
            }
            Cut::Neck => {
                let middle = warp.apply(marks.neck.middle, Follow::default()) + Vec3::y() * place;
                let (sin, cos) = NECK_TILT.sin_cos();
                Self {
                    part: Part::Head,
                    plane: [middle, Vec3::new(0.0, cos, sin)],
                    near: {
                        let level = warp.template_level(middle.y);
                        let at = neck_height(Vec3::new(0.0, level, marks.neck.middle.z));
                        Near::Neck([at - NECK, at + NECK])
                    },
                }
            }
            Cut::Arm => {
                let distance = warp.arm_distance(place);
                let [from, to] = [-ARM_WAY, ARM_WAY].map(|way| arm_middle(marks, distance + way));
                let on_arm = |p: Vec3| warp.apply(p, Follow::ARM);
                let middle = on_arm(arm_middle(marks, distance));
                Self {
                    plane: [middle, (on_arm(to) - on_arm(from)).normalize()],
                    ..Self::across_arm(distance, warp)
                }
            }
        }
    }

    /// The plane of a girth whose position is given by lengths alone.
    pub(crate) fn placed(
        girth: Girth,
        marks: &TemplateMarks,
        levels: &Levels,
        warp: &Warp,
    ) -> Self {
        let trunk = |level: Level| {
            let y = levels.at(level);
            Self::level(Part::Trunk, y, warp.near(y, FAR))
        };
        match girth {
            Girth::Elbow => Self::across_arm(marks.arm.elbow, warp),
            Girth::Heel => {
                let on_leg = |p: Vec3| warp.apply(p, Follow::LEG);
                let [a, b, c] = marks.leg.heel.map(on_leg);
                let normal = (b - a).cross(&(c - a)).normalize();
                let heights = marks.leg.heel.map(|p| p.y);
                let low = heights.iter().copied().fold(f64::INFINITY, f64::min);
                let high = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                Self {
                    part: Part::LeftLeg,
                    plane: [a, if normal.y < 0.0 { -normal } else { normal }],
                    near: Near::Level([low - 0.12, high + 0.12]),
                }
            }
            _ => trunk(girth.level().unwrap_or(Level::HighBust)),
        }
    }

    fn level(part: Part, y: f64, near: Near) -> Self {
        Self {
            part,
            plane: [Vec3::y() * y, Vec3::y()],
            near,
        }
    }

    /// Plane across the arm at a distance from the template's shoulder joint (m).
    fn across_arm(distance: f64, warp: &Warp) -> Self {
        Self {
            part: Part::LeftArm,
            plane: warp.arm_plane(distance),
            near: Near::Arm([distance - ARM, distance + ARM]),
        }
    }
}
