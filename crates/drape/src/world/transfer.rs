//! What the state remembers, carried from one structure of a world to the next: every vertex, sample and
//! triangle of an object that an edit does not touch keeps its numbers to the bit.

use super::{ObjectId, VertexMap, World};
use crate::collision::{ClothMemory, ContactFrictionState, FeaturePair, RecoveryDirection};
use crate::{ContactSample, InternalStrain, Memory, Model, State};
use std::collections::BTreeMap;
use std::sync::Arc;
use toile_geometry::Vec3;

/// Where vertices that become one meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MeetingPlace {
    /// At their centre of mass.
    CentreOfMass,
    /// Half-way, whatever they weigh: where the two sides of a seam are drawn.
    Midpoint,
}

/// Places [m] and velocities [m/s] of an object that the former structure knew nothing of, or had another mesh
/// of.
#[derive(Clone, Debug, Default)]
pub(super) struct StartingMotion {
    pub places: Vec<Vec3>,
    pub velocities: Vec<Vec3>,
}

/// Where a merged vertex comes from.
enum Origin {
    /// Former merged vertices, ascending, and the one among them that is held: it leads the others.
    Vertices(Vec<u32>, Option<u32>),
    /// An object that starts here.
    Start(Vec3, Vec3),
}

/// From the vertices and triangles of one structure to those of the next.
pub(super) struct Transfer {
    origins: Vec<Origin>,
    /// The new vertex of each former one; none where it is gone or was divided.
    successors: Vec<Option<u32>>,
    /// The former triangle of each new one.
    triangles: Vec<Option<u32>>,
}

