//! Discards candidate pairs that a plane separates on their whole trajectories. Sixteen pairs are tested at a time, in
//! single precision with a margin for its rounding.
//!
//! A direction n separates two features where every corner b_j of one lies beyond every corner a_i of the other along
//! it. For corners on straight trajectories this holds throughout if it holds at the start and at the end:
//! ```text
//! min_j n . b_j - max_i n . a_i > (reach + error) |n|
//! ```
//! The test is valid for any n, so an approximate one is enough: the vector between the closest points at the start.
//! Pairs that are not separated remain candidates, and so do pairs with a coordinate that is not finite.

use super::closest_vectors::{
    ROUNDING, edge_is_beyond, edge_to_edge, face_is_beyond, vertex_to_face,
};
use super::leaf_aabbs::{Hits, origin};
use super::surface_view::SurfaceView;
use crate::lane_arithmetic::{F32s, Triple};
use crate::lanes::{Corner, LANES, Point, Row, gather, lane_groups};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use toile_geometry::Vec3;

/// Kind of the pairs to be tested, with the vertices of their features.
#[derive(Clone, Copy, Debug)]
enum PairKind<'a> {
    /// A vertex and a face; corners of all faces.
    VertexFace(&'a [[u32; 3]]),
    /// Two edges; ends of all edges.
    EdgeEdge(&'a [[u32; 2]]),
}

/// The filter: positions of the vertices in single precision, relative to a vertex of the cloth.
#[derive(Clone, Debug)]
pub struct SeparationFilter {
    /// Positions at the start of the trajectories (m).
    from: Vec<Point>,
    /// Positions at the end (m); none where nothing moves.
    to: Option<Vec<Point>>,
    /// Pairs that come within this distance remain (m). Candidates may have a reach of their own instead.
    reach: f64,
    /// Largest coordinate (m), from which the rounding follows.
    farthest: f32,
}

impl SeparationFilter {
    /// Filter that keeps features within `reach` (m) of each other at positions `x`. It also discards edges that
    /// pass by each other, where the lines through them are nearest beyond the end of one.
    pub fn still(x: &[Vec3], reach: f64) -> Self {
        Self::new(x, None, reach)
    }

    /// Filter that keeps features that come within `reach` (m) of each other on trajectories on which all vertices
    /// move in step.
    pub fn together(from: &[Vec3], to: &[Vec3], reach: f64) -> Self {
        Self::new(from, Some(to), reach)
    }

    fn new(from: &[Vec3], to: Option<&[Vec3]>, reach: f64) -> Self {
        let origin = origin(from);
        let points = |x: &[Vec3]| -> Vec<Point> {
            let points = x.par_iter().with_min_len(4096).map(|x| {
                let p = x - origin;
                [p.x as f32, p.y as f32, p.z as f32, 0.0]
            });
            points.collect()
        };
        let (from, to) = (points(from), to.map(points));
        let ends = from.iter().chain(to.iter().flatten()).flatten();
        let farthest = ends.fold(0.0, |most: f32, end| most.max(end.abs()));
        Self {
            from,
            to,
            reach,
            farthest,
        }
    }

    /// Pairs that come within this distance remain (m).
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// Sets in `remaining` the bits of the pairs that are not separated, sixteen bits each. `reach` is that of each
    /// pair (m).
    fn filter(&self, kind: PairKind, hits: &[[u32; 2]], reach: &[f32], remaining: &mut Vec<u16>) {
        Arch::new().dispatch(FilterRun {
            filter: self,
            kind,
            hits,
            reach,
            remaining,
        });
    }
}

/// Candidate pairs of features, and working memory for the filter.
#[derive(Debug, Default)]
pub struct Candidates {
    /// The pairs.
    pub hits: Hits,
    /// Reach of every pair of a vertex and a face, and of every pair of two edges (m).
    reach: [Vec<f32>; 2],
    /// Bits of the pairs that the filter does not separate.
    remaining: Vec<u16>,
}

impl Candidates {
    /// Removes all pairs.
    pub fn clear(&mut self) {
        self.hits.clear();
        self.reach.iter_mut().for_each(Vec::clear);
    }

    /// Sets the reach of the pairs that were added since the last call (m).
    pub fn set_reach(&mut self, reach: f64) {
        let reach = (reach as f32).next_up();
        let hits = [&self.hits.vertex_face, &self.hits.edge_edge];
        for (list, hits) in self.reach.iter_mut().zip(hits) {
            list.resize(hits.len(), reach);
        }
    }

    /// Discards the pairs that a filter separates.
    pub fn discard(&mut self, filter: &SeparationFilter, cloth: &SurfaceView) {
        let [faces, edges] = &self.reach;
        let (hits, remaining) = (&mut self.hits, &mut self.remaining);
        let kind = PairKind::VertexFace(cloth.triangles);
        filter.filter(kind, &hits.vertex_face, faces, remaining);
        retain(&mut hits.vertex_face, remaining);
        let kind = PairKind::EdgeEdge(cloth.edges);
        filter.filter(kind, &hits.edge_edge, edges, remaining);
        retain(&mut hits.edge_edge, remaining);
    }
}

/// Removes the hits whose bits are not set.
fn retain(hits: &mut Vec<[u32; 2]>, remaining: &[u16]) {
    let mut count = 0;
    for (block, &bits) in remaining.iter().enumerate() {
        let mut bits = bits;
        while bits != 0 {
            hits[count] = hits[LANES * block + bits.trailing_zeros() as usize];
            count += 1;
            bits &= bits - 1;
        }
    }
    hits.truncate(count);
}

/// One run of the filter. It is a type so that it is compiled for the processor's vector instructions.
struct FilterRun<'a> {
    filter: &'a SeparationFilter,
    kind: PairKind<'a>,
    hits: &'a [[u32; 2]],
    reach: &'a [f32],
    remaining: &'a mut Vec<u16>,
}

