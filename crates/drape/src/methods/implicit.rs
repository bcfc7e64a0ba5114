//! Implicit methods: one potential a step, a minimiser, and the division of steps that fail, common to all rules.
//!
//! Each method is a rule of time integration, by which a step is a minimum of
//! Phi(x) = E(x) + sum_i w_i/2 |x_i - y_i|^2, w_i = b m_i,
//! (see [`Workspace`]), and a solver that minimises Phi. A step that fails is undone and repeated in two, four ...
//! pieces.

use super::energy::{
    EnergyBudget, EnergyMonitor, fastest_vertex, first_impossible_speed, possible_energy,
};
use crate::measure::weight_norm;
use crate::method::{Method, MethodSettings, StepReport};
use crate::{ContactSample, DrapeError, Inertia, NewtonReport, State, System, Workspace};
use std::marker::PhantomData;
use toile_geometry::Vec3;

/// Longest displacement of a vertex in one iteration of Newton and quasi-Newton methods where there are solids (m).
pub const MAX_MOVE: f64 = 0.05;

/// A rule of time integration: the potential that a step minimises, and the new state from the minimum.
pub trait TimeRule: Send {
    /// Largest energy after a step over its physical bound, that for the step or that for the whole run, whichever is
    /// less. None for rules with numerical damping, which gain no energy from step to step.
    const MAX_ENERGY_FACTOR: Option<f64> = None;

    /// Time from the start of the step to the unknown positions (s).
    fn unknown_time(h: f64) -> f64 {
        h
    }

    /// Number of substeps of a step of `step` (s) where the settings give none.
    fn substeps(_model: &System, _samples: &[ContactSample], _step: f64) -> u32 {
        1
    }

    /// Inertia's weight per mass b (1/s2).
    fn weight(system: &System, state: &State, h: f64) -> f64;

    /// Sets the inertial target y of each vertex (m).
    fn set_target(system: &System, state: &State, h: f64, target: &mut Vec<Vec3>);

    /// Computes the new positions and velocities from the minimum in `state.positions`; `before` is the old state.
    fn finish(before: &State, state: &mut State, h: f64);
}

/// When a solver stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Most iterations.
    pub iterations: usize,
    /// Norm of the gradient (N).
    pub tolerance: f64,
}

/// The potential of a step and the limits of its solver.
pub struct Problem<'a> {
    /// The model.
    pub system: &'a System,
    /// Weights and targets of the vertices.
    pub inertia: Inertia<'a>,
    /// Weight per mass (1/s2): the weights are this times the masses.
    pub weight: f64,
    /// Limits of the solver.
    pub limits: Limits,
}

impl Problem<'_> {
    /// Longest displacement of a vertex in one iteration (m): `near` where there are solids, since contact is detected
    /// within 10 mm only and a longer step may pass through a limb; otherwise infinite.
    pub fn longest_move(&self, near: f64) -> f64 {
        if self.system.colliders.is_empty() {
            f64::INFINITY
        } else {
            near
        }
    }
}

/// A minimiser of Phi.
pub trait Solver: Default + Send {
    /// The method's name, for errors.
    const STAGE: &'static str;

    /// Iterations and tolerance where the settings give none.
    const LIMITS: Limits;

    /// Whether a step without convergence counts as failed.
    const CONVERGES: bool;

    /// Minimises Phi, starting from `state.positions`, and stores the result there.
    fn minimise(
        &mut self,
        problem: &Problem,
        state: &mut State,
        workspace: &mut Workspace,
    ) -> NewtonReport;
}

/// An implicit method: a rule with a solver.
pub struct Implicit<R, S> {
    rule: PhantomData<R>,
    solver: S,
    limits: Limits,
    substeps: Option<u32>,
    workspace: Workspace,
    weights: Vec<f64>,
    target: Vec<Vec3>,
    before: State,
    start: State,
    energy: EnergyMonitor,
    budget: EnergyBudget,
}

/// Most halvings of a step that fails, before it is an error.
const MAX_HALVINGS: u32 = 6;

/// Gradient over weight below which a solve counts as converged even above the tolerance: in very stiff cloth the
/// rounding error of the gradient exceeds the tolerance.
const CONVERGED_RESIDUAL: f64 = 1e-3;

/// Cause of the failure of a piece of a step.
enum Failure {
    /// A vertex with a speed that is not finite or not physically possible, or too much energy.
    Unstable(usize),
    /// The potential could not be lowered, or the solver did not converge.
    NotConverged,
}

impl<R: TimeRule, S: Solver> Implicit<R, S> {
    /// With the settings, and the solver's defaults where they give none.
    pub fn new(settings: &MethodSettings) -> Self {
        Self {
            rule: PhantomData,
            solver: S::default(),
            limits: Limits {
                iterations: settings.iterations.unwrap_or(S::LIMITS.iterations).max(1),
                tolerance: settings.tolerance.unwrap_or(S::LIMITS.tolerance),
            },
            substeps: settings.substeps,
            workspace: Workspace::default(),
            weights: Vec::new(),
            target: Vec::new(),
            before: State::default(),
            start: State::default(),
            energy: EnergyMonitor::default(),
            budget: EnergyBudget::default(),
        }
    }

