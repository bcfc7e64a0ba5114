//! A no-fit polygon with a grid for fast queries of the signed distance.
//!
//! Each cell of the grid lists the edges that can be nearest to some point of the cell. A query therefore
//! examines two or three edges, however many the polygon has, and is exact.

use toile_geometry::{Bounds2, Polygon, Vec2};

/// Smallest number of cells along each side of the grid.
const MIN_CELLS: usize = 16;
/// Points of an outline that are nearer to each other than this fraction of its extent are merged: rounding
/// in the polygon operations leaves such pairs.
const REPEATED: f64 = 8e-9;

/// Largest number of grid cells per side for a number of no-fit polygons: together they stay below about 600
/// MB.
pub(crate) fn most_cells(no_fits: usize) -> usize {
    match no_fits {
        0..=4_000 => 64,
        4_001..=16_000 => 32,
        _ => 16,
    }
}

/// An edge with the region on its left, in one cache line of the processor.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Edge {
    start: Vec2,
    /// Unit direction.
    along: Vec2,
    length: f64,
    /// Indices of the edges before and after this one.
    beside: [u32; 2],
}

/// Position of a translation relative to a no-fit polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Probe {
    /// Distance to the boundary, positive inside (m): length of the shortest translation that ends the
    /// overlap.
    pub depth: f64,
    /// Direction of that translation.
    pub normal: Vec2,
}

/// The translations of one shape at which it overlaps another, fixed one.
#[derive(Clone, Debug)]
pub(crate) struct NoFit {
    edges: Vec<Edge>,
    /// For every cell, the start of its list in `lists`.
    cells: Vec<u32>,
    /// Number of cells along each side.
    count: usize,
    /// Each list is the number of its edges, then their indices. The first list is empty.
    lists: Vec<u32>,
    corner: Vec2,
    per_metre: Vec2,
}

impl NoFit {
    /// Prepares the polygon for queries up to `reach` (m) outside of it, with at most `most_cells` cells
    /// along each side of the grid (16 or more).
    pub fn new(regions: &[Polygon], reach: f64, most_cells: usize) -> Self {
        let mut edges = Vec::new();
        for region in regions {
            let region = region.oriented();
            let least = REPEATED * region.bounds().size().norm();
            for ring in region.rings() {
                push_ring(&mut edges, ring, least);
            }
        }
        let bounds = Bounds2::of(regions.iter().flat_map(|r| r.outer.iter().copied()));
        let bounds = bounds.grown(reach);
        let size = bounds.size();
        let count = (2 * edges.len()).next_power_of_two();
        let count = count.clamp(MIN_CELLS, most_cells);
        let mut no_fit = Self {
            edges,
            cells: vec![0; count * count],
            count,
            lists: vec![0],
            corner: bounds.min,
            per_metre: Vec2::new(count as f64 / size.x, count as f64 / size.y),
        };
        let all: Vec<u32> = (0..no_fit.edges.len() as u32).collect();
        if !all.is_empty() {
            no_fit.divide([0, 0], count, &all, reach);
        }
        no_fit
    }

    /// Fills the lists of a square block of cells with the edges that can be nearest there.
    fn divide(&mut self, [column, row]: [usize; 2], count: usize, edges: &[u32], reach: f64) {
        let cell = Vec2::new(1.0 / self.per_metre.x, 1.0 / self.per_metre.y);
        let half = cell * (count as f64 / 2.0);
        let centre = self.corner + cell.component_mul(&Vec2::new(column as f64, row as f64)) + half;
        let radius = half.norm() * (1.0 + 1e-9);
        let apart: Vec<f64> = edges
            .iter()
            .map(|&e| self.edges[e as usize].distance(centre))
            .collect();
        let nearest = apart.iter().copied().fold(f64::INFINITY, f64::min);
        let outside = nearest > reach + radius && self.side(edges, centre).depth < 0.0;
        let kept: Vec<u32> = if outside {
            Vec::new()
        } else {
            let near = |k: &usize| apart[*k] <= nearest + 2.0 * radius;
            (0..edges.len()).filter(near).map(|k| edges[k]).collect()
        };
        if count > 1 && kept.len() > 1 {
            let half = count / 2;
            for (x, y) in [(0, 0), (half, 0), (0, half), (half, half)] {
                self.divide([column + x, row + y], half, &kept, reach);
            }
            return;
        }
        if kept.is_empty() {
            return;
        }
        let list = self.lists.len() as u32;
        self.lists.push(kept.len() as u32);
        self.lists.extend(&kept);
        for y in row..row + count {
            let start = y * self.count + column;
            self.cells[start..start + count].fill(list);
        }
    }

    /// The signed distance to the nearest of some edges.
    #[inline]
    fn side(&self, list: &[u32], at: Vec2) -> Probe {
        let mut best = (f64::INFINITY, 0, 0.0);
        for &e in list {
            let edge = &self.edges[e as usize];
            let from = at - edge.start;
            let t = from.dot(&edge.along).clamp(0.0, edge.length);
            let squared = (from - edge.along * t).norm_squared();
            if squared < best.0 {
                best = (squared, e, t);
            }
        }
        let (squared, e, t) = best;
        let edge = &self.edges[e as usize];
        let away = at - edge.start - edge.along * t;
        let beside = |which: usize| self.edges[edge.beside[which] as usize].along;
        let inside = if t <= 0.0 {
            in_corner([beside(0), edge.along], away)
        } else if t >= edge.length {
            in_corner([edge.along, beside(1)], away)
        } else {
            edge.along.perp(&away) > 0.0
        };
        let distance = squared.sqrt();
        let outward = Vec2::new(edge.along.y, -edge.along.x);
        let sign = if inside { 1.0 } else { -1.0 };
        Probe {
            depth: sign * distance,
            normal: if distance > 1e-12 {
                away * (-sign / distance)
            } else {
                outward
            },
        }
    }

