//! What the explicit methods share: substeps, forces, the check that nothing has blown up.
//!
//! Every explicit method evaluates accelerations a(x, v) = f(x, v) / m from the net force f and
//! extrapolates. All forces of the model act: membrane, bending, elastics, gravity, contact as the
//! penalty k d of depth d with a dashpot, friction by return mapping to anchors that slide once a substep. Drag
//! acts as -c v on the acceleration.
//!
//! Stability: a vibration of angular frequency w, undamped, stays bounded while h w is below the
//! method's limit: 2 for symplectic Euler and Verlet, 2.828 for Runge-Kutta 4, 0 for forward Euler
//! (Hairer, Norsett and Wanner 1993, II; Hairer, Lubich and Wanner 2006, I.5). Contact adds w^2 =
//! stiffness / density: at 1e6 N/m3 and 0.2 kg/m2 the substep must stay below 2 / 2236 s = 0.89 ms
//! however soft the cloth is, and below 0.73 ms by its dashpot.

use super::energy::{EnergyWatch, fastest, runaway};
use super::frequency::{FrequencySearch, damped_contact_frequency};
use crate::method::{Method, MethodSettings, StepReport};
use crate::{DrapeError, State, System, Workspace};
use toile_geometry::Vec3;

/// One substep of an explicit method.
pub trait Scheme: Default + Send {
    /// Its name, for errors.
    const STAGE: &'static str;

    /// Largest stable h w of an undamped vibration; for a method that has none, the one its
    /// substeps are counted by.
    const LIMIT: f64;

    /// Prepares for the substeps of `h` [s] of one step.
    fn begin(&mut self, _model: &System, _state: &State, _workspace: &mut Workspace, _h: f64) {}

    /// Moves positions and velocities on by `h` [s], and the friction anchors.
    fn substep(&mut self, system: &System, state: &mut State, workspace: &mut Workspace, h: f64);
}

/// An explicit method: a scheme with its substeps.
pub struct Explicit<S> {
    scheme: S,
    substeps: Option<u32>,
    workspace: Workspace,
    search: FrequencySearch,
    watch: EnergyWatch,
}

/// Share of the stability limit that automatic substeps use: what is left pays for cloth that
/// stiffens as it stretches (10 % of stretch raises the frequency by 8 %).
const SHARE: f64 = 0.9;

/// Substeps of one step at the most: more is a mesh with slivers, not a simulation.
const MOST_SUBSTEPS: f64 = 1e6;

/// Net force on every vertex: all forces of the model at a state, zero at pins [N], for a substep
/// of `h` [s].
pub fn forces<'a>(
    system: &System,
    state: &State,
    workspace: &'a mut Workspace,
    h: f64,
) -> &'a [Vec3] {
    workspace.force_in_motion(system, state, h)
}

/// The same, and slides the friction anchors to where the cloth is now. Once a substep.
pub fn forces_and_settle<'a>(
    system: &System,
    state: &mut State,
    workspace: &'a mut Workspace,
    h: f64,
) -> &'a [Vec3] {
    forces(system, state, workspace, h);
    if !system.colliders.is_empty() {
        workspace.contacts.remember_step(system, state);
        workspace.contacts.remember_buried(system, state);
    }
    workspace.last_force()
}

impl<S: Scheme> Explicit<S> {
    /// With the settings' substeps; automatic ones when not given.
    pub fn new(settings: &MethodSettings) -> Self {
        Self {
            scheme: S::default(),
            substeps: settings.substeps,
            workspace: Workspace::default(),
            search: FrequencySearch::default(),
            watch: EnergyWatch::default(),
        }
    }

    /// Substeps a step is cut into: as given, or what the largest frequency at this state asks.
    fn substep_count(
        &mut self,
        system: &System,
        state: &State,
        step: f64,
    ) -> Result<u32, DrapeError> {
        if let Some(given) = self.substeps {
            return Ok(given.max(1));
        }
        let limits = [S::LIMIT, damped_contact_frequency(system, &state.samples)];
        let (longest, vertex) = self
            .search
            .stable_step(system, state, &mut self.workspace, limits);
        let substeps = (step / (SHARE * longest)).ceil();
        if substeps > MOST_SUBSTEPS || !substeps.is_finite() {
            return Err(DrapeError::TooStiff {
                stage: S::STAGE,
                vertex,
                substeps,
            });
        }
        Ok((substeps as u32).max(1))
    }
}

fn blown_up(stage: &'static str, state: &State, vertex: usize, substep: f64) -> DrapeError {
    let speed = state.velocities[vertex].norm();
    if speed.is_finite() {
        DrapeError::BlownUp {
            stage,
            vertex,
            speed,
            substep,
        }
    } else {
        DrapeError::NotFinite { stage, vertex }
    }
}

impl<S: Scheme> Method for Explicit<S> {
    fn advance(
        &mut self,
        system: &System,
        state: &mut State,
        step: f64,
    ) -> Result<StepReport, DrapeError> {
        let substeps = self.substep_count(system, state, step)?;
        let h = step / f64::from(substeps);
        state.follow_samples();
        for (v, &pinned) in state.velocities.iter_mut().zip(&system.prescribed.pinned) {
            if pinned {
                *v = Vec3::zeros();
            }
        }
        self.watch.start(system, state, &mut self.workspace);
        let end = state.time + step;
        self.scheme.begin(system, state, &mut self.workspace, h);
        for _ in 0..substeps {
            self.scheme.substep(system, state, &mut self.workspace, h);
            if let Some(vertex) = runaway(state) {
                return Err(blown_up(S::STAGE, state, vertex, h));
            }
        }
        if !self
            .watch
            .is_possible(system, state, &mut self.workspace, step)
        {
            return Err(blown_up(S::STAGE, state, fastest(state).0, h));
        }
        state.time = end;
        Ok(StepReport {
            pieces: 1,
            iterations: substeps as usize,
            linear_iterations: 0,
        })
    }
}
