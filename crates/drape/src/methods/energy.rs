//! The energy of a cloth and upper bounds of it, by which unstable results are detected.

use crate::{Inertia, State, System, Workspace};

/// Largest physically possible speed of a vertex (m/s): the speed of sound in the stiffest fibres (aramid, drawn
/// polyethylene).
const MAX_SPEED: f64 = 1e4;

/// Factor of the physical bound that the energy may reach. The energy of a symplectic method oscillates by the factor
/// (1 + hw/2) / (1 - hw/2), which is 1000 at 0.999 of the stability limit. An unstable method exceeds the larger
/// bound only a few substeps later.
const OSCILLATION: f64 = 1e3;

/// Speed (m/s) of the whole cloth whose kinetic energy is allowed for rounding errors.
const ROUNDING_SPEED: f64 = 1e-3;

/// Measures the energy before and after a step; its buffers are sized once.
#[derive(Default)]
pub struct EnergyMonitor {
    zeros: Vec<f64>,
    before: f64,
    after: f64,
}

impl EnergyMonitor {
    /// Records the energy before a step.
    pub fn start(&mut self, system: &System, state: &State, workspace: &mut Workspace) {
        self.before = self.energy(system, state, workspace);
    }

    /// Whether the energy after `step` (s) is below the bound for the energy before it.
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

    /// The energy that [`Self::is_possible`] measured last (J).
    pub fn last(&self) -> f64 {
        self.after
    }

    /// Kinetic energy and that of strain, elastics and contact, without weight (J).
    pub fn energy(&mut self, system: &System, state: &State, workspace: &mut Workspace) -> f64 {
        self.zeros.resize(system.vertex_count(), 0.0);
        let no_inertia = Inertia {
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
        workspace.potential(system, &state.positions, &no_inertia)
            + gravity
            + state.kinetic_energy(system)
    }
}

/// An upper bound of the energy of a cloth over a run: its energy at the start of the run plus the most that weight,
/// air and changes between steps can have added.
pub struct EnergyBudget {
    /// Time (s) and energy (J) at the end of the last step. A state of another time starts a new run.
    time: f64,
    after: f64,
    /// The bound at that time (J).
    possible: f64,
}

impl Default for EnergyBudget {
    fn default() -> Self {
        Self {
            time: f64::NAN,
            after: 0.0,
            possible: 0.0,
        }
    }
}

impl EnergyBudget {
    /// The bound before a step from `time` (s) with energy `before` (J): solids and pins that were moved since the
    /// last step may have added energy.
    pub fn start(&self, time: f64, before: f64) -> f64 {
        if time == self.time {
            self.possible + (before - self.after).max(0.0)
        } else {
            before
        }
    }

    /// Records a step that ended at `time` (s) with energy `after` and bound `possible` (J).
    pub fn end(&mut self, time: f64, after: f64, possible: f64) {
        *self = Self {
            time,
            after,
            possible,
        };
    }
}

/// Kinetic energy and that of strain, elastics, contact and weight (J), heights counted from the origin.
pub fn whole_energy(system: &System, state: &State, workspace: &mut Workspace) -> f64 {
    let weight = |(x, m): (&toile_geometry::Vec3, &f64)| m * system.control.gravity.dot(x);
    let gravity: f64 = state
        .positions
        .iter()
        .zip(&system.rest.mass)
        .map(weight)
        .sum();
    EnergyMonitor::default().energy(system, state, workspace) - gravity
}

/// The largest energy of a stable method after `step` (s): [`possible_energy`] times the factor by which that of
/// symplectic methods oscillates (J).
pub fn energy_bound(system: &System, before: f64, step: f64) -> f64 {
    OSCILLATION * possible_energy(system, before, step)
}

/// Upper bound of the energy H without weight after `step` (s), when it was `before` (J). All potentials but gravity's
/// are above zero, so dH/dt = sum m g.v <= |g| sqrt(2 M H), and sqrt(H) grows by |g| sqrt(M/2) a second at most.
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
    let acceleration =
        system.control.gravity.norm() + system.control.air.largest_acceleration(lightest);
    let root = before.max(0.0).sqrt() + acceleration * (0.5 * mass).sqrt() * step;
    root * root + 0.5 * mass * ROUNDING_SPEED * ROUNDING_SPEED
}

/// Whether a speed of a vertex (m/s) is physically possible; false for NaN.
pub fn is_possible_speed(speed: f64) -> bool {
    speed <= MAX_SPEED
}

/// The first vertex whose speed is not physically possible or not finite.
pub fn first_impossible_speed(state: &State) -> Option<usize> {
    let possible = |speed: f64| speed <= MAX_SPEED * MAX_SPEED;
    state
        .velocities
        .iter()
        .position(|v| !possible(v.norm_squared()))
}

/// The vertex with the highest speed, and the speed (m/s).
pub fn fastest_vertex(state: &State) -> (usize, f64) {
    let mut best = (0, 0.0);
    for (v, velocity) in state.velocities.iter().enumerate() {
        let squared = velocity.norm_squared();
        if squared > best.1 {
            best = (v, squared);
        }
    }
    (best.0, best.1.sqrt())
}
