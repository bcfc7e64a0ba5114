//! Pieces of cloth that hang together, and the shift of each as a whole that lowers the potential.

use crate::methods::implicit::Problem;
use crate::{State, System, Workspace, merge_map};
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
    pub fn fit(&mut self, system: &System) {
        let sides = system
            .topology
            .triangles
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c]]);
        let (label, count) = merge_map(system.vertex_count(), sides.chain(system.couplings.ends()));
        self.label = label;
        self.sums = vec![Sum::default(); count];
    }

    /// Shifts every piece that nothing pins by its Newton step, -(sum H)^-1 (sum g): one step of
    /// a two-level method with the translations as coarse level. Inside a piece only inertia,
    /// contact and elastics to fixed places resist it, so it is exact where those are linear, and
    /// linear momentum is kept however little the sweeps have converged. Undone where the potential
    /// would rise.
    pub fn shift(&mut self, problem: &Problem, state: &mut State, workspace: &mut Workspace) {
        let system = problem.system;
        workspace.contacts.refresh(system, state, &state.positions);
        workspace.fill_gradient(system, &state.positions, Some(&problem.inertia));
        self.sums.fill(Sum::default());
        for (v, &label) in self.label.iter().enumerate() {
            let sum = &mut self.sums[label as usize];
            sum.held |= system.prescribed.pinned[v];
            sum.gradient += workspace.gradient[v];
            sum.hessian += Matrix3::identity() * problem.inertia.weight[v];
        }
        for one in system.control.attachments.all() {
            let v = one.vertex as usize;
            let secant = one.law.secant(state.positions[v] - one.place);
            self.sums[self.label[v] as usize].hessian += Matrix3::identity() * secant;
        }
        for contact in &workspace.contacts.active {
            let sample = &contact.point;
            let (_, _, hessian) = contact
                .law
                .evaluate(&contact.plane, sample.position(&state.positions));
            self.sums[self.label[sample.vertices[0] as usize] as usize].hessian += hessian;
        }
        let before = workspace.potential(system, &state.positions, &problem.inertia);
        let mut trial = std::mem::take(&mut workspace.trial);
        trial.clone_from(&state.positions);
        for (x, &label) in trial.iter_mut().zip(&self.label) {
            *x += self.sums[label as usize].step();
        }
        if workspace.potential(system, &trial, &problem.inertia) < before {
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
