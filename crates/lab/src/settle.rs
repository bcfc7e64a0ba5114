//! Helpers that run a cloth to rest or in time by any method.

use crate::LabError;
use toile_drape::{
    DrapeError, MethodKind, MethodSettings, PseudoTransientContinuation, RestSettings, State,
    System, Workspace,
};
use toile_geometry::Vec3;

/// Net force over weight at which a static law is read: errors from it are far below those of any
/// mesh used.
pub(crate) const TIGHT: f64 = 1e-6;

/// Steps to rest at the most.
const MAX_STEPS: usize = 3000;

/// Leads a model to rest from a state, to a net force that is a share of the weight.
///
/// # Errors
/// The drape stopped, or did not get there.
pub fn to_rest(system: &System, state: &mut State, residual: f64) -> Result<usize, LabError> {
    let mut workspace = Workspace::default();
    let mut run = PseudoTransientContinuation::new(RestSettings {
        residual,
        steps: MAX_STEPS,
        ..RestSettings::default()
    });
    while !run.finished() {
        match run.advance(system, state, &mut workspace) {
            Ok(()) => {}
            // Rounding may forbid the last digit; a hundred times more is still below any mesh.
            Err(DrapeError::NoProgress { .. }) if run.residual() < 1e2 * residual => break,
            Err(error) => return Err(error.into()),
        }
    }
    if run.residual() > 1e2 * residual {
        return Err(LabError::Unfinished {
            what: "net force over weight",
            got: run.residual(),
            asked: residual,
            steps: run.steps(),
        });
    }
    Ok(run.steps())
}

/// The methods that run in time, but for those that no step makes stable without damping
/// (forward Euler): they are held to account by the stability map.
pub(crate) fn methods_in_time() -> impl Iterator<Item = (&'static str, MethodKind)> {
    MethodKind::ALL
        .into_iter()
        .filter(|(_, kind)| !kind.is_equilibrium() && kind.stability_limit() != Some(0.0))
}

/// A method that goes on until its gradient is below `tolerance` (N) or it has iterated `most`
/// times. XPBD is left as
/// it is used, one sweep a substep: it has no gradient to stop at.
pub(crate) fn converged(kind: MethodKind, tolerance: f64, most: usize) -> MethodSettings {
    MethodSettings {
        tolerance: Some(tolerance),
        iterations: (kind != MethodKind::Xpbd).then_some(most),
        ..kind.into()
    }
}

/// Runs a state for some steps, showing it to `watch` after each.
///
/// # Errors
/// The method cannot be made, stopped, or left the finite numbers without saying so.
pub fn in_time(
    system: &System,
    state: &mut State,
    settings: MethodSettings,
    [step, duration]: [f64; 2],
    mut watch: impl FnMut(&State),
) -> Result<(), LabError> {
    let mut method = toile_reference::build(&settings)?;
    let steps = (duration / step).round() as usize;
    for _ in 0..steps {
        method.advance(system, state, step)?;
        if let Some(vertex) = state.first_not_finite() {
            return Err(LabError::Drape(DrapeError::NotFinite {
                stage: "step in time",
                vertex,
            }));
        }
        watch(state);
    }
    Ok(())
}

/// Steps of a trial run: an unstable method multiplies a disturbance by far more in as many.
const TRIAL: usize = 150;

/// Speed of the disturbance (m/s): far above what single precision makes of positions in a substep
/// (2^-24 of 0.1 m over 0.1 ms is 6e-5 m/s), and still 1 % of the speed of sound in soft cloth at
/// the most.
const DISTURBANCE: f64 = 1e-2;

/// Halvings of a step before a method counts as unfit.
const HALVINGS: usize = 20;

/// The longest step, halved from the one wanted, with which a method keeps a small disturbance of
/// a resting state small; half of it again where it had to be halved.
///
/// # Errors
/// No step is sound.
pub(crate) fn sound_step(
    system: &System,
    resting: &State,
    settings: MethodSettings,
    wanted: f64,
) -> Result<f64, LabError> {
    let mut start = resting.clone();
    for (v, velocity) in start.velocities.iter_mut().enumerate() {
        let k = v as f64;
        let noise = Vec3::new((7.1 * k).sin(), (3.3 * k).cos(), (5.7 * k + 1.0).sin());
        *velocity = if system.prescribed.pinned[v] {
            Vec3::zeros()
        } else {
            noise * DISTURBANCE
        };
    }
    let energy = start.kinetic_energy(system);
    let mut step = wanted;
    for _ in 0..HALVINGS {
        let mut state = start.clone();
        let mut highest = 0.0f64;
        let outcome = in_time(
            system,
            &mut state,
            settings,
            [step, TRIAL as f64 * step],
            |s| {
                highest = highest.max(s.kinetic_energy(system));
            },
        );
        if outcome.is_ok() && highest < 100.0 * energy {
            return Ok(if step < wanted { 0.5 * step } else { step });
        }
        step *= 0.5;
    }
    Err(LabError::Unfinished {
        what: "growth of a small disturbance",
        got: f64::INFINITY,
        asked: 100.0,
        steps: TRIAL,
    })
}

/// Mean place of some vertices (m).
pub(crate) fn mean(positions: &[Vec3], chosen: &[u32]) -> Vec3 {
    let sum: Vec3 = chosen.iter().map(|&v| positions[v as usize]).sum();
    sum / chosen.len().max(1) as f64
}
