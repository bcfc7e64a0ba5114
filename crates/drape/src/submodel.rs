//! A region of the cloth as a model of its own with a pinned rim, which nonlinear elimination brings to equilibrium by
//! itself.

use crate::collision::ClothContact;
use crate::laws::elastic::ElasticLaw;
use crate::{
    Attachment, Attachments, ContactSample, ContactSettings, Control, ElasticCouplings, Materials,
    Model, ModelParts, Prescribed, RestData, SolidFriction, State, System, Topology,
};
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_geometry::Vec3;
use toile_sparse::ScalarMatrix;

/// A submodel: some free vertices of a model, its own, and the pinned rim of all vertices coupled with them.
pub struct SubModel {
    /// The system of the region: its potential is that of the whole up to a constant.
    pub system: System,
    /// Its state.
    pub state: State,
    /// Contacts of cloth with cloth at its own vertices, detected in the whole; the submodel detects none.
    pub touching: Vec<ClothContact>,
    /// Vertices in the whole, own ones first.
    vertices: Vec<u32>,
    own: usize,
}

/// Numbering of the submodel's vertices: its own first, then those of the rim in order of their first use.
struct Numbers {
    numbers: BTreeMap<u32, u32>,
    vertices: Vec<u32>,
    own: usize,
}

impl Numbers {
    fn new(own: &[u32]) -> Self {
        Self {
            numbers: own.iter().copied().zip(0..).collect(),
            vertices: own.to_vec(),
            own: own.len(),
        }
    }

    fn of(&mut self, vertex: u32) -> u32 {
        *self.numbers.entry(vertex).or_insert_with(|| {
            self.vertices.push(vertex);
            self.vertices.len() as u32 - 1
        })
    }

    /// Whether any vertex with a nonzero weight is the submodel's own.
    fn moves(&self, vertices: &[u32], weights: &[f64]) -> bool {
        let own = |v: &u32| self.numbers.get(v).is_some_and(|&n| n < self.own as u32);
        vertices
            .iter()
            .zip(weights)
            .any(|(v, w)| *w != 0.0 && own(v))
    }

    /// The bending entries with an own vertex. The energy counts a pair once in the row of each of its vertices, so
    /// rows of the rim have their entries with own vertices.
    fn bending(&mut self, system: &System) -> Vec<(u32, u32, f64)> {
        let mut entries = Vec::new();
        for i in 0..self.own {
            let (columns, values) = system.rest.bending.row_entries(self.vertices[i] as usize);
            for (&column, &value) in columns.iter().zip(values) {
                let j = self.of(column);
                entries.push((i as u32, j, value));
                if j as usize >= self.own {
                    entries.push((j, i as u32, value));
                }
            }
        }
        entries
    }

    /// Elastics between vertices with an own vertex, in their order.
    fn couplings(&mut self, system: &System) -> Vec<([u32; 2], ElasticLaw)> {
        let uses = self.vertices[..self.own].iter();
        let uses = uses.flat_map(|&v| system.couplings.at(v as usize));
        let mut used: Vec<u32> = uses.copied().collect();
        used.sort_unstable();
        used.dedup();
        let couplings = used.into_iter().map(|e| {
            let (ends, law) = system.couplings.all[e as usize];
            (ends.map(|v| self.of(v)), law)
        });
        couplings.collect()
    }

    /// Attachments of own vertices.
    fn attachments(&mut self, system: &System) -> Attachments {
        let own = (0..).zip(&self.vertices[..self.own]);
        let attachments = own.flat_map(|(number, &v)| {
            let at_vertex = system.control.attachments.at(v as usize).1.iter();
            at_vertex.map(move |attachment| Attachment {
                vertex: number,
                ..*attachment
            })
        });
        attachments.collect()
    }

    fn touching(&mut self, contacts: &[ClothContact]) -> Vec<ClothContact> {
        let mut touching = Vec::new();
        for contact in contacts {
            if self.moves(&contact.vertices, &contact.weights) {
                touching.push(ClothContact {
                    vertices: contact.vertices.map(|v| self.of(v)),
                    ..*contact
                });
            }
        }
        touching
    }

    /// Contact samples with an own vertex, and their indices in the whole; `triangles` are those of the submodel,
    /// ascending.
    fn samples(&mut self, all: &[ContactSample], triangles: &[u32]) -> Vec<(usize, ContactSample)> {
        let mut samples = Vec::new();
        for (at, sample) in all.iter().enumerate() {
            if self.moves(&sample.vertices, &sample.weights) {
                let triangle = |t| triangles.binary_search(&t).ok().map(|t| t as u32);
                let own = ContactSample {
                    triangle: sample.triangle.and_then(triangle),
                    vertices: sample.vertices.map(|v| self.of(v)),
                    ..*sample
                };
                samples.push((at, own));
            }
        }
        samples
    }
}

