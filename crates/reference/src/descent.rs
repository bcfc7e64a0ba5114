//! Quasi-Newton methods: gradient, iteration and line search, common to all of them.

use toile_drape::methods::implicit::{MAX_MOVE, Problem};
use toile_drape::{NewtonReport, State, Workspace};
use toile_geometry::Vec3;
use toile_sparse::dot;

/// Armijo's constant: least decrease over that of the linear model (Nocedal and Wright 2006, 3.1).
const ARMIJO: f64 = 1e-4;

/// Most trial steps of a line search, each half of the last.
const MAX_TRIALS: usize = 16;

/// Detects the contacts and computes the gradient at the state's positions; returns its norm (N).
pub fn update_gradient(problem: &Problem, state: &State, workspace: &mut Workspace) -> f64 {
    let system = problem.system;
    workspace.contacts.refresh(system, state, &state.positions);
    workspace.fill_gradient(system, &state.positions, Some(&problem.inertia));
    dot(&workspace.gradient, &workspace.gradient).sqrt()
}

/// Iterates until the gradient is below the tolerance. `iterate` lowers the potential by means of the gradient in the
/// workspace and returns the fraction of its step that was taken. A fraction of zero ends the descent; in the first
/// iteration it is a failure.
pub fn descend(
    problem: &Problem,
    state: &mut State,
    workspace: &mut Workspace,
    mut iterate: impl FnMut(&mut State, &mut Workspace, usize) -> f64,
) -> NewtonReport {
    let mut report = NewtonReport {
        succeeded: true,
        ..NewtonReport::default()
    };
    while report.iterations < problem.limits.iterations {
        report.gradient = update_gradient(problem, state, workspace);
        report.succeeded = report.gradient.is_finite();
        if report.gradient <= problem.limits.tolerance || !report.succeeded {
            break;
        }
        report.fraction = iterate(state, workspace, report.iterations);
        if report.fraction == 0.0 {
            report.succeeded = report.iterations > 0;
            break;
        }
        report.iterations += 1;
    }
    report
}

/// Scales a direction so that no vertex moves farther than contact detection allows, where there are solids.
pub fn truncate_length(problem: &Problem, direction: &mut [Vec3]) {
    let moved = direction.iter().map(Vec3::norm_squared).fold(0.0, f64::max);
    let longest = problem.longest_move(MAX_MOVE);
    if moved > longest * longest {
        let scale = longest / moved.sqrt();
        for d in direction {
            *d *= scale;
        }
    }
}

/// The step of a line search.
pub struct Line<'a> {
    /// The full step (m).
    pub direction: &'a [Vec3],
    /// Most trial steps.
    pub max_trials: usize,
    /// In: the potential at the start, where known. Out: the potential at the end, where it is known (J).
    pub energy: &'a mut Option<f64>,
}

/// Backtracking line search: moves by the largest fraction 1, 1/2, 1/4 ... of the step that satisfies Armijo's
/// condition. Returns the fraction, 0 where none does. The former positions are in `workspace.trial` afterwards.
pub fn line_search(
    problem: &Problem,
    state: &mut State,
    workspace: &mut Workspace,
    line: Line,
) -> f64 {
    let system = problem.system;
    let Line {
        direction,
        max_trials,
        energy: known,
    } = line;
    let start = known
        .take()
        .unwrap_or_else(|| workspace.potential(system, &state.positions, &problem.inertia));
    let slope = dot(&workspace.gradient, direction);
    // A change below the rounding error of the potential counts as a decrease.
    let rounding = 1e-13 * start.abs().max(1.0);
    let mut trial = std::mem::take(&mut workspace.trial);
    let mut fraction = 1.0;
    for _ in 0..max_trials.min(MAX_TRIALS) {
        for ((trial, x), d) in trial.iter_mut().zip(&state.positions).zip(direction) {
            *trial = x + d * fraction;
        }
        let energy = workspace.potential(system, &trial, &problem.inertia);
        if energy <= start + ARMIJO * fraction * slope + rounding {
            // With solids the potential changes, since contact planes are detected anew.
            *known = system.colliders.is_empty().then_some(energy);
            std::mem::swap(&mut state.positions, &mut trial);
            workspace.trial = trial;
            return fraction;
        }
        fraction *= 0.5;
    }
    workspace.trial = trial;
    *known = Some(start);
    0.0
}
