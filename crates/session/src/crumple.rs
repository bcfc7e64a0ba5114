//! Finds seams that hang in a heap: shorter from top to bottom than their cloth, without a gather that
//! explains it.

use crate::GarmentJob;
use std::collections::BTreeSet;
use toile_geometry::{Vec2, Vec3};

/// A seam that hangs shorter than its cloth.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ShortSeam {
    /// Name of the seam.
    pub name: String,
    /// Length of the cloth along the seam (m).
    pub cloth: f64,
    /// Length of the seam as it hangs (m).
    pub hangs: f64,
}

/// Smallest shortening of a hanging seam that is reported, as a share of the length of its cloth (1).
const SHORTER: f64 = 0.05;
/// Length of cloth between two sample points of a seam (m): long enough that folds in between count, short
/// enough that the curvature of the body does not.
const SPACING: f64 = 0.06;
/// Length below which a seam is not examined (m).
const LEAST: f64 = 0.2;
/// Smallest steepness of a seam that counts as hanging: height between its ends over their distance (1).
const STEEP: f64 = 0.9;
/// Largest share by which the lengths of the two sides of an uneased seam differ (1).
const EASED: f64 = 0.03;
/// Distance from gathers within which a seam is not examined (m).
const NEAR_GATHERS: f64 = 0.05;

/// A sample point of a seam.
#[derive(Clone, Copy)]
struct Point {
    /// Position in space (m).
    place: Vec3,
    /// Positions in the flat pieces on the two sides of the seam (m).
    flat: [Vec2; 2],
    /// Length of cloth along the shorter side from the start of the seam (m).
    cloth: f64,
}

/// Finds the seams that hang in a heap. `target` maps vertices of the garment to merged vertices; `places`
/// are the positions of the merged vertices (m). `taut` are merged vertices where the cloth is stretched:
/// there it contracts across the stretch, so that a seam is shorter without a fold.
pub(crate) fn short_seams(
    job: &GarmentJob,
    target: &[u32],
    places: &[Vec3],
    taut: &BTreeSet<u32>,
) -> Vec<ShortSeam> {
    let near = near_gathers(job);
    let is_left_out = |v: &u32| near.contains(v) || taut.contains(&target[*v as usize]);
    let stitches = &job.garment.stitches;
    let chains = stitches.chunk_by(|a, b| a.draft_seam == b.draft_seam);
    let short = chains.filter_map(|chain| {
        let seam = job.seams.get(chain.first()?.draft_seam)?;
        if seam.gathered {
            return None;
        }
        let pairs: Vec<[u32; 2]> = chain.iter().map(|stitch| stitch.vertices).collect();
        let pieces = pairs.split(|pair| pair.iter().any(is_left_out));
        let point = |v: u32| places[target[v as usize] as usize];
        pieces
            .filter_map(|piece| hanging(&line(job, piece, &point)?))
            .map(|[cloth, hangs]| ShortSeam {
                name: seam.name.clone(),
                cloth,
                hangs,
            })
            .next()
    });
    short.collect()
}

/// Vertices near a gathered seam; the distance is measured in the flat piece.
fn near_gathers(job: &GarmentJob) -> BTreeSet<u32> {
    let garment = &job.garment;
    let gathered = garment.stitches.iter().filter(|stitch| {
        let seam = job.seams.get(stitch.draft_seam);
        seam.is_some_and(|seam| seam.gathered)
    });
    let gathered: Vec<u32> = gathered.flat_map(|stitch| stitch.vertices).collect();
    let mut near = BTreeSet::new();
    for panel in &garment.panels {
        let here = |v: &&u32| panel.vertices.contains(&(**v as usize));
        let at: Vec<_> = gathered
            .iter()
            .filter(here)
            .map(|&v| garment.flat[v as usize])
            .collect();
        let close = |v: &usize| {
            at.iter()
                .any(|p| (garment.flat[*v] - p).norm() < NEAR_GATHERS)
        };
        near.extend(panel.vertices.clone().filter(close).map(|v| v as u32));
    }
    near
}

/// Sample points along a seam, with the length of cloth on its shorter side; `None` if the two sides differ
/// in length, or if a side passes from one panel to another.
fn line(job: &GarmentJob, pairs: &[[u32; 2]], point: &dyn Fn(u32) -> Vec3) -> Option<Vec<Point>> {
    let flat = &job.garment.flat;
    let panel_of = |v: u32| {
        let mut panels = job.garment.panels.iter();
        panels.position(|panel| panel.vertices.contains(&(v as usize)))
    };
    let at = |pair: &[u32; 2], cloth: f64| Point {
        place: point(pair[0]),
        flat: pair.map(|v| flat[v as usize]),
        cloth,
    };
    let mut points = vec![at(pairs.first()?, 0.0)];
    let mut lengths = [0.0; 2];
    for step in pairs.windows(2) {
        let side = |k: usize| {
            let [a, b] = [step[0][k], step[1][k]];
            (panel_of(a) == panel_of(b)).then(|| (flat[a as usize] - flat[b as usize]).norm())
        };
        let both = [side(0)?, side(1)?];
        lengths = [lengths[0] + both[0], lengths[1] + both[1]];
        points.push(at(&step[1], lengths[0].min(lengths[1])));
    }
    let [a, b] = lengths;
    ((a - b).abs() <= EASED * a.max(b)).then_some(points)
}

/// Length of cloth, and length as it hangs, of a seam that hangs shorter than its cloth (m). Both are
/// measured along straight lines between the same points, so that a seam cut in a curve does not count as
/// short. A single fold, as under an arm, is no heap: the seam must also be too short without the section
/// between two points that is shortened most.
fn hanging(points: &[Point]) -> Option<[f64; 2]> {
    let (first, last) = (points.first()?, points.last()?);
    let length = last.cloth;
    let across = last.place - first.place;
    if length < LEAST || across.y.abs() < STEEP * across.norm() {
        return None;
    }
    let pieces = (length / SPACING).round().max(1.0);
    let (mut cloth, mut hangs) = (0.0, 0.0);
    let mut fold = [0.0; 2];
    let mut from = first;
    for k in 1..=pieces as usize {
        let reached = length * k as f64 / pieces;
        let to = points.iter().find(|point| point.cloth >= reached - 1e-9)?;
        let sides = [0, 1].map(|side| (to.flat[side] - from.flat[side]).norm());
        let stretch = [sides[0].min(sides[1]), (to.place - from.place).norm()];
        if stretch[0] - stretch[1] > fold[0] - fold[1] {
            fold = stretch;
        }
        cloth += stretch[0];
        hangs += stretch[1];
        from = to;
    }
    let rest = [cloth - fold[0], hangs - fold[1]];
    (rest[1] < (1.0 - SHORTER) * rest[0]).then_some([cloth, hangs])
}
