//! Where cloth at rest goes when its rest shapes change, to first order: one step with the matrix factorised
//! last (sensitivity of an equilibrium; Umetani, Kaufman, Igarashi and Grinspun 2011).
//!
//! At rest g(x; q) = 0 for the net force g at places x and rest shapes q. With other shapes q'
//! ```text
//! dx = -H^-1 g(x; q'),    2 E = g . H^-1 g
//! ```
//! is a chord step of Newton's method: the force is that of the new shapes, the matrix still that of the old.
//! E [J], half the square of Newton's decrement, is what the step promises to lower the potential by, and
//! says how far off the new rest is.

use super::{Inertia, LinearSolver, NewtonReport, NewtonSettings, PcgLimits, Workspace};
use crate::laws::membrane::Curvature;
use crate::{State, System};
use toile_geometry::Vec3;
use toile_sparse::dot;

/// A first-order step towards another rest.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FirstOrder {
    /// Where the vertices come to lie [m].
    pub positions: Vec<Vec3>,
    /// What the whole step promised to lower the potential by [J].
    pub promised: f64,
    /// Share of the step that was taken.
    pub share: f64,
}

impl Workspace {
    /// The step from a state at rest under other rest shapes, shortened where cloth would pass through cloth,
    /// where a vertex would go farther than `longest_move` [m], and where the potential would not fall. Where
    /// no matrix was factorised yet, that of the state is, under a pseudo step of `pseudo_step` [s]. None where
    /// numbers are not finite.
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
        self.turn_gradient();
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
        let promised = 0.5 * dot(&self.gradient, &self.direction);
        if !promised.is_finite() {
            return None;
        }
        self.limit_moves(longest_move);
        self.truncate_by_contact(system, x);
        let share = self.line_search(system, x, &inertia);
        let positions = match share > 0.0 {
            true => self.trial.clone(),
            false => x.clone(),
        };
        Some(FirstOrder {
            positions,
            promised,
            share,
        })
    }
}
