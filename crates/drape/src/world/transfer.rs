//! Transfer of a state from one structure of a world to the next: the state of every vertex, sample and triangle of an
//! untouched object stays the same to the bit.

use super::{ObjectId, VertexMap, World};
use crate::collision::{ClothMemory, ContactFrictionState, FeaturePair, RecoveryDirection};
use crate::{Collider, ContactSample, InternalStrain, Memory, Model, SolidFriction, State};
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_geometry::Vec3;

/// The meeting point of vertices that merge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MeetingPoint {
    /// Their centre of mass.
    CentreOfMass,
    /// The mean of their positions without regard to mass, for the two sides of a seam.
    Midpoint,
}

/// Positions (m) and velocities (m/s) of an object that the former structure did not have, or had with another mesh.
#[derive(Clone, Debug, Default)]
pub(super) struct StartingMotion {
    pub positions: Vec<Vec3>,
    pub velocities: Vec<Vec3>,
}

/// The source of a merged vertex's state.
enum Origin {
    /// Former merged vertices, ascending, and the prescribed one among them, which decides alone.
    Vertices(Vec<u32>, Option<u32>),
    /// Position (m) and velocity (m/s) of an object that starts.
    Start(Vec3, Vec3),
}

/// The map from the vertices and triangles of one structure to those of the next.
pub(super) struct Transfer {
    origins: Vec<Origin>,
    /// The new vertex of each former one; none where it was removed or divided.
    successors: Vec<Option<u32>>,
    /// The former triangle of each new one.
    triangles: Vec<Option<u32>>,
}

impl Transfer {
    /// The map from one structure to the next; objects among `starting` take nothing from the former state, and
    /// `prescribed` marks the former vertices that are pinned or gripped.
    pub fn new(
        world: &World,
        [old, new]: [&VertexMap; 2],
        prescribed: &[bool],
        starting: &BTreeMap<ObjectId, StartingMotion>,
    ) -> Self {
        let former = |id: ObjectId| match starting.contains_key(&id) {
            true => None,
            false => old.vertices_of(id),
        };
        let mut sources: Vec<Vec<u32>> = vec![Vec::new(); new.count];
        let mut starts: Vec<Option<(Vec3, Vec3)>> = vec![None; new.count];
        for id in new.objects() {
            let own = new.vertices_of(id).unwrap_or(&[]);
            let cloth = world.object(id).and_then(|object| object.cloth.as_deref());
            for (k, &vertex) in own.iter().enumerate() {
                if let Some(former) = former(id) {
                    sources[vertex as usize].push(former[k]);
                } else {
                    let given = starting.get(&id);
                    let position = given.and_then(|start| start.positions.get(k).copied());
                    let position = position.or_else(|| Some(cloth?.positions[k]));
                    let velocity = given.and_then(|start| start.velocities.get(k).copied());
                    let velocity = velocity.unwrap_or_else(Vec3::zeros);
                    starts[vertex as usize] = position.map(|position| (position, velocity));
                }
            }
        }
        let mut uses = vec![0u32; old.count];
        let mut successors = vec![None; old.count];
        let mut origins = Vec::with_capacity(new.count);
        for (vertex, (mut from, start)) in sources.into_iter().zip(starts).enumerate() {
            from.sort_unstable();
            from.dedup();
            for &v in &from {
                uses[v as usize] += 1;
                successors[v as usize] = Some(vertex as u32);
            }
            origins.push(match (from.is_empty(), start) {
                (true, Some((position, velocity))) => Origin::Start(position, velocity),
                _ => {
                    let leader = from.iter().copied().find(|&v| prescribed[v as usize]);
                    Origin::Vertices(from, leader)
                }
            });
        }
        for (successor, uses) in successors.iter_mut().zip(uses) {
            if uses > 1 {
                *successor = None;
            }
        }
        let mut former_triangles = BTreeMap::new();
        for (present, &unmerged) in old.triangles.iter().enumerate() {
            if let Some(own) = old.triangle(unmerged)
                && !starting.contains_key(&own.0)
            {
                former_triangles.insert(own, present as u32);
            }
        }
        let triangles = new.triangles.iter().map(|&unmerged| {
            let own = new.triangle(unmerged)?;
            former_triangles.get(&own).copied()
        });
        Self {
            triangles: triangles.collect(),
            origins,
            successors,
        }
    }

