//! Detection of contacts of the cloth with solids.
//!
//! # Decided with
//! - [`crate::contact_sample::ContactSample`], [`crate::contact_refinement`] (`refine`): points of the cloth
//!   that are tested; more where a triangle crosses;
//! - [`crate::contact_settings::ContactSettings`]: how far cloth keeps off and how hard contact pushes;
//! - [`crate::laws::contact::ContactLaw`]: force, friction and when cloth slides;
//! - [`crate::collider::PlacedSolid`], [`crate::rest_data`] (`lump`): distance to a solid and its direction;
//!   friction of a vertex from its materials;
//! - [`crate::solid_friction::SolidFriction`]: where cloth sticks;
//! - [`crate::xpbd`] (`contact.rs`), crate `reference` (`patches/`: `patch_contacts.rs`): contact with solids in XPBD
//!   and in patches;
//! - [`crate::collision`]: contact of cloth with cloth;
//! - [`crate::measure`](mod@crate::measure) (`measure_solids`): crossings with solids, counted exactly.
//!
//! Friction is off where a scene file says so: crate `interchange`, `scene.rs`.

use crate::collision::{ContactDetector, ContactSet};
use crate::contact_settings::FIELD_REACH;
use crate::laws::contact::{ContactLaw, ContactPlane, damped_push, gentle_push};
use crate::memory::Memory as StateMemory;
use crate::{Collider, ContactSample, Model, PairPolicies, PlacedSolid, SolidFriction, State};
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::sync::Arc;
use toile_geometry::Vec3;

/// A contact of a sample with a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Index of the sample.
    pub sample: u32,
    /// Index of the solid.
    pub solid: u32,
    /// The sample: a point of the cloth.
    pub point: ContactSample,
    /// The surface, linearised at the sample.
    pub plane: ContactPlane,
    /// Its laws.
    pub law: ContactLaw,
}

/// Contacts at the present positions, with caches for the next detection.
#[derive(Default)]
pub struct Contacts {
    /// Contacts in order of their samples, then of the solids.
    pub active: Vec<Contact>,
    /// Contacts of cloth with cloth.
    pub cloth: ContactSet,
    detector: ContactDetector,
    clearances: Vec<Clearance>,
    measured_for: Option<MeasuredFor>,
    /// Positions at the start of the present step in time (m).
    step_start: Option<Vec<Vec3>>,
}

/// The last measurement of a sample. As long as its displacement since then is below the distance less the reach of
/// contacts, it makes no contact.
#[derive(Clone, Copy)]
struct Clearance {
    /// Position at the measurement (m).
    position: Vec3,
    /// Lower bound of the distance from all solids there (m).
    distance: f64,
}

/// The data that clearances depend on: they are valid while these are the same.
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

/// Reach of contacts in offsets: a step is stopped by a contact before the cloth lands.
const REACH_IN_OFFSETS: f64 = 2.5;

/// Slope of the distance below which a sample lies on the medial axis, with opposed surfaces on both sides and no
/// direction out.
const MIN_SLOPE: f64 = 0.05;

impl Contacts {
    /// Detects all contacts at `positions`. A sample is skipped only when its clearance proves that it is out of reach.
    pub fn refresh(&mut self, model: &Model, state: &State, positions: &[Vec3]) {
        let (memory, found) = (&state.cloth, &mut self.cloth);
        self.detector.refresh(model, memory, positions, found);
        self.refresh_surfaces(model, state, positions);
    }

    /// Begins a step in time at some positions (m). Until [`Self::end_step`] a contact without memory of an earlier step
    /// is anchored where it was then, and its friction follows its present normal force instead of the last one.
    pub(crate) fn begin_step(&mut self, positions: &[Vec3]) {
        self.step_start = Some(positions.to_vec());
        self.detector.step_start.clone_from(&self.step_start);
    }

    /// Ends a step in time.
    pub(crate) fn end_step(&mut self) {
        (self.step_start, self.detector.step_start) = (None, None);
    }

