//! Leading a cloth to rest, and running it in time, with any method.

use crate::LabError;
use toile_drape::{
    DrapeError, MethodKind, MethodSettings, Model, RestRun, RestSettings, State, Workspace,
};
use toile_geometry::Vec3;

/// Net force over weight at which a static law is read: errors from it are far below those of any
/// mesh used.
pub(crate) const TIGHT: f64 = 1e-7;

/// Steps to rest at the most.
const MOST_STEPS: usize = 3000;

/// Leads a model to rest from a state, to a net force that is a share of the weight.
///
/// # Errors
/// The drape stopped, or did not get there.
pub fn to_rest(model: &Model, state: &mut State, residual: f64) -> Result<usize, LabError> {
    let mut workspace = Workspace::default();
    let mut run = RestRun::new(RestSettings {
        residual,
        steps: MOST_STEPS,
        ..RestSettings::default()
    });
    while !run.finished() {
        match run.advance(model, state, &mut workspace) {
            Ok(()) => {}
            // Rounding may forbid the last digit; a thousand times more is still below any mesh.
            Err(DrapeError::NoProgress { .. }) if run.residual() < 1e3 * residual => break,
            Err(error) => return Err(error.into()),
        }
    }
    if run.residual() > 1e3 * residual {
        return Err(LabError::Unfinished {
            what: "net force over weight",
            got: run.residual(),
            asked: residual,
            steps: run.steps(),
        });
    }
    Ok(run.steps())
}

/// The methods that run in time.
pub(crate) fn methods_in_time() -> impl Iterator<Item = (&'static str, MethodKind)> {
    MethodKind::ALL
        .into_iter()
        .filter(|(_, kind)| !kind.is_equilibrium())
}

/// Runs a state for some steps, showing it to `watch` after each.
///
/// # Errors
/// The method stopped, or left the finite numbers without saying so.
pub fn in_time(
    model: &Model,
    state: &mut State,
    settings: MethodSettings,
    [step, duration]: [f64; 2],
    mut watch: impl FnMut(&State),
) -> Result<(), LabError> {
    let mut method = settings.build();
    let steps = (duration / step).round() as usize;
    for _ in 0..steps {
        method.advance(model, state, step)?;
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

/// Mean place of some vertices [m].
pub(crate) fn mean(positions: &[Vec3], chosen: &[u32]) -> Vec3 {
    let sum: Vec3 = chosen.iter().map(|&v| positions[v as usize]).sum();
    sum / chosen.len().max(1) as f64
}
