//! What the implicit methods share: one potential a step, some way to lower it, halving.
//!
//! Each is a rule that turns a step into a minimum of
//! Phi(x) = E(x) + sum_i w_i/2 |x_i - y_i|^2, w_i = b m_i,
//! (see [`Workspace`]), and a solver that lowers Phi. A step that fails is undone and taken in
//! two, four ... pieces.

use super::energy::{EnergyAccount, EnergyWatch, fastest, possible_energy, runaway};
use crate::measure::weight_norm;
use crate::method::{Method, MethodSettings, StepReport};
use crate::{ContactSample, DrapeError, Inertia, NewtonReport, State, System, Workspace};
use std::marker::PhantomData;
use toile_geometry::Vec3;

/// Longest move of a vertex in one iteration near solid surfaces [m].
pub const LONGEST_MOVE: f64 = 0.05;

/// A rule of time integration, as a minimum and what follows from it.
pub trait TimeRule: Send {
    /// How many times the most energy that a cloth can have it may show after a whole step: that of
    /// the step before or of the whole run, whichever is less. None for rules that damp: they gain
    /// no energy from step to step.
    const MOST_ENERGY: Option<f64> = None;

    /// How long after the start of the step its unknown lies [s].
    fn reach(h: f64) -> f64 {
        h
    }

    /// Substeps a step of `step` [s] is cut into where the settings say nothing.
    fn substeps(_model: &System, _samples: &[ContactSample], _step: f64) -> u32 {
        1
    }

    /// Inertia's weight per mass b [1/s2].
    fn weight(system: &System, state: &State, h: f64) -> f64;

    /// Where inertia alone would take each vertex, into `target` [m].
    fn aim(system: &System, state: &State, h: f64, target: &mut Vec<Vec3>);

    /// Turns the minimum in `state.positions` into the new positions and velocities; `before`
    /// holds the old ones.
    fn finish(before: &State, state: &mut State, h: f64);
}

/// When a solver stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Iterations at the most.
    pub iterations: usize,
    /// Norm of the gradient [N].
    pub tolerance: f64,
}

/// What a solver is to lower.
pub struct Problem<'a> {
    /// The model.
    pub system: &'a System,
    /// Weights and targets of the vertices.
    pub inertia: Inertia<'a>,
    /// Weight per mass [1/s2]: the weights are this times the masses.
    pub weight: f64,
    /// When to stop.
    pub limits: Limits,
}

impl Problem<'_> {
    /// Longest move of a vertex in one iteration [m]: `near` where there are solid surfaces, whose
    /// contact is found within 10 mm only, so that a longer one may pass through a limb.
    pub fn longest_move(&self, near: f64) -> f64 {
        if self.system.colliders.is_empty() {
            f64::INFINITY
        } else {
            near
        }
    }
}

/// A way to lower Phi.
pub trait Solver: Default + Send {
    /// The method's name, for errors.
    const STAGE: &'static str;

    /// Iterations and tolerance where the settings give none.
    const LIMITS: Limits;

    /// Whether a step counts only when the minimum was reached.
    const CONVERGES: bool;

