//! What the quasi-Newton methods share: gradient and potential at a place, and a line search.

use crate::methods::implicit::{LONGEST_MOVE, Problem};
use crate::{NewtonReport, State, Workspace};
use toile_geometry::Vec3;
use toile_sparse::dot;

/// Sufficient decrease (Armijo's constant; Nocedal and Wright 2006, 3.1).
const DECREASE: f64 = 1e-4;

/// Halvings before a line search gives up.
const HALVINGS: usize = 16;

/// Contacts and gradient at the state's positions; returns the gradient's norm [N].
pub fn slope(problem: &Problem, state: &State, workspace: &mut Workspace) -> f64 {
    let system = problem.system;
    workspace.contacts.refresh(system, state, &state.positions);
    workspace.fill_gradient(system, &state.positions, Some(&problem.inertia));
    dot(&workspace.gradient, &workspace.gradient).sqrt()
}

/// Iterates until the gradient is below the tolerance. `iterate` lowers the potential from the
/// gradient in the workspace and returns the share of its step that was taken; where nothing
/// lowers it any more the descent ends, a failure only when nothing ever did.
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
        report.gradient = slope(problem, state, workspace);
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

/// Shortens a direction so that no vertex near solid surfaces moves too far to find its contact.
pub fn shorten(problem: &Problem, direction: &mut [Vec3]) {
    let moved = direction.iter().map(Vec3::norm_squared).fold(0.0, f64::max);
    let longest = problem.longest_move(LONGEST_MOVE);
    if moved > longest * longest {
        let scale = longest / moved.sqrt();
        for d in direction {
            *d *= scale;
        }
    }
}

/// What a search goes along.
pub struct Line<'a> {
    /// The whole step [m].
    pub direction: &'a [Vec3],
    /// How many shares of it are tried.
    pub shares: usize,
    /// Potential where it starts, where known, and then where it ended [J].
    pub energy: &'a mut Option<f64>,
}

/// Moves along `line.direction` by the largest of 1, 1/2, 1/4 ... that lowers the potential enough;
/// returns the share, 0 when none does. The positions before are left in `workspace.trial`.
pub fn search(problem: &Problem, state: &mut State, workspace: &mut Workspace, line: Line) -> f64 {
    let system = problem.system;
    let Line {
        direction,
        shares,
        energy: known,
    } = line;
    let start = known
        .take()
        .unwrap_or_else(|| workspace.potential(system, &state.positions, &problem.inertia));
    let slope = dot(&workspace.gradient, direction);
    // Below rounding of the potential nothing can be told apart: take the step.
    let noise = 1e-13 * start.abs().max(1.0);
    let mut trial = std::mem::take(&mut workspace.trial);
    let mut share = 1.0;
    for _ in 0..shares.min(HALVINGS) {
        for ((trial, x), d) in trial.iter_mut().zip(&state.positions).zip(direction) {
            *trial = x + d * share;
        }
        let energy = workspace.potential(system, &trial, &problem.inertia);
        if energy <= start + DECREASE * share * slope + noise {
            // With solid surfaces the planes, and with them the potential, are found anew.
            *known = system.colliders.is_empty().then_some(energy);
            std::mem::swap(&mut state.positions, &mut trial);
            workspace.trial = trial;
            return share;
        }
        share *= 0.5;
    }
    workspace.trial = trial;
    *known = Some(start);
    0.0
}
