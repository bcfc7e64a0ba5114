//! Pieces of cloth that hang together, and the shift of each as a whole that lowers the potential.

use crate::methods::implicit::Problem;
use crate::{ElasticEnd, Model, State, Workspace, merge_map};
use nalgebra::Matrix3;
use toile_geometry::Vec3;

/// The pieces of a model and what is summed over each.
#[derive(Default)]
pub struct Pieces {
    label: Vec<u32>,
    sums: Vec<Sum>,
}

/// A piece's gradient and Hessian for a shift of all of it.
#[derive(Clone, Copy, Default)]
struct Sum {
    held: bool,
    gradient: Vec3,
    hessian: Matrix3<f64>,
}

impl Pieces {
    /// Finds the pieces: vertices joined by triangles or elastics.
    pub fn fit(&mut self, model: &Model) {
        let sides = model
            .triangles
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c]]);
        let elastics = model.elastics.iter().filter_map(|e| match e.to {
            ElasticEnd::Vertex(to) => Some([e.from, to]),
            ElasticEnd::Point(_) => None,
        });
        let (label, count) = merge_map(model.vertex_count(), sides.chain(elastics));
        self.label = label;
        self.sums = vec![Sum::default(); count];
    }

    /// Shifts every piece that nothing pins by its Newton step, -(sum H)^-1 (sum g): one step of
    /// a two-level method with the translations as coarse level. Inside a piece only inertia,
    /// contact and elastics to fixed places resist it, so it is exact where those are linear, and
    /// linear momentum is kept however little the sweeps have converged. Undone where the potential
    /// would rise.
    pub fn shift(&mut self, problem: &Problem, state: &mut State, workspace: &mut Workspace) {
        let model = problem.model;
        workspace.contacts.refresh(model, state, &state.positions);
        workspace.fill_gradient(model, &state.positions, Some(&problem.inertia));
        self.sums.fill(Sum::default());
        for (v, &label) in self.label.iter().enumerate() {
            let sum = &mut self.sums[label as usize];
            sum.held |= model.pinned[v];
            sum.gradient += workspace.gradient[v];
            sum.hessian += Matrix3::identity() * problem.inertia.weight[v];
        }
        for elastic in &model.elastics {
            if let ElasticEnd::Point(point) = elastic.to {
                let secant = elastic
                    .law
                    .secant(state.positions[elastic.from as usize] - point);
                self.sums[self.label[elastic.from as usize] as usize].hessian +=
                    Matrix3::identity() * secant;
            }
        }
        for contact in &workspace.contacts.active {
            let sample = &contact.point;
            let (_, _, hessian) = contact
                .law
                .evaluate(&contact.plane, sample.place(&state.positions));
            self.sums[self.label[sample.vertices[0] as usize] as usize].hessian += hessian;
        }
        let before = workspace.potential(model, &state.positions, &problem.inertia);
        let mut trial = std::mem::take(&mut workspace.trial);
        trial.clone_from(&state.positions);
        for (x, &label) in trial.iter_mut().zip(&self.label) {
            *x += self.sums[label as usize].step();
        }
        if workspace.potential(model, &trial, &problem.inertia) < before {
            std::mem::swap(&mut state.positions, &mut trial);
        }
        workspace.trial = trial;
    }
}

impl Sum {
    fn step(&self) -> Vec3 {
        if self.held {
            return Vec3::zeros();
        }
        self.hessian
            .cholesky()
            .map_or_else(Vec3::zeros, |c| -c.solve(&self.gradient))
    }
}
