//! Named points of a body, its axes and its levels.

use crate::marks::middle_depth;
use crate::solve::Grown;
use crate::tape::ridge;
use crate::warp::{Follow, Warp};
use crate::{Mannequin, Part};
use toile_geometry::{TriangleMesh, Vec2, Vec3, horizontal_section};

/// Named points of a body [m]. Pairs are left, +X, then right. Joints are centres inside the
/// body, the other points lie on the skin.
#[derive(Clone, Debug, PartialEq)]
pub struct Landmarks {
    /// Top of the head.
    pub crown: Vec3,
    /// Base of the neck at the back, over the seventh neck vertebra.
    pub nape: Vec3,
    /// Where neck and shoulder meet.
    pub neck_sides: [Vec3; 2],
    /// Outer ends of the shoulders.
    pub shoulder_tips: [Vec3; 2],
    /// Foremost points of the bust.
    pub bust_points: [Vec3; 2],
    /// Front middle at the waist.
    pub waist: Vec3,
    /// Front middle at the fullest hip.
    pub hips: Vec3,
    /// Lowest point of the trunk between the legs.
    pub crotch: Vec3,
    /// Shoulder joints.
    pub shoulders: [Vec3; 2],
    /// Elbow joints.
    pub elbows: [Vec3; 2],
    /// Wrist joints.
    pub wrists: [Vec3; 2],
    /// Hip joints.
    pub hip_joints: [Vec3; 2],
    /// Knee joints.
    pub knees: [Vec3; 2],
    /// Ankle joints.
    pub ankles: [Vec3; 2],
    /// Middle of the trunk at crotch, hips, waist, bust and base of the neck, from below.
    pub spine: [Vec3; 5],
    /// Base of the skull.
    pub skull_base: Vec3,
}

/// The axis of one part of the body.
#[derive(Clone, Debug, PartialEq)]
pub struct PartAxis {
    /// Which part.
    pub part: Part,
    /// Points from the root outward: trunk from the crotch to the neck, head from the neck to the
    /// crown, arm from the shoulder joint to the wrist, leg from the hip joint to the ankle [m].
    pub axis: Vec<Vec3>,
}

/// Heights above the floor [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyLevels {
    /// Top of the head.
    pub crown: f64,
    /// Side of the neck.
    pub neck: f64,
    /// Outer end of the shoulder.
    pub shoulder: f64,
    /// Fullest bust or chest.
    pub chest: f64,
    /// Natural waist.
    pub waist: f64,
    /// Fullest hip.
    pub hip: f64,
    /// Crotch.
    pub crotch: f64,
}

fn pair(left: Vec3) -> [Vec3; 2] {
    [left, Vec3::new(-left.x, left.y, left.z)]
}

impl Landmarks {
    pub(crate) fn find(grown: &Grown, warp: &Warp, mesh: &TriangleMesh) -> Self {
        let q = &grown.request;
        let j = grown.template.joints;
        let trunk_section = |y: f64| -> Vec<Vec2> {
            let trunk = (0..mesh.triangles.len())
                .filter(|&t| matches!(grown.skin.parts[t], Part::Trunk | Part::Head));
            horizontal_section(mesh, trunk, y)
        };
        let front = |y: f64| {
            let z = middle_extreme(&trunk_section(y), 1.0);
            Vec3::new(0.0, y, z)
        };
        let nape_z = -middle_extreme(&trunk_section(q.nape()), -1.0);
        let spine = |y: f64| Vec3::new(0.0, y, middle_depth(&trunk_section(y)));
        let window = [q.bust_level(), q.nape() + 0.02 * q.height];
        let fallback = Vec3::new(0.5 * q.shoulder_width, q.nape(), 0.0);
        let tip = ridge(mesh, 0.5 * q.shoulder_width, window).unwrap_or(fallback);
        let neck = warp.apply(grown.marks.neck_side, Follow::default());
        let bust = trunk_section(q.bust_level())
            .into_iter()
            .filter(|p| p.x >= 0.0)
            .max_by(|a, b| a.y.total_cmp(&b.y))
            .map_or(fallback, |p| Vec3::new(p.x, q.bust_level(), p.y));
        let middle = |v: &usize| grown.skin.mirror[*v] as usize == *v;
        let lowest = (0..mesh.positions.len())
            .filter(middle)
            .map(|v| mesh.positions[v])
            .min_by(|a, b| a.y.total_cmp(&b.y))
            .unwrap_or_default();
        let crown = (0..mesh.positions.len())
            .map(|v| mesh.positions[v])
            .max_by(|a, b| a.y.total_cmp(&b.y))
            .unwrap_or_default();
        let arm = |p: [f64; 3]| pair(warp.apply(Vec3::from(p), Follow { arm: 1.0, leg: 0.0 }));
        let leg = |p: [f64; 3]| pair(warp.apply(Vec3::from(p), Follow { arm: 0.0, leg: 1.0 }));
        let centre = |p: [f64; 3]| warp.apply(Vec3::from(p), Follow::default());
        let neck_base = centre(j.neck);
        Self {
            crown,
            nape: Vec3::new(0.0, q.nape(), nape_z),
            neck_sides: pair(neck),
            shoulder_tips: pair(tip),
            bust_points: pair(bust),
            waist: front(q.waist_level()),
            hips: front(q.hip_level()),
            crotch: lowest,
            shoulders: arm(j.shoulder),
            elbows: arm(j.elbow),
            wrists: arm(j.wrist),
            hip_joints: leg(j.hip),
            knees: leg(j.knee),
            ankles: leg(j.ankle),
            spine: [
                Vec3::new(0.0, lowest.y, lowest.z),
                spine(q.hip_level()),
                spine(q.waist_level()),
                spine(q.bust_level()),
                Vec3::new(0.0, neck.y, neck_base.z),
            ],
            skull_base: centre(j.head),
        }
    }
}

/// Largest `side * z` of a section near the middle [m].
fn middle_extreme(section: &[Vec2], side: f64) -> f64 {
    let near = section.iter().filter(|p| p.x.abs() < 0.012);
    near.map(|p| side * p.y).fold(f64::NEG_INFINITY, f64::max)
}

impl Mannequin {
    /// The axes of all six parts, in the order of [`Part::ALL`].
    pub fn parts(&self) -> Vec<PartAxis> {
        let l = &self.landmarks;
        let limb = |joints: [&[Vec3; 2]; 3], side: usize| joints.map(|pair| pair[side]).to_vec();
        Part::ALL
            .into_iter()
            .map(|part| PartAxis {
                part,
                axis: match part {
                    Part::Trunk => l.spine.to_vec(),
                    Part::Head => vec![l.spine[4], l.skull_base, l.crown],
                    Part::LeftArm => limb([&l.shoulders, &l.elbows, &l.wrists], 0),
                    Part::RightArm => limb([&l.shoulders, &l.elbows, &l.wrists], 1),
                    Part::LeftLeg => limb([&l.hip_joints, &l.knees, &l.ankles], 0),
                    Part::RightLeg => limb([&l.hip_joints, &l.knees, &l.ankles], 1),
                },
            })
            .collect()
    }

    /// Heights of the levels garments hang on.
    pub fn levels(&self) -> BodyLevels {
        let l = &self.landmarks;
        BodyLevels {
            crown: l.crown.y,
            neck: l.neck_sides[0].y,
            shoulder: l.shoulder_tips[0].y,
            chest: self.request.bust_level(),
            waist: self.request.waist_level(),
            hip: self.request.hip_level(),
            crotch: l.crotch.y,
        }
    }
}