    /// Positions (m) and velocities (m/s) of the new vertices. A prescribed vertex keeps its position to the bit;
    /// others meet as `meeting` says, with the velocity that keeps their total momentum. `mass` is that of the former
    /// vertices (kg), zero for a vertex without cloth.
    pub fn motion(
        &self,
        state: &State,
        mass: &[f64],
        meeting: MeetingPoint,
    ) -> (Vec<Vec3>, Vec<Vec3>) {
        let [equal, by_mass] = [&vec![1.0; mass.len()][..], mass];
        let weights = match meeting {
            MeetingPoint::CentreOfMass => by_mass,
            MeetingPoint::Midpoint => equal,
        };
        let positions = self.blend(weights, &state.positions, |position, _| position);
        let velocities = self.blend(by_mass, &state.velocities, |_, velocity| velocity);
        (positions, velocities)
    }

    /// The state of the new structure, with the positions (m) and velocities (m/s) of [`Transfer::motion`].
    pub fn state(
        &self,
        (old, former): (&State, &Model),
        model: &Model,
        (positions, velocities): (Vec<Vec3>, Vec<Vec3>),
    ) -> State {
        let mass = former.cloth_mass();
        let samples = self.samples((old, former), model);
        let cloth = ClothMemory {
            positions: match old.cloth.positions.is_empty() {
                true => Vec::new(),
                false => self.blend(&mass, &old.cloth.positions, |position, _| position),
            },
            friction: self.friction(&old.cloth.friction),
            // An edit may have added cloth on the wrong side of a layer: the next detection searches the full reach.
            layer_reach: None,
            recovery_directions: self.recovery_directions(&old.cloth.recovery_directions),
            crossing_counts: self.crossing_counts(&old.cloth.crossing_counts),
        };
        State {
            memory: self.memory(&old.memory, &mass, &samples.successors),
            samples: Arc::new(samples.all),
            solid_friction: samples.friction,
            cloth,
            internal_strain: match old.internal_strain.len() == former.topology.triangles.len() {
                true => self.internal_strain(&old.internal_strain, [former, model]),
                false => Vec::new(),
            },
            time: old.time,
            positions,
            velocities,
        }
    }

    /// A vector for each new vertex from those of the former ones: the vector of the prescribed vertex among its
    /// origins, else their weighted mean; for an object that starts, `start` of position and velocity.
    fn blend(&self, weights: &[f64], of: &[Vec3], start: impl Fn(Vec3, Vec3) -> Vec3) -> Vec<Vec3> {
        let vector = |origin: &Origin| match origin {
            Origin::Start(position, velocity) => start(*position, *velocity),
            Origin::Vertices(_, Some(leader)) => of[*leader as usize],
            Origin::Vertices(from, None) => match from[..] {
                [only] => of[only as usize],
                _ => mean(from, weights, of),
            },
        };
        self.origins.iter().map(vector).collect()
    }

    /// Friction of the contacts whose features both still exist.
    fn friction(&self, friction: &[ContactFrictionState]) -> Vec<ContactFrictionState> {
        let carried = friction.iter().filter_map(|former| {
            let mut vertices = former.pair.vertices();
            for vertex in &mut vertices {
                *vertex = self.successors[*vertex as usize]?;
            }
            let distinct = (0..4).all(|k| !vertices[..k].contains(&vertices[k]));
            let mut slip = former.slip;
            let pair = match former.pair {
                FeaturePair::VertexFace(_) => FeaturePair::VertexFace(vertices),
                // The ends of an edge are in order, and so are the edges of a pair; slip changes sign with their
                // order.
                FeaturePair::EdgeEdge([..]) => {
                    let [a, b, c, d] = vertices;
                    let [first, second] = [[a.min(b), a.max(b)], [c.min(d), c.max(d)]];
                    if second < first {
                        slip = -slip;
                    }
                    let [[a, b], [c, d]] = [first.min(second), first.max(second)];
                    FeaturePair::EdgeEdge([a, b, c, d])
                }
            };
            distinct.then_some(ContactFrictionState {
                pair,
                slip,
                ..*former
            })
        });
        let mut carried: Vec<ContactFrictionState> = carried.collect();
        carried.sort_by_key(|contact| contact.pair);
        carried.dedup_by_key(|contact| contact.pair);
        carried
    }