impl WithSimd for FilterRun<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let rounding = ROUNDING * self.filter.farthest;
        self.remaining.clear();
        for (hits, reach) in self.hits.chunks(LANES).zip(self.reach.chunks(LANES)) {
            let mut distance = Row::splat(rounding);
            for (distance, reach) in distance.0.iter_mut().zip(reach) {
                *distance += reach;
            }
            let mut separated = Row::splat(0.0);
            match self.kind {
                PairKind::VertexFace(triangles) => {
                    let corners = vertex_face_corners(triangles, hits);
                    for lane_group in 0..lane_groups::<S>() {
                        let flags = (self.filter)
                            .separated_vertex_faces(simd, &corners, &distance, lane_group);
                        separated.set_lane_group(lane_group, flags);
                    }
                }
                PairKind::EdgeEdge(edges) => {
                    let corners = edge_edge_corners(edges, hits);
                    for lane_group in 0..lane_groups::<S>() {
                        let flags = self
                            .filter
                            .separated_edges(simd, &corners, &distance, lane_group);
                        separated.set_lane_group(lane_group, flags);
                    }
                }
            }
            let mut bits = 0u16;
            for lane in 0..LANES {
                bits |= u16::from(separated.0[lane] == 0.0) << lane;
            }
            self.remaining
                .push(bits & (u16::MAX >> (LANES - hits.len())));
        }
    }
}

/// Vertices of up to sixteen pairs of a vertex and a face.
#[inline(always)]
fn vertex_face_corners(triangles: &[[u32; 3]], hits: &[[u32; 2]]) -> [Corner; 4] {
    let mut corners = [Corner([0; LANES]); 4];
    for (lane, &[v, t]) in hits.iter().enumerate() {
        let [a, b, c] = triangles[t as usize];
        for (corner, v) in corners.iter_mut().zip([v, a, b, c]) {
            corner.0[lane] = v;
        }
    }
    corners
}

/// Vertices of up to sixteen pairs of edges.
#[inline(always)]
fn edge_edge_corners(edges: &[[u32; 2]], hits: &[[u32; 2]]) -> [Corner; 4] {
    let mut corners = [Corner([0; LANES]); 4];
    for (lane, &[e, f]) in hits.iter().enumerate() {
        let ([a, b], [c, d]) = (edges[e as usize], edges[f as usize]);
        for (corner, v) in corners.iter_mut().zip([a, b, c, d]) {
            corner.0[lane] = v;
        }
    }
    corners
}

/// Positions of the four vertices, in one vector of lanes of the sixteen.
#[inline(always)]
fn positions<S: Simd>(
    simd: S,
    points: &[Point],
    corners: &[Corner; 4],
    lane_group: usize,
) -> [Triple<F32s<S>>; 4] {
    let [a, b, c, d] = corners;
    [
        gather(simd, points, a, lane_group).0,
        gather(simd, points, b, lane_group).0,
        gather(simd, points, c, lane_group).0,
        gather(simd, points, d, lane_group).0,
    ]
}

impl SeparationFilter {
    /// 1 for a vertex and a face that are separated by more than `distance` (m), else 0.
    #[inline(always)]
    fn separated_vertex_faces<S: Simd>(
        &self,
        simd: S,
        corners: &[Corner; 4],
        distance: &Row,
        lane_group: usize,
    ) -> F32s<S> {
        let p = positions(simd, &self.from, corners, lane_group);
        let n = vertex_to_face(&p);
        let gap = distance.lane_group(simd, lane_group) * n.norm();
        let mut separated = face_is_beyond(&p, n, gap);
        if let Some(to) = &self.to {
            let p = positions(simd, to, corners, lane_group);
            separated = separated & face_is_beyond(&p, n, gap);
        }
        separated.flags()
    }

    /// 1 for two edges that are separated by more than `distance` (m) or, where nothing moves, pass by each other;
    /// else 0.
    #[inline(always)]
    fn separated_edges<S: Simd>(
        &self,
        simd: S,
        corners: &[Corner; 4],
        distance: &Row,
        lane_group: usize,
    ) -> F32s<S> {
        let p = positions(simd, &self.from, corners, lane_group);
        let (n, passing) = edge_to_edge(&p, self.farthest);
        let gap = distance.lane_group(simd, lane_group) * n.norm();
        let separated = edge_is_beyond(&p, n, gap);
        let discarded = match &self.to {
            Some(to) => {
                let p = positions(simd, to, corners, lane_group);
                separated & edge_is_beyond(&p, n, gap)
            }
            None => separated | passing,
        };
        discarded.flags()
    }
}

