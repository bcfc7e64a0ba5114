//! Estimates of the derivative across each edge of a sheet at rest, as linear combinations of the vertices around the
//! edge: see [`super::bending`].

use nalgebra::{Matrix6, SVector, Vector6};
use toile_geometry::{Topology, Vec2};

/// A sheet of triangles at rest, each flat in its own material plane (warp along the first axis).
pub struct RestSheet<'a> {
    /// Corners of the triangles.
    pub triangles: &'a [[u32; 3]],
    /// Position of each corner in the material plane (m).
    pub rest: &'a [[Vec2; 3]],
    /// Edges of the triangles.
    pub topology: &'a Topology,
}

/// A triangle whose curvature cannot be estimated from given rings: its neighbours lie close to a conic or to a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IllConditioned {
    /// The triangle.
    pub triangle: usize,
}

/// The derivative across an edge at its midpoint, outwards from the edge's first triangle, as a linear combination of
/// vertex positions.
pub(super) struct Across {
    /// The triangle it points out of.
    pub first: u32,
    pub vertices: Vec<u32>,
    /// (1/m)
    pub weights: Vec<f64>,
    /// Rings of neighbours in the estimate.
    pub rings: u8,
}

/// Largest trace of the inverse of the scaled normal matrix of a fit: beyond it the vertices lie
/// close to a conic, and another ring is added.
const MAX_INVERSE: f64 = 1e3;

/// Most rings of neighbours; without a good fit the estimate uses the two triangles of the edge only.
const MAX_RINGS: u8 = 3;

impl RestSheet<'_> {
    /// The estimate of the derivative across an edge between two triangles, with a given number of rings, or with the
    /// least number that is well conditioned. None at a free edge, at an edge of more than two triangles, and where the
    /// given number is ill-conditioned.
    pub(super) fn across(&self, edge: usize, given_rings: Option<u8>) -> Option<Across> {
        let [first, second] = self.topology.edge_triangles[edge][..] else {
            return None;
        };
        let rest = self.rest[first as usize];
        let k = self.edge_of(first, edge)?;
        let [a, b] = [rest[k], rest[(k + 1) % 3]];
        let n = outward(rest, k).try_normalize(0.0)?;
        let mut visited = vec![first, second];
        let ends = [0, 1].map(|i| self.triangles[first as usize][(k + i) % 3]);
        let unfolded = self.unfold(second, ends, [a, b], rest[(k + 2) % 3])?;
        let middle = (a + b) * 0.5;
        let mut points: Vec<(u32, Vec2)> = Vec::with_capacity(12);
        let mut front = vec![(first, rest), (second, unfolded)];
        collect(self.triangles, &front, &mut points);
        let scale = {
            let square: f64 = points
                .iter()
                .map(|(_, p)| (p - middle).norm_squared())
                .sum();
            (square / points.len() as f64).sqrt()
        };
        let start = self.blend([first, second], [rest, unfolded], edge, n)?;
        let start: Vec<f64> = points
            .iter()
            .map(|&(v, _)| start.iter().filter(|s| s.0 == v).map(|s| s.1 * scale).sum())
            .collect();
        let mut weights = start.clone();
        let mut rings = 0;
        for ring in 1..=given_rings.unwrap_or(MAX_RINGS) {
            front = self.next_ring(&front, &mut visited);
            collect(self.triangles, &front, &mut points);
            if given_rings.is_some_and(|given_rings| ring < given_rings) {
                continue;
            }
            let scaled: Vec<Vec2> = points.iter().map(|(_, p)| (p - middle) / scale).collect();
            if let Some(corrected) = correct(&scaled, &start, n) {
                weights = corrected;
                rings = ring;
                break;
            }
            if front.is_empty() {
                break;
            }
        }
        if given_rings.is_some_and(|given_rings| rings != given_rings) {
            return None;
        }
        points.truncate(weights.len());
        Some(Across {
            rings,
            first,
            vertices: points.iter().map(|p| p.0).collect(),
            weights: weights.iter().map(|w| w / scale).collect(),
        })
    }

    /// Index in a triangle of an edge of the mesh.
    fn edge_of(&self, triangle: u32, edge: usize) -> Option<usize> {
        let edges = self.topology.triangle_edges[triangle as usize];
        edges.iter().position(|&other| other as usize == edge)
    }

    /// The mean of the two triangles' derivatives along `n`, weighted by their heights over the edge, so that the
    /// weights of a sliver are bounded.
    fn blend(
        &self,
        pair: [u32; 2],
        shapes: [[Vec2; 3]; 2],
        edge: usize,
        n: Vec2,
    ) -> Option<Vec<(u32, f64)>> {
        let mut weights = Vec::with_capacity(6);
        let mut heights = 0.0;
        for (t, corners) in pair.into_iter().zip(shapes) {
            let k = self.edge_of(t, edge)?;
            let (side, other) = (corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3]);
            let height = side.perp(&(other - corners[k])).abs() / side.norm();
            heights += height;
            for (&v, g) in self.triangles[t as usize]
                .iter()
                .zip(hat_gradients(corners))
            {
                weights.push((v, height * g.dot(&n)));
            }
        }
        for weight in &mut weights {
            weight.1 /= heights;
        }
        Some(weights)
    }

    /// Triangles across the free edges of `front`, unfolded into its plane.
    fn next_ring(
        &self,
        front: &[(u32, [Vec2; 3])],
        visited: &mut Vec<u32>,
    ) -> Vec<(u32, [Vec2; 3])> {
        let mut ring = Vec::new();
        for &(t, corners) in front {
            let vertices = self.triangles[t as usize];
            for k in 0..3 {
                let (a, b) = (vertices[k], vertices[(k + 1) % 3]);
                let edge = self.topology.triangle_edges[t as usize][k];
                let [first, second] = self.topology.edge_triangles[edge as usize][..] else {
                    continue;
                };
                let other = if first == t { second } else { first };
                if visited.contains(&other) {
                    continue;
                }
                if let Some(unfolded) = self.unfold(
                    other,
                    [a, b],
                    [corners[k], corners[(k + 1) % 3]],
                    corners[(k + 2) % 3],
                ) {
                    visited.push(other);
                    ring.push((other, unfolded));
                }
            }
        }
        ring
    }

    /// Corners of `triangle` moved rigidly in the plane so that the edge `[a, b]` lies on `onto`
    /// (middle and direction), on the far side of `away`.
    fn unfold(
        &self,
        triangle: u32,
        [a, b]: [u32; 2],
        onto: [Vec2; 2],
        away: Vec2,
    ) -> Option<[Vec2; 3]> {
        let t = triangle as usize;
        let position = |v: u32| {
            self.triangles[t]
                .iter()
                .position(|&w| w == v)
                .map(|k| self.rest[t][k])
        };
        let (pa, pb) = (position(a)?, position(b)?);
        let from = (pb - pa).try_normalize(0.0)?;
        let to = (onto[1] - onto[0]).try_normalize(0.0)?;
        let (from_middle, to_middle) = ((pa + pb) * 0.5, (onto[0] + onto[1]) * 0.5);
        let left = |d: Vec2| Vec2::new(-d.y, d.x);
        let far = self.triangles[t].iter().position(|&w| w != a && w != b)?;
        let same_hand =
            (self.rest[t][far] - from_middle).dot(&left(from)) * (away - to_middle).dot(&left(to));
        let hand = if same_hand > 0.0 { -1.0 } else { 1.0 };
        Some(self.rest[t].map(|p| {
            let d = p - from_middle;
            to_middle + to * d.dot(&from) + left(to) * (hand * d.dot(&left(from)))
        }))
    }
}