    /// Advances by `h` (s): as one step, or in up to 64 pieces where that fails.
    fn advance_in_pieces(
        &mut self,
        system: &System,
        state: &mut State,
        h: f64,
        total: &mut StepReport,
    ) -> Result<(), DrapeError> {
        self.start.clone_from(state);
        let mut failure = Failure::NotConverged;
        'halving: for halvings in 0..=MAX_HALVINGS {
            let pieces = 1u32 << halvings;
            for _ in 0..pieces {
                match self.advance_piece(system, state, h / f64::from(pieces)) {
                    Ok(report) => {
                        total.iterations += report.iterations;
                        total.linear_iterations += report.linear_iterations;
                    }
                    Err(cause) => {
                        failure = cause;
                        if halvings < MAX_HALVINGS {
                            state.clone_from(&self.start);
                        }
                        continue 'halving;
                    }
                }
            }
            total.pieces = total.pieces.max(pieces);
            return Ok(());
        }
        Err(self.error(system, state, failure, h))
    }

    /// Advances by one piece of `h` (s).
    fn advance_piece(
        &mut self,
        system: &System,
        state: &mut State,
        h: f64,
    ) -> Result<NewtonReport, Failure> {
        self.before.clone_from(state);
        self.energy.start(system, state, &mut self.workspace);
        let weight = R::weight(system, state, h);
        self.weights.clear();
        self.weights
            .extend(system.rest.mass.iter().map(|m| m * weight));
        R::set_target(system, state, h, &mut self.target);
        for (v, target) in self.target.iter_mut().enumerate() {
            if system.prescribed.pinned[v] {
                *target = state.positions[v];
            }
        }
        let problem = Problem {
            system,
            inertia: Inertia {
                weight: &self.weights,
                target: &self.target,
            },
            weight,
            limits: self.limits,
        };
        let rate = 1.0 / R::unknown_time(h);
        self.workspace.increment.begin_step(system, state, rate);
        // A single linear solve cannot follow the friction of a contact that it does not yet know.
        if self.limits.iterations > 1 {
            (self.workspace.contacts).begin_step(&self.before.positions);
        }
        let report = self.solver.minimise(&problem, state, &mut self.workspace);
        self.workspace.increment.begin_static(system, state);
        R::finish(&self.before, state, h);
        let outcome = self.end_piece(system, state, &report, h);
        self.workspace.contacts.end_step();
        outcome.map(|()| report)
    }

    /// Checks the new state of a piece of `h` (s), and stores its contacts.
    fn end_piece(
        &mut self,
        system: &System,
        state: &mut State,
        report: &NewtonReport,
        h: f64,
    ) -> Result<(), Failure> {
        if let Some(vertex) = state
            .first_not_finite()
            .or_else(|| first_impossible_speed(state))
        {
            return Err(Failure::Unstable(vertex));
        }
        let converged = report.gradient
            <= self
                .limits
                .tolerance
                .max(CONVERGED_RESIDUAL * weight_norm(system));
        if !report.succeeded || S::CONVERGES && !converged {
            return Err(Failure::NotConverged);
        }
        let workspace = &mut self.workspace;
        if !self.energy.is_possible(system, state, workspace, h) {
            return Err(Failure::Unstable(fastest_vertex(state).0));
        }
        // `is_possible` has detected the contacts at the new positions.
        self.workspace.contacts.remember_step(system, state);
        state.time += h;
        Ok(())
    }

    fn error(&mut self, system: &System, state: &State, failure: Failure, h: f64) -> DrapeError {
        let stage = S::STAGE;
        match failure {
            Failure::Unstable(vertex) if state.velocities[vertex].iter().all(|x| x.is_finite()) => {
                DrapeError::BlownUp {
                    stage,
                    vertex,
                    speed: state.velocities[vertex].norm(),
                    substep: h / f64::from(1u32 << MAX_HALVINGS),
                }
            }
            Failure::Unstable(vertex) => DrapeError::NotFinite { stage, vertex },
            Failure::NotConverged => DrapeError::NoProgress {
                stage,
                residual: crate::measure::residual(system, &self.start, &mut self.workspace),
            },
        }
    }
}

impl<R: TimeRule, S: Solver> Implicit<R, S> {
    /// Whether cloth crossed cloth, or lay on the wrong side of a layer, at the last detection: recovery forces have no
    /// potential and may add any amount of energy.
    fn is_recovering(&self) -> bool {
        let tally = &self.workspace.contacts.cloth.tally;
        tally.crossings[2] > 0 || tally.astray[2] > 0
    }
}

impl<R: TimeRule, S: Solver> Method for Implicit<R, S> {
    fn most_iterations(&self) -> Option<usize> {
        Some(self.limits.iterations)
    }

    fn advance(
        &mut self,
        system: &System,
        state: &mut State,
        step: f64,
    ) -> Result<StepReport, DrapeError> {
        // A step must depend on the state alone, not on pairs detected before it.
        self.workspace.forget_pairs();
        let mut total = StepReport::default();
        let end = state.time + step;
        let before = R::MAX_ENERGY_FACTOR.map(|_| {
            let before = self.energy.energy(system, state, &mut self.workspace);
            [before, self.budget.start(state.time, before)]
        });
        let mut recovering = self.is_recovering();
        let automatic = || R::substeps(system, &state.samples, step);
        let substeps = self.substeps.unwrap_or_else(automatic).max(1);
        for _ in 0..substeps {
            self.advance_in_pieces(system, state, step / f64::from(substeps), &mut total)?;
            recovering |= self.is_recovering();
        }
        if let (Some(factor), Some(before)) = (R::MAX_ENERGY_FACTOR, before) {
            let [in_step, mut in_run] = before.map(|before| possible_energy(system, before, step));
            let (after, possible) = (self.energy.last(), in_step.min(in_run));
            if recovering {
                in_run = after;
            } else if after > factor * possible {
                return Err(DrapeError::EnergyGrew {
                    stage: S::STAGE,
                    vertex: fastest_vertex(state).0,
                    energy: after,
                    possible,
                });
            }
            self.budget.end(end, after, in_run);
        }
        state.time = end;
        Ok(total)
    }
}
