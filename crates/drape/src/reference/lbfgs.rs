//! L-BFGS that starts from the metric of projective dynamics.

use super::descent::{Line, descend, search, shorten};
use super::metric::Metric;
use crate::methods::implicit::{Limits, Problem, Solver};
use crate::pairs::Pairs;
use crate::{NewtonReport, State, Workspace};
use toile_geometry::Vec3;

/// L-BFGS (Nocedal 1980) whose initial inverse Hessian is the inverse of the prefactored [`Metric`]
/// (Liu, Bouaziz and Kavan 2017, section 5). Steps are searched along by halving; a pair is kept when
/// s.y > 0.
#[derive(Default)]
pub struct Lbfgs {
    metric: Metric,
    pairs: Pairs,
    direction: Vec<Vec3>,
}

/// Pairs remembered.
const MEMORY: usize = 8;

impl Lbfgs {
    /// A step along the direction for the present gradient; the share of it that was taken.
    fn step(
        &mut self,
        problem: &Problem,
        state: &mut State,
        workspace: &mut Workspace,
        energy: &mut Option<f64>,
    ) -> f64 {
        let metric = &mut self.metric;
        self.pairs.descent_direction(&mut self.direction, |q, r| {
            metric.solve(problem.system, q, r);
        });
        shorten(problem, &mut self.direction);
        let line = Line {
            direction: &self.direction,
            shares: usize::MAX,
            energy,
        };
        search(problem, state, workspace, line)
    }
}

impl Solver for Lbfgs {
    const STAGE: &'static str = "L-BFGS";
    const LIMITS: Limits = Limits {
        iterations: 60,
        tolerance: 1e-7,
    };
    const CONVERGES: bool = false;

    fn lower(
        &mut self,
        problem: &Problem,
        state: &mut State,
        workspace: &mut Workspace,
    ) -> NewtonReport {
        workspace.fit(problem.system);
        self.direction
            .resize(problem.system.vertex_count(), Vec3::zeros());
        self.pairs = Pairs::default();
        if !self.metric.fit(problem.system, problem.weight) {
            return NewtonReport::default();
        }
        let mut energy = None;
        descend(problem, state, workspace, |state, workspace, _| {
            self.metric.press(problem, state, workspace);
            let (x, gradient) = (&state.positions, &workspace.gradient);
            self.pairs.push(x, gradient, MEMORY);
            let share = self.step(problem, state, workspace, &mut energy);
            if share > 0.0 || self.pairs.is_empty() {
                return share;
            }
            // The memory misleads: once more from the metric alone.
            self.pairs.clear();
            self.step(problem, state, workspace, &mut energy)
        })
    }
}
