//! The constant metric of projective dynamics: one scalar matrix for x, y and z, factorised once.

use std::sync::Arc;
use toile_drape::methods::implicit::Problem;
use toile_drape::{Attachments, ElasticEnd, Model, State, System, Workspace};
use toile_geometry::Vec3;
use toile_sparse::ScalarMatrix;
use toile_sparse::factor::{Factor, Graph};

/// A = b M + sum_t A_t (k_u a a^T + k_v b b^T) + bending + elastics, with fixed pins.
///
/// a and b are the weights of a triangle's tangents ([`toile_drape::laws::membrane`]),
/// k_u = max(C11 + C12 sqrt(C11/C22), 2 G) and k_v with C22 in place of C11: A is then an upper bound of the Hessian
/// of the membrane at rest, as a quadratic form, since 2 C12 p q <= C12 (s p^2 + q^2 / s) and
/// (p + q)^2 <= 2 p^2 + 2 q^2.
///
/// Contact changes with every step and is a thousand times stiffer than inertia w, so A does not contain it. The metric
/// is S A^-1 S instead, with S = 1 along the surface and (w / (w + k))^1/2 along the normal of a vertex in contact
/// with stiffness k. For a piece that only translates this is exact.
#[derive(Default)]
pub struct Metric {
    factorised: Option<Factorised>,
    right: Vec<Vec3>,
    /// Vertices in contact, the normal of the surface, and 1 minus the scale along it.
    contacts: Vec<(u32, Vec3, f64)>,
}

/// The factor of A, and the data from which A was built.
struct Factorised {
    factor: Factor<1>,
    key: Key,
}

/// The data from which the matrix was built.
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
    /// Builds the metric of a model with inertia's weight per mass `weight` (1/s2) where it is not up to date. False
    /// where the matrix cannot be factorised.
    pub fn fit(&mut self, system: &System, weight: f64) -> bool {
        if let Some(factorised) = &self.factorised
            && factorised.key.fits(system, weight)
        {
            return true;
        }
        let matrix = stiffness(system);
        let rows = 0..system.vertex_count();
        let structure = match self.factorised.take() {
            Some(last) if same_structure(&last, system) => last.factor,
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
        self.factorised = Some(Factorised {
            factor,
            key: Key {
                weight,
                model: system.model.clone(),
                attachments: system.control.attachments.clone(),
            },
        });
        true
    }

    /// Updates the list of vertices in contact.
    pub fn update_contacts(&mut self, problem: &Problem, state: &State, workspace: &Workspace) {
        self.contacts.clear();
        for contact in &workspace.contacts.active {
            let sample = &contact.point;
            let vertex = sample.vertices[0];
            let position = sample.position(&state.positions);
            if sample.triangle.is_none() && contact.plane.depth_of(position) > 0.0 {
                let inertia = problem.inertia.weight[vertex as usize];
                let scale = (inertia / (inertia + contact.law.normal)).sqrt();
                self.contacts
                    .push((vertex, contact.plane.normal, 1.0 - scale));
            }
        }
    }

    /// Computes x = S A^-1 S b, zero at pins; [`Self::fit`] must have succeeded.
    pub fn solve(&mut self, system: &System, b: &[Vec3], x: &mut [Vec3]) {
        self.right.clear();
        self.right.extend(
            b.iter().zip(&system.prescribed.pinned).map(
                |(b, &pinned)| {
                    if pinned { Vec3::zeros() } else { *b }
                },
            ),
        );
        scale_normal_components(&self.contacts, &mut self.right);
        if let Some(factorised) = &mut self.factorised {
            factorised.factor.solve(&self.right, x);
        }
        scale_normal_components(&self.contacts, x);
    }
}

/// Multiplies vectors by S: scales their components along the normals of vertices in contact.
fn scale_normal_components(contacts: &[(u32, Vec3, f64)], vectors: &mut [Vec3]) {
    for &(vertex, normal, reduction) in contacts {
        let vector = &mut vectors[vertex as usize];
        *vector -= normal * (reduction * vector.dot(&normal));
    }
}

/// Whether the sparsity structure is unchanged, so that the symbolic factorisation is valid.
fn same_structure(last: &Factorised, system: &System) -> bool {
    let of = &last.key.model;
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
