//! Finding where the cloth touches solid surfaces: recomputed as it moves.

use crate::collision::{ContactDetector, ContactSet};
use crate::contact_settings::FIELD_REACH;
use crate::laws::contact::{ContactLaw, ContactPlane, damped_push, gentle_push};
use crate::memory::Memory as StateMemory;
use crate::{Collider, ContactSample, Model, PairPolicies, Pose, State};
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::sync::Arc;
use toile_geometry::Vec3;

/// One sample near one surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Index of the sample.
    pub sample: u32,
    /// The sample: a point of the cloth.
    pub point: ContactSample,
    /// The surface, linearised there.
    pub plane: ContactPlane,
    /// Its laws.
    pub law: ContactLaw,
}

/// Contacts of the present positions, and what makes finding them again cheap.
#[derive(Default)]
pub struct Contacts {
    /// Contacts in order of their samples.
    pub active: Vec<Contact>,
    /// Contacts of cloth with cloth.
    pub cloth: ContactSet,
    detector: ContactDetector,
    memory: Vec<Memory>,
    measured_for: Option<MeasuredFor>,
}

/// Where a sample was last measured and how far from every surface it was: until it has moved
/// by that much less the contact distance, it cannot touch anything.
#[derive(Clone, Copy)]
struct Memory {
    place: Vec3,
    clearance: f64,
}

/// What the memories of samples were measured for: they are valid while these are the same ones.
struct MeasuredFor {
    colliders: Arc<Vec<Collider>>,
    policies: Arc<PairPolicies>,
    samples: Arc<Vec<ContactSample>>,
}

impl MeasuredFor {
    fn fits(&self, model: &Model, state: &State) -> bool {
        Arc::ptr_eq(&self.colliders, &model.colliders)
            && Arc::ptr_eq(&self.policies, &model.policies)
            && Arc::ptr_eq(&self.samples, &state.samples)
    }
}

/// Planes are kept from this many offsets away, so that a step is stopped before it lands.
const REACH_IN_OFFSETS: f64 = 2.5;

/// Below this slope of the distance a sample lies on a ridge between walls that push against each
/// other: no direction leads out.
const FLAT_SLOPE: f64 = 0.05;

impl Contacts {
    /// Finds the contacts of the present positions. A sample is skipped only when the distance it
    /// moved proves that it is out of reach.
    pub fn refresh(&mut self, model: &Model, state: &State, positions: &[Vec3]) {
        let (memory, found) = (&state.cloth, &mut self.cloth);
        self.detector.refresh(model, memory, positions, found);
        self.refresh_surfaces(model, state, positions);
    }

    /// Finds all of them anew at the next look, so that what is found does not depend on what was before.
    pub(crate) fn forget(&mut self) {
        self.memory.clear();
        self.detector.forget();
    }

    /// Finds all contacts of cloth with cloth anew at the next look.
    pub(crate) fn forget_cloth(&mut self) {
        self.detector.forget();
    }

    /// Shortens moves from `x` so that cloth does not pass through cloth, but for pairs that the contacts in
    /// hand exempt; returns the number of vertices held back.
    pub(crate) fn truncate_moves(
        &mut self,
        model: &Model,
        x: &[Vec3],
        moves: &mut [Vec3],
    ) -> usize {
        (self.detector).truncate_moves(model, &self.cloth.exemptions, x, moves)
    }

    /// Finds those with solid surfaces alone.
    pub(crate) fn refresh_surfaces(&mut self, model: &Model, state: &State, positions: &[Vec3]) {
        if model.colliders.is_empty() {
            self.active.clear();
            return;
        }
        let unknown = Memory {
            place: Vec3::repeat(f64::INFINITY),
            clearance: 0.0,
        };
        let fits = |of: &MeasuredFor| of.fits(model, state);
        if !self.measured_for.as_ref().is_some_and(fits) {
            self.memory.clear();
            self.measured_for = Some(MeasuredFor {
                colliders: model.colliders.clone(),
                policies: model.policies.clone(),
                samples: state.samples.clone(),
            });
        }
        self.memory.resize(state.samples.len(), unknown);
        let poses: Vec<Option<Pose>> = model.colliders.iter().map(|c| c.pose(state.time)).collect();
        if poses.iter().any(Option::is_some) {
            // What was measured holds for a surface that stands still.
            self.memory.fill(unknown);
        }
        let found: Vec<Vec<Contact>> = self
            .memory
            .par_chunks_mut(128)
            .enumerate()
            .map(|(chunk, memory)| {
                let mut contacts = Vec::new();
                for (k, memory) in memory.iter_mut().enumerate() {
                    let at = chunk * 128 + k;
                    let scene = Surfaces {
                        model,
                        state,
                        poses: &poses,
                    };
                    find(&scene, positions, at, memory, &mut contacts);
                }
                contacts
            })
            .collect();
        self.active.clear();
        self.active.extend(found.into_iter().flatten());
    }

