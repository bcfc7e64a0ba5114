//! Equilibrium by pseudo-transient continuation (Kelley and Keyes 1998). Each step is one Newton iteration with an
//! added inertia m/h^2 about the present positions. The pseudo step h grows while full steps lower the residual and
//! shrinks when the line search cuts a step: far from rest steps are short, near rest they are those of Newton's
//! method. After each Newton step follow chord steps with the same factor, and then regions with most of the net force
//! are solved by themselves (nonlinear elimination). The Hessian has the largest tried share of the negative curvature
//! of compression with which it is positive definite.
//!
//! # Decided with
//! - [`crate::measure::residual`]: net force over weight, by which rest is judged;
//! - [`crate::pseudo_transient::PseudoTransientContinuation::adapt`],
//!   [`crate::pseudo_transient::PseudoTransientContinuation::break_cycles`]: how long the next step is;
//! - [`crate::newton`] (`chord.rs`, `elimination.rs`): steps with the same factor; regions brought to rest
//!   first;
//! - [`crate::garment::GarmentRun::step_to_rest`], [`crate::garment::GarmentRun::finish`]: another swing,
//!   more steps, the warning;
//! - [`crate::garment::GarmentSetup::rest_on`]: limits on coarser meshes;
//! - [`crate::garment::GarmentRun::forces_of_stuck`] (`watch.rs`): a net force that no longer falls;
//! - [`crate::methods`] (`rest.rs`, `finished`): when a scene is at rest.
//!
//! Limits are given by crate `session`, `choice.rs`, `setup.rs`.

use crate::laws::membrane::Curvature;
use crate::measure::{residual, weight_norm};
use crate::memory::RestMemory;
use crate::newton::ChordLimits;
use crate::{
    DrapeError, Inertia, LinearSolver, NewtonReport, NewtonSettings, PcgLimits, State, System,
    Workspace,
};
use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;

/// Settings of pseudo-transient continuation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RestSettings {
    /// Net force over weight at which it ends.
    pub residual: f64,
    /// Most steps.
    pub steps: usize,
    /// Longest displacement of a vertex in one step (m).
    pub longest_move: f64,
}

impl Default for RestSettings {
    /// To 5e-3, within 1000 steps of at most 15 mm: a gathered skirt takes 400.
    fn default() -> Self {
        Self {
            residual: 5e-3,
            steps: 1000,
            longest_move: 0.015,
        }
    }
}

/// A run of pseudo-transient continuation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PseudoTransientContinuation {
    settings: RestSettings,
    memory: RestMemory,
}

/// Steps without a new low of the residual before a cycle is suspected.
const PATIENCE: usize = 60;
/// Most chord steps (same factor, new gradient) after a Newton step.
const CHORDS: usize = 24;
/// Chord steps end when the net force is below this share of the one that counts as rest.
const CHORD_END: f64 = 0.5;
/// First pseudo time step (s): a drop of 4 mm under gravity.
const FIRST_STEP: f64 = 0.02;
/// First pseudo time step near rest, after a swing (s).
const NEAR_STEP: f64 = 0.1;
/// Bounds of the pseudo time step (s): at the upper one inertia is 1e-6 of gravity over a metre.
const SHORTEST_STEP: f64 = 1e-6;
const MAX_STEP: f64 = 100.0;

impl PseudoTransientContinuation {
    /// A run from any state.
    pub fn new(settings: RestSettings) -> Self {
        let memory = RestMemory {
            pseudo_step: FIRST_STEP,
            steps: 0,
            residual: f64::INFINITY,
            longest_step: MAX_STEP,
            best: f64::INFINITY,
            waited: 0,
            linear_iterations: 0,
            curvature: Curvature::CONVEX,
        };
        Self { settings, memory }
    }

    /// A run from a state near rest, after a swing.
    pub fn near(settings: RestSettings) -> Self {
        let mut run = Self::new(settings);
        run.memory.pseudo_step = NEAR_STEP;
        run
    }

    /// A run that continues from the memory of a state.
    pub fn resume(settings: RestSettings, memory: RestMemory) -> Self {
        Self { settings, memory }
    }

    /// The memory that a state stores, to continue from.
    pub fn memory(&self) -> &RestMemory {
        &self.memory
    }

    /// Residual after the last step.
    pub fn residual(&self) -> f64 {
        self.memory.residual
    }

    /// Next pseudo step (s).
    pub(crate) fn pseudo_step(&self) -> f64 {
        self.memory.pseudo_step
    }

    /// Steps taken.
    pub fn steps(&self) -> usize {
        self.memory.steps
    }

    /// Conjugate-gradient iterations in all steps.
    pub fn linear_iterations(&self) -> usize {
        self.memory.linear_iterations
    }

