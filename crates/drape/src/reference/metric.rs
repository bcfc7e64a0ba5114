//! The constant metric of projective dynamics: one scalar matrix for x, y and z, factorised once.

use crate::methods::implicit::Problem;
use crate::{Attachments, ElasticEnd, Model, State, System, Workspace};
use std::sync::Arc;
use toile_geometry::Vec3;
use toile_sparse::ScalarMatrix;
use toile_sparse::factor::{Factor, Graph};

/// A = b M + sum_t A_t (k_u a a^T + k_v b b^T) + bending + elastics, pins held.
///
/// a and b are the weights of a triangle's tangents ([`crate::laws::membrane`]),
/// k_u = max(C11 + C12 sqrt(C11/C22), 2 G) and k_v likewise: with them A is at no vector below the
/// Hessian of the membrane at rest, since 2 C12 p q <= C12 (s p^2 + q^2 / s) and
/// (p + q)^2 <= 2 p^2 + 2 q^2.
///
/// Contact changes with every step and is a thousand times stiffer than inertia w, so A does not
/// hold it: what is solved with is S A^-1 S, with S = 1 along the surface and (w / (w + k))^1/2
/// along the normal of a vertex that presses on it with stiffness k. For a piece that moves as a
/// whole that is exact.
#[derive(Default)]
pub struct Metric {
    made: Option<Made>,
    right: Vec<Vec3>,
    /// Vertices that press on something, its normal, and 1 less the scale along it.
    pressing: Vec<(u32, Vec3, f64)>,
}

struct Made {
    factor: Factor<1>,
    key: Key,
}

/// What the matrix was made of.
struct Key {
    weight: f64,
    model: Model,
    attachments: Attachments,
}

impl Key {
    fn fits(&self, system: &System, weight: f64) -> bool {
        self.weight == weight
            && self.model.has_cloth_of(system)
            && self.model.has_couplings_of(system)
            && self.attachments.is(&system.control.attachments)
    }
}

impl Metric {
    /// Makes the metric that of a model with inertia's weight per mass `weight` [1/s2]; nothing to
    /// do when it is. False when the matrix cannot be factorised.
    pub fn fit(&mut self, system: &System, weight: f64) -> bool {
        if let Some(made) = &self.made
            && made.key.fits(system, weight)
        {
            return true;
        }
        let matrix = stiffness(system);
        let rows = 0..system.vertex_count();
        let structure = match self.made.take() {
            Some(made) if same_structure(&made, system) => made.factor,
            _ => {
                let pairs = rows.flat_map(|v| {
                    let columns = matrix.row_entries(v).0.iter();
                    columns.map(move |&u| [v as u32, u])
                });
                let graph = Graph::from_pairs(system.vertex_count(), pairs);
                Factor::new(graph, &system.topology.layout)
            }
        };
        let mut factor = structure;
        let fill = |v: usize, columns: &[u32], row: &mut [[[f64; 1]; 1]]| {
            let (present, values) = matrix.row_entries(v);
            let mut at = 0;
            for (&u, out) in columns.iter().zip(row) {
                while at < present.len() && present[at] < u {
                    at += 1;
                }
                let mut value = if present.get(at) == Some(&u) {
                    values[at]
                } else {
                    0.0
                };
                let diagonal = u as usize == v;
                if diagonal {
                    value += weight * system.rest.mass[v];
                }
                if system.prescribed.pinned[v] || system.prescribed.pinned[u as usize] {
                    value = if diagonal { 1.0 } else { 0.0 };
                }
                *out = [[value]];
            }
        };
        if factor.factorise(fill).is_err() {
            return false;
        }
        self.made = Some(Made {
            factor,
            key: Key {
                weight,
                model: system.model.clone(),
                attachments: system.control.attachments.clone(),
            },
        });
        true
    }

    /// Looks which vertices press on something.
    pub fn press(&mut self, problem: &Problem, state: &State, workspace: &Workspace) {
        self.pressing.clear();
        for contact in &workspace.contacts.active {
            let sample = &contact.point;
            let vertex = sample.vertices[0];
            let place = sample.position(&state.positions);
            if sample.triangle.is_none() && contact.plane.depth_of(place) > 0.0 {
                let inertia = problem.inertia.weight[vertex as usize];
                let scale = (inertia / (inertia + contact.law.normal)).sqrt();
                self.pressing
                    .push((vertex, contact.plane.normal, 1.0 - scale));
            }
        }
    }

    /// x = S A^-1 S b, zero at pins; A must fit.
    pub fn solve(&mut self, system: &System, b: &[Vec3], x: &mut [Vec3]) {
        self.right.clear();
        self.right.extend(
            b.iter().zip(&system.prescribed.pinned).map(
                |(b, &pinned)| {
                    if pinned { Vec3::zeros() } else { *b }
                },
            ),
        );
        shrink(&self.pressing, &mut self.right);
        if let Some(made) = &mut self.made {
            made.factor.solve(&self.right, x);
        }
        shrink(&self.pressing, x);
    }
}

/// Scales the parts along the normals of pressing vertices.
fn shrink(pressing: &[(u32, Vec3, f64)], vectors: &mut [Vec3]) {
    for &(vertex, normal, less) in pressing {
        let vector = &mut vectors[vertex as usize];
        *vector -= normal * (less * vector.dot(&normal));
    }
}

/// Whether only numbers changed since the structure was worked out.
fn same_structure(made: &Made, system: &System) -> bool {
    let of = &made.key.model;
    Arc::ptr_eq(&of.topology, &system.topology)
        && Arc::ptr_eq(&of.rest, &system.rest)
        && Arc::ptr_eq(&of.couplings, &system.couplings)
}

/// The constant stiffness: membrane, bending, elastics.
fn stiffness(system: &System) -> ScalarMatrix {
    let mut entries = Vec::with_capacity(9 * system.topology.triangles.len());
    for (t, corners) in system.topology.triangles.iter().enumerate() {
        let element = &system.rest.elements[t];
        let [c11, c22, c12, g] = system.materials.law(t).stiffness;
        let ratio = (c11 / c22).sqrt();
        let k_u = (c11 + c12.abs() * ratio).max(2.0 * g);
        let k_v = (c22 + c12.abs() / ratio).max(2.0 * g);
        for i in 0..3 {
            for j in 0..3 {
                let value = k_u * element.warp[i] * element.warp[j]
                    + k_v * element.weft[i] * element.weft[j];
                entries.push((corners[i], corners[j], element.area * value));
            }
        }
    }
    for v in 0..system.vertex_count() {
        let (columns, values) = system.rest.bending.row_entries(v);
        entries.extend(columns.iter().zip(values).map(|(&u, &b)| (v as u32, u, b)));
    }
    for elastic in system.elastics() {
        let (from, k) = (elastic.from, elastic.law.stiffness);
        entries.push((from, from, k));
        if let ElasticEnd::Vertex(to) = elastic.to {
            entries.extend([(to, to, k), (from, to, -k), (to, from, -k)]);
        }
    }
    ScalarMatrix::from_entries(system.vertex_count(), &entries)
}
