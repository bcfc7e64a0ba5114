//! Explicit methods: substeps, forces, and the detection of instability, common to all schemes.
//!
//! Every explicit method evaluates accelerations a(x, v) = f(x, v) / m from the net force f and
//! extrapolates. All forces of the model act: membrane, bending, elastics, gravity, contact as the
//! penalty k d of depth d with a dashpot, friction by return mapping with anchors updated once a substep. Drag
//! acts as -c v on the acceleration.
//!
//! Stability: a vibration of angular frequency w, undamped, stays bounded while h w is below the
//! method's limit: 2 for symplectic Euler and Verlet, 2.828 for Runge-Kutta 4, 0 for forward Euler
//! (Hairer, Norsett and Wanner 1993, II; Hairer, Lubich and Wanner 2006, I.5). Contact adds w^2 =
//! stiffness / density: at 1e6 N/m3 and 0.2 kg/m2 the substep must stay below 2 / 2236 s = 0.89 ms
//! however soft the cloth is, and below 0.73 ms by its dashpot.
//!
//! # Decided with
//! - [`crate::methods::frequency::FrequencySearch::stable_step`]: largest frequency of a model;
//! - [`crate::methods::explicit::STABILITY_FRACTION`], [`crate::methods::explicit::Explicit::substep_count`]:
//!   share of the stability limit that is used; number of substeps;
//! - crate `reference` (`patches/`: `limits.rs`, `stretch.rs`): frequency of patches, raised by stretch;
//! - crate `reference` (`patches/`: `take_automatic`): patches: a stretch of time begun anew with more substeps;
//! - [`crate::kinetic_damping::KineticDamping::substep`]: substeps of the swing;
//! - [`crate::xpbd`] (`xpbd_method.rs`, `SUBSTEPS`): substeps of XPBD where none are given;
//! - [`crate::methods::energy::EnergyMonitor::is_possible`]: a state that shows instability.
//!
//! Substeps that are chosen or given beforehand are not divided when they fail.

use super::energy::{EnergyMonitor, fastest_vertex, first_impossible_speed};
use super::frequency::{FrequencySearch, damped_contact_frequency};
use crate::method::{Method, MethodSettings, StepReport};
use crate::{DrapeError, State, System, Workspace};
use toile_geometry::Vec3;

/// One substep of an explicit method.
pub trait Scheme: Default + Send {
    /// Its name, for errors.
    const STAGE: &'static str;

    /// Largest stable h w of an undamped vibration, from which automatic substeps follow; a nominal one for a
    /// scheme that is never stable.
    const LIMIT: f64;

    /// Prepares for a step of substeps of `h` (s).
    fn begin(&mut self, _model: &System, _state: &State, _workspace: &mut Workspace, _h: f64) {}

    /// Advances positions, velocities and friction anchors by `h` (s).
    fn substep(&mut self, system: &System, state: &mut State, workspace: &mut Workspace, h: f64);
}

/// An explicit method: a scheme with its substeps.
pub struct Explicit<S> {
    scheme: S,
    substeps: Option<u32>,
    workspace: Workspace,
    search: FrequencySearch,
    energy: EnergyMonitor,
}

/// Fraction of the stability limit that automatic substeps use: the margin covers the stiffening of stretched cloth
/// (10 % of stretch raises the frequency by 8 %).
const STABILITY_FRACTION: f64 = 0.9;

/// Most substeps of one step: only a mesh with sliver triangles asks for more, and that is an error.
const MAX_SUBSTEPS: f64 = 1e6;

/// Net force on every vertex at a state (N), zero at pins: all forces of the model, with contact dashpots for a
/// substep of `h` (s).
pub fn forces<'a>(
    system: &System,
    state: &State,
    workspace: &'a mut Workspace,
    h: f64,
) -> &'a [Vec3] {
    workspace.force_in_motion(system, state, h)
}

/// [`forces`], and updates the friction anchors for the present positions. Called once a substep.
pub fn forces_and_update_friction<'a>(
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
    /// With the settings' substeps, or automatic ones where not given.
    pub fn new(settings: &MethodSettings) -> Self {
        Self {
            scheme: S::default(),
            substeps: settings.substeps,
            workspace: Workspace::default(),
            search: FrequencySearch::default(),
            energy: EnergyMonitor::default(),
        }
    }

    /// Number of substeps of a step: as given, or by the stability limit for the largest frequency at this state.
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
        let substeps = (step / (STABILITY_FRACTION * longest)).ceil();
        if substeps > MAX_SUBSTEPS || !substeps.is_finite() {
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
        for (v, &pinned) in state.velocities.iter_mut().zip(&system.prescribed.pinned) {
            if pinned {
                *v = Vec3::zeros();
            }
        }
        self.energy.start(system, state, &mut self.workspace);
        let end = state.time + step;
        self.scheme.begin(system, state, &mut self.workspace, h);
        for _ in 0..substeps {
            self.scheme.substep(system, state, &mut self.workspace, h);
            if let Some(vertex) = first_impossible_speed(state) {
                return Err(blown_up(S::STAGE, state, vertex, h));
            }
        }
        if !self
            .energy
            .is_possible(system, state, &mut self.workspace, step)
        {
            return Err(blown_up(S::STAGE, state, fastest_vertex(state).0, h));
        }
        state.time = end;
        Ok(StepReport {
            pieces: 1,
            iterations: substeps as usize,
            linear_iterations: 0,
        })
    }
}