    /// Makes the next detection independent of all earlier ones.
    pub(crate) fn forget(&mut self) {
        self.clearances.clear();
        self.detector.forget();
    }

    /// Makes the next detection of contacts of cloth with cloth independent of earlier ones.
    pub(crate) fn forget_cloth(&mut self) {
        self.detector.forget();
    }

    /// Shortens displacements from `x` so that cloth does not pass through cloth, except for exempt pairs of the last
    /// detection; returns the number of vertices whose displacement was shortened.
    pub(crate) fn truncate_moves(
        &mut self,
        model: &Model,
        x: &[Vec3],
        moves: &mut [Vec3],
    ) -> usize {
        (self.detector).truncate_moves(model, &self.cloth.exemptions, x, moves)
    }

    /// Detects the contacts with solids only.
    pub(crate) fn refresh_surfaces(&mut self, model: &Model, state: &State, positions: &[Vec3]) {
        if model.colliders.is_empty() {
            self.active.clear();
            return;
        }
        let unknown = Clearance {
            position: Vec3::repeat(f64::INFINITY),
            distance: 0.0,
        };
        let fits = |of: &MeasuredFor| of.fits(model, state);
        if !self.measured_for.as_ref().is_some_and(fits) {
            self.clearances.clear();
            self.measured_for = Some(MeasuredFor {
                colliders: model.colliders.clone(),
                policies: model.policies.clone(),
                samples: state.samples.clone(),
            });
        }
        self.clearances.resize(state.samples.len(), unknown);
        let step_start = self.step_start.as_deref();
        let solids = model.colliders.iter().map(|solid| solid.at(state.time));
        let solids: Vec<PlacedSolid> = solids.collect();
        if !solids.iter().all(PlacedSolid::is_at_rest) {
            // Clearances are valid for solids at rest only.
            self.clearances.fill(unknown);
        }
        let found: Vec<Vec<Contact>> = self
            .clearances
            .par_chunks_mut(128)
            .enumerate()
            .map(|(chunk, clearances)| {
                let mut contacts = Vec::new();
                for (k, clearance) in clearances.iter_mut().enumerate() {
                    let at = chunk * 128 + k;
                    let scene = Surfaces {
                        model,
                        state,
                        solids: &solids,
                        step_start,
                    };
                    find(&scene, positions, at, clearance, &mut contacts);
                }
                contacts
            })
            .collect();
        self.active.clear();
        self.active.extend(found.into_iter().flatten());
    }

    /// Adds the damping of contact with solids to the forces (N), for explicit methods in substeps of `h` (s), and
    /// limits the force on buried samples, which would throw the cloth off.
    pub fn damp(&self, model: &Model, state: &State, h: f64, force: &mut [Vec3]) {
        for contact in &self.active {
            let sample = &contact.point;
            let (plane, law) = (&contact.plane, &contact.law);
            let position = sample.position(&state.positions);
            let elastic = law.normal_force(plane, position);
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
            if is_buried(model, state, contact, position) {
                push = push.min(gentle_push(mass, leaving, h));
            }
            for (&v, w) in corners {
                force[v as usize] += plane.normal * (w * (push - elastic));
            }
        }
    }

    /// Stores the buried samples in the state, for explicit methods, after
    /// [`Self::remember_step`]. Methods with a memory of their own store none.
    pub fn remember_buried(&self, model: &Model, state: &mut State) {
        if !matches!(state.memory, StateMemory::Nothing | StateMemory::Buried(_)) {
            return;
        }
        let buried = self.active.iter().filter(|contact| {
            let sample = &contact.point;
            is_buried(model, state, contact, sample.position(&state.positions))
        });
        state.memory = StateMemory::of_buried(buried.map(|contact| contact.sample));
    }

    /// Stores the end of a step in the state: friction anchors, moved along where contacts slide, and normal forces.
    pub fn remember_step(&self, model: &Model, state: &mut State) {
        self.cloth.remember_step(model, state);
        state.solid_friction.clear();
        for contact in &self.active {
            let position = contact.point.position(&state.positions);
            let force = contact.law.normal_force(&contact.plane, position);
            if force > 0.0 {
                state.solid_friction.push(SolidFriction {
                    sample: contact.sample,
                    solid: contact.solid,
                    anchor: contact.law.slide(&contact.plane, position, force),
                    force,
                });
            }
        }
    }
}

