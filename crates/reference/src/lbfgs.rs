//! L-BFGS that starts from the metric of projective dynamics.

use super::descent::{Line, descend, line_search, truncate_length};
use super::metric::Metric;
use toile_drape::methods::implicit::{Limits, Problem, Solver};
use toile_drape::{CorrectionPairs, NewtonReport, State, Workspace};
use toile_geometry::Vec3;

/// L-BFGS (Nocedal 1980) whose initial inverse Hessian is the inverse of the prefactored [`Metric`]
/// (Liu, Bouaziz and Kavan 2017, section 5). With a backtracking line search; a pair is stored
/// where s.y > 0.
#[derive(Default)]
pub struct Lbfgs {
    metric: Metric,
    pairs: CorrectionPairs,
    direction: Vec<Vec3>,
}

/// Number of stored pairs.
const MEMORY: usize = 8;

impl Lbfgs {
    /// A step in the L-BFGS direction for the present gradient; returns the fraction of it that was taken.
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
        truncate_length(problem, &mut self.direction);
        let line = Line {
            direction: &self.direction,
            max_trials: usize::MAX,
            energy,
        };
        line_search(problem, state, workspace, line)
    }
}

impl Solver for Lbfgs {
    const STAGE: &'static str = "L-BFGS";
    const LIMITS: Limits = Limits {
        iterations: 60,
        tolerance: 1e-7,
    };
    const CONVERGES: bool = false;

    fn minimise(
        &mut self,
        problem: &Problem,
        state: &mut State,
        workspace: &mut Workspace,
    ) -> NewtonReport {
        workspace.fit(problem.system);
        self.direction
            .resize(problem.system.vertex_count(), Vec3::zeros());
        self.pairs = CorrectionPairs::default();
        if !self.metric.fit(problem.system, problem.weight) {
            return NewtonReport::default();
        }
        let mut energy = None;
        descend(problem, state, workspace, |state, workspace, _| {
            self.metric.update_contacts(problem, state, workspace);
            let (x, gradient) = (&state.positions, &workspace.gradient);
            self.pairs.push(x, gradient, MEMORY);
            let fraction = self.step(problem, state, workspace, &mut energy);
            if fraction > 0.0 || self.pairs.is_empty() {
                return fraction;
            }
            // The pairs give no descent direction: a second attempt with the metric alone.
            self.pairs.clear();
            self.step(problem, state, workspace, &mut energy)
        })
    }
}
