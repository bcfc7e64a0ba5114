//! The misfit: distances of a skin from the mesh it was fitted to, by sections.

use crate::rings::crossings;
use crate::{Joints, Loop, Scan};
use serde::Serialize;
use std::f64::consts::TAU;
use toile_geometry::{Vec2, closed_length, convex_hull};

/// Distances of a fitted skin from the mesh, over level sections at steps of 1 % of the height, from the
/// ankles to the chin, without the hands.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FitMisfit {
    /// Root mean square of the distance along rays from the sections' centres (m).
    pub radial: f64,
    /// Largest distance along these rays (m).
    pub radial_max: f64,
    /// Root mean square of the difference of girths by a tight tape (m).
    pub girth: f64,
    /// Largest difference of girths (m).
    pub girth_max: f64,
    /// Number of primitives of both sides.
    pub primitives: usize,
    /// Number of sections compared.
    pub sections: usize,
    /// Root mean square of the distance along rays (m), for trunk with neck, legs, and arms.
    pub parts: [f64; 3],
    /// All sections compared, from the floor up.
    pub levels: Vec<LevelMisfit>,
    /// Number of pairs of the skin's triangles that cross.
    pub self_crossings: usize,
}

/// Part of the body that a level section goes through.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum LevelPart {
    /// Trunk, neck and head; the whole section where the arms are joined with the trunk in either body.
    Trunk,
    /// The left leg.
    Leg,
    /// The left arm beside the trunk.
    Arm,
}

/// Differences between the level sections of a mesh and of the skin fitted to it, at one height.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LevelMisfit {
    /// Height of the section (m).
    #[serde(rename = "height_m")]
    pub height: f64,
    /// Part that the section goes through.
    pub part: LevelPart,
    /// Girth of the mesh by a tight tape (m).
    #[serde(rename = "girth_m")]
    pub girth: f64,
    /// Girth of the fitted skin minus girth of the mesh (m).
    #[serde(rename = "gap_m")]
    pub gap: f64,
    /// Root mean square of the distance along rays from the section's centre (m).
    #[serde(rename = "radial_rms_m")]
    pub radial: f64,
}

/// Number of rays of a section.
const RAYS: usize = 72;

impl FitMisfit {
    /// One number by which fits are compared: the larger of the radial and the girth misfit, each divided by
    /// its accepted value and stature (1). A skin that crosses itself is worse than any that does not.
    pub(crate) fn badness(&self, stature: f64) -> f64 {
        /// Accepted misfits of an adult's fit as a share of stature: 2 mm radially and 3 mm in girth.
        const MAY: [f64; 2] = [2e-3 / 1.7, 3e-3 / 1.7];
        let over = (self.radial / MAY[0]).max(self.girth / MAY[1]) / stature;
        over + 100.0 * self.self_crossings as f64
    }
}

/// Compares a skin with the mesh that it was fitted to, on the levels between two heights (m).
pub(crate) fn misfit(
    mesh: &Scan,
    skin: &Scan,
    joints: &Joints,
    [low, high]: [f64; 2],
) -> FitMisfit {
    let height = mesh.height();
    let mut found = FitMisfit::default();
    let (mut radial, mut girth) = ([[0.0_f64; 2]; 3], 0.0_f64);
    for k in 4..100 {
        let y = 0.01 * height * f64::from(k);
        if y < low || y > high {
            continue;
        }
        for (part, pair) in pairs([mesh, skin], joints, y) {
            let rays = distances(&pair);
            let square: f64 = rays.iter().map(|d| d * d).sum();
            radial[part as usize][0] += square;
            radial[part as usize][1] += rays.len() as f64;
            let most = rays.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
            found.radial_max = found.radial_max.max(most);
            let [around, skin] = pair.map(|loops| tape(&loops));
            let gap = skin - around;
            found.levels.push(LevelMisfit {
                height: y,
                part,
                girth: around,
                gap,
                radial: (square / rays.len().max(1) as f64).sqrt(),
            });
            girth += gap * gap;
            found.girth_max = found.girth_max.max(gap.abs());
            found.sections += 1;
        }
    }
    let [sum, count] = radial
        .iter()
        .fold([0.0, 0.0], |a, b| [a[0] + b[0], a[1] + b[1]]);
    found.self_crossings = crossings(skin.mesh());
    let root = |square: f64, count: f64| (square / count.max(1.0)).sqrt();
    found.radial = root(sum, count);
    found.girth = root(girth, found.sections as f64);
    found.parts = radial.map(|[square, count]| root(square, count));
    found
}

