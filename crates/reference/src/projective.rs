//! Projective dynamics as descent in a constant metric, with Anderson acceleration.

use super::descent::{Line, descend, line_search, truncate_length};
use super::metric::Metric;
use nalgebra::{DMatrix, DVector};
use std::collections::VecDeque;
use toile_drape::methods::implicit::{Limits, Problem, Solver};
use toile_drape::{NewtonReport, State, Workspace};
use toile_geometry::Vec3;
use toile_sparse::dot;

/// Projective dynamics (Bouaziz, Martin, Liu, Kavan and Pauly 2014) for any energy, as the
/// quasi-Newton method it is (Liu, Bouaziz and Kavan 2017, section 4):
/// G(x) = x - A^-1 grad Phi(x) is one local projection and one global solve, A the prefactored
/// [`Metric`]. It lowers the same Phi as the other methods, so it converges to the same step.
///
/// Accelerated as in Peng et al. 2018: with f_k = G(x_k) - x_k and the last m differences
/// df, dx, theta minimises |f_k - sum theta_j df_j|, and
/// x_k+1 = x_k + f_k - sum theta_j (dx_j + df_j). Where that does not lower Phi, a line search along f_k is made
/// instead and the differences are cleared.
#[derive(Default)]
pub struct Projective {
    metric: Metric,
    step: Vec<Vec3>,
    accelerated: Vec<Vec3>,
    negative: Vec<Vec3>,
    last: Option<(Vec<Vec3>, Vec<Vec3>)>,
    history: VecDeque<Difference>,
}

/// Differences of positions and of steps between two iterations.
struct Difference {
    position: Vec<Vec3>,
    step: Vec<Vec3>,
}

/// Number of stored differences, m in the paper.
const MEMORY: usize = 5;

impl Projective {
    /// Stores the differences of present positions and step to the last ones.
    fn store_difference(&mut self, x: &[Vec3]) {
        let (mut position, mut step) = self.last.take().unwrap_or_default();
        if position.len() == x.len() {
            let mut difference = if self.history.len() >= MEMORY {
                self.history.pop_front()
            } else {
                None
            }
            .unwrap_or(Difference {
                position: Vec::new(),
                step: Vec::new(),
            });
            subtract(x, &position, &mut difference.position);
            subtract(&self.step, &step, &mut difference.step);
            self.history.push_back(difference);
        }
        position.clear();
        position.extend_from_slice(x);
        step.clear();
        step.extend_from_slice(&self.step);
        self.last = Some((position, step));
    }

    /// Clears the differences.
    fn clear_history(&mut self) {
        self.history.clear();
        self.last = None;
    }

    /// Computes the accelerated step in `accelerated`; false where there are no differences or it is not finite.
    fn accelerate(&mut self) -> bool {
        let m = self.history.len();
        if m == 0 {
            return false;
        }
        let mut products = DMatrix::<f64>::zeros(m, m);
        let mut right = DVector::<f64>::zeros(m);
        for i in 0..m {
            for j in 0..=i {
                let product = dot(&self.history[i].step, &self.history[j].step);
                products[(i, j)] = product;
                products[(j, i)] = product;
            }
            right[i] = dot(&self.history[i].step, &self.step);
        }
        // Nearly parallel differences: a small multiple of the identity makes the system regular.
        let trace = products.trace();
        for i in 0..m {
            products[(i, i)] += 1e-12 * trace;
        }
        let Some(theta) = products.cholesky().map(|c| c.solve(&right)) else {
            return false;
        };
        self.accelerated.clone_from(&self.step);
        for (difference, &theta) in self.history.iter().zip(theta.iter()) {
            let changes = difference.position.iter().zip(&difference.step);
            for (out, (dx, df)) in self.accelerated.iter_mut().zip(changes) {
                *out -= (dx + df) * theta;
            }
        }
        self.accelerated
            .iter()
            .all(|d| d.norm_squared().is_finite())
    }

    /// One iteration with the gradient in the workspace; returns the fraction of the step taken.
    fn iterate(
        &mut self,
        problem: &Problem,
        state: &mut State,
        workspace: &mut Workspace,
        energy: &mut Option<f64>,
    ) -> f64 {
        self.negative.clear();
        self.negative.extend(workspace.gradient.iter().map(|g| -g));
        self.metric.update_contacts(problem, state, workspace);
        self.metric
            .solve(problem.system, &self.negative, &mut self.step);
        self.store_difference(&state.positions);
        if self.accelerate() {
            let mut direction = std::mem::take(&mut self.accelerated);
            truncate_length(problem, &mut direction);
            let fraction = line_search(
                problem,
                state,
                workspace,
                Line {
                    direction: &direction,
                    max_trials: 1,
                    energy,
                },
            );
            self.accelerated = direction;
            if fraction > 0.0 {
                return fraction;
            }
            self.clear_history();
        }
        let mut step = std::mem::take(&mut self.step);
        truncate_length(problem, &mut step);
        let fraction = line_search(
            problem,
            state,
            workspace,
            Line {
                direction: &step,
                max_trials: usize::MAX,
                energy,
            },
        );
        self.step = step;
        if fraction < 1.0 {
            self.clear_history();
        }
        fraction
    }
}

fn subtract(a: &[Vec3], b: &[Vec3], out: &mut Vec<Vec3>) {
    out.clear();
    out.extend(a.iter().zip(b).map(|(a, b)| a - b));
}

impl Solver for Projective {
    const STAGE: &'static str = "projective dynamics";
    const LIMITS: Limits = Limits {
        iterations: 30,
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
        self.step
            .resize(problem.system.vertex_count(), Vec3::zeros());
        self.clear_history();
        if !self.metric.fit(problem.system, problem.weight) {
            return NewtonReport::default();
        }
        let mut energy = None;
        descend(problem, state, workspace, |state, workspace, _| {
            self.iterate(problem, state, workspace, &mut energy)
        })
    }
}