    /// Adds what damps the push of the surfaces, for explicit methods in substeps of `h` [s], and
    /// takes from it what would throw cloth that a surface was put over [N].
    pub fn damp(&self, model: &Model, state: &State, h: f64, force: &mut [Vec3]) {
        for contact in &self.active {
            let sample = &contact.point;
            let (plane, law) = (&contact.plane, &contact.law);
            let place = sample.place(&state.positions);
            let elastic = law.normal_force(plane, place);
            if elastic <= 0.0 {
                continue;
            }
            let corners = sample.vertices.iter().zip(sample.weights);
            let [mut leaving, mut mass] = [0.0; 2];
            for (&v, w) in corners.clone() {
                leaving += w * plane.normal.dot(&state.velocities[v as usize]);
                mass += w * model.rest.mass[v as usize];
            }
            let mut push = damped_push(elastic, law.normal, mass, leaving);
            if is_buried(model, state, contact, place) {
                push = push.min(gentle_push(mass, leaving, h));
            }
            for (&v, w) in corners {
                force[v as usize] += plane.normal * (w * (push - elastic));
            }
        }
    }

    /// Remembers which samples a surface was put over, for explicit methods, after
    /// [`Self::remember_step`]. Methods with a memory of their own store none.
    pub fn remember_buried(&self, model: &Model, state: &mut State) {
        if !matches!(state.memory, StateMemory::Nothing | StateMemory::Buried(_)) {
            return;
        }
        let buried = self.active.iter().filter(|contact| {
            let sample = &contact.point;
            is_buried(model, state, contact, sample.place(&state.positions))
        });
        state.memory = StateMemory::of_buried(buried.map(|contact| contact.sample));
    }

    /// Stores the end of a step in the state: friction anchors, moved along where contacts slide, and normal forces.
    pub fn remember_step(&self, model: &Model, state: &mut State) {
        self.cloth.remember_step(model, state);
        state.anchors.fill(None);
        state.normal_forces.fill(0.0);
        state.follow_samples();
        for contact in &self.active {
            let at = contact.sample as usize;
            let place = contact.point.place(&state.positions);
            let force = contact.law.normal_force(&contact.plane, place);
            if force > 0.0 {
                state.anchors[at] = Some(contact.law.slide(&contact.plane, place, force));
                state.normal_forces[at] = force;
            }
        }
    }
}

/// Whether a sample lies deeper in a surface than the offset, where no motion brings it, or has
/// lain so and not come out since.
fn is_buried(model: &Model, state: &State, contact: &Contact, place: Vec3) -> bool {
    let depth = contact.plane.depth_of(place);
    let offset = model.contact.offset + contact.point.extra_offset;
    let remembered = || state.memory.buried().binary_search(&contact.sample).is_ok();
    depth > offset || (depth > 0.0 && remembered())
}

/// What samples are measured against.
struct Surfaces<'a> {
    model: &'a Model,
    state: &'a State,
    poses: &'a [Option<Pose>],
}

fn find(
    scene: &Surfaces,
    positions: &[Vec3],
    at: usize,
    memory: &mut Memory,
    out: &mut Vec<Contact>,
) {
    let Surfaces {
        model,
        state,
        poses,
    } = scene;
    let sample = &state.samples[at];
    let place = sample.place(positions);
    let offset = model.contact.offset + sample.extra_offset;
    let reach = offset * REACH_IN_OFFSETS;
    let moved = (place - memory.place).norm();
    if moved.is_finite() && memory.clearance - moved > reach {
        return;
    }
    let mut nearest: Option<(f64, Vec3)> = None;
    let mut owner = None;
    let object = model.policies.object_of_sample(&sample.vertices);
    for (k, (collider, pose)) in model.colliders.iter().zip(*poses).enumerate() {
        if model.policies.ignores_solid(object, k) {
            continue;
        }
        if let Some(found) = collider.distance(pose.as_ref(), place)
            && nearest.is_none_or(|(distance, _)| found.0 < distance)
        {
            nearest = Some(found);
            owner = Some((collider, pose));
        }
    }
    let Some((distance, slope)) = nearest else {
        *memory = Memory {
            place,
            clearance: FIELD_REACH,
        };
        return;
    };
    // The smooth distance may exceed the exact one by a fraction of a millimetre.
    *memory = Memory {
        place,
        clearance: 0.9 * distance.max(0.0),
    };
    if distance > reach || slope.norm() < FLAT_SLOPE {
        return;
    }
    let depth = offset - distance;
    let bent = owner.filter(|_| depth > 0.0);
    let [hollow, bulge] = bent
        .and_then(|(collider, pose)| collider.curvature(pose.as_ref(), place))
        .map_or([Matrix3::zeros(); 2], parts);
    let normal = model.contact.stiffness * sample.area;
    let plane = ContactPlane {
        point: place,
        depth,
        gradient: slope,
        normal: slope.normalize(),
        hollow,
        bulge,
        anchor: state.anchors[at].unwrap_or(place),
        lagged_normal_force: state.normal_forces[at],
        returning: false,
        landing: false,
    };
    let friction = if model.contact.friction {
        sample.friction
    } else {
        0.0
    };
    let law = ContactLaw {
        normal,
        tangential: 0.5 * normal,
        friction,
        hard_from: f64::INFINITY,
    };
    out.push(Contact {
        sample: at as u32,
        point: *sample,
        plane,
        law,
    });
}

/// A symmetric matrix as the difference of two positive semidefinite ones: the one it lacks, the
/// one it has.
fn parts(matrix: Matrix3<f64>) -> [Matrix3<f64>; 2] {
    let eigen = matrix.symmetric_eigen();
    let part = |sign: f64| {
        let kept = eigen.eigenvalues.map(|value| (sign * value).max(0.0));
        eigen.eigenvectors * Matrix3::from_diagonal(&kept) * eigen.eigenvectors.transpose()
    };
    [part(-1.0), part(1.0)]
}
