//! Discards pairs of features that a direction separates along their whole trajectories, sixteen at a time, in
//! single precision with its rounding allowed for.
//!
//! A direction n separates two features where every corner b_j of one lies beyond every corner a_i of the
//! other along it. Corners that move straight do so all the way if they do at its beginning and its end:
//! ```text
//! min_j n . b_j - max_i n . a_i > (reach + error) |n|
//! ```
//! Any n serves, so it need not be known well: it is taken between the closest points where the trajectories
//! begin. Pairs that are not separated, those with a NaN among them, are left to be measured.

use super::apart::{ROUNDING, edge_is_beyond, face_is_beyond, to_edge, to_face};
use super::leaf_aabbs::{Hits, origin};
use super::surface_view::SurfaceView;
use crate::lanes::{Corner, LANES, Point, Row, Triple, dot, gather, parts};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use toile_geometry::Vec3;

/// Which features a pair is of.
#[derive(Clone, Copy, Debug)]
enum Filtered<'a> {
    /// Vertices against faces, whose corners these are.
    VertexFace(&'a [[u32; 3]]),
    /// Edges against edges, whose ends these are.
    EdgeEdge(&'a [[u32; 2]]),
}

/// Places of the cloth in single precision.
#[derive(Clone, Debug)]
pub struct SeparationFilter {
    from: Vec<Point>,
    /// Where the trajectories end; none where nothing moves.
    to: Option<Vec<Point>>,
    /// Pairs that come within this are left [m], where their list says nothing else.
    reach: f64,
    /// Largest coordinate [m].
    farthest: f32,
}

impl SeparationFilter {
    /// For features within `reach` [m] of each other. Also discards edges that pass by each other: the lines
    /// through them are nearest beyond the end of one.
    pub fn still(x: &[Vec3], reach: f64) -> Self {
        Self::new(x, None, reach)
    }

    /// For features that come within `reach` [m] on their trajectories, all at one pace.
    pub fn together(from: &[Vec3], to: &[Vec3], reach: f64) -> Self {
        Self::new(from, Some(to), reach)
    }

    fn new(from: &[Vec3], to: Option<&[Vec3]>, reach: f64) -> Self {
        let origin = origin(from);
        let points = |x: &[Vec3]| -> Vec<Point> {
            let points = x.par_iter().with_min_len(4096).map(|x| {
                let place = x - origin;
                [place.x as f32, place.y as f32, place.z as f32, 0.0]
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

    /// Pairs that come within this are left [m].
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// Which pairs may come within their reach [m], as bits for every sixteen of them.
    fn filter(&self, features: Filtered, hits: &[[u32; 2]], reach: &[f32], left: &mut Vec<u16>) {
        Arch::new().dispatch(Filter {
            filter: self,
            features,
            hits,
            reach,
            left,
        });
    }
}

/// Candidate pairs of features found in some pairs of leaves.
#[derive(Debug, Default)]
pub struct Candidates {
    /// The features.
    pub hits: Hits,
    /// Reach of each pair of a vertex and a face, and of each of two edges [m].
    reach: [Vec<f32>; 2],
    left: Vec<u16>,
}

impl Candidates {
    /// Empties it.
    pub fn clear(&mut self) {
        self.hits.clear();
        self.reach.iter_mut().for_each(Vec::clear);
    }

    /// Sets the reach of the pairs added since it was set last [m].
    pub fn come_within(&mut self, reach: f64) {
        let reach = (reach as f32).next_up();
        let hits = [&self.hits.vertex_face, &self.hits.edge_edge];
        for (list, hits) in self.reach.iter_mut().zip(hits) {
            list.resize(hits.len(), reach);
        }
    }

    /// Discards the pairs that a filter separates.
    pub fn discard(&mut self, filter: &SeparationFilter, cloth: &SurfaceView) {
        let [faces, edges] = &self.reach;
        let features = Filtered::VertexFace(cloth.triangles);
        filter.filter(features, &self.hits.vertex_face, faces, &mut self.left);
        keep(&mut self.hits.vertex_face, &self.left);
        let features = Filtered::EdgeEdge(cloth.edges);
        filter.filter(features, &self.hits.edge_edge, edges, &mut self.left);
        keep(&mut self.hits.edge_edge, &self.left);
    }
}

/// Keeps the hits whose bits are set.
fn keep(hits: &mut Vec<[u32; 2]>, left: &[u16]) {
    let mut count = 0;
    for (block, &bits) in left.iter().enumerate() {
        let mut bits = bits;
        while bits != 0 {
            hits[count] = hits[LANES * block + bits.trailing_zeros() as usize];
            count += 1;
            bits &= bits - 1;
        }
    }
    hits.truncate(count);
}

/// A filtering. A type of its own, to be compiled for the processor's vectors.
struct Filter<'a> {
    filter: &'a SeparationFilter,
    features: Filtered<'a>,
    hits: &'a [[u32; 2]],
    reach: &'a [f32],
    left: &'a mut Vec<u16>,
}

impl WithSimd for Filter<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let rounding = ROUNDING * self.filter.farthest;
        self.left.clear();
        for (hits, reach) in self.hits.chunks(LANES).zip(self.reach.chunks(LANES)) {
            let mut room = Row::splat(rounding);
            for (room, reach) in room.0.iter_mut().zip(reach) {
                *room += reach;
            }
            let mut apart = Row::splat(0.0);
            match self.features {
                Filtered::VertexFace(triangles) => {
                    let corners = of_faces(triangles, hits);
                    for part in 0..parts::<S>() {
                        let told = self.filter.vertices_and_faces(simd, &corners, &room, part);
                        apart.set_part::<S>(part, told);
                    }
                }
                Filtered::EdgeEdge(edges) => {
                    let corners = of_edges(edges, hits);
                    for part in 0..parts::<S>() {
                        let told = self.filter.edges(simd, &corners, &room, part);
                        apart.set_part::<S>(part, told);
                    }
                }
            }
            let mut bits = 0u16;
            for lane in 0..LANES {
                bits |= u16::from(apart.0[lane] == 0.0) << lane;
            }
            self.left.push(bits & (u16::MAX >> (LANES - hits.len())));
        }
    }
}

/// The vertices of sixteen hits or fewer.
#[inline(always)]
fn of_faces(triangles: &[[u32; 3]], hits: &[[u32; 2]]) -> [Corner; 4] {
    let mut corners = [Corner([0; LANES]); 4];
    for (lane, &[v, t]) in hits.iter().enumerate() {
        let [a, b, c] = triangles[t as usize];
        for (corner, v) in corners.iter_mut().zip([v, a, b, c]) {
            corner.0[lane] = v;
        }
    }
    corners
}

/// The same of edges.
#[inline(always)]
fn of_edges(edges: &[[u32; 2]], hits: &[[u32; 2]]) -> [Corner; 4] {
    let mut corners = [Corner([0; LANES]); 4];
    for (lane, &[e, f]) in hits.iter().enumerate() {
        let ([a, b], [c, d]) = (edges[e as usize], edges[f as usize]);
        for (corner, v) in corners.iter_mut().zip([a, b, c, d]) {
            corner.0[lane] = v;
        }
    }
    corners
}

/// The places of the four vertices.
#[inline(always)]
fn places<S: Simd>(
    simd: S,
    points: &[Point],
    corners: &[Corner; 4],
    part: usize,
) -> [Triple<S::f32s>; 4] {
    let [a, b, c, d] = corners;
    [
        place(gather(simd, points, a, part)),
        place(gather(simd, points, b, part)),
        place(gather(simd, points, c, part)),
        place(gather(simd, points, d, part)),
    ]
}

#[inline(always)]
fn place<F>([x, y, z, _]: [F; 4]) -> Triple<F> {
    [x, y, z]
}

/// One where a mask is set, else zero.
#[inline(always)]
fn flag<S: Simd>(simd: S, mask: S::m32s) -> S::f32s {
    simd.select_f32s(mask, simd.splat_f32s(1.0), simd.splat_f32s(0.0))
}

impl SeparationFilter {
    /// One where a vertex and a face are separated.
    #[inline(always)]
    fn vertices_and_faces<S: Simd>(
        &self,
        simd: S,
        corners: &[Corner; 4],
        room: &Row,
        part: usize,
    ) -> S::f32s {
        let p = places(simd, &self.from, corners, part);
        let n = to_face(simd, &p);
        let far = simd.mul_f32s(room.part::<S>(part), simd.sqrt_f32s(dot(simd, n, n)));
        let mut apart = face_is_beyond(simd, &p, n, far);
        if let Some(to) = &self.to {
            let p = places(simd, to, corners, part);
            apart = simd.and_m32s(apart, face_is_beyond(simd, &p, n, far));
        }
        flag(simd, apart)
    }

    /// One where two edges are separated, or pass by each other where nothing moves.
    #[inline(always)]
    fn edges<S: Simd>(&self, simd: S, corners: &[Corner; 4], room: &Row, part: usize) -> S::f32s {
        let p = places(simd, &self.from, corners, part);
        let (n, passing) = to_edge(simd, &p, self.farthest);
        let far = simd.mul_f32s(room.part::<S>(part), simd.sqrt_f32s(dot(simd, n, n)));
        let apart = edge_is_beyond(simd, &p, n, far);
        let told = match &self.to {
            Some(to) => {
                let p = places(simd, to, corners, part);
                simd.and_m32s(apart, edge_is_beyond(simd, &p, n, far))
            }
            None => simd.or_m32s(apart, passing),
        };
        flag(simd, told)
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

    /// Whether a filter leaves the features of four vertices, at any width of vectors.
    fn leaves(filter: &SeparationFilter, edges: bool, reach: f64) -> bool {
        let (features, hit) = match edges {
            true => (Filtered::EdgeEdge(&EDGES), [0, 1]),
            false => (Filtered::VertexFace(&FACE), [0, 0]),
        };
        let (hits, reach) = ([hit; 20], [reach as f32; 20]);
        let mut left = Vec::new();
        filter.filter(features, &hits, &reach, &mut left);
        let mut narrow = Vec::new();
        let narrowed = Filter {
            filter,
            features,
            hits: &hits,
            reach: &reach,
            left: &mut narrow,
        };
        narrowed.with_simd(pulp::Scalar);
        for left in [&left, &narrow] {
            assert!(matches!(left[..], [0, 0] | [0xffff, 0xf]), "{left:x?}");
        }
        left[0] != 0 || narrow[0] != 0
    }

    fn pair(edges: bool) -> FeaturePair {
        match edges {
            true => FeaturePair::EdgeEdge([0, 1, 2, 3]),
            false => FeaturePair::VertexFace([0, 1, 2, 3]),
        }
    }

    /// Four vertices, shapes of all kinds among them, somewhere in a cloth a hundred times as large.
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
    fn what_comes_within_reach_is_left() {
        let mut numbers = Numbers(1);
        let mut told = [0; 4];
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
                let left = leaves(&filter, edges, reach);
                let counts =
                    moving || !edges || Nearness::measure(pair(edges), &from, reach).is_some();
                assert!(
                    left || share < 1.0 || !counts,
                    "{k} {least} {from:?} {to:?}"
                );
                if share == 0.5 {
                    told[k % 4] += usize::from(!left);
                }
            }
        }
        assert!(told.iter().all(|&told| told > 2500), "{told:?}");
    }

    #[test]
    fn what_is_no_number_is_left() {
        let mut numbers = Numbers(2);
        for k in 0..400 {
            let (edges, at) = (k % 2 == 0, k / 2 % 8);
            let from = features(&mut numbers, edges);
            let to: Vec<Vec3> = from.iter().map(|x| x + Vec3::x()).collect();
            let none = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY][k % 3];
            let spoiled = |places: &[Vec3], at: usize| {
                let mut places = places.to_vec();
                places.iter_mut().skip(at).take(1).for_each(|p| p.y = none);
                places
            };
            let [first, last] = [spoiled(&from, at), spoiled(&to, at.wrapping_sub(4))];
            let filter = SeparationFilter::together(&first, &last, 1e-6);
            assert!(leaves(&filter, edges, 1e-6), "{k} {first:?} {last:?}");
        }
    }
}
