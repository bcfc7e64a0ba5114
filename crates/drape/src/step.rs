//! Steps of sewing by implicit Euler. A failed step is undone and repeated as two of half the size, down to a smallest
//! size at which failure is an error. The method `implicit-euler` of scenes is in `methods/implicit.rs`.

use crate::{DrapeError, Inertia, NewtonReport, NewtonSettings, State, System, Workspace};
use toile_geometry::Vec3;

/// Settings of a step in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepSettings {
    /// Step (s).
    pub step: f64,
    /// Drag per mass (1/s): a free velocity falls by exp(-drag t).
    pub drag: f64,
    /// Limit of the speed of a vertex after a step (m/s).
    pub speed_limit: f64,
    /// Newton iterations, tolerance, longest displacement, linear solver.
    pub newton: NewtonSettings,
}

/// Most halvings of a step, to a thousandth of its size.
const STEP_HALVINGS: u32 = 10;

/// Advances by `settings.step`, in smaller steps after a failure. Returns the report of the last solve and the number
/// of steps.
///
/// # Errors
/// Failure of the smallest step; the state is then unchanged.
pub fn step_in_time(
    system: &System,
    state: &mut State,
    workspace: &mut Workspace,
    settings: &StepSettings,
) -> Result<(NewtonReport, u32), DrapeError> {
    let start = state.clone();
    'halving: for halvings in 0..=STEP_HALVINGS {
        let pieces = 1u32 << halvings;
        let mut report = NewtonReport::default();
        for _ in 0..pieces {
            let h = settings.step / f64::from(pieces);
            report = implicit_euler(system, state, workspace, settings, h);
            if !report.succeeded || state.first_not_finite().is_some() {
                if halvings == STEP_HALVINGS {
                    let vertex = state.first_not_finite();
                    *state = start;
                    return Err(failure(system, state, workspace, vertex));
                }
                state.clone_from(&start);
                continue 'halving;
            }
        }
        return Ok((report, pieces));
    }
    Err(DrapeError::NoProgress {
        stage: "step in time",
        residual: f64::NAN,
    })
}

fn failure(
    system: &System,
    state: &State,
    workspace: &mut Workspace,
    vertex: Option<usize>,
) -> DrapeError {
    let stage = "step in time";
    match vertex.or_else(|| state.first_not_finite()) {
        Some(vertex) => DrapeError::NotFinite { stage, vertex },
        None => DrapeError::NoProgress {
            stage,
            residual: crate::measure::residual(system, state, workspace),
        },
    }
}

/// One step: minimises Phi with w = m (1 + drag h) / h^2 and y = x + h v / (1 + drag h); then
/// v = (x' - x) / h.
fn implicit_euler(
    system: &System,
    state: &mut State,
    workspace: &mut Workspace,
    settings: &StepSettings,
    h: f64,
) -> NewtonReport {
    let slowing = 1.0 + settings.drag * h;
    let weight: Vec<f64> = system
        .rest
        .mass
        .iter()
        .map(|m| m * slowing / (h * h))
        .collect();
    let before = state.positions.clone();
    let target: Vec<Vec3> = before
        .iter()
        .zip(&state.velocities)
        .zip(&system.prescribed.pinned)
        .map(|((x, v), &pinned)| if pinned { *x } else { x + v * (h / slowing) })
        .collect();
    let inertia = Inertia {
        weight: &weight,
        target: &target,
    };
    workspace.increment.begin_step(system, state, 1.0 / h);
    let report = workspace.solve(system, state, &inertia, &settings.newton);
    for ((v, x), old) in state
        .velocities
        .iter_mut()
        .zip(&state.positions)
        .zip(&before)
    {
        let velocity = (x - old) / h;
        let speed = velocity.norm();
        *v = if speed > settings.speed_limit {
            velocity * (settings.speed_limit / speed)
        } else {
            velocity
        };
    }
    workspace.contacts.refresh(system, state, &state.positions);
    workspace.contacts.remember_step(system, state);
    state.time += h;
    report
}
