//! L-BFGS that starts from the metric of projective dynamics.

use super::descent::{Line, descend, search, shorten};
use super::implicit::{Limits, Problem, Solver};
use super::metric::Metric;
use crate::sparse::dot;
use crate::{NewtonReport, State, Workspace};
use std::collections::VecDeque;
use toile_geometry::Vec3;

/// L-BFGS (Nocedal 1980; two loops, Nocedal and Wright 2006, algorithm 7.4) whose initial inverse
/// Hessian is the inverse of the prefactored [`Metric`] (Liu, Bouaziz and Kavan 2017, section 5):
/// q = g; for the pairs from new to old a_i = s_i.q / s_i.y_i, q -= a_i y_i; r = A^-1 q; from old
/// to new r += (a_i - y_i.r / s_i.y_i) s_i; the direction is -r. Steps are searched along by
/// halving; a pair is kept when s.y > 0.
#[derive(Default)]
pub struct Lbfgs {
    metric: Metric,
    pairs: VecDeque<Pair>,
    spare: Option<Pair>,
    before: Vec<Vec3>,
    gradient: Vec<Vec3>,
    direction: Vec<Vec3>,
    shares: Vec<f64>,
}

/// A step s and the change y of the gradient over it.
#[derive(Default)]
struct Pair {
    s: Vec<Vec3>,
    y: Vec<Vec3>,
    product: f64,
}

/// Pairs remembered.
const MEMORY: usize = 8;

/// Least s.y as a share of |s| |y|: below it a pair says nothing but rounding.
const LEAST_CURVATURE: f64 = 1e-10;

impl Lbfgs {
    /// Notes the step from `before` to the present place and gradient.
    fn learn(&mut self, x: &[Vec3], gradient: &[Vec3]) {
        let mut pair = if self.pairs.len() >= MEMORY {
            self.pairs.pop_front().unwrap_or_default()
        } else {
            self.spare.take().unwrap_or_default()
        };
        pair.s.clear();
        pair.s
            .extend(x.iter().zip(&self.before).map(|(a, b)| a - b));
        pair.y.clear();
        let changes = gradient.iter().zip(&self.gradient);
        pair.y.extend(changes.map(|(a, b)| a - b));
        pair.product = dot(&pair.s, &pair.y);
        let scale = (dot(&pair.s, &pair.s) * dot(&pair.y, &pair.y)).sqrt();
        if pair.product > LEAST_CURVATURE * scale {
            self.pairs.push_back(pair);
        } else {
            self.spare = Some(pair);
        }
    }

    /// The direction for `gradient` (the present one), by the two loops.
    fn aim(&mut self, problem: &Problem) {
        let mut q = std::mem::take(&mut self.before);
        q.clone_from(&self.gradient);
        self.shares.clear();
        for pair in self.pairs.iter().rev() {
            let share = dot(&pair.s, &q) / pair.product;
            self.shares.push(share);
            for (q, y) in q.iter_mut().zip(&pair.y) {
                *q -= y * share;
            }
        }
        self.metric.solve(problem.model, &q, &mut self.direction);
        for (pair, &share) in self.pairs.iter().zip(self.shares.iter().rev()) {
            let rest = share - dot(&pair.y, &self.direction) / pair.product;
            for (r, s) in self.direction.iter_mut().zip(&pair.s) {
                *r += s * rest;
            }
        }
        for d in &mut self.direction {
            *d = -*d;
        }
        self.before = q;
    }

    /// A step along the direction for the present gradient; the share of it that was taken.
    fn step(
        &mut self,
        problem: &Problem,
        state: &mut State,
        workspace: &mut Workspace,
        energy: &mut Option<f64>,
    ) -> f64 {
        self.aim(problem);
        shorten(problem, &mut self.direction);
        self.before.clone_from(&state.positions);
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
        workspace.fit(problem.model);
        self.direction
            .resize(problem.model.vertex_count(), Vec3::zeros());
        self.pairs.clear();
        if !self.metric.fit(problem.model, problem.weight) {
            return NewtonReport::default();
        }
        let mut energy = None;
        descend(problem, state, workspace, |state, workspace, iteration| {
            self.metric.press(problem, state, workspace);
            if iteration > 0 {
                self.learn(&state.positions, &workspace.gradient);
            }
            self.gradient.clone_from(&workspace.gradient);
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