/// The sections at a height that both bodies have: trunk, leg and arm. Where the arms are joined with the
/// trunk in one of the bodies only, the whole section counts as trunk.
pub(crate) fn pairs(
    [mesh, skin]: [&Scan; 2],
    joints: &Joints,
    y: f64,
) -> Vec<(LevelPart, [Vec<Loop>; 2])> {
    let loops = [mesh.level(y), skin.level(y)];
    let both = |take: for<'a> fn(&Scan, &'a [Loop]) -> Option<&'a Loop>| {
        let own = take(mesh, &loops[0])?.clone();
        let other = take(skin, &loops[1])?.clone();
        Some([vec![own], vec![other]])
    };
    let mut all = Vec::new();
    let crotch = mesh.landmarks().crotch.unwrap_or_default();
    if y < crotch {
        all.extend(both(Scan::leg_of).map(|pair| (LevelPart::Leg, pair)));
        return all;
    }
    let apart = [
        mesh.arm_of(&loops[0]).is_some(),
        skin.arm_of(&loops[1]).is_some(),
    ];
    let armpit = mesh.landmarks().armpit.unwrap_or_default();
    if apart[0] != apart[1] && y > armpit - 0.03 * mesh.height() {
        return vec![(LevelPart::Trunk, loops)];
    }
    all.extend(both(Scan::trunk_of).map(|pair| (LevelPart::Trunk, pair)));
    // Lower down, a level section of a slanting forearm reaches into the hand.
    if y > joints.wrist[1] + 0.02 * mesh.height() {
        all.extend(both(Scan::arm_of).map(|pair| (LevelPart::Arm, pair)));
    }
    all
}

/// Girth of a tight tape round all loops (m).
pub(crate) fn tape(loops: &[Loop]) -> f64 {
    let points: Vec<Vec2> = loops.iter().flat_map(|l| &l.points).copied().collect();
    closed_length(&convex_hull(&points))
}

/// Differences along rays from the centre of the mesh's section: the outermost crossing with the skin minus
/// the outermost crossing with the mesh (m).
fn distances([mesh, skin]: &[Vec<Loop>; 2]) -> Vec<f64> {
    let longest = mesh.iter().max_by(|a, b| a.length().total_cmp(&b.length()));
    let Some(centre) = longest.map(Loop::centre) else {
        return Vec::new();
    };
    (0..RAYS)
        .filter_map(|k| {
            let (sin, cos) = (TAU * k as f64 / RAYS as f64).sin_cos();
            let ray = Vec2::new(cos, sin);
            let far = |loops: &[Loop]| {
                let ways = loops.iter().filter_map(|l| outermost(l, centre, ray));
                ways.max_by(f64::total_cmp)
            };
            Some(far(skin)? - far(mesh)?)
        })
        .collect()
}

/// Distance along a ray from `centre` to its last crossing of a loop (m).
pub(crate) fn outermost(section: &Loop, centre: Vec2, ray: Vec2) -> Option<f64> {
    let points = &section.points;
    let mut best: Option<f64> = None;
    for (k, a) in points.iter().enumerate() {
        let b = points[(k + 1) % points.len()];
        let (u, v) = (a - centre, b - centre);
        let [from, to] = [ray.perp(&u), ray.perp(&v)];
        if (from >= 0.0) == (to >= 0.0) {
            continue;
        }
        let at = u + (v - u) * (from / (from - to));
        let along = at.dot(&ray);
        if along > 0.0 && best.is_none_or(|known| along > known) {
            best = Some(along);
        }
    }
    best
}