#[cfg(test)]
mod tests {
    use super::super::feature_pair::FeaturePair;
    use super::super::nearness::Nearness;
    use super::super::numbers::Numbers;
    use super::*;

    const FACE: [[u32; 3]; 1] = [[1, 2, 3]];
    const EDGES: [[u32; 2]; 2] = [[0, 1], [2, 3]];

    /// Whether the pair of four vertices remains, with vectors of any width.
    fn remains(filter: &SeparationFilter, edges: bool, reach: f64) -> bool {
        let (kind, hit) = match edges {
            true => (PairKind::EdgeEdge(&EDGES), [0, 1]),
            false => (PairKind::VertexFace(&FACE), [0, 0]),
        };
        let (hits, reach) = ([hit; 20], [reach as f32; 20]);
        let mut wide = Vec::new();
        filter.filter(kind, &hits, &reach, &mut wide);
        let mut scalar = Vec::new();
        let run = FilterRun {
            filter,
            kind,
            hits: &hits,
            reach: &reach,
            remaining: &mut scalar,
        };
        run.with_simd(pulp::Scalar);
        for bits in [&wide, &scalar] {
            assert!(matches!(bits[..], [0, 0] | [0xffff, 0xf]), "{bits:x?}");
        }
        wide[0] != 0 || scalar[0] != 0
    }

    fn pair(edges: bool) -> FeaturePair {
        match edges {
            true => FeaturePair::EdgeEdge([0, 1, 2, 3]),
            false => FeaturePair::VertexFace([0, 1, 2, 3]),
        }
    }

    /// Two features, slender and degenerate ones among them, somewhere in a cloth a hundred times as large.
    fn features(numbers: &mut Numbers, edges: bool) -> Vec<Vec3> {
        let thin = [1.0, 1e-3, 1e-6, 0.0][(4.0 * numbers.next()) as usize];
        let far = [1.0, 0.1, 1e-2, 1e-4][(4.0 * numbers.next()) as usize];
        let (middle, along, off) = (
            numbers.vector(50.0),
            numbers.vector(0.5),
            numbers.vector(far),
        );
        let mut p: Vec<Vec3> = (0..4)
            .map(|_| middle + along * numbers.next() + numbers.vector(thin))
            .collect();
        let first = if edges { 2 } else { 1 };
        p[..first].iter_mut().for_each(|p| *p += off);
        p
    }

    #[test]
    fn pairs_within_reach_remain() {
        let mut numbers = Numbers(1);
        let mut discarded = [0; 4];
        for k in 0..20_000 {
            let (edges, moving) = (k % 2 == 0, k % 4 < 2);
            let from = features(&mut numbers, edges);
            let pace = numbers.between(0.0, 0.3);
            let common = numbers.vector(3.0);
            let to: Vec<Vec3> = (from.iter())
                .map(|x| x + common + numbers.vector(pace))
                .collect();
            let at = |time: f64| -> Vec<Vec3> {
                let both = from.iter().zip(&to);
                both.map(|(from, to)| from + (to - from) * time).collect()
            };
            let steps = if moving { 32 } else { 0 };
            let least = (0..=steps)
                .map(|k| Nearness::distance(pair(edges), &at(f64::from(k) / 32.0)))
                .fold(f64::INFINITY, f64::min);
            for share in [0.5, 0.9, 1.000_001] {
                let reach = share * least;
                let filter = match moving {
                    true => SeparationFilter::together(&from, &to, reach),
                    false => SeparationFilter::still(&from, reach),
                };
                let remains = remains(&filter, edges, reach);
                let is_candidate =
                    moving || !edges || Nearness::measure(pair(edges), &from, reach).is_some();
                assert!(
                    remains || share < 1.0 || !is_candidate,
                    "{k} {least} {from:?} {to:?}"
                );
                if share == 0.5 {
                    discarded[k % 4] += usize::from(!remains);
                }
            }
        }
        assert!(discarded.iter().all(|&count| count > 2500), "{discarded:?}");
    }

    #[test]
    fn pairs_with_a_coordinate_that_is_not_finite_remain() {
        let mut numbers = Numbers(2);
        for k in 0..400 {
            let (edges, at) = (k % 2 == 0, k / 2 % 8);
            let from = features(&mut numbers, edges);
            let to: Vec<Vec3> = from.iter().map(|x| x + Vec3::x()).collect();
            let invalid = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY][k % 3];
            let spoiled = |positions: &[Vec3], at: usize| {
                let mut positions = positions.to_vec();
                positions
                    .iter_mut()
                    .skip(at)
                    .take(1)
                    .for_each(|p| p.y = invalid);
                positions
            };
            let [first, last] = [spoiled(&from, at), spoiled(&to, at.wrapping_sub(4))];
            let filter = SeparationFilter::together(&first, &last, 1e-6);
            assert!(remains(&filter, edges, 1e-6), "{k} {first:?} {last:?}");
        }
    }
}
