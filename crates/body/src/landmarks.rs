//! Named points of a body.

use crate::Part;
use crate::levels::{Level, Levels};
use crate::solve_input::SolveInput;
use crate::tape::outermost;
use crate::template_marks::middle_depth;
use crate::warp::{Follow, Warp};
use toile_geometry::{TriangleMesh, Vec2, Vec3, horizontal_section};

/// Named points of a body (m), on its skin except for those inside the trunk. Pairs are left, +X, then right.
/// The joints are in [`crate::Mannequin::skeleton`].
#[derive(Clone, Debug, PartialEq)]
pub struct Landmarks {
    /// Top of the head.
    pub crown: Vec3,
    /// Underside of the chin: the point of the front midline that lies three quarters of the way forward from
    /// the throat to the foremost point of the chin.
    pub chin: Vec3,
    /// Base of the neck at the back, over the seventh neck vertebra.
    pub nape: Vec3,
    /// Points where neck and shoulder meet.
    pub neck_sides: [Vec3; 2],
    /// Outer ends of the shoulders.
    pub shoulder_tips: [Vec3; 2],
    /// Bust points.
    pub bust_points: [Vec3; 2],
    /// Point of the front midline at the waist.
    pub waist: Vec3,
    /// Point of the front midline at the fullest hip.
    pub hips: Vec3,
    /// Lowest point of the trunk between the legs.
    pub crotch: Vec3,
    /// Centres of the trunk at crotch, hips, waist, bust and base of the neck, from below.
    pub spine: [Vec3; 5],
}

fn pair(left: Vec3) -> [Vec3; 2] {
    [left, Vec3::new(-left.x, left.y, left.z)]
}

impl Landmarks {
    pub(crate) fn find(
        input: &SolveInput,
        (levels, warp): (&Levels, &Warp),
        mesh: &TriangleMesh,
    ) -> Self {
        let level = |level: Level| levels.at(level);
        let trunk_section = |y: f64| -> Vec<Vec2> {
            let near = warp.near(y, 0.08);
            let trunk = input
                .skin
                .bands
                .of(near)
                .filter(|&t| matches!(input.skin.parts[t], Part::Trunk | Part::Head));
            horizontal_section(mesh, trunk, y)
        };
        let front = |y: f64| {
            let z = middle_extreme(&trunk_section(y), 1.0);
            Vec3::new(0.0, y, z)
        };
        let nape_z = -middle_extreme(&trunk_section(level(Level::Nape)), -1.0);
        let spine = |y: f64| Vec3::new(0.0, y, middle_depth(&trunk_section(y)));
        let tip = input.marks.shoulder.tip_on.at(&mesh.positions);
        let neck = input.marks.neck.side_on.at(&mesh.positions);
        let bust_level = level(Level::Bust);
        let ends = trunk_section(bust_level);
        let section: Vec<[Vec2; 2]> = ends.chunks_exact(2).map(|s| [s[0], s[1]]).collect();
        let point = warp.apply(input.marks.bust.point, Follow::default());
        let bust =
            outermost(&section, point.x).map_or(point, |on| Vec3::new(on.x, bust_level, on.y));
        let middle = |v: &usize| input.skin.mirror[*v] as usize == *v;
        let lowest = (0..mesh.positions.len())
            .filter(middle)
            .map(|v| mesh.positions[v])
            .min_by(|a, b| a.y.total_cmp(&b.y))
            .unwrap_or_default();
        let crown = (0..mesh.positions.len())
            .map(|v| mesh.positions[v])
            .max_by(|a, b| a.y.total_cmp(&b.y))
            .unwrap_or_default();
        let neck_base = warp.apply(Vec3::from(input.template.joints.neck), Follow::default());
        let outline: Vec<Vec3> = (0..mesh.positions.len())
            .filter(middle)
            .map(|v| mesh.positions[v])
            .filter(|p| p.z > neck_base.z && p.y > neck_base.y)
            .collect();
        Self {
            crown,
            chin: chin(outline, [neck_base.y, crown.y]),
            nape: Vec3::new(0.0, level(Level::Nape), nape_z),
            neck_sides: pair(neck),
            shoulder_tips: pair(tip),
            bust_points: pair(bust),
            waist: front(level(Level::Waist)),
            hips: front(level(Level::Hips)),
            crotch: lowest,
            spine: [
                Vec3::new(0.0, lowest.y, lowest.z),
                spine(level(Level::Hips)),
                spine(level(Level::Waist)),
                spine(bust_level),
                Vec3::new(0.0, neck.y, neck_base.z),
            ],
        }
    }
}

/// Underside of the chin: the point of an outline of neck and face, between the neck's base and the mouth,
/// that lies three quarters of the way forward from the throat to the chin.
fn chin(mut outline: Vec<Vec3>, [base, crown]: [f64; 2]) -> Vec3 {
    /// Share of the way from the neck's base to the crown at which the mouth begins.
    const MOUTH: f64 = 0.3;
    /// Share of the way forward from the throat to the foremost point of the chin at which its underside
    /// lies.
    const FORWARD: f64 = 0.75;
    outline.retain(|p| p.y < base + MOUTH * (crown - base));
    outline.sort_by(|a, b| a.y.total_cmp(&b.y));
    let foremost = (0..outline.len()).max_by(|&a, &b| outline[a].z.total_cmp(&outline[b].z));
    let below = &outline[..foremost.unwrap_or_default()];
    let throat = below.iter().map(|p| p.z).reduce(f64::min);
    let (Some(front), Some(throat)) = (foremost, throat) else {
        return Vec3::new(0.0, crown, 0.0);
    };
    let depth = throat + FORWARD * (outline[front].z - throat);
    let behind = below.iter().rposition(|p| p.z < depth).unwrap_or_default();
    let [a, b] = [outline[behind], outline[behind + 1]];
    a + (b - a) * ((depth - a.z) / (b.z - a.z)).clamp(0.0, 1.0)
}

/// Largest `side * z` of a section near the median plane (m).
fn middle_extreme(section: &[Vec2], side: f64) -> f64 {
    let near = section.iter().filter(|p| p.x.abs() < 0.012);
    near.map(|p| side * p.y).fold(f64::NEG_INFINITY, f64::max)
}