    /// Whether the residual of the settings is reached or the steps are used up.
    pub fn finished(&self) -> bool {
        self.memory.residual <= self.settings.residual || self.memory.steps >= self.settings.steps
    }

    /// Whether the steps are used up above the residual of the settings.
    pub(crate) fn is_used_up(&self) -> bool {
        self.finished() && self.memory.residual > self.settings.residual
    }

    /// Continues to a residual, with a number of further steps.
    pub fn continue_to(&mut self, residual: f64, more_steps: usize) {
        self.settings.residual = residual;
        self.settings.steps = self.memory.steps + more_steps;
        self.memory.residual = f64::INFINITY;
        self.memory.best = f64::INFINITY;
        self.memory.waited = 0;
        self.memory.longest_step = MAX_STEP;
    }

    /// Takes one step.
    ///
    /// # Errors
    /// Numbers that are not finite; no step that lowers the potential although the residual is not reached. The state
    /// is then the last good one.
    pub fn advance(
        &mut self,
        system: &System,
        state: &mut State,
        workspace: &mut Workspace,
    ) -> Result<(), DrapeError> {
        let start = state.clone();
        workspace.increment.begin_static(system, state);
        loop {
            let h = self.memory.pseudo_step;
            let weight: Vec<f64> = system.rest.mass.iter().map(|m| m / (h * h)).collect();
            let inertia = Inertia {
                weight: &weight,
                target: &start.positions,
            };
            let newton = NewtonSettings {
                iterations: 1,
                tolerance: 0.0,
                longest_move: self.settings.longest_move,
                curvature: self.memory.curvature,
                linear: LinearSolver::Direct {
                    otherwise: PcgLimits {
                        tolerance: 1e-3,
                        iterations: 2000,
                    },
                },
            };
            let report = workspace.solve(system, state, &inertia, &newton);
            self.memory.linear_iterations += report.linear_iterations;
            if report.succeeded && state.first_not_finite().is_none() {
                let enough = self.settings.residual * weight_norm(system);
                let limits = ChordLimits {
                    steps: CHORDS,
                    tolerance: CHORD_END * enough,
                    longest_move: self.settings.longest_move,
                };
                workspace.chord_steps(system, state, &inertia, limits);
                workspace.contacts.refresh(system, state, &state.positions);
                if workspace.eliminate(system, state, enough) {
                    workspace.contacts.refresh(system, state, &state.positions);
                }
                workspace.contacts.remember_step(system, state);
                let before = self.memory.residual;
                self.memory.residual = residual(system, state, workspace);
                self.adapt(&report, before);
                break;
            }
            let vertex = state.first_not_finite();
            state.clone_from(&start);
            self.memory.pseudo_step *= 0.5;
            if self.memory.pseudo_step < SHORTEST_STEP {
                let stage = "drape to rest";
                return Err(match vertex {
                    Some(vertex) => DrapeError::NotFinite { stage, vertex },
                    None => DrapeError::NoProgress {
                        stage,
                        residual: self.memory.residual,
                    },
                });
            }
        }
        for v in &mut state.velocities {
            *v = Vec3::zeros();
        }
        self.memory.steps += 1;
        Ok(())
    }

    /// Enlarges the pseudo step after a full step that does not raise the residual; shortens it where the line search
    /// or the longest displacement limited the step.
    fn adapt(&mut self, report: &NewtonReport, residual_before: f64) {
        let (fraction, moved) = (report.fraction, report.moved);
        self.memory.curvature = report.next_curvature();
        let free = moved < 0.5 * self.settings.longest_move;
        if fraction >= 1.0 && free && self.memory.residual < 1.05 * residual_before {
            self.memory.pseudo_step = (self.memory.pseudo_step * 1.5).min(self.memory.longest_step);
        } else if fraction < 0.3 || moved >= 0.99 * self.settings.longest_move {
            self.memory.pseudo_step = (self.memory.pseudo_step * 0.7).max(SHORTEST_STEP);
        }
        self.break_cycles();
    }

    /// Newton's method can cycle between two sets of contacts. After `PATIENCE` steps without a new lowest residual the
    /// bound of the pseudo step falls to a tenth: inertia then damps the cycle, except in regions that nonlinear
    /// elimination solves by themselves.
    fn break_cycles(&mut self) {
        if self.memory.residual < 0.9 * self.memory.best {
            self.memory.best = self.memory.residual;
            self.memory.waited = 0;
            return;
        }
        self.memory.waited += 1;
        if self.memory.waited >= PATIENCE {
            self.memory.waited = 0;
            self.memory.best = self.memory.residual;
            self.memory.longest_step = (0.1 * self.memory.longest_step).max(FIRST_STEP);
            self.memory.pseudo_step = self.memory.pseudo_step.min(self.memory.longest_step);
        }
    }
}
