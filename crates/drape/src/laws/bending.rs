//! Bending by a quadratic fit: around each triangle the surface is fitted by a parabola in the
//! rest plane, and its three second derivatives are the curvatures.
//!
//! x(u, v) = c0 + c1 u + c2 v + c3 u^2/2 + c4 u v + c5 v^2/2 through the triangle's corners and
//! the far corners of its neighbours, unfolded into its plane. Then x_uu = c3, x_uv = c4,
//! x_vv = c5 are fixed linear combinations of vertex positions and
//! E = A/2 (D_warp |x_uu|^2 + D_weft |x_vv|^2 + 2 D_twist |x_uv|^2)
//! is quadratic with a constant positive semidefinite Hessian that is the same for x, y and z
//! (after the smoothed hinge of Liang 2025). Unlike a hinge it needs no factor that depends on the
//! mesh pattern. At boundaries and where six points lie near a conic the fit takes the next ring
//! in the least-squares sense.

use nalgebra::{DMatrix, Matrix6};
use toile_geometry::{Topology, Vec2};

/// A sheet of triangles at rest, each flat in its own material plane (warp along the first axis).
pub struct RestSheet<'a> {
    /// Corners of the triangles.
    pub triangles: &'a [[u32; 3]],
    /// Place of each corner in the material plane [m].
    pub rest: &'a [[Vec2; 3]],
    /// Edges of the triangles.
    pub topology: &'a Topology,
}

/// Curvatures of one triangle as combinations of vertex positions.
#[derive(Clone, Debug, PartialEq)]
pub struct BendingStencil {
    /// Vertices taking part.
    pub vertices: Vec<u32>,
    /// Weights of each vertex in x_uu, x_uv, x_vv [1/m2].
    pub weights: Vec<[f64; 3]>,
}

/// Largest norm of the inverse of the scaled fit matrix that is accepted: beyond it six points
/// lie close to a conic. Measured: at most 15 on Delaunay meshes, far above 100 when they do.
const LARGEST_INVERSE: f64 = 60.0;

/// Rings of neighbours looked at before a fit settles for what it has.
const MOST_RINGS: usize = 3;

