//! The state of a simulation: all data that change with time and are needed to continue.
//!
//! # Decided with
//! - [`crate::world`] (`transfer.rs`, `state`): each field carried over an edit or a merge;
//! - [`crate::collision::ClothMemory`], [`crate::solid_friction::SolidFriction`],
//!   [`crate::internal_strain::InternalStrain`], [`crate::memory::Memory`]: parts of the state;
//! - [`crate::world::Simulation::reset_motion`]: what is wiped when motion is reset;
//! - [`crate::garment`] (`checkpoint.rs`), [`crate::scene_checkpoint`]: the state in checkpoints.
//!
//! By hand: `clear_equilibrium_memory`, the version of checkpoints (crate `interchange`, `checkpoint.rs`), a
//! comparison in `drape/tests/suite/transfer.rs`. The compiler asks in `clone_from`, `at_rest` and `check`.

use crate::collision::ClothMemory;
use crate::{ContactSample, DrapeError, InternalStrain, Memory, Model, SolidFriction};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use toile_geometry::Vec3;

/// Positions, velocities, and the memories of contact and methods. A new field has to be transferred over edits
/// (`world/transfer.rs`) and raises the version of saved checkpoints (`VERSION` in `toile-interchange`).
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct State {
    /// Positions (m).
    pub positions: Vec<Vec3>,
    /// Velocities (m/s).
    pub velocities: Vec<Vec3>,
    /// Contact samples: at the vertices, and within triangles that crossed a solid.
    pub samples: Arc<Vec<ContactSample>>,
    /// Friction of the samples that pressed on solids, in order of [`SolidFriction::key`].
    pub solid_friction: Vec<SolidFriction>,
    /// Memory of contact of cloth with cloth.
    pub cloth: ClothMemory,
    /// Internal strain of each triangle's standard linear solid; empty unless a material relaxes.
    pub internal_strain: Vec<InternalStrain>,
    /// Simulated time (s).
    pub time: f64,
    /// Memory of the method.
    pub memory: Memory,
}

impl Clone for State {
    fn clone(&self) -> Self {
        let mut copy = Self::default();
        copy.clone_from(self);
        copy
    }

    /// Copies into the allocated vectors, so that a step that copies its start allocates nothing.
    fn clone_from(&mut self, from: &Self) {
        let Self {
            positions,
            velocities,
            samples,
            solid_friction,
            cloth,
            internal_strain,
            time,
            memory,
        } = from;
        self.positions.clone_from(positions);
        self.velocities.clone_from(velocities);
        self.samples.clone_from(samples);
        self.solid_friction.clone_from(solid_friction);
        self.cloth.clone_from(cloth);
        self.internal_strain.clone_from(internal_strain);
        self.time = *time;
        self.memory.clone_from(memory);
    }
}

impl State {
    /// A state at rest at some positions (m).
    pub fn at_rest(model: &Model, positions: Vec<Vec3>) -> Self {
        Self {
            velocities: vec![Vec3::zeros(); positions.len()],
            positions,
            samples: model.rest.samples.clone(),
            solid_friction: Vec::new(),
            cloth: ClothMemory::default(),
            internal_strain: Vec::new(),
            time: 0.0,
            memory: Memory::Nothing,
        }
    }

    /// Clears the memory of an equilibrium method, after a change of the forces.
    pub(crate) fn clear_equilibrium_memory(&mut self) {
        if let Memory::Rest(_) | Memory::Relaxation(_) = self.memory {
            self.memory = Memory::Nothing;
        }
    }

    /// Refuses a state that does not fit a model, and names the field.
    pub(crate) fn check(&self, model: &Model) -> Result<(), DrapeError> {
        // Exhaustive patterns: a new field does not compile before it is checked or ignored by name.
        let Self {
            positions,
            velocities,
            samples,
            solid_friction,
            cloth,
            internal_strain,
            time: _,
            memory: _,
        } = self;
        let ClothMemory {
            positions: previous,
            friction,
            layer_reach: _,
            recovery_directions,
            crossing_counts,
        } = cloth;
        let [count, triangles] = [model.vertex_count(), model.topology.triangles.len()];
        let of_sample = |sample: &ContactSample| {
            let corners = sample.vertices.iter().all(|&v| (v as usize) < count);
            corners && sample.triangle.is_none_or(|t| (t as usize) < triangles)
        };
        let is_contact = |friction: &SolidFriction| {
            (friction.sample as usize) < samples.len()
                && (friction.solid as usize) < model.colliders.len()
        };
        let is_vertex = |v: u32| (v as usize) < count;
        let mut pairs = friction.iter().map(|contact| contact.pair.vertices());
        let mut recovering = recovery_directions.iter().map(|entry| entry.vertex);
        let is_full = |length: usize, whole: usize| length == 0 || length == whole;
        let fits = [
            ("positions", positions.len() == count),
            ("velocities", velocities.len() == count),
            ("samples", samples.iter().all(of_sample)),
            ("solid_friction", solid_friction.iter().all(is_contact)),
            (
                "solid_friction",
                solid_friction.is_sorted_by(|a, b| a.key() < b.key()),
            ),
            ("cloth.positions", is_full(previous.len(), count)),
            (
                "cloth.friction",
                pairs.all(|pair| pair.into_iter().all(is_vertex)),
            ),
            (
                "cloth.friction",
                friction.is_empty() || !previous.is_empty(),
            ),
            ("cloth.recovery_directions", recovering.all(is_vertex)),
            (
                "cloth.crossing_counts",
                is_full(crossing_counts.len(), count),
            ),
            ("internal strain", is_full(internal_strain.len(), triangles)),
        ];
        if let Some((field, _)) = fits.iter().find(|(_, fits)| !fits) {
            return Err(DrapeError::Scene {
                place: format!("state, {field}"),
                what: format!("it does not fit a cloth of {count} vertices"),
                remedy: "take another state of this cloth: this one is damaged".to_owned(),
            });
        }
        match self.first_not_finite() {
            Some(vertex) => Err(DrapeError::NotFinite {
                stage: "saved state",
                vertex,
            }),
            None => Ok(()),
        }
    }

    /// First vertex with a position or velocity that is not finite.
    pub fn first_not_finite(&self) -> Option<usize> {
        let finite = |v: &Vec3| v.iter().all(|x| x.is_finite());
        self.positions
            .iter()
            .zip(&self.velocities)
            .position(|(x, v)| !finite(x) || !finite(v))
    }

    /// Kinetic energy (J).
    pub fn kinetic_energy(&self, model: &Model) -> f64 {
        self.velocities
            .iter()
            .zip(&model.rest.mass)
            .map(|(v, m)| 0.5 * m * v.norm_squared())
            .sum()
    }
}
