//! The energy a cloth has, and the most it can have: what tells a result from rubbish.

use crate::{Inertia, State, System, Workspace};

/// No part of a cloth moves faster [m/s]: the speed of sound in the stiffest fibres (aramid,
/// drawn polyethylene), which no wave in it exceeds.
const FASTEST: f64 = 1e4;

/// How far the energy may lie above its physical bound. The energy of a symplectic method swings
/// by (1 + hw/2) / (1 - hw/2): 1000 is reached at 0.999 of the limit. What is unstable passes it a
/// few substeps later than it would pass 1.
const SWING: f64 = 1e3;

/// Speed of the whole cloth whose energy is counted as rounding [m/s].
const STILL: f64 = 1e-3;

/// Measures energies; its memory is sized once.
#[derive(Default)]
pub struct EnergyWatch {
    zeros: Vec<f64>,
    before: f64,
    after: f64,
}

impl EnergyWatch {
    /// Notes the energy before a step.
    pub fn start(&mut self, system: &System, state: &State, workspace: &mut Workspace) {
        self.before = self.energy(system, state, workspace);
    }

    /// Whether the energy after `step` [s] is one the cloth can have.
    pub fn is_possible(
        &mut self,
        system: &System,
        state: &State,
        workspace: &mut Workspace,
        step: f64,
    ) -> bool {
        let bound = energy_bound(system, self.before, step);
        self.after = self.energy(system, state, workspace);
        self.after <= bound
    }

    /// The energy that [`Self::is_possible`] found last [J].
    pub fn last(&self) -> f64 {
        self.after
    }

    /// Energy of motion, strain, elastics and contact [J].
    pub fn energy(&mut self, system: &System, state: &State, workspace: &mut Workspace) -> f64 {
        self.zeros.resize(system.vertex_count(), 0.0);
        let nothing = Inertia {
            weight: &self.zeros,
            target: &state.positions,
        };
        workspace.fit(system);
        workspace.increment.begin_static(system, state);
        workspace.contacts.refresh(system, state, &state.positions);
        let gravity: f64 = state
            .positions
            .iter()
            .zip(&system.rest.mass)
            .map(|(x, m)| m * system.control.gravity.dot(x))
            .sum();
        workspace.potential(system, &state.positions, &nothing)
            + gravity
            + state.kinetic_energy(system)
    }
}

/// The energy that a cloth can have come by since its run began: what it had then, what its weight and
/// the air can have added, and what was done to it between steps.
pub struct EnergyAccount {
    /// When the last step ended [s], and with what energy [J]. A state of another time begins anew.
    time: f64,
    after: f64,
    /// What the cloth can have come by until then [J].
    possible: f64,
}

impl Default for EnergyAccount {
    fn default() -> Self {
        Self {
            time: f64::NAN,
            after: 0.0,
            possible: 0.0,
        }
    }
}

impl EnergyAccount {
    /// The energy that can be there before a step from `time` [s], when `before` [J] is: bodies and
    /// pins that were moved since the last step may have added to it.
    pub fn start(&self, time: f64, before: f64) -> f64 {
        if time == self.time {
            self.possible + (before - self.after).max(0.0)
        } else {
            before
        }
    }

    /// Notes a step that ended at `time` [s] with `after` [J], where `possible` [J] were.
    pub fn end(&mut self, time: f64, after: f64, possible: f64) {
        *self = Self {
            time,
            after,
            possible,
        };
    }
}

/// Energy of motion, strain, weight, elastics and contact [J]; places count from the origin.
pub fn whole_energy(system: &System, state: &State, workspace: &mut Workspace) -> f64 {
    let weight = |(x, m): (&toile_geometry::Vec3, &f64)| m * system.control.gravity.dot(x);
    let gravity: f64 = state
        .positions
        .iter()
        .zip(&system.rest.mass)
        .map(weight)
        .sum();
    EnergyWatch::default().energy(system, state, workspace) - gravity
}

/// The energy that a method may show after `step` [s]: [`possible_energy`], and room for the swing
/// of symplectic methods.
pub fn energy_bound(system: &System, before: f64, step: f64) -> f64 {
    SWING * possible_energy(system, before, step)
}

/// The most energy of motion, strain, elastics and contact [J] that a cloth with `before` [J] of it
/// can have after `step` [s]. All potentials but gravity's are above zero, so this energy H obeys
/// dH/dt = sum m g.v <= |g| sqrt(2 M H), and sqrt(H) grows by |g| sqrt(M/2) a second at most.
pub fn possible_energy(system: &System, before: f64, step: f64) -> f64 {
    let mass: f64 = system
        .rest
        .mass
        .iter()
        .zip(&system.prescribed.pinned)
        .filter(|&(_, &pinned)| !pinned)
        .map(|(m, _)| m)
        .sum();
    let lightest = system
        .materials
        .list
        .iter()
        .map(|m| m.density)
        .fold(f64::INFINITY, f64::min);
    let push = system.control.gravity.norm() + system.control.air.largest_acceleration(lightest);
    let root = before.max(0.0).sqrt() + push * (0.5 * mass).sqrt() * step;
    root * root + 0.5 * mass * STILL * STILL
}

/// Whether a vertex can move at a speed [m/s].
pub fn is_possible_speed(speed: f64) -> bool {
    speed <= FASTEST
}

/// The first vertex faster than anything can be, or not finite.
pub fn runaway(state: &State) -> Option<usize> {
    let possible = |speed: f64| speed <= FASTEST * FASTEST;
    state
        .velocities
        .iter()
        .position(|v| !possible(v.norm_squared()))
}

/// The vertex with the highest speed, and the speed [m/s].
pub fn fastest(state: &State) -> (usize, f64) {
    let mut best = (0, 0.0);
    for (v, velocity) in state.velocities.iter().enumerate() {
        let squared = velocity.norm_squared();
        if squared > best.1 {
            best = (v, squared);
        }
    }
    (best.0, best.1.sqrt())
}
