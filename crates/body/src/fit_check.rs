//! How far a skin lies from the mesh it was fitted to, by sections.

use crate::{Joints, Loop, Scan};
use std::f64::consts::TAU;
use toile_geometry::{Vec2, closed_length, convex_hull};

/// How far a fitted skin lies from the mesh, over level sections each 1 % of the height, from the
/// ankles to the chin, without the hands.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FitMisfit {
    /// Root mean square of the distance along rays from the sections' middles [m].
    pub radial: f64,
    /// Its largest [m].
    pub radial_max: f64,
    /// Root mean square of the difference of girths by a tight tape [m].
    pub girth: f64,
    /// Its largest [m].
    pub girth_max: f64,
    /// Primitives of both sides.
    pub primitives: usize,
    /// Sections compared.
    pub sections: usize,
    /// Radial root mean square of trunk with neck, legs and arms [m].
    pub parts: [f64; 3],
}

/// Rays of a section.
const RAYS: usize = 72;

/// Compares two bodies.
pub(crate) fn misfit(mesh: &Scan, skin: &Scan, joints: &Joints, chin: f64) -> FitMisfit {
    let height = mesh.height();
    let mut found = FitMisfit::default();
    let (mut radial, mut girth) = ([[0.0_f64; 2]; 3], 0.0_f64);
    for k in 4..100 {
        let y = 0.01 * height * f64::from(k);
        if y > chin {
            break;
        }
        for (part, pair) in pairs(mesh, skin, joints, y) {
            let rays = distances(&pair);
            let square: f64 = rays.iter().map(|d| d * d).sum();
            radial[part][0] += square;
            radial[part][1] += rays.len() as f64;
            let most = rays.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
            found.radial_max = found.radial_max.max(most);
            let gap = tape(&pair[1]) - tape(&pair[0]);
            girth += gap * gap;
            found.girth_max = found.girth_max.max(gap.abs());
            found.sections += 1;
        }
    }
    let [sum, count] = radial
        .iter()
        .fold([0.0, 0.0], |a, b| [a[0] + b[0], a[1] + b[1]]);
    let root = |square: f64, count: f64| (square / count.max(1.0)).sqrt();
    found.radial = root(sum, count);
    found.girth = root(girth, found.sections as f64);
    found.parts = radial.map(|[square, count]| root(square, count));
    found
}

/// The sections at a height that both have: of trunk, leg and arm. Where the arms are one with
/// the trunk in one of them, all of it together.
fn pairs(mesh: &Scan, skin: &Scan, joints: &Joints, y: f64) -> Vec<(usize, [Vec<Loop>; 2])> {
    let both = |take: &dyn Fn(&Scan) -> Option<Loop>| Some([vec![take(mesh)?], vec![take(skin)?]]);
    let mut all = Vec::new();
    let crotch = mesh.landmarks().crotch.unwrap_or_default();
    if y < crotch {
        all.extend(both(&|s| s.leg(y)).map(|pair| (1, pair)));
        return all;
    }
    let apart = [mesh, skin].map(|s| s.arm(y).is_some());
    let armpit = mesh.landmarks().armpit.unwrap_or_default();
    if apart[0] != apart[1] && y > armpit - 0.03 * mesh.height() {
        return vec![(0, [mesh.level(y), skin.level(y)])];
    }
    all.extend(both(&|s| s.trunk(y)).map(|pair| (0, pair)));
    // Level sections of a slanting forearm reach over the wrist.
    if y > joints.wrist[1] + 0.02 * mesh.height() {
        all.extend(both(&|s| s.arm(y)).map(|pair| (2, pair)));
    }
    all
}

/// Girth of a tight tape round all loops [m].
fn tape(loops: &[Loop]) -> f64 {
    let points: Vec<Vec2> = loops.iter().flat_map(|l| &l.points).copied().collect();
    closed_length(&convex_hull(&points))
}

/// Distances along rays from the middle of the first to both: the outermost crossings [m].
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

/// Distance along a ray to where it crosses a loop last [m].
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
