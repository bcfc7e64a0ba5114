//! First-order prediction of an equilibrium under changed rest shapes: one step with the matrix factorised last
//! (sensitivity of an equilibrium; Umetani, Kaufman, Igarashi and Grinspun 2011).
//!
//! At equilibrium g(x; q) = 0 for the gradient g at positions x and rest shapes q. With other shapes q'
//! ```text
//! dx = -H^-1 g(x; q'),    2 E = g . H^-1 g
//! ```
//! is a chord step of Newton's method: the gradient is that of the new shapes, the matrix still that of the old.
//! E (J), half the squared Newton decrement, is the predicted decrease of the potential and measures the distance
//! to the new equilibrium.

use super::{Inertia, LinearSolver, NewtonReport, NewtonSettings, PcgLimits, Workspace};
use crate::laws::membrane::Curvature;
use crate::{State, System};
use toile_geometry::Vec3;
use toile_sparse::dot;

/// A first-order step towards another equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FirstOrder {
    /// Predicted positions of the vertices (m).
    pub positions: Vec<Vec3>,
    /// Decrease of the potential that the quadratic model predicts for the full step (J).
    pub predicted_decrease: f64,
    /// Fraction of the step that was taken.
    pub share: f64,
}

impl Workspace {
    /// The first-order step from an equilibrium under other rest shapes; it is shortened where cloth would pass
    /// through cloth, where a vertex would move farther than `longest_move` (m), and where the potential would not
    /// decrease. Where no factor is available, the matrix of the state is factorised, with the inertia of a
    /// pseudo step of `pseudo_step` (s). None where a number is not finite.
    pub(crate) fn first_order(
        &mut self,
        system: &System,
        state: &State,
        pseudo_step: f64,
        longest_move: f64,
    ) -> Option<FirstOrder> {
        self.fit(system);
        self.increment.begin_static(system, state);
        let x = &state.positions;
        self.contacts.refresh(system, state, x);
        self.fill_gradient(system, x, None);
        let weight = 1.0 / (pseudo_step * pseudo_step);
        let weight: Vec<f64> = system.rest.mass.iter().map(|m| m * weight).collect();
        let inertia = Inertia {
            weight: &weight,
            target: x,
        };
        self.negate_gradient();
        let last = self.direct.as_mut().filter(|direct| direct.is_of(system));
        let solved = last.is_some_and(|last| last.solve_again(&self.gradient, &mut self.direction));
        if !solved || dot(&self.gradient, &self.direction) <= 0.0 {
            let settings = NewtonSettings {
                iterations: 1,
                tolerance: 0.0,
                longest_move,
                curvature: Curvature::EXACT,
                linear: LinearSolver::Direct {
                    otherwise: PcgLimits {
                        tolerance: 1e-3,
                        iterations: 2000,
                    },
                },
            };
            self.find_direction(system, x, &inertia, &settings, &mut NewtonReport::default());
        }
        let predicted_decrease = 0.5 * dot(&self.gradient, &self.direction);
        if !predicted_decrease.is_finite() {
            return None;
        }
        self.truncate_length(longest_move);
        self.truncate_by_contact(system, x);
        let share = self.line_search(system, x, &inertia);
        let positions = match share > 0.0 {
            true => self.trial.clone(),
            false => x.clone(),
        };
        Some(FirstOrder {
            positions,
            predicted_decrease,
            share,
        })
    }
}
