//! The direction of a Newton step: the linear solve, the prediction of contact kinks, and the truncation of the
//! step.
//!
//! # Decided with
//! - [`crate::methods`] (`newton_solver.rs`, `is_stiff`), [`crate::sew::SewRun::advance`],
//!   [`crate::pseudo_transient::PseudoTransientContinuation::advance`]: who chooses to iterate or to
//!   factorise;
//! - [`crate::newton::LinearSolver`]: the kinds of linear solver;
//! - [`toile_sparse::factor`], [`toile_sparse::Pcg`]: factorisation; conjugate gradients and their
//!   preconditioner;
//! - [`crate::newton::NewtonReport::next_curvature`]: how much of the indefinite part of the Hessian the next
//!   step keeps;
//! - [`crate::laws::membrane::Curvature`], [`crate::laws::contact::ContactLaw::missing_curvature`]: what is
//!   left out to keep the Hessian positive definite;
//! - [`crate::newton::contact_kinks`]: direction found anew where a contact sticks or lands;
//! - [`crate::collision::truncate_moves`]: step cut so that cloth does not pass through cloth;
//! - [`crate::newton::Workspace::line_search`]: step halved until the potential falls.

use super::{Inertia, LinearSolver, NewtonReport, NewtonSettings, Workspace};
use crate::System;
use crate::hessian::{Direct, Hessian};
use crate::laws::membrane::Curvature;
use toile_geometry::Vec3;
use toile_sparse::LinearSystem;
use toile_sparse::dot;

/// Most times that a direction is computed anew because it crosses kinks of contact.
const MAX_KINK_PREDICTIONS: usize = 2;

impl Workspace {
    /// Negates the gradient: it becomes the right side of the linear system.
    pub(crate) fn negate_gradient(&mut self) {
        for g in &mut self.gradient {
            *g = -*g;
        }
    }

    /// Computes the Newton direction; `gradient` contains the negative gradient. Uses the Hessian of
    /// `settings.curvature`, or the next one with less destabilising curvature that is positive definite. Where
    /// the direction crosses kinks of contact it is computed anew with those points as sticking or touching.
    pub(super) fn find_direction(
        &mut self,
        system: &System,
        x: &[Vec3],
        inertia: &Inertia,
        settings: &NewtonSettings,
        report: &mut NewtonReport,
    ) {
        if !matches!(settings.linear, LinearSolver::Direct { .. }) {
            report.curvature = Curvature::CONVEX;
            self.solve_with(system, x, inertia, settings, report);
            return;
        }
        report.curvature = settings.curvature;
        self.solve_with(system, x, inertia, settings, report);
        for _ in 0..MAX_KINK_PREDICTIONS {
            let predicted_decrease = 0.5 * dot(&self.gradient, &self.direction);
            if !(self.contacts).predict_kinks(x, &self.direction, predicted_decrease) {
                break;
            }
            self.force.clone_from(&self.gradient);
            self.trial.clone_from(&self.direction);
            (self.contacts).add_landing_pull(system, x, &mut self.gradient);
            self.solve_with(system, x, inertia, settings, report);
            std::mem::swap(&mut self.force, &mut self.gradient);
            if dot(&self.gradient, &self.direction) <= 0.0 {
                std::mem::swap(&mut self.trial, &mut self.direction);
                break;
            }
        }
    }

    /// Solves with the Hessian of `report.curvature`, or with the next one that is positive definite; the convex
    /// one always is.
    fn solve_with(
        &mut self,
        system: &System,
        x: &[Vec3],
        inertia: &Inertia,
        settings: &NewtonSettings,
        report: &mut NewtonReport,
    ) {
        while report.curvature != Curvature::CONVEX {
            self.fill_hessian(system, x, inertia, report.curvature);
            if self.solve_directly(system) {
                return;
            }
            report.curvature = report.curvature.less();
        }
        self.fill_hessian(system, x, inertia, Curvature::CONVEX);
        report.linear_iterations += self.solve_linear(system, settings.linear);
    }

    /// Solves for the Newton direction; `gradient` contains the negative gradient. Returns the iterations of the
    /// linear solver, zero for a factorisation.
    pub(crate) fn solve_linear(&mut self, system: &System, limits: LinearSolver) -> usize {
        let limits = match limits {
            LinearSolver::Iterative(limits) => limits,
            LinearSolver::Direct { otherwise } => {
                if self.solve_directly(system) {
                    return 0;
                }
                otherwise
            }
        };
        let hessian = Hessian {
            system,
            bending: self.increment.bending(system),
            blocks: &self.blocks,
            secants: &self.secants,
            touching: &self.cloth_contact_blocks,
        };
        self.jacobi
            .refresh(&system.prescribed.pinned, |row| hessian.diagonal(row));
        let system = LinearSystem {
            b: &self.gradient,
            fixed: &system.prescribed.pinned,
            row: |row, p: &[Vec3]| hessian.row_times(row, p),
        };
        self.pcg
            .solve(&system, &mut self.jacobi, limits, &mut self.direction)
    }

    /// Solves for the right side `gradient` by factorisation; false where the matrix is not positive definite.
    fn solve_directly(&mut self, system: &System) -> bool {
        let fits = |direct: &Direct| direct.fits(system, &self.cloth_contact_blocks);
        let direct = match self.direct.take().filter(fits) {
            Some(direct) => self.direct.insert(direct),
            None => {
                let cloth_pairs = self.contacts.cloth.couples();
                self.symbolic_factorisations += 1;
                self.direct
                    .insert(Direct::new(system, &system.topology.layout, &cloth_pairs))
            }
        };
        let hessian = Hessian {
            system,
            bending: self.increment.bending(system),
            blocks: &self.blocks,
            secants: &self.secants,
            touching: &self.cloth_contact_blocks,
        };
        direct.solve(&hessian, &self.gradient, &mut self.direction)
    }

    /// Scales the direction so that no vertex moves farther than `longest` (m).
    pub(super) fn truncate_length(&mut self, longest: f64) {
        let length = self.longest_displacement();
        if length > longest {
            let scale = longest / length;
            for d in &mut self.direction {
                *d *= scale;
            }
        }
    }

    /// Truncates the direction where cloth would pass through cloth: vertex by vertex, or uniformly where the
    /// truncated direction would no longer be one of descent.
    pub(super) fn truncate_by_contact(&mut self, system: &System, x: &[Vec3]) {
        if system.contact.cloth_offset <= 0.0 {
            return;
        }
        self.trial.clone_from(&self.direction);
        let truncated = (self.contacts).truncate_moves(system, x, &mut self.direction);
        // `gradient` contains the negative gradient after the linear solve.
        if truncated == 0 || dot(&self.gradient, &self.direction) > 0.0 {
            return;
        }
        let fraction = |(full, truncated): (&Vec3, &Vec3)| {
            let length = full.norm();
            if length > 0.0 {
                truncated.norm() / length
            } else {
                1.0
            }
        };
        let smallest = self
            .trial
            .iter()
            .zip(&self.direction)
            .map(fraction)
            .fold(1.0, f64::min);
        for (d, full) in self.direction.iter_mut().zip(&self.trial) {
            *d = full * smallest;
        }
    }
}
