//! The direction of a Newton step: the linear solve, the kinks of contact it runs into, and how far
//! it may go.

use super::{Inertia, LinearSolver, NewtonReport, NewtonSettings, Workspace};
use crate::System;
use crate::hessian::{Direct, Hessian};
use crate::laws::membrane::Curvature;
use toile_geometry::Vec3;
use toile_sparse::LinearSystem;
use toile_sparse::dot;

/// Times a direction is found anew because points come back from the limit of friction.
const FORESIGHTS: usize = 2;

impl Workspace {
    /// Turns the sign of the gradient: the right side of the linear system.
    pub(crate) fn turn_gradient(&mut self) {
        for g in &mut self.gradient {
            *g = -*g;
        }
    }

    /// Finds the Newton direction, `gradient` holding its negative: with the Hessian asked for, or the
    /// next with less of the destabilising curvature that is positive definite; then anew with the
    /// kinks of contact that it runs into.
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
        for _ in 0..FORESIGHTS {
            let promises = 0.5 * dot(&self.gradient, &self.direction);
            if !(self.contacts).foresee(x, &self.direction, promises) {
                break;
            }
            self.force.clone_from(&self.gradient);
            self.trial.clone_from(&self.direction);
            self.contacts.pull_down(system, x, &mut self.gradient);
            self.solve_with(system, x, inertia, settings, report);
            std::mem::swap(&mut self.force, &mut self.gradient);
            if dot(&self.gradient, &self.direction) <= 0.0 {
                std::mem::swap(&mut self.trial, &mut self.direction);
                break;
            }
        }
    }

    /// Solves with the Hessian of `report.curvature`, or with the next that is positive definite; the
    /// convex one always is.
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

    /// Solves for the Newton direction, `gradient` holding its negative; returns the iterations
    /// taken.
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
            touching: &self.touching,
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

    /// Solves for `gradient` by factorisation; false when the matrix is not positive definite.
    fn solve_directly(&mut self, system: &System) -> bool {
        let fits = |direct: &Direct| direct.fits(system, &self.touching);
        let direct = match self.direct.take().filter(fits) {
            Some(direct) => self.direct.insert(direct),
            None => {
                let near = self.contacts.cloth.couples();
                self.structures += 1;
                self.direct
                    .insert(Direct::new(system, &system.topology.layout, &near))
            }
        };
        let hessian = Hessian {
            system,
            bending: self.increment.bending(system),
            blocks: &self.blocks,
            secants: &self.secants,
            touching: &self.touching,
        };
        direct.solve(&hessian, &self.gradient, &mut self.direction)
    }

    /// Shortens the whole direction so that no vertex moves farther than `longest` [m].
    pub(super) fn limit_moves(&mut self, longest: f64) {
        let most = self.longest_direction();
        if most > longest {
            let scale = longest / most;
            for d in &mut self.direction {
                *d *= scale;
            }
        }
    }

    /// Shortens the direction where cloth would pass through cloth: vertex by vertex, or, where that
    /// would no longer lower the potential, as a whole.
    pub(super) fn truncate_by_contact(&mut self, system: &System, x: &[Vec3]) {
        if system.contact.cloth_offset <= 0.0 {
            return;
        }
        self.trial.clone_from(&self.direction);
        let held = (self.contacts).truncate_moves(system, x, &mut self.direction);
        // `gradient` holds its negative after the linear solve.
        if held == 0 || dot(&self.gradient, &self.direction) > 0.0 {
            return;
        }
        let share = |(whole, cut): (&Vec3, &Vec3)| {
            let length = whole.norm();
            if length > 0.0 {
                cut.norm() / length
            } else {
                1.0
            }
        };
        let least = self
            .trial
            .iter()
            .zip(&self.direction)
            .map(share)
            .fold(1.0, f64::min);
        for (d, whole) in self.direction.iter_mut().zip(&self.trial) {
            *d = whole * least;
        }
    }
}