    fn recovery_directions(&self, directions: &[RecoveryDirection]) -> Vec<RecoveryDirection> {
        let carried = directions.iter().filter_map(|former| {
            let vertex = self.successors[former.vertex as usize]?;
            Some(RecoveryDirection { vertex, ..*former })
        });
        let mut carried: Vec<RecoveryDirection> = carried.collect();
        carried.sort_by_key(|entry| entry.vertex);
        carried.dedup_by_key(|entry| entry.vertex);
        carried
    }

    fn crossing_counts(&self, counts: &[u32]) -> Vec<u32> {
        if counts.is_empty() {
            return Vec::new();
        }
        let count = |origin: &Origin| match origin {
            Origin::Start(..) => 0,
            Origin::Vertices(from, _) => {
                let counts = from.iter().map(|&v| counts[v as usize]);
                counts.max().unwrap_or(0)
            }
        };
        self.origins.iter().map(count).collect()
    }

    fn internal_strain(&self, old: &[InternalStrain], models: [&Model; 2]) -> Vec<InternalStrain> {
        let strain = |(new, former): (usize, &Option<u32>)| {
            let same = former.filter(|&old| has_same_diagonal(models, [old, new as u32]));
            same.map_or_else(InternalStrain::default, |t| old[t as usize])
        };
        self.triangles.iter().enumerate().map(strain).collect()
    }

    fn memory(&self, memory: &Memory, mass: &[f64], samples: &[Option<u32>]) -> Memory {
        match memory {
            Memory::Previous {
                positions,
                velocities,
                step,
            } => Memory::Previous {
                positions: self.blend(mass, positions, |position, velocity| {
                    position - velocity * *step
                }),
                velocities: self.blend(mass, velocities, |_, velocity| velocity),
                step: *step,
            },
            Memory::Buried(buried) => {
                let carried = buried.iter().filter_map(|&s| samples[s as usize]);
                let mut carried: Vec<u32> = carried.collect();
                carried.sort_unstable();
                carried.dedup();
                Memory::of_buried(carried.into_iter())
            }
            // Pseudo-transient continuation and relaxation start again under another structure.
            Memory::Nothing | Memory::Rest(_) | Memory::Relaxation(_) => Memory::Nothing,
        }
    }

    /// The contact samples of the new vertices, and of the former samples within triangles those whose triangle still
    /// exists.
    fn samples(&self, (old, former): (&State, &Model), model: &Model) -> CarriedSamples {
        let mut carried = CarriedSamples {
            all: model.rest.samples.to_vec(),
            friction: Vec::new(),
            successors: vec![None; old.samples.len()],
        };
        let friction = FormerFriction::new(old, [former, model]);
        let mut at_vertex = vec![None; self.successors.len()];
        for (index, sample) in old.samples.iter().enumerate() {
            if sample.triangle.is_none() {
                at_vertex[sample.vertices[0] as usize] = Some(index);
            }
        }
        for (index, sample) in carried.all.iter_mut().enumerate() {
            let from: Vec<usize> = match &self.origins[sample.vertices[0] as usize] {
                Origin::Start(..) => Vec::new(),
                Origin::Vertices(from, _) => {
                    let of = from.iter().filter_map(|&v| at_vertex[v as usize]);
                    of.collect()
                }
            };
            let mut merged: BTreeMap<u32, MergedAnchor> = BTreeMap::new();
            for former in from {
                let before = &old.samples[former];
                sample.extra_offset = sample.extra_offset.max(before.extra_offset);
                // A divided vertex takes a share of the force by area.
                let share = (sample.area / before.area).min(1.0);
                for (solid, memory) in friction.of_sample(former) {
                    let anchor = merged.entry(solid).or_default();
                    anchor.add(memory.anchor, share * memory.force);
                }
                carried.successors[former] = Some(index as u32);
            }
            let of_solids = merged.iter().filter_map(|(&solid, merged)| {
                Some(SolidFriction {
                    sample: index as u32,
                    solid,
                    anchor: merged.anchor()?,
                    force: merged.force,
                })
            });
            carried.friction.extend(of_solids);
        }
        self.carry_triangle_samples((old, former), model, &mut carried);
        carried
    }

