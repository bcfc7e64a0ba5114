//! Chord steps (Kelley 1995, chapter 5): steps that reuse the factor of the last Newton step, here as the initial
//! metric of L-BFGS (Nocedal 1980). A solve costs a tenth of a factorisation, and cloth that buckles changes few
//! entries of the Hessian at a time.

use super::{Inertia, Workspace};
use crate::correction_pairs::CorrectionPairs;
use crate::{State, System};
use toile_sparse::dot;

/// Chord steps end when the line search takes less than this fraction of one: the factor no longer approximates
/// the Hessian.
const MIN_FRACTION: f64 = 0.1;

/// When chord steps end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ChordLimits {
    /// Most steps.
    pub steps: usize,
    /// Stop when the gradient's norm is below this (N).
    pub tolerance: f64,
    /// Longest displacement of any vertex in one step (m).
    pub longest_move: f64,
}

impl Workspace {
    /// Lowers the potential further with the matrix factorised last. Friction anchors are updated after each
    /// step, so that points at the limit of friction creep to rest on one factor. Contacts with solids are
    /// detected before each step, those of cloth with cloth once. Tangled cloth takes no chord step: its recovery
    /// direction has to be computed anew after every displacement. Returns the number of steps taken.
    pub(crate) fn chord_steps(
        &mut self,
        system: &System,
        state: &mut State,
        inertia: &Inertia,
        limits: ChordLimits,
    ) -> usize {
        self.contacts.refresh(system, state, &state.positions);
        if !self.contacts.cloth.is_in_order() {
            return 0;
        }
        let start = state.clone();
        let mut pairs = CorrectionPairs::default();
        let mut steps = 0;
        while steps < limits.steps {
            if steps > 0 {
                self.contacts
                    .refresh_surfaces(system, state, &state.positions);
            }
            let fraction = self.chord_step(system, state, inertia, &mut pairs, limits);
            steps += usize::from(fraction > 0.0);
            if fraction < MIN_FRACTION {
                break;
            }
        }
        if steps > 0 && !self.truncate_or_undo(system, state, start.positions.clone()) {
            *state = start;
            return 0;
        }
        steps
    }

    /// One step with the contacts detected last; returns the fraction of it that the line search took.
    fn chord_step(
        &mut self,
        system: &System,
        state: &mut State,
        inertia: &Inertia,
        pairs: &mut CorrectionPairs,
        limits: ChordLimits,
    ) -> f64 {
        self.fill_gradient(system, &state.positions, Some(inertia));
        let norm = dot(&self.gradient, &self.gradient).sqrt();
        if !norm.is_finite() || norm <= limits.tolerance {
            return 0.0;
        }
        pairs.push(&state.positions, &self.gradient, limits.steps);
        let Some(direct) = &mut self.direct else {
            return 0.0;
        };
        let mut solved = false;
        pairs.descent_direction(&mut self.direction, |q, r| {
            solved = direct.solve_again(q, r);
        });
        self.negate_gradient();
        if !solved || dot(&self.gradient, &self.direction) <= 0.0 {
            return 0.0;
        }
        self.truncate_length(limits.longest_move);
        let fraction = self.line_search(system, &state.positions, inertia);
        if fraction > 0.0 {
            std::mem::swap(&mut state.positions, &mut self.trial);
            self.contacts.remember_step(system, state);
        }
        fraction
    }
}

#[cfg(test)]
mod tests {
    use super::super::elimination::tests::hung;
    use super::*;
    use crate::measure::residual;
    use crate::{LinearSolver, NewtonSettings, PcgLimits};

    const LIMITS: ChordLimits = ChordLimits {
        steps: 24,
        tolerance: 0.0,
        longest_move: 0.015,
    };

    /// A rumpled sheet after one Newton step of a pseudo step of 0.1 s: the number of chord steps, and the
    /// residual before and after them.
    fn after_newton(direct: bool) -> (usize, [f64; 2]) {
        let (system, rest, mut workspace) = hung();
        let mut state = rest;
        for (v, x) in state.positions.iter_mut().enumerate().skip(41) {
            x.z += 3e-4 * (v as f64 * 1.7).sin();
        }
        let weight: Vec<f64> = system.rest.mass.iter().map(|m| m * 100.0).collect();
        let target = state.positions.clone();
        let inertia = Inertia {
            weight: &weight,
            target: &target,
        };
        let pcg = PcgLimits {
            tolerance: 1e-3,
            iterations: 500,
        };
        let settings = NewtonSettings {
            iterations: 1,
            tolerance: 0.0,
            longest_move: 0.015,
            linear: match direct {
                true => LinearSolver::Direct { otherwise: pcg },
                false => LinearSolver::Iterative(pcg),
            },
            curvature: crate::laws::membrane::Curvature::CONVEX,
        };
        if !direct {
            workspace = Workspace::default();
        }
        assert!(
            workspace
                .solve(&system, &mut state, &inertia, &settings)
                .succeeded
        );
        let before = residual(&system, &state, &mut workspace);
        let start = state.positions.clone();
        let steps = workspace.chord_steps(&system, &mut state, &inertia, LIMITS);
        assert_eq!(steps == 0, state.positions == start);
        (steps, [before, residual(&system, &state, &mut workspace)])
    }

    #[test]
    fn one_factor_is_used_for_many_steps() {
        let (steps, [before, after]) = after_newton(true);
        assert!(
            steps > 10 && after < 0.1 * before,
            "{steps} {before} {after}"
        );
    }

    #[test]
    fn without_a_factor_no_step_is_taken() {
        assert_eq!(after_newton(false).0, 0);
    }

    #[test]
    fn no_step_is_taken_from_a_nan_state() {
        let (system, mut state, mut workspace) = hung();
        let inertia = Inertia {
            weight: &vec![1.0; system.vertex_count()],
            target: &state.positions.clone(),
        };
        state.positions[800].x = f64::NAN;
        assert_eq!(
            workspace.chord_steps(&system, &mut state, &inertia, LIMITS),
            0
        );
    }
}
