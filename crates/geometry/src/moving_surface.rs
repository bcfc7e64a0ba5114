//! A surface whose vertices move on straight lines within a step of time: the closest point at any time of it.

use crate::swept_tree::SweptTree;
use crate::tree::{ClosestPoint, weighted};
use crate::{Feature, TriangleMesh, Vec3, closest_point_on_triangle, triangles_intersect};
use std::sync::{Arc, OnceLock};

/// Triangles that keep their vertices, and which of them meet at each vertex.
struct Connectivity {
    triangles: Vec<[u32; 3]>,
    /// Where the triangles of each vertex begin in `around`; one entry more than there are vertices.
    first: Vec<u32>,
    around: Vec<u32>,
    /// The triangle across each side of each triangle, or [`NONE`] on a rim.
    across: Vec<[u32; 3]>,
    is_closed: bool,
}

/// In place of a triangle's number: there is none.
const NONE: u32 = u32::MAX;

impl Connectivity {
    fn new(mesh: &TriangleMesh) -> Self {
        let mut first = vec![0; mesh.positions.len() + 1];
        for &v in mesh.triangles.iter().flatten() {
            first[v as usize + 1] += 1;
        }
        for v in 1..first.len() {
            first[v] += first[v - 1];
        }
        let mut next = first.clone();
        let mut around = vec![0; 3 * mesh.triangles.len()];
        for (t, triangle) in mesh.triangles.iter().enumerate() {
            for &v in triangle {
                around[next[v as usize] as usize] = t as u32;
                next[v as usize] += 1;
            }
        }
        let is_closed = mesh.topology().boundary().next().is_none();
        let mut all = Self {
            triangles: mesh.triangles.clone(),
            first,
            around,
            across: Vec::new(),
            is_closed,
        };
        let across = |t: usize| [0, 1, 2].map(|side| all.find_across(t as u32, side));
        all.across = (0..all.triangles.len()).map(across).collect();
        all
    }

    /// The lowest other triangle that has both ends of a side, or [`NONE`].
    fn find_across(&self, triangle: u32, side: usize) -> u32 {
        let own = self.triangles[triangle as usize];
        let (from, to) = (own[side], own[(side + 1) % 3]);
        let has_both = |&&t: &&u32| t != triangle && self.triangles[t as usize].contains(&to);
        self.around(from)
            .iter()
            .find(has_both)
            .copied()
            .unwrap_or(NONE)
    }

    fn around(&self, vertex: u32) -> &[u32] {
        let [from, to] = [vertex as usize, vertex as usize + 1].map(|v| self.first[v] as usize);
        &self.around[from..to]
    }
}

/// A surface in a step of time, at whose start and end the places of its vertices are given; between they move
/// straight on. Times are shares of the step, 0 at its start and 1 at its end.
///
/// The boxes of its tree hold their triangles through the whole step. The tree is built once and refitted for
/// each step, and of points that are equally close the one on the lowest triangle is taken, so that an answer
/// depends on the step alone and not on those before it.
#[derive(Clone)]
pub struct MovingSurface {
    connectivity: Arc<Connectivity>,
    starts: Vec<Vec3>,
    ends: Vec<Vec3>,
    tree: SweptTree,
    /// Unit normals of the triangles at the start of the step, once they were asked for.
    start_normals: OnceLock<Vec<Vec3>>,
}

impl MovingSurface {
    /// A surface at rest, of a mesh whose indices are valid ([`TriangleMesh::check`]).
    pub fn new(mesh: &TriangleMesh) -> Self {
        Self {
            connectivity: Arc::new(Connectivity::new(mesh)),
            starts: mesh.positions.clone(),
            ends: mesh.positions.clone(),
            tree: SweptTree::new(mesh),
            start_normals: OnceLock::new(),
        }
    }

    /// Begins a step from some places of the vertices to others (m).
    ///
    /// # Panics
    /// Where there are not as many places as vertices.
    pub fn set_step(&mut self, starts: &[Vec3], ends: &[Vec3]) {
        assert_eq!(starts.len(), self.starts.len(), "places at the start");
        assert_eq!(ends.len(), self.ends.len(), "places at the end");
        self.starts.copy_from_slice(starts);
        self.ends.copy_from_slice(ends);
        self.start_normals.take();
        self.tree
            .refit(&self.connectivity.triangles, [&self.starts, &self.ends]);
    }

