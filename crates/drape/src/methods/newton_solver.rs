//! Minimisers by Newton's method: to convergence, or by one linear solve.

use super::implicit::{Limits, MAX_MOVE, Problem, Solver};
use crate::laws::membrane::Curvature;
use crate::{LinearSolver, NewtonReport, NewtonSettings, PcgLimits, State, System, Workspace};
use toile_sparse::dot;

/// Block conjugate gradients to 1e-6 of the first residual, within 1000 iterations.
const LINEAR: LinearSolver = LinearSolver::Iterative(PcgLimits {
    tolerance: 1e-6,
    iterations: 1000,
});

/// By factorisation, and by conjugate gradients where the matrix cannot be factorised.
const FACTORISED: LinearSolver = LinearSolver::Direct {
    otherwise: PcgLimits {
        tolerance: 1e-6,
        iterations: 1000,
    },
};

/// Largest product h w, w the largest frequency, at which systems are solved by conjugate gradients: they take about
/// twice as many iterations, and thirty cost as much as a factorisation of a thousand vertices.
const MAX_ITERATIVE_STEP: f64 = 15.0;

/// Whether steps with inertia's weight per mass `weight` (1/s2) are stiff: whether h w exceeds [`MAX_ITERATIVE_STEP`],
/// by the frequencies of single triangles, w^2 = C |a|^2 3 / rho.
fn is_stiff(system: &System, weight: f64) -> bool {
    system
        .topology
        .triangles
        .iter()
        .enumerate()
        .any(|(t, corners)| {
            let element = &system.rest.elements[t];
            let [c11, c22, ..] = system.materials.law(t).stiffness;
            (0..3).any(|i| {
                let stiffness = c11 * element.warp[i].powi(2) + c22 * element.weft[i].powi(2);
                element.area * stiffness
                    > MAX_ITERATIVE_STEP
                        * MAX_ITERATIVE_STEP
                        * weight
                        * system.rest.mass[corners[i] as usize]
            })
        })
}

/// Least and usual relative tolerance of the single linear solve, whose error is lost momentum, 1e-7 of it a step. A
/// tolerance of the settings (N) lowers it down to the least, which is rounding.
const ONE_SOLVE_TOLERANCE: [f64; 2] = [1e-14, 1e-8];

/// Newton's method with line search: see [`Workspace::solve`].
///
/// Rules that extrapolate from the minimum (midpoint, BDF2) are `STRICT`: a step without convergence fails. Implicit
/// Euler ends at the minimum itself: without convergence a step only loses more energy than it should.
#[derive(Default)]
pub struct Newton<const STRICT: bool>;

impl<const STRICT: bool> Solver for Newton<STRICT> {
    const STAGE: &'static str = "implicit step";
    const LIMITS: Limits = Limits {
        iterations: 40,
        tolerance: 1e-8,
    };
    const CONVERGES: bool = STRICT;

    fn minimise(
        &mut self,
        problem: &Problem,
        state: &mut State,
        workspace: &mut Workspace,
    ) -> NewtonReport {
        let (curvature, linear) = if is_stiff(problem.system, problem.weight) {
            (Curvature::EXACT, FACTORISED)
        } else {
            (Curvature::CONVEX, LINEAR)
        };
        let settings = NewtonSettings {
            iterations: problem.limits.iterations,
            tolerance: problem.limits.tolerance,
            longest_move: problem.longest_move(MAX_MOVE),
            curvature,
            linear,
        };
        workspace.solve(problem.system, state, &problem.inertia, &settings)
    }
}

/// One linear solve and nothing else: (M (1 + c h) / h^2 + K(x)) dx = -grad Phi(x), x' = x + dx.
///
/// With dv = dx/h - v this is (M + h^2 K) dv = h (f(x) - h K v), semi-implicit Euler as in
/// Baraff and Witkin 1998, equation 6, solved like theirs by conjugate gradients preconditioned by
/// the 3x3 diagonal blocks, with exact pins. K is the positive semidefinite Hessian. Nonlinear errors (kinks,
/// large rotations in one step) are not corrected; a step whose energy exceeds its bound is halved, as theirs is.
#[derive(Default)]
pub struct OneSolve;

impl Solver for OneSolve {
    const STAGE: &'static str = "semi-implicit Euler";
    const LIMITS: Limits = Limits {
        iterations: 1,
        tolerance: 0.0,
    };
    const CONVERGES: bool = false;

    fn minimise(
        &mut self,
        problem: &Problem,
        state: &mut State,
        workspace: &mut Workspace,
    ) -> NewtonReport {
        let system = problem.system;
        workspace.fit(system);
        workspace.contacts.refresh(system, state, &state.positions);
        workspace.fill_gradient(system, &state.positions, Some(&problem.inertia));
        workspace.fill_hessian(
            system,
            &state.positions,
            &problem.inertia,
            Curvature::CONVEX,
        );
        let gradient = dot(&workspace.gradient, &workspace.gradient).sqrt();
        let [rounding, usual] = ONE_SOLVE_TOLERANCE;
        let tolerance = problem.limits.tolerance;
        let linear = LinearSolver::Iterative(PcgLimits {
            tolerance: if tolerance > 0.0 && gradient > 0.0 {
                (tolerance / gradient).clamp(rounding, usual)
            } else {
                usual
            },
            iterations: 1000,
        });
        workspace.negate_gradient();
        let linear_iterations = workspace.solve_linear(system, linear);
        for (x, d) in state.positions.iter_mut().zip(&workspace.direction) {
            *x += d;
        }
        NewtonReport {
            iterations: 1,
            linear_iterations,
            gradient,
            fraction: 1.0,
            succeeded: gradient.is_finite(),
            ..NewtonReport::default()
        }
    }
}