    /// Probes a translation; `None` if it is farther outside than the reach. Exact except for rounding.
    #[inline]
    pub fn probe(&self, at: Vec2) -> Option<Probe> {
        let cell = (at - self.corner).component_mul(&self.per_metre);
        let end = self.count as f64;
        let inside = cell.x >= 0.0 && cell.y >= 0.0 && cell.x < end && cell.y < end;
        if !inside {
            return None;
        }
        let list = self.cells[cell.y as usize * self.count + cell.x as usize] as usize;
        let (number, list) = self.lists[list..].split_first()?;
        (*number > 0).then(|| self.side(&list[..*number as usize], at))
    }
}

impl Edge {
    fn distance(&self, at: Vec2) -> f64 {
        let from = at - self.start;
        let t = from.dot(&self.along).clamp(0.0, self.length);
        (from - self.along * t).norm()
    }
}

/// Whether a point, given relative to a corner, lies on the left of the outline that turns there.
fn in_corner([before, after]: [Vec2; 2], away: Vec2) -> bool {
    let (first, second) = (before.perp(&away) > 0.0, after.perp(&away) > 0.0);
    if before.perp(&after) >= 0.0 {
        first && second
    } else {
        first || second
    }
}

/// The points of a ring without near duplicates, and without whiskers: slits of zero width, which a shape
/// fits only in theory.
fn cleaned(ring: &[Vec2], least: f64) -> Vec<Vec2> {
    let superfluous = |points: &[Vec2], k: usize| {
        let n = points.len();
        let (a, b, c) = (points[(k + n - 1) % n], points[k], points[(k + 1) % n]);
        let (back, on) = (a - b, c - b);
        let (shorter, longer) = if back.norm() < on.norm() {
            (back, on)
        } else {
            (on, back)
        };
        let width = shorter.perp(&longer).abs() / longer.norm();
        shorter.norm() <= least || (shorter.dot(&longer) > 0.0 && width <= 2.0 * least)
    };
    let mut points = ring.to_vec();
    let mut k = 0;
    while k < points.len() && points.len() > 2 {
        if superfluous(&points, k) {
            points.remove(k);
            k = k.saturating_sub(2);
        } else {
            k += 1;
        }
    }
    points
}

/// Adds the edges of a ring with points that are accurate to about `least` (m).
fn push_ring(edges: &mut Vec<Edge>, ring: &[Vec2], least: f64) {
    let points = cleaned(ring, least);
    let n = points.len();
    if n < 3 {
        return;
    }
    let first = edges.len();
    let number = |k: usize| (first + k % n) as u32;
    edges.extend((0..n).map(|k| {
        let way = points[(k + 1) % n] - points[k];
        Edge {
            start: points[k],
            along: way.normalize(),
            length: way.norm(),
            beside: [number(k + n - 1), number(k + 1)],
        }
    }));
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use toile_geometry::{Location, no_fit_polygon, point_segment_distance};

    fn star(radii: &[f64], turn: f64) -> Vec<Vec2> {
        let n = radii.len() as f64;
        let point = |(k, &r): (usize, &f64)| {
            let angle = turn + std::f64::consts::TAU * k as f64 / n;
            Vec2::new(r * angle.cos(), r * angle.sin())
        };
        radii.iter().enumerate().map(point).collect()
    }

    proptest! {
        #[test]
        fn probes_are_the_distance_to_the_boundary(
            a in prop::collection::vec(0.2..1.0f64, 3..12),
            b in prop::collection::vec(0.2..1.0f64, 3..12),
            points in prop::collection::vec((-2.2..2.2f64, -2.2..2.2f64), 50),
            cells in prop::sample::select(vec![16usize, 32, 64]),
        ) {
            let regions = no_fit_polygon(&star(&a, 0.1), &star(&b, 0.7));
            let reach = 0.3;
            let no_fit = NoFit::new(&regions, reach, cells);
            for (x, y) in points {
                let at = Vec2::new(x, y);
                let edges = regions.iter().flat_map(|r| r.edges());
                let apart = edges
                    .map(|e| point_segment_distance(at, e))
                    .fold(f64::INFINITY, f64::min);
                let inside = regions.iter().any(|r| r.locate(at) == Location::Inside);
                let want = if inside { apart } else { -apart };
                match no_fit.probe(at) {
                    Some(probe) => {
                        prop_assert!((probe.depth - want).abs() < 1e-9, "{} {want}", probe.depth);
                        let moved = at + probe.normal * probe.depth;
                        let edges = regions.iter().flat_map(|r| r.edges());
                        let left = edges
                            .map(|e| point_segment_distance(moved, e))
                            .fold(f64::INFINITY, f64::min);
                        prop_assert!(left < 1e-9, "{left}");
                    }
                    None => prop_assert!(!inside && apart > reach),
                }
            }
        }
    }
}
