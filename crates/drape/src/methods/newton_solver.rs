//! Lowering the potential by Newton's method: to its minimum, or by one linear solve.

use super::implicit::{LONGEST_MOVE, Limits, Problem, Solver};
use crate::laws::membrane::Curvature;
use crate::{LinearSolver, NewtonReport, NewtonSettings, PcgLimits, State, System, Workspace};
use toile_sparse::dot;

/// Block conjugate gradients to 1e-6 of the first residual, within 1000 iterations.
const LINEAR: LinearSolver = LinearSolver::Iterative(PcgLimits {
    tolerance: 1e-6,
    iterations: 1000,
});

/// By factorisation, iterating where the matrix cannot be factorised.
const FACTORISED: LinearSolver = LinearSolver::Direct {
    otherwise: PcgLimits {
        tolerance: 1e-6,
        iterations: 1000,
    },
};

/// Product of the fastest vibration and the step beyond which systems are factorised: conjugate
/// gradients take about twice as many iterations, and thirty cost as much as a factorisation of a
/// thousand vertices.
const STIFF: f64 = 15.0;

/// Whether steps with inertia's weight per mass `weight` [1/s2] are long for the model's fastest
/// vibrations, judged by one triangle after the other: w^2 = C |a|^2 3 / rho.
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
                    > STIFF * STIFF * weight * system.rest.mass[corners[i] as usize]
            })
        })
}

/// Relative tolerance of a step that is never corrected: what the solve leaves is lost momentum,
/// 1e-7 of it a step. A caller's own tolerance [N] may ask for less, down to rounding.
const ONE_SOLVE: [f64; 2] = [1e-14, 1e-8];

/// Newton's method with line search to the minimum: see [`Workspace::solve`].
///
/// Rules that extrapolate from the minimum (midpoint, BDF2) are `STRICT`: a step counts only when
/// it was reached. Implicit Euler ends at the minimum itself: a step cut short lost more energy
/// than it should, and is still sound.
#[derive(Default)]
pub struct Newton<const STRICT: bool>;

impl<const STRICT: bool> Solver for Newton<STRICT> {
    const STAGE: &'static str = "implicit step";
    const LIMITS: Limits = Limits {
        iterations: 40,
        tolerance: 1e-8,
    };
    const CONVERGES: bool = STRICT;

    fn lower(
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
            longest_move: problem.longest_move(LONGEST_MOVE),
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
/// the 3x3 diagonal blocks, pins held exactly. K is the positive semidefinite Hessian. What the
/// solve cannot see (kinks, large rotation in one step) is not corrected; a step whose energy
/// rises out of bounds is halved, as theirs is.
#[derive(Default)]
pub struct OneSolve;

impl Solver for OneSolve {
    const STAGE: &'static str = "semi-implicit Euler";
    const LIMITS: Limits = Limits {
        iterations: 1,
        tolerance: 0.0,
    };
    const CONVERGES: bool = false;

    fn lower(
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
        let [rounding, usual] = ONE_SOLVE;
        let asked = problem.limits.tolerance;
        let linear = LinearSolver::Iterative(PcgLimits {
            tolerance: if asked > 0.0 && gradient > 0.0 {
                (asked / gradient).clamp(rounding, usual)
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