    /// Lowers Phi from `state.positions` and leaves the result there.
    fn lower(
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
    watch: EnergyWatch,
    account: EnergyAccount,
}

/// Halvings of a step before it is an error.
const HALVINGS: u32 = 6;

/// Gradient over weight up to which a minimum counts as reached although the tolerance is not:
/// rounding alone leaves more than the tolerance in very stiff cloth.
const REACHED: f64 = 1e-3;

/// Why a piece of a step was given up.
enum Failure {
    /// A vertex left the finite or the possible.
    Runaway(usize),
    /// The potential could not be lowered, or its minimum was not reached.
    Stuck,
}

impl<R: TimeRule, S: Solver> Implicit<R, S> {
    /// With what the settings leave open at the solver's defaults.
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
            watch: EnergyWatch::default(),
            account: EnergyAccount::default(),
        }
    }

    /// One step of `h` [s], in pieces where it fails whole.
    fn whole(
        &mut self,
        system: &System,
        state: &mut State,
        h: f64,
        total: &mut StepReport,
    ) -> Result<(), DrapeError> {
        self.start.clone_from(state);
        let mut failure = Failure::Stuck;
        'halving: for halvings in 0..=HALVINGS {
            let pieces = 1u32 << halvings;
            for _ in 0..pieces {
                match self.piece(system, state, h / f64::from(pieces)) {
                    Ok(report) => {
                        total.iterations += report.iterations;
                        total.linear_iterations += report.linear_iterations;
                    }
                    Err(why) => {
                        failure = why;
                        if halvings < HALVINGS {
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

    fn piece(
        &mut self,
        system: &System,
        state: &mut State,
        h: f64,
    ) -> Result<NewtonReport, Failure> {
        self.before.clone_from(state);
        self.watch.start(system, state, &mut self.workspace);
        let weight = R::weight(system, state, h);
        self.weights.clear();
        self.weights
            .extend(system.rest.mass.iter().map(|m| m * weight));
        R::aim(system, state, h, &mut self.target);
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
        let rate = 1.0 / R::reach(h);
        self.workspace.increment.begin_step(system, state, rate);
        let report = self.solver.lower(&problem, state, &mut self.workspace);
        self.workspace.increment.begin_static(system, state);
        R::finish(&self.before, state, h);
        if let Some(vertex) = state.first_not_finite().or_else(|| runaway(state)) {
            return Err(Failure::Runaway(vertex));
        }
        let reached = report.gradient <= self.limits.tolerance.max(REACHED * weight_norm(system));
        if !report.sound || S::CONVERGES && !reached {
            return Err(Failure::Stuck);
        }
        let workspace = &mut self.workspace;
        if !self.watch.is_possible(system, state, workspace, h) {
            return Err(Failure::Runaway(fastest(state).0));
        }
        // `is_possible` found the contacts of the new positions.
        self.workspace.contacts.remember_step(system, state);
        state.time += h;
        Ok(report)
    }

    fn error(&mut self, system: &System, state: &State, failure: Failure, h: f64) -> DrapeError {
        let stage = S::STAGE;
        match failure {
            Failure::Runaway(vertex) if state.velocities[vertex].iter().all(|x| x.is_finite()) => {
                DrapeError::BlownUp {
                    stage,
                    vertex,
                    speed: state.velocities[vertex].norm(),
                    substep: h / f64::from(1u32 << HALVINGS),
                }
            }
            Failure::Runaway(vertex) => DrapeError::NotFinite { stage, vertex },
            Failure::Stuck => DrapeError::NoProgress {
                stage,
                residual: crate::measure::residual(system, &self.start, &mut self.workspace),
            },
        }
    }
}

impl<R: TimeRule, S: Solver> Implicit<R, S> {
    /// Whether cloth was in cloth or on the wrong side of a layer at the last look: the pulls that
    /// lead it out belong to no potential and may add any energy.
    fn leads_out(&self) -> bool {
        let tally = &self.workspace.contacts.cloth.tally;
        tally.crossings[2] > 0 || tally.astray[2] > 0
    }
}

impl<R: TimeRule, S: Solver> Method for Implicit<R, S> {
    fn advance(
        &mut self,
        system: &System,
        state: &mut State,
        step: f64,
    ) -> Result<StepReport, DrapeError> {
        state.follow_samples();
        // A step must not depend on what was found before it.
        self.workspace.forget_pairs();
        let mut total = StepReport::default();
        let end = state.time + step;
        let before = R::MOST_ENERGY.map(|_| {
            let before = self.watch.energy(system, state, &mut self.workspace);
            [before, self.account.start(state.time, before)]
        });
        let mut led = self.leads_out();
        let automatic = || R::substeps(system, &state.samples, step);
        let substeps = self.substeps.unwrap_or_else(automatic).max(1);
        for _ in 0..substeps {
            self.whole(system, state, step / f64::from(substeps), &mut total)?;
            led |= self.leads_out();
        }
        if let (Some(times), Some(before)) = (R::MOST_ENERGY, before) {
            let [in_step, mut in_run] = before.map(|before| possible_energy(system, before, step));
            let (after, possible) = (self.watch.last(), in_step.min(in_run));
            if led {
                in_run = after;
            } else if after > times * possible {
                return Err(DrapeError::EnergyGrew {
                    stage: S::STAGE,
                    vertex: fastest(state).0,
                    energy: after,
                    possible,
                });
            }
            self.account.end(end, after, in_run);
        }
        state.time = end;
        Ok(total)
    }
}