    /// Appends the former samples within triangles that still exist.
    fn carry_triangle_samples(
        &self,
        (old, former): (&State, &Model),
        model: &Model,
        carried: &mut CarriedSamples,
    ) {
        let mut successors: BTreeMap<u32, u32> = BTreeMap::new();
        for (new, old) in self.triangles.iter().enumerate() {
            successors.extend(old.map(|old| (old, new as u32)));
        }
        let friction = FormerFriction::new(old, [former, model]);
        for (index, sample) in old.samples.iter().enumerate() {
            let Some(triangle) = sample.triangle else {
                continue;
            };
            let successor = successors.get(&triangle).copied();
            let Some(new) =
                successor.filter(|&new| has_same_diagonal([former, model], [triangle, new]))
            else {
                continue;
            };
            let number = carried.all.len() as u32;
            carried.successors[index] = Some(number);
            let of_solids = friction.of_sample(index);
            carried
                .friction
                .extend(of_solids.map(|(solid, memory)| SolidFriction {
                    sample: number,
                    solid,
                    ..*memory
                }));
            carried.all.push(ContactSample {
                triangle: Some(new),
                vertices: model.topology.triangles[new as usize],
                area: model.rest_area(new as usize) / 3.0,
                ..*sample
            });
        }
    }
}

/// Whether the diagonal of a triangle's quadrilateral was exchanged (a cap) in both models or in neither, so that the
/// triangle has the same corners in both.
fn has_same_diagonal(models: [&Model; 2], triangles: [u32; 2]) -> bool {
    let [old, new] = [0, 1].map(|k| {
        let (model, t) = (models[k], triangles[k] as usize);
        model.topology.triangles[t] != model.surface_triangles()[t]
    });
    old == new
}

/// Contact samples of the new structure with their friction memory.
struct CarriedSamples {
    all: Vec<ContactSample>,
    friction: Vec<SolidFriction>,
    /// The new sample of each former one.
    successors: Vec<Option<u32>>,
}

/// The friction of the former samples with the solids that are still there.
struct FormerFriction<'a> {
    all: &'a [SolidFriction],
    /// The new index of each former solid.
    solids: Vec<Option<u32>>,
}

impl<'a> FormerFriction<'a> {
    fn new(old: &'a State, [former, model]: [&Model; 2]) -> Self {
        let successor = |one: &Collider| {
            let same = |other: &Collider| Arc::ptr_eq(&one.surface, &other.surface);
            Some(model.colliders.iter().position(same)? as u32)
        };
        Self {
            all: &old.solid_friction,
            solids: former.colliders.iter().map(successor).collect(),
        }
    }

    /// The friction of a former sample, with the new index of each solid.
    fn of_sample(&self, former: usize) -> impl Iterator<Item = (u32, &'a SolidFriction)> {
        let first = (self.all).partition_point(|one| (one.sample as usize) < former);
        let all = self.all[first..].iter();
        all.take_while(move |one| one.sample as usize == former)
            .filter_map(|one| Some((self.solids[one.solid as usize]?, one)))
    }
}

/// The friction anchor of merged samples: the mean of theirs, weighted by their normal forces.
#[derive(Default)]
struct MergedAnchor {
    only: Option<Vec3>,
    count: usize,
    weighted: Vec3,
    force: f64,
}

impl MergedAnchor {
    fn add(&mut self, anchor: Vec3, force: f64) {
        self.force += force;
        self.only = Some(anchor);
        self.count += 1;
        self.weighted += anchor * force;
    }

    fn anchor(&self) -> Option<Vec3> {
        match self.count > 1 && self.force > 0.0 {
            true => Some(self.weighted / self.force),
            false => self.only,
        }
    }
}

/// The weighted mean of the vectors at some vertices; the plain mean where all weights are zero.
fn mean(from: &[u32], weights: &[f64], of: &[Vec3]) -> Vec3 {
    let whole: f64 = from.iter().map(|&v| weights[v as usize]).sum();
    let weight = |v: u32| {
        if whole > 0.0 {
            weights[v as usize]
        } else {
            1.0
        }
    };
    let total: f64 = from.iter().map(|&v| weight(v)).sum();
    let sum: Vec3 = from.iter().map(|&v| of[v as usize] * weight(v)).sum();
    sum / total
}