impl Transfer {
    /// From one structure to the next; objects among `starting` begin anew.
    pub fn new(
        world: &World,
        [old, new]: [&VertexMap; 2],
        held: &[bool],
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
                    let place = given.and_then(|start| start.places.get(k).copied());
                    let place = place.or_else(|| Some(cloth?.positions[k]));
                    let velocity = given.and_then(|start| start.velocities.get(k).copied());
                    let velocity = velocity.unwrap_or_else(Vec3::zeros);
                    starts[vertex as usize] = place.map(|place| (place, velocity));
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
                (true, Some((place, velocity))) => Origin::Start(place, velocity),
                _ => {
                    let leader = from.iter().copied().find(|&v| held[v as usize]);
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

    /// Places [m] and velocities [m/s] of the new vertices. One that is held stays where it is, exactly; others
    /// meet as `meeting` says, with the velocity of their common momentum. A vertex without cloth has no
    /// mass to draw others by.
    pub fn motion(
        &self,
        state: &State,
        mass: &[f64],
        meeting: MeetingPlace,
    ) -> (Vec<Vec3>, Vec<Vec3>) {
        let [alike, by_mass] = [&vec![1.0; mass.len()][..], mass];
        let weights = match meeting {
            MeetingPlace::CentreOfMass => by_mass,
            MeetingPlace::Midpoint => alike,
        };
        let places = self.blend(weights, &state.positions, |place, _| place);
        let velocities = self.blend(by_mass, &state.velocities, |_, velocity| velocity);
        (places, velocities)
    }

    /// The state of the new structure, at places [m] and velocities [m/s] from [`Transfer::motion`].
    pub fn state(
        &self,
        (old, former): (&State, &Model),
        model: &Model,
        (positions, velocities): (Vec<Vec3>, Vec<Vec3>),
    ) -> State {
        let mass = former.cloth_mass();
        let samples = self.samples((old, former), model);
        let cloth = ClothMemory {
            places: match old.cloth.places.is_empty() {
                true => Vec::new(),
                false => self.blend(&mass, &old.cloth.places, |place, _| place),
            },
            held: self.friction(&old.cloth.held),
            // Layers may lie on the wrong side of what an edit has put there.
            layer_reach: None,
            drawn: self.recovery(&old.cloth.drawn),
            crossed_for: self.crossed_for(&old.cloth.crossed_for),
        };
        State {
            memory: self.memory(&old.memory, &mass, &samples.successors),
            samples: Arc::new(samples.all),
            anchors: samples.anchors,
            normal_forces: samples.normal_forces,
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

    /// Vectors of the former vertices for the new ones: of those that became one that of the held one, else the
    /// mean by their weights; of an object that starts `start` of its place and velocity.
    fn blend(&self, weights: &[f64], of: &[Vec3], start: impl Fn(Vec3, Vec3) -> Vec3) -> Vec<Vec3> {
        let one = |origin: &Origin| match origin {
            Origin::Start(place, velocity) => start(*place, *velocity),
            Origin::Vertices(_, Some(held)) => of[*held as usize],
            Origin::Vertices(from, None) => match from[..] {
                [only] => of[only as usize],
                _ => mean(from, weights, of),
            },
        };
        self.origins.iter().map(one).collect()
    }

    /// Friction of contacts whose features both are still there.
    fn friction(&self, held: &[ContactFrictionState]) -> Vec<ContactFrictionState> {
        let carried = held.iter().filter_map(|one| {
            let mut vertices = one.pair.vertices();
            for vertex in &mut vertices {
                *vertex = self.successors[*vertex as usize]?;
            }
            let distinct = (0..4).all(|k| !vertices[..k].contains(&vertices[k]));
            let mut slip = one.slip;
            let pair = match one.pair {
                FeaturePair::VertexFace(_) => FeaturePair::VertexFace(vertices),
                // Ends of edges and edges are in order; the gap of exchanged edges has the other sign.
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
            distinct.then_some(ContactFrictionState { pair, slip, ..*one })
        });
        let mut carried: Vec<ContactFrictionState> = carried.collect();
        carried.sort_by_key(|one| one.pair);
        carried.dedup_by_key(|one| one.pair);
        carried
    }

    fn recovery(&self, drawn: &[RecoveryDirection]) -> Vec<RecoveryDirection> {
        let carried = drawn.iter().filter_map(|one| {
            let vertex = self.successors[one.vertex as usize]?;
            Some(RecoveryDirection { vertex, ..*one })
        });
        let mut carried: Vec<RecoveryDirection> = carried.collect();
        carried.sort_by_key(|one| one.vertex);
        carried.dedup_by_key(|one| one.vertex);
        carried
    }

    fn crossed_for(&self, crossed: &[u32]) -> Vec<u32> {
        if crossed.is_empty() {
            return Vec::new();
        }
        let one = |origin: &Origin| match origin {
            Origin::Start(..) => 0,
            Origin::Vertices(from, _) => {
                let looks = from.iter().map(|&v| crossed[v as usize]);
                looks.max().unwrap_or(0)
            }
        };
        self.origins.iter().map(one).collect()
    }

    fn internal_strain(&self, old: &[InternalStrain], models: [&Model; 2]) -> Vec<InternalStrain> {
        let one = |(new, former): (usize, &Option<u32>)| {
            let kept = former.filter(|&old| has_same_diagonal(models, [old, new as u32]));
            kept.map_or_else(InternalStrain::default, |t| old[t as usize])
        };
        self.triangles.iter().enumerate().map(one).collect()
    }

    fn memory(&self, memory: &Memory, mass: &[f64], samples: &[Option<u32>]) -> Memory {
        match memory {
            Memory::Previous {
                positions,
                velocities,
                step,
            } => Memory::Previous {
                positions: self.blend(mass, positions, |place, velocity| place - velocity * *step),
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
            // A way to rest begins anew under another structure.
            Memory::Nothing | Memory::Rest(_) | Memory::Relaxation(_) => Memory::Nothing,
        }
    }

    /// Contact samples: those of the new vertices, and those within triangles that are still there.
    fn samples(&self, (old, former): (&State, &Model), model: &Model) -> CarriedSamples {
        let mut carried = CarriedSamples {
            all: model.rest.samples.to_vec(),
            anchors: Vec::new(),
            normal_forces: Vec::new(),
            successors: vec![None; old.samples.len()],
        };
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
            let mut sticks = Sticking::default();
            for former in from {
                let before = &old.samples[former];
                sample.extra_offset = sample.extra_offset.max(before.extra_offset);
                // A divided vertex takes its share of the force along.
                let share = (sample.area / before.area).min(1.0);
                sticks.add(old.anchors[former], share * old.normal_forces[former]);
                carried.successors[former] = Some(index as u32);
            }
            carried.anchors.push(sticks.anchor());
            carried.normal_forces.push(sticks.force);
        }
        self.carry_within((old, former), model, &mut carried);
        carried
    }

    /// Carries the samples within triangles.
    fn carry_within(
        &self,
        (old, former): (&State, &Model),
        model: &Model,
        carried: &mut CarriedSamples,
    ) {
        let mut successors: BTreeMap<u32, u32> = BTreeMap::new();
        for (new, old) in self.triangles.iter().enumerate() {
            successors.extend(old.map(|old| (old, new as u32)));
        }
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
            carried.successors[index] = Some(carried.all.len() as u32);
            carried.all.push(ContactSample {
                triangle: Some(new),
                vertices: model.topology.triangles[new as usize],
                area: model.rest_area(new as usize) / 3.0,
                ..*sample
            });
            carried.anchors.push(old.anchors[index]);
            carried.normal_forces.push(old.normal_forces[index]);
        }
    }
}

/// Whether a triangle has the same corners in two models, merged vertices taken for one: its cap was exchanged in both
/// or in neither.
fn has_same_diagonal(models: [&Model; 2], triangles: [u32; 2]) -> bool {
    let [old, new] = [0, 1].map(|k| {
        let (model, t) = (models[k], triangles[k] as usize);
        model.topology.triangles[t] != model.surface_triangles()[t]
    });
    old == new
}

/// Contact samples of the new structure, with what is remembered of them.
struct CarriedSamples {
    all: Vec<ContactSample>,
    anchors: Vec<Option<Vec3>>,
    normal_forces: Vec<f64>,
    /// The new sample of each former one.
    successors: Vec<Option<u32>>,
}

/// The anchors of samples that become one, weighted by their normal forces.
#[derive(Default)]
struct Sticking {
    only: Option<Vec3>,
    count: usize,
    weighted: Vec3,
    weight: f64,
    force: f64,
}

impl Sticking {
    fn add(&mut self, anchor: Option<Vec3>, force: f64) {
        self.force += force;
        if let Some(anchor) = anchor {
            self.only = Some(anchor);
            self.count += 1;
            self.weighted += anchor * force;
            self.weight += force;
        }
    }

    fn anchor(&self) -> Option<Vec3> {
        match self.count > 1 && self.weight > 0.0 {
            true => Some(self.weighted / self.weight),
            false => self.only,
        }
    }
}

/// The mean of vectors at some vertices by their weights; without any, by number.
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