/// Outward normal of edge `k` of a triangle, with the length of the edge.
pub(super) fn outward(corners: [Vec2; 3], k: usize) -> Vec2 {
    let edge = corners[(k + 1) % 3] - corners[k];
    let normal = Vec2::new(edge.y, -edge.x);
    if normal.dot(&(corners[(k + 2) % 3] - corners[k])) > 0.0 {
        -normal
    } else {
        normal
    }
}

/// Gradients of the linear functions that are one at one corner and zero at the others (1/m).
pub(super) fn hat_gradients(corners: [Vec2; 3]) -> [Vec2; 3] {
    let twice = (corners[1] - corners[0]).perp(&(corners[2] - corners[0]));
    [0, 1, 2].map(|k| {
        let edge = corners[(k + 2) % 3] - corners[(k + 1) % 3];
        Vec2::new(-edge.y, edge.x) / twice
    })
}

/// Appends the vertices of triangles that are not in the list.
fn collect(triangles: &[[u32; 3]], ring: &[(u32, [Vec2; 3])], points: &mut Vec<(u32, Vec2)>) {
    for (t, corners) in ring {
        for (&v, &p) in triangles[*t as usize].iter().zip(corners) {
            if points.iter().all(|&(known, _)| known != v) {
                points.push((v, p));
            }
        }
    }
}

/// The smallest change of `start` (weights of the first points, zero for the others) that makes the
/// derivative along `n` at the origin exact for every parabola; near points may change more
/// (inverse fourth power of the distance). None where the points do not determine it.
fn correct(points: &[Vec2], start: &[f64], n: Vec2) -> Option<Vec<f64>> {
    if points.len() < 6 {
        return None;
    }
    let row = |p: &Vec2| Vector6::new(1.0, p.x, p.y, 0.5 * p.x * p.x, p.x * p.y, 0.5 * p.y * p.y);
    let freedom = |p: &Vec2| 1.0 / (p.norm_squared() + 0.25).powi(2);
    let mut normal = Matrix6::zeros();
    let mut missing: SVector<f64, 6> = Vector6::new(0.0, n.x, n.y, 0.0, 0.0, 0.0);
    for (i, p) in points.iter().enumerate() {
        let r = row(p);
        normal += r * r.transpose() * freedom(p);
        missing -= r * start.get(i).copied().unwrap_or(0.0);
    }
    let inverse = normal.cholesky()?.inverse();
    if inverse.trace() > MAX_INVERSE {
        return None;
    }
    let force = inverse * missing;
    Some(
        points
            .iter()
            .enumerate()
            .map(|(i, p)| start.get(i).copied().unwrap_or(0.0) + freedom(p) * row(p).dot(&force))
            .collect(),
    )
}