/// The friction with solids of some samples, given by their former number, in their order.
fn own_friction(
    friction: &[SolidFriction],
    samples: &[(usize, ContactSample)],
) -> Vec<SolidFriction> {
    let mut own = Vec::new();
    for (sample, &(former, _)) in (0..).zip(samples) {
        let first = friction.partition_point(|one| (one.sample as usize) < former);
        let of_sample = friction[first..].iter();
        let of_sample = of_sample.take_while(|one| one.sample as usize == former);
        own.extend(of_sample.map(|&one| SolidFriction { sample, ..one }));
    }
    own
}

impl SubModel {
    /// The submodel of some free vertices; `contacts` are those of cloth with cloth. It has no viscosity, no internal
    /// strain of bending and no wind: the elimination of `newton` refuses systems with these.
    pub fn new(system: &System, state: &State, contacts: &[ClothContact], own: &[u32]) -> Self {
        let corners = (own.iter()).flat_map(|&v| system.topology.corners_of(v as usize));
        let mut used: Vec<u32> = corners.map(|corner| corner / 3).collect();
        used.sort_unstable();
        used.dedup();
        let mut numbers = Numbers::new(own);
        let triangles: Vec<[u32; 3]> = used
            .iter()
            .map(|&t| system.topology.triangles[t as usize].map(|v| numbers.of(v)))
            .collect();
        let bending = numbers.bending(system);
        let couplings = numbers.couplings(system);
        let attachments = numbers.attachments(system);
        let touching = numbers.touching(contacts);
        let samples = numbers.samples(&state.samples, &used);
        let vertices = numbers.vertices;
        let mut pinned = vec![false; vertices.len()];
        pinned[own.len()..].fill(true);
        let own_samples: Vec<ContactSample> = samples.iter().map(|(_, sample)| *sample).collect();
        let own_samples = Arc::new(own_samples);
        let state = State {
            samples: own_samples.clone(),
            solid_friction: own_friction(&state.solid_friction, &samples),
            internal_strain: match state.internal_strain.is_empty() {
                true => Vec::new(),
                false => used
                    .iter()
                    .map(|&t| state.internal_strain[t as usize])
                    .collect(),
            },
            time: state.time,
            positions: taken(&vertices, &state.positions),
            velocities: taken(&vertices, &state.velocities),
            ..State::default()
        };
        let count = vertices.len();
        let rest = RestData {
            elements: taken(&used, &system.rest.elements),
            bending: ScalarMatrix::from_entries(count, &bending),
            viscous_bending: None,
            stencils: Vec::new(),
            curvatures: Vec::new(),
            mass: taken(&vertices, &system.rest.mass),
            samples: own_samples,
        };
        let materials = Materials::new(
            system.materials.list.clone(),
            taken(&used, &system.materials.of_triangle),
        );
        let layout = taken(&vertices, &system.topology.layout);
        let submodel = System {
            model: Model::of(ModelParts {
                topology: Arc::new(Topology::new(layout, triangles)),
                rest: Arc::new(rest),
                materials: Arc::new(materials),
                prescribed: Arc::new(Prescribed {
                    pinned,
                    led: Vec::new(),
                }),
                couplings: Arc::new(ElasticCouplings::new(count, couplings)),
                colliders: system.colliders.clone(),
                contact: ContactSettings {
                    cloth_offset: 0.0,
                    ..system.contact
                },
                layer: Arc::default(),
                policies: Arc::new(system.policies.taken(&vertices)),
            }),
            control: Control {
                gravity: system.control.gravity,
                air_drag: 0.0,
                air: system.control.air,
                attachments,
                frames: Vec::new(),
                ties: Vec::new(),
            },
        };
        Self {
            system: submodel,
            state,
            touching,
            own: own.len(),
            vertices,
        }
    }

    /// Its own vertices, as numbered in the whole, with their positions (m).
    pub fn own_positions(&self) -> impl Iterator<Item = (u32, Vec3)> + '_ {
        let own = self.vertices[..self.own].iter().copied();
        own.zip(self.state.positions.iter().copied())
    }
}