impl RestSheet<'_> {
    /// The stencil of one triangle; nothing when the mesh is too small to say (one triangle).
    pub fn stencil(&self, triangle: usize) -> Option<BendingStencil> {
        let centre = self.rest[triangle].iter().sum::<Vec2>() / 3.0;
        let scale = {
            let [a, b, c] = self.rest[triangle];
            (b - a).perp(&(c - a)).abs().sqrt()
        };
        let mut points: Vec<(u32, Vec2)> = Vec::with_capacity(12);
        for (&v, &p) in self.triangles[triangle].iter().zip(&self.rest[triangle]) {
            points.push((v, (p - centre) / scale));
        }
        let mut visited = vec![triangle as u32];
        let mut front = vec![(triangle as u32, self.rest[triangle])];
        for _ in 0..MOST_RINGS {
            front = self.next_ring(&front, &mut visited);
            for (t, corners) in &front {
                for (&v, &p) in self.triangles[*t as usize].iter().zip(corners) {
                    if points.iter().all(|&(known, _)| known != v) {
                        points.push((v, (p - centre) / scale));
                    }
                }
            }
            if let Some(weights) = fit(&points) {
                let to_metres = 1.0 / (scale * scale);
                return Some(BendingStencil {
                    vertices: points.iter().map(|&(v, _)| v).collect(),
                    weights: weights.iter().map(|w| w.map(|x| x * to_metres)).collect(),
                });
            }
            if front.is_empty() {
                break;
            }
        }
        None
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
                let Some(edge) = self.topology.edge(a, b) else {
                    continue;
                };
                let [first, second] = self.topology.edge_triangles[edge][..] else {
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
        let place = |v: u32| {
            self.triangles[t]
                .iter()
                .position(|&w| w == v)
                .map(|k| self.rest[t][k])
        };
        let (pa, pb) = (place(a)?, place(b)?);
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

/// Weights of x_uu, x_uv, x_vv for each point; nothing when the points do not determine them.
fn fit(points: &[(u32, Vec2)]) -> Option<Vec<[f64; 3]>> {
    let row = |p: Vec2| [1.0, p.x, p.y, 0.5 * p.x * p.x, p.x * p.y, 0.5 * p.y * p.y];
    if points.len() < 6 {
        return None;
    }
    if points.len() == 6 {
        let matrix = Matrix6::from_fn(|i, j| row(points[i].1)[j]);
        let inverse = matrix.try_inverse()?;
        if inverse.norm() > LARGEST_INVERSE {
            return None;
        }
        return Some(
            (0..6)
                .map(|i| [inverse[(3, i)], inverse[(4, i)], inverse[(5, i)]])
                .collect(),
        );
    }
    // Nearer points count more, so that the fit stays local.
    let weight = |p: Vec2| 1.0 / (1.0 + p.norm_squared());
    let matrix = DMatrix::from_fn(points.len(), 6, |i, j| {
        row(points[i].1)[j] * weight(points[i].1)
    });
    let svd = matrix.svd(true, true);
    if svd.singular_values.min() * LARGEST_INVERSE < 1.0 {
        return None;
    }
    let inverse = svd.pseudo_inverse(0.0).ok()?;
    Some(
        points
            .iter()
            .enumerate()
            .map(|(i, &(_, p))| [3, 4, 5].map(|k| inverse[(k, i)] * weight(p)))
            .collect(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_geometry::{TriangleMesh, Vec3};

    /// A jittered sheet of right triangles, alternating or not.
    fn sheet(n: usize, jitter: f64, alternate: bool) -> (Vec<Vec2>, Vec<[u32; 3]>) {
        let mut points = Vec::new();
        for j in 0..=n {
            for i in 0..=n {
                let s = (i * 31 + j * 17) as f64;
                let wobble = Vec2::new((s * 1.7).sin(), (s * 2.3).cos()) * jitter;
                points.push((Vec2::new(i as f64, j as f64) + wobble) / n as f64);
            }
        }
        let mut triangles = Vec::new();
        for j in 0..n {
            for i in 0..n {
                let at = |a: usize, b: usize| ((j + b) * (n + 1) + i + a) as u32;
                if alternate && (i + j) % 2 == 1 {
                    triangles.extend([
                        [at(0, 0), at(1, 0), at(0, 1)],
                        [at(1, 0), at(1, 1), at(0, 1)],
                    ]);
                } else {
                    triangles.extend([
                        [at(0, 0), at(1, 0), at(1, 1)],
                        [at(0, 0), at(1, 1), at(0, 1)],
                    ]);
                }
            }
        }
        (points, triangles)
    }

    fn bent_energy_ratio(
        points: &[Vec2],
        triangles: &[[u32; 3]],
        direction: f64,
        curvature: f64,
    ) -> f64 {
        let bent: Vec<Vec3> = points
            .iter()
            .map(|p| {
                let (s, c) = direction.sin_cos();
                let (along, across) = (p.x * c + p.y * s, p.y * c - p.x * s);
                let angle = along * curvature;
                Vec3::new(
                    angle.sin() / curvature,
                    (1.0 - angle.cos()) / curvature,
                    across,
                )
            })
            .collect();
        let rest: Vec<[Vec2; 3]> = triangles
            .iter()
            .map(|t| t.map(|v| points[v as usize]))
            .collect();
        let mesh = TriangleMesh {
            positions: bent.clone(),
            triangles: triangles.to_vec(),
        };
        let topology = mesh.topology();
        let sheet = RestSheet {
            triangles,
            rest: &rest,
            topology: &topology,
        };
        let (mut energy, mut area) = (0.0, 0.0);
        for (t, corners) in rest.iter().enumerate() {
            let stencil = sheet.stencil(t).expect("determined");
            let mut k = [Vec3::zeros(); 3];
            for (&v, w) in stencil.vertices.iter().zip(&stencil.weights) {
                for c in 0..3 {
                    k[c] += bent[v as usize] * w[c];
                }
            }
            let a = 0.5
                * (corners[1] - corners[0])
                    .perp(&(corners[2] - corners[0]))
                    .abs();
            energy += a * (k[0].norm_squared() + 2.0 * k[1].norm_squared() + k[2].norm_squared());
            area += a;
        }
        energy / (area * curvature * curvature)
    }

    #[test]
    fn a_cylinder_has_its_energy_on_every_mesh_in_every_direction() {
        for (jitter, alternate) in [(0.0, false), (0.0, true), (0.2, false), (0.25, true)] {
            let (points, triangles) = sheet(16, jitter, alternate);
            for direction in [0.0, 0.4, 0.785, 1.3, 2.2] {
                let ratio = bent_energy_ratio(&points, &triangles, direction, 0.5);
                assert!(
                    (ratio - 1.0).abs() < 0.005,
                    "{jitter} {alternate} {direction}: {ratio}"
                );
            }
        }
    }

    #[test]
    fn a_flat_sheet_has_no_curvature_wherever_it_lies() {
        let (points, triangles) = sheet(6, 0.25, true);
        let rest: Vec<[Vec2; 3]> = triangles
            .iter()
            .map(|t| t.map(|v| points[v as usize]))
            .collect();
        let flat = TriangleMesh {
            positions: points.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect(),
            triangles: triangles.clone(),
        };
        let topology = flat.topology();
        let sheet = RestSheet {
            triangles: &triangles,
            rest: &rest,
            topology: &topology,
        };
        let turn = nalgebra::Rotation3::from_euler_angles(0.4, 1.0, -0.3);
        for t in 0..triangles.len() {
            let stencil = sheet.stencil(t).expect("determined");
            for c in 0..3 {
                let k: Vec3 = stencil
                    .vertices
                    .iter()
                    .zip(&stencil.weights)
                    .map(|(&v, w)| turn * flat.positions[v as usize] * w[c])
                    .sum();
                assert!(k.norm() < 1e-9, "{k:?}");
            }
        }
    }

    #[test]
    fn panels_with_other_frames_unfold_into_one() {
        // Two triangles pairs, the second pair described in a turned, mirrored plane.
        let (points, triangles) = sheet(4, 0.2, false);
        let straight: Vec<[Vec2; 3]> = triangles
            .iter()
            .map(|t| t.map(|v| points[v as usize]))
            .collect();
        let mut other = straight.clone();
        for corners in other.iter_mut().skip(16) {
            *corners =
                corners.map(|p| Vec2::new(-p.y + 3.0, p.x).component_mul(&Vec2::new(-1.0, 1.0)));
        }
        let mesh = TriangleMesh {
            positions: points.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect(),
            triangles: triangles.clone(),
        };
        let topology = mesh.topology();
        for t in 0..16 {
            let stencil = |rest: &[[Vec2; 3]]| {
                RestSheet {
                    triangles: &triangles,
                    rest,
                    topology: &topology,
                }
                .stencil(t)
                .expect("determined")
            };
            let (a, b) = (stencil(&straight), stencil(&other));
            assert_eq!(a.vertices, b.vertices);
            for (x, y) in a.weights.iter().flatten().zip(b.weights.iter().flatten()) {
                assert!((x - y).abs() < 1e-6 * x.abs().max(1.0), "{x} {y}");
            }
        }
    }
}