    /// The corners of each triangle, as indices of vertices.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.connectivity.triangles
    }

    /// Whether it has no rim, so that it has an inside.
    pub fn is_closed(&self) -> bool {
        self.connectivity.is_closed
    }

    /// Places of the vertices at the start of the step (m).
    pub fn starts(&self) -> &[Vec3] {
        &self.starts
    }

    /// Places of the vertices at the end of the step (m).
    pub fn ends(&self) -> &[Vec3] {
        &self.ends
    }

    /// Length of the longest side of a triangle at the start of the step (m).
    pub fn longest_side(&self) -> f64 {
        let place = |v: u32| self.starts[v as usize];
        let sides = (self.connectivity.triangles.iter())
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .map(|[a, b]| (place(b) - place(a)).norm_squared());
        sides.fold(0.0, f64::max).sqrt()
    }

    /// A vertex at a time of the step (m).
    pub fn vertex(&self, vertex: u32, time: f64) -> Vec3 {
        let (start, end) = (self.starts[vertex as usize], self.ends[vertex as usize]);
        match time {
            1.0 => end,
            _ => start + (end - start) * time,
        }
    }

    /// The corners of a triangle at a time of the step (m).
    pub fn corners(&self, triangle: u32, time: f64) -> [Vec3; 3] {
        self.connectivity.triangles[triangle as usize].map(|v| self.vertex(v, time))
    }

    /// How a point of a triangle, given by its barycentric weights, is moved between two times of the step (m).
    pub fn displacement(&self, triangle: u32, weights: [f64; 3], times: [f64; 2]) -> Vec3 {
        let [from, to] = times.map(|time| weighted(self.corners(triangle, time), weights));
        to - from
    }

    /// The closest point at a time of the step, no farther than `reach` (m); none for a point that is not finite.
    /// Its side is told by the pseudo-normal of the closest feature (Baerentzen and Aanaes 2005), exact where
    /// the surface is closed and does not cross itself. A triangle that is likely to be near makes it faster
    /// and changes nothing else.
    pub fn closest_point(
        &self,
        point: Vec3,
        time: f64,
        reach: f64,
        likely: Option<u32>,
    ) -> Option<ClosestPoint> {
        if !point.iter().all(|x| x.is_finite()) {
            return None;
        }
        let distance2 = |triangle| {
            self.away_from_triangle(triangle, point, time)
                .norm_squared()
        };
        let triangle = self.tree.closest(point, reach, likely, distance2)?;
        Some(self.closest_on(triangle, point, time))
    }

    /// A distance that no point of the surface comes nearer than at any time of the step, at most `reach` (m).
    pub fn clearance(&self, point: Vec3, reach: f64) -> f64 {
        self.tree.clearance(point, reach)
    }

    /// The closest point of one triangle at a time of the step.
    pub fn closest_on(&self, triangle: u32, point: Vec3, time: f64) -> ClosestPoint {
        let corners = self.corners(triangle, time);
        let (weights, feature) = closest_point_on_triangle(point, corners);
        let normal = self.pseudo_normal(triangle, feature, time);
        ClosestPoint::of(point, (triangle, corners, weights), normal)
    }

    /// A vertex at a time of the step as a place of one of its triangles, with its pseudo-normal; none on no triangle.
    pub fn at_vertex(&self, vertex: u32, time: f64) -> Option<ClosestPoint> {
        let &triangle = self.connectivity.around(vertex).first()?;
        let corners = self.connectivity.triangles[triangle as usize];
        let k = corners.iter().position(|&v| v == vertex)?;
        let normal = self.pseudo_normal(triangle, Feature::Corner(k), time);
        let mut weights = [0.0; 3];
        weights[k] = 1.0;
        let here = (triangle, self.corners(triangle, time), weights);
        Some(ClosestPoint::of(self.vertex(vertex, time), here, normal))
    }

    /// Whether a side of a triangle is told of by this triangle: each edge has one that tells of it.
    pub fn tells_of(&self, triangle: u32, side: usize) -> bool {
        triangle < self.connectivity.across[triangle as usize][side]
    }

    /// Unit normals of all triangles at the start of the step, zero of those without area; they are found once a step.
    fn start_normals(&self) -> &[Vec3] {
        let all = 0..self.connectivity.triangles.len() as u32;
        self.start_normals.get_or_init(|| {
            all.map(|triangle| self.face_normal(triangle, 0.0))
                .collect()
        })
    }

    /// Unit normals at the start of the step of a triangle and of the one across a side of it; none on a rim. The edge is
    /// convex where their cross product points along the side.
    pub fn normals_at_side(&self, triangle: u32, side: usize) -> Option<[Vec3; 2]> {
        let across = self.connectivity.across[triangle as usize][side];
        let normals = || [triangle, across].map(|t| self.start_normals()[t as usize]);
        (across != NONE).then(normals)
    }

    /// A place of a triangle at a time of the step, with a unit normal.
    pub fn place(&self, triangle: u32, weights: [f64; 3], normal: Vec3, time: f64) -> ClosestPoint {
        let corners = self.corners(triangle, time);
        let here = weighted(corners, weights);
        ClosestPoint::of(here, (triangle, corners, weights), normal)
    }

    /// Unit pseudo-normal of a feature of a triangle at a time of the step; zero where the triangles that meet there
    /// have no area.
    fn pseudo_normal(&self, triangle: u32, feature: Feature, time: f64) -> Vec3 {
        let corners_of = |t: u32| self.connectivity.triangles[t as usize];
        let own = corners_of(triangle);
        let sum: Vec3 = match feature {
            Feature::Face => self.face_normal(triangle, time),
            Feature::Edge(k) => {
                let (from, to) = (own[k], own[(k + 1) % 3]);
                let around = self.connectivity.around(from).iter();
                around
                    .filter(|&&t| corners_of(t).contains(&to))
                    .map(|&t| self.face_normal(t, time))
                    .sum()
            }
            Feature::Corner(k) => {
                let around = self.connectivity.around(own[k]).iter();
                around
                    .map(|&t| {
                        let at = corners_of(t).iter().position(|&v| v == own[k]).unwrap_or(0);
                        let corners = self.corners(t, time);
                        let u = corners[(at + 1) % 3] - corners[at];
                        let v = corners[(at + 2) % 3] - corners[at];
                        self.face_normal(t, time) * u.angle(&v)
                    })
                    .sum()
            }
        };
        sum.try_normalize(0.0).unwrap_or_default()
    }

    /// From the closest point of a triangle at a time of the step to a point (m).
    pub(crate) fn away_from_triangle(&self, triangle: u32, point: Vec3, time: f64) -> Vec3 {
        let corners = self.corners(triangle, time);
        let (weights, _) = closest_point_on_triangle(point, corners);
        point - weighted(corners, weights)
    }

    /// The triangle of the least squared distance from a point, among those within `reach` (m) of it.
    pub(crate) fn closest_by(
        &self,
        point: Vec3,
        reach: f64,
        distance2: impl Fn(u32) -> f64,
    ) -> Option<u32> {
        self.tree.closest(point, reach, None, distance2)
    }

    pub(crate) fn face_normal(&self, triangle: u32, time: f64) -> Vec3 {
        let [a, b, c] = self.corners(triangle, time);
        let across = (b - a).cross(&(c - a));
        across.try_normalize(0.0).unwrap_or_default()
    }

    /// Triangles that come within `margin` (m) of the box from `low` to `high` (m) at some time of the step, or may.
    pub fn near_box(&self, low: Vec3, high: Vec3, margin: f64, found: impl FnMut(u32)) {
        let margin = Vec3::repeat(margin);
        self.tree.near_box([low - margin, high + margin], found);
    }

    /// Pairs (triangle of `other`, triangle of this surface at the end of the step) that intersect, exactly, sorted.
    pub fn intersections_with(&self, other: &TriangleMesh) -> Vec<[u32; 2]> {
        let mut pairs = Vec::new();
        for t in 0..other.triangles.len() {
            let corners = other.corners(t);
            let low = corners[0].inf(&corners[1]).inf(&corners[2]);
            let high = corners[0].sup(&corners[1]).sup(&corners[2]);
            self.near_box(low, high, 0.0, |near| {
                if triangles_intersect(corners, self.corners(near, 1.0)) {
                    pairs.push([t as u32, near]);
                }
            });
        }
        pairs.sort_unstable();
        pairs
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SurfaceTree;
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    const ROUND: usize = 24;
    const ACROSS: usize = 12;

    /// A ring of thickness `tube`, every vertex moved by `moved` (m).
    fn ring(tube: f64, moved: impl Fn(Vec3) -> Vec3) -> TriangleMesh {
        let at = |i: usize, j: usize| ((i % ROUND) * ACROSS + j % ACROSS) as u32;
        let mut mesh = TriangleMesh::default();
        for i in 0..ROUND {
            for j in 0..ACROSS {
                let (u, v) = (
                    i as f64 / ROUND as f64 * TAU,
                    j as f64 / ACROSS as f64 * TAU,
                );
                let out = 1.0 + tube * v.cos();
                let place = Vec3::new(out * u.cos(), tube * v.sin(), out * u.sin());
                mesh.positions.push(place + moved(place));
                let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
                mesh.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        mesh
    }

    fn wave(size: f64, phase: f64) -> impl Fn(Vec3) -> Vec3 {
        move |p| {
            let turn = |k: f64| (3.0 * p.x + k * p.z + phase * k).sin();
            Vec3::new(turn(1.0), turn(2.0), turn(3.0)) * size
        }
    }

    fn places(seed: u64) -> impl Iterator<Item = Vec3> {
        (0..40).map(move |k| {
            let s = (seed % 1000) as f64 + f64::from(k);
            Vec3::new((s * 0.731).sin(), 0.4 * (s * 1.37).sin(), (s * 2.11).sin()) * 1.6
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]
        #[test]
        fn the_closest_point_is_that_of_the_surface_as_it_lies_then(
            seed in 0_u64..1000, time in prop::sample::select(vec![0.0, 0.3, 0.77, 1.0]),
            open in any::<bool>(),
        ) {
            let phase = seed as f64 * 0.37;
            let mut from = ring(0.3, wave(0.04, phase));
            let mut to = ring(0.3, wave(0.05, phase + 1.0));
            if open {
                from.triangles.truncate(350);
                to.triangles.truncate(350);
            }
            let mut surface = MovingSurface::new(&ring(0.3, |_| Vec3::zeros()));
            if open {
                surface = MovingSurface::new(&from);
            }
            prop_assert_eq!(surface.is_closed(), !open);
            // Steps that came before change nothing.
            surface.set_step(&to.positions, &from.positions);
            surface.set_step(&from.positions, &to.positions);
            let now = TriangleMesh {
                positions: (0..from.positions.len() as u32).map(|v| surface.vertex(v, time)).collect(),
                triangles: from.triangles.clone(),
            };
            let brute = |point: Vec3| {
                let distance = |t: usize| {
                    let corners = now.corners(t);
                    let (weights, _) = closest_point_on_triangle(point, corners);
                    (weighted(corners, weights) - point).norm()
                };
                (0..now.triangles.len()).map(distance).fold(f64::INFINITY, f64::min)
            };
            let tree = SurfaceTree::new(now.clone());
            for (k, point) in places(seed).enumerate() {
                let found = surface.closest_point(point, time, f64::INFINITY, None).unwrap();
                prop_assert!((found.signed_distance.abs() - brute(point)).abs() < 1e-12);
                let other = tree.closest_point(point, f64::INFINITY).unwrap();
                prop_assert_eq!(found.signed_distance < 0.0, other.signed_distance < 0.0);
                let likely = Some((k * 13 % now.triangles.len()) as u32);
                prop_assert_eq!(surface.closest_point(point, time, f64::INFINITY, likely), Some(found));
                let distance = found.signed_distance.abs();
                prop_assert!(surface.clearance(point, 9.0) <= distance);
                prop_assert_eq!(surface.clearance(point, 1e-3), surface.clearance(point, 9.0).min(1e-3));
                // It is within reach only if it is.
                prop_assert!(surface.closest_point(point, time, 0.99 * distance, likely).is_none());
                prop_assert!(surface.closest_point(point, time, 1.01 * distance, None).is_some());
            }
            if time == 1.0 {
                let cloth = ring(0.32, wave(0.06, phase + 2.0));
                prop_assert_eq!(surface.intersections_with(&cloth), tree.intersections_with(&cloth));
            }
        }
    }

    #[test]
    fn of_equally_close_triangles_the_lowest_is_taken_wherever_the_search_begins() {
        let cube = TriangleMesh::cuboid(Vec3::repeat(-1.0), Vec3::repeat(1.0));
        let surface = MovingSurface::new(&cube);
        let corner = Vec3::repeat(2.0);
        let meet = |t: &u32| cube.corners(*t as usize).contains(&Vec3::repeat(1.0));
        let lowest = (0..12).find(meet);
        for likely in (0..12).map(Some).chain([None]) {
            let found = surface.closest_point(corner, 0.5, 9.0, likely).unwrap();
            assert_eq!(Some(found.triangle), lowest);
            assert!((found.signed_distance - 3.0_f64.sqrt()).abs() < 1e-12);
        }
    }

    #[test]
    fn points_of_the_surface_go_with_it_and_what_is_no_number_has_no_closest_point() {
        let cube = TriangleMesh::cuboid(Vec3::zeros(), Vec3::repeat(1.0));
        let mut surface = MovingSurface::new(&cube);
        let by = Vec3::new(0.1, -0.2, 0.3);
        let ends: Vec<Vec3> = cube.positions.iter().map(|p| p + by).collect();
        surface.set_step(&cube.positions, &ends);
        let moved = surface.displacement(3, [0.2, 0.3, 0.5], [0.25, 0.75]);
        assert!((moved - 0.5 * by).norm() < 1e-15);
        let nowhere = Vec3::new(0.0, f64::NAN, 0.0);
        assert!(surface.closest_point(nowhere, 0.0, 1.0, Some(0)).is_none());
        let nothing = MovingSurface::new(&TriangleMesh::default());
        assert!(nothing.closest_point(by, 0.0, 1.0, None).is_none());
    }
}