/// The elements of a slice at some indices.
fn taken<T: Copy>(which: &[u32], from: &[T]) -> Vec<T> {
    which.iter().map(|&k| from[k as usize]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::elastic::ElasticLaw;
    use crate::{Cloth, Collider, Inertia, Material, Workspace};
    use crate::{Elastic, ElasticEnd, SystemBuilder};
    use std::sync::Arc;
    use toile_geometry::{SurfaceTree, TriangleMesh};

    /// Two waved sheets of 10 x 10 squares of 10 mm, 1.5 mm above each other.
    fn sheets() -> TriangleMesh {
        let mut mesh = TriangleMesh::default();
        for sheet in 0..2u32 {
            for v in 0..121u32 {
                let (x, z) = (0.01 * f64::from(v % 11), 0.01 * f64::from(v / 11));
                let y = 0.003 * (60.0 * x).sin() * (45.0 * z).cos() + 1.5e-3 * f64::from(sheet);
                mesh.positions.push(Vec3::new(1.01 * x, y, 0.99 * z));
            }
            for q in 0..100u32 {
                let a = sheet * 121 + q / 10 * 11 + q % 10;
                mesh.triangles
                    .extend([[a, a + 11, a + 1], [a + 1, a + 11, a + 12]]);
            }
        }
        mesh
    }

    /// A wall of two triangles a little below the sheets' middles.
    fn wall() -> Collider {
        let mesh = TriangleMesh {
            positions: [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
                .map(|[x, z]| Vec3::new(x, -3e-3, z))
                .to_vec(),
            triangles: vec![[0, 2, 1], [0, 3, 2]],
        };
        Collider::new(Arc::new(SurfaceTree::new(mesh)))
    }

    #[test]
    fn a_submodel_has_the_forces_and_the_energy_of_the_whole() {
        let mesh = sheets();
        let cloth = Cloth::from_mesh("sheets", &mesh, Material::default()).unwrap();
        let mut builder = SystemBuilder::new("sheets", &cloth).unwrap();
        builder.contact.cloth_offset = 2e-3;
        builder.colliders = vec![wall()];
        let law = ElasticLaw {
            stiffness: 30.0,
            largest_force: 1.0,
        };
        let elastic = |from, to| Elastic { from, to, law };
        builder.elastics = vec![
            elastic(36, ElasticEnd::Point(Vec3::zeros())),
            elastic(37, ElasticEnd::Vertex(200)),
            elastic(90, ElasticEnd::Vertex(38)),
            elastic(1, ElasticEnd::Vertex(120)),
        ];
        let system = builder.build();
        let mut state = State::at_rest(&system, mesh.positions.clone());
        state.refine_contact(&system, 48);
        let own: Vec<u32> = (0..36).map(|k| 24 + k / 6 * 11 + k % 6).collect();

        let mut whole = Workspace::default();
        let forces = whole.net_force(&system, &state).to_vec();
        let submodel = SubModel::new(&system, &state, &whole.contacts.cloth.contacts, &own);
        assert!(!submodel.touching.is_empty() && submodel.system.elastic_count() == 3);
        let mut alone = Workspace::default();
        alone.fit(&submodel.system);
        alone
            .increment
            .begin_static(&submodel.system, &submodel.state);
        alone.contacts.cloth.contacts.clone_from(&submodel.touching);
        let positions = &submodel.state.positions;
        (alone.contacts).refresh_surfaces(&submodel.system, &submodel.state, positions);
        assert!(alone.contacts.active.iter().any(|c| c.plane.depth > 0.0));
        let triangles = submodel
            .state
            .samples
            .iter()
            .filter(|s| s.triangle.is_some());
        assert_eq!(triangles.count(), 4);
        alone.fill_gradient(&submodel.system, positions, None);
        let largest = forces.iter().map(|f| f.norm()).fold(0.0, f64::max);
        for (k, &v) in own.iter().enumerate() {
            let off = (alone.gradient[k] + forces[v as usize]).norm();
            assert!(off < 1e-12 * largest, "vertex {v}: {off:e} of {largest:e}");
        }
        assert!(
            alone.gradient[own.len()..]
                .iter()
                .all(|g| *g == Vec3::zeros())
        );

        // A displacement of its own vertices changes both potentials equally.
        let moved = |v: u32| 1e-3 * Vec3::new(0.0, f64::from(v % 5) - 2.0, f64::from(v % 3) - 1.0);
        let mut there = [state.positions.clone(), submodel.state.positions.clone()];
        for (k, &v) in own.iter().enumerate() {
            there[0][v as usize] += moved(v);
            there[1][k] += moved(v);
        }
        let change = |workspace: &Workspace, system: &System, from: &[Vec3], to: &[Vec3]| {
            let inertia = Inertia {
                weight: &vec![0.0; from.len()],
                target: from,
            };
            workspace.potential(system, to, &inertia) - workspace.potential(system, from, &inertia)
        };
        let expected = change(&whole, &system, &state.positions, &there[0]);
        let got = change(&alone, &submodel.system, positions, &there[1]);
        assert!(expected.abs() > 1e-5);
        assert!(
            (got - expected).abs() < 1e-11 * expected.abs(),
            "{got:e} {expected:e}"
        );
    }
}
