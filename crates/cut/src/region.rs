//! The union of all cloth, on a grid on which every sum is exact.

use crate::chain::Chain;
use crate::ring::Ring;
use toile_geometry::{Bounds2, Polygon, Vec2, point_segment_distance, ring_area, wound_region};

/// Step (m) to which points are rounded before the union: a hundredth of the step of the union's own grid.
/// The union's result lies on multiples of this step too, so it is not rounded again, which could make its
/// rings cross.
const STEP: f64 = 1.0 / (1u64 << 36) as f64;
/// Step (m) to which the origin of a frame is rounded, so that moving points back is exact up to 8 km from
/// it.
const ORIGIN_STEP: f64 = 1.0 / (1u64 << 20) as f64;
/// Step of the union's grid, over half the union's extent (1): half the extent has 2^28 to 2^29 steps.
const GRID: f64 = 1.0 / (1u64 << 28) as f64;

/// A coordinate system whose origin is near the piece; its coordinates are rounded to [`STEP`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub origin: Vec2,
    /// Largest distance by which the union moves a point (m): some of its grid steps.
    pub tolerance: f64,
}

impl Frame {
    pub fn of(ring: &Ring, chains: &[Chain]) -> Self {
        let cloth = chains.iter().flat_map(|chain| &chain.points);
        let seam = ring.chords.iter().map(|chord| &chord.from);
        let bounds = Bounds2::of(cloth.chain(seam).copied());
        Self {
            origin: bounds
                .centre()
                .map(|x| (x / ORIGIN_STEP).round() * ORIGIN_STEP),
            tolerance: 16.0 * GRID * bounds.size().amax() + 2.0 * STEP,
        }
    }

    pub fn snap(&self, p: Vec2) -> Vec2 {
        (p - self.origin).map(|x| (x / STEP).round() * STEP)
    }

    fn loops(&self, chains: &[Chain]) -> Vec<Vec<Vec2>> {
        let one = |chain: &Chain| {
            let mut points: Vec<Vec2> = chain.points.iter().map(|&p| self.snap(p)).collect();
            points.dedup();
            points
        };
        chains.iter().map(one).collect()
    }
}

fn largest(polygons: Vec<Polygon>) -> Option<Polygon> {
    polygons
        .into_iter()
        .max_by(|a, b| a.area().total_cmp(&b.area()))
}

/// Whether a ring is more than a sliver: whether its area exceeds that of a strip which is as wide as the
/// tolerance (m) and as long as the ring's box is wide and high together.
fn is_real(ring: &[Vec2], tolerance: f64) -> bool {
    let length: f64 = Bounds2::of(ring.iter().copied()).size().sum();
    ring_area(ring).abs() > tolerance * length
}

/// A ring without segments shorter than the grid's error, and without hairlines (places where the ring runs
/// back along itself). Rounding leaves hairlines where sides on one line end in different points.
fn without_hairlines(mut ring: Vec<Vec2>, tolerance: f64) -> Vec<Vec2> {
    let mut k = 0;
    // Corners examined since the last removal; after a whole round without a removal the loop ends.
    let mut steady = 0;
    while ring.len() > 3 && steady < ring.len() {
        let count = ring.len();
        k %= count;
        let (p, q, r) = (
            ring[(k + count - 1) % count],
            ring[k],
            ring[(k + 1) % count],
        );
        let back = (q - p).dot(&(r - q)) < 0.0;
        let hair = || {
            point_segment_distance(r, [p, q]) <= tolerance
                || point_segment_distance(p, [q, r]) <= tolerance
        };
        if (q - p).norm() <= tolerance || (back && hair()) {
            ring.remove(k);
            k = (k + ring.len() - 1) % ring.len();
            steady = 0;
        } else {
            k += 1;
            steady += 1;
        }
    }
    ring
}

/// The piece's outline, and the bays whose mouths are closed by allowances, in coordinates of the frame.
pub(crate) fn outline_region(chains: &[Chain], frame: Frame) -> Vec<Vec<Vec2>> {
    let Some(whole) = largest(wound_region(&frame.loops(chains))) else {
        return Vec::new();
    };
    let whole = whole.oriented();
    let bays = whole.holes.into_iter();
    std::iter::once(whole.outer)
        .chain(bays.filter(|bay| is_real(bay, frame.tolerance)))
        .map(|ring| without_hairlines(ring, frame.tolerance))
        .collect()
}

/// The parts of a hole that its allowances leave open, clockwise, in coordinates of the frame. They are the
/// holes of a sheet of cloth round the hole, from which the hole is cut out and to which its allowances are
/// added.
pub(crate) fn hole_region(ring: &Ring, chains: &[Chain], frame: Frame) -> Vec<Vec<Vec2>> {
    let mut loops = frame.loops(chains);
    let seam = ring.chords.iter().map(|chord| frame.snap(chord.from));
    let bounds = Bounds2::of(loops.iter().flatten().copied().chain(seam));
    let sheet = bounds.grown(bounds.size().amax() * 0.125);
    let corners = Polygon::rectangle(sheet).outer;
    loops.push(
        corners
            .into_iter()
            .map(|p| frame.snap(p + frame.origin))
            .collect(),
    );
    let Some(whole) = largest(wound_region(&loops)) else {
        return Vec::new();
    };
    let parts = whole.oriented().holes.into_iter();
    parts
        .filter(|part| is_real(part, frame.tolerance))
        .map(|ring| without_hairlines(ring, frame.tolerance))
        .collect()
}