/// Whether a sample is buried: deeper in a solid than the offset, which happens when a solid is put over the cloth and
/// not by motion, or remembered as buried and not yet out.
fn is_buried(model: &Model, state: &State, contact: &Contact, position: Vec3) -> bool {
    let depth = contact.plane.depth_of(position);
    let offset = model.contact.offset + contact.point.extra_offset;
    let remembered = || state.memory.buried().binary_search(&contact.sample).is_ok();
    depth > offset || (depth > 0.0 && remembered())
}

/// The solids at the present time, that samples are measured against.
struct Surfaces<'a> {
    model: &'a Model,
    state: &'a State,
    solids: &'a [PlacedSolid<'a>],
    /// As in [`Contacts`].
    step_start: Option<&'a [Vec3]>,
}

/// Appends the contacts of sample `at` with the solids within reach.
fn find(
    scene: &Surfaces,
    positions: &[Vec3],
    at: usize,
    clearance: &mut Clearance,
    out: &mut Vec<Contact>,
) {
    let Surfaces {
        model,
        state,
        solids,
        step_start,
    } = scene;
    let sample = &state.samples[at];
    let position = sample.position(positions);
    let offset = model.contact.offset + sample.extra_offset;
    // A negative offset lies inside the solid; the reach is on its outer side all the same.
    let reach = offset + (REACH_IN_OFFSETS - 1.0) * offset.abs();
    let moved = (position - clearance.position).norm();
    if moved.is_finite() && clearance.distance - moved > reach {
        return;
    }
    let mut nearest = FIELD_REACH;
    let object = model.policies.object_of_sample(&sample.vertices);
    for (solid, placed) in solids.iter().enumerate() {
        if model.policies.ignores_solid(object, solid) {
            continue;
        }
        let Some((distance, slope)) = placed.distance(position) else {
            continue;
        };
        // The smooth distance may exceed the exact one by a fraction of a millimetre.
        nearest = nearest.min(0.9 * distance.max(0.0));
        if distance > reach || slope.norm() < MIN_SLOPE {
            continue;
        }
        let depth = offset - distance;
        let [hollow, bulge] = Some(placed)
            .filter(|_| depth > 0.0)
            .and_then(|placed| placed.curvature(position))
            .map_or([Matrix3::zeros(); 2], split_by_sign);
        let law = model.contact.law(sample.area, sample.friction);
        let memory = SolidFriction::find(&state.solid_friction, at as u32, solid as u32);
        let (anchor, force) = match (memory, step_start) {
            (Some(memory), _) => (memory.anchor, memory.force),
            (None, Some(from)) => {
                let force = law.normal * depth.max(0.0) * slope.norm();
                (sample.position(from), force)
            }
            (None, None) => (position, 0.0),
        };
        let plane = ContactPlane {
            point: position,
            depth,
            gradient: slope,
            normal: slope.normalize(),
            hollow,
            bulge,
            anchor,
            lagged_normal_force: force,
            returning: false,
            landing: false,
        };
        out.push(Contact {
            sample: at as u32,
            solid: solid as u32,
            point: *sample,
            plane,
            law,
        });
    }
    *clearance = Clearance {
        position,
        distance: nearest,
    };
}

/// The negative and the positive part of a symmetric matrix, both positive semidefinite: it is the second minus the
/// first.
fn split_by_sign(matrix: Matrix3<f64>) -> [Matrix3<f64>; 2] {
    let eigen = matrix.symmetric_eigen();
    let part = |sign: f64| {
        let values = eigen.eigenvalues.map(|value| (sign * value).max(0.0));
        eigen.eigenvectors * Matrix3::from_diagonal(&values) * eigen.eigenvectors.transpose()
    };
    [part(-1.0), part(1.0)]
}
