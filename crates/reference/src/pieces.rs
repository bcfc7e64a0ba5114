//! Connected pieces of cloth, and the translation of each as a whole that lowers the potential.

use nalgebra::Matrix3;
use toile_drape::methods::implicit::Problem;
use toile_drape::{State, System, Workspace, merge_map};
use toile_geometry::Vec3;

/// The connected pieces of a model, and the reduced system of each.
#[derive(Default)]
pub struct Pieces {
    /// The piece of each vertex.
    label: Vec<u32>,
    systems: Vec<PieceSystem>,
}

/// Gradient (N) and Hessian (N/m) of the potential for a translation of a piece.
#[derive(Clone, Copy, Default)]
struct PieceSystem {
    has_pin: bool,
    gradient: Vec3,
    hessian: Matrix3<f64>,
}

impl Pieces {
    /// Determines the pieces: vertices connected by triangles or elastics.
    pub fn fit(&mut self, system: &System) {
        let sides = system
            .topology
            .triangles
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c]]);
        let (label, count) = merge_map(system.vertex_count(), sides.chain(system.couplings.ends()));
        self.label = label;
        self.systems = vec![PieceSystem::default(); count];
    }

    /// Translates every piece without a pin by its Newton step, -(sum H)^-1 (sum g): one step of a two-level method
    /// with translations as the coarse level. Only inertia, contact and elastics to fixed points resist a
    /// translation, so the step is exact where those are linear, and linear momentum is conserved even where sweeps
    /// have not converged. Undone where the potential would rise.
    pub fn shift(&mut self, problem: &Problem, state: &mut State, workspace: &mut Workspace) {
        let system = problem.system;
        workspace.contacts.refresh(system, state, &state.positions);
        workspace.fill_gradient(system, &state.positions, Some(&problem.inertia));
        self.systems.fill(PieceSystem::default());
        for (v, &label) in self.label.iter().enumerate() {
            let sum = &mut self.systems[label as usize];
            sum.has_pin |= system.prescribed.pinned[v];
            sum.gradient += workspace.gradient[v];
            sum.hessian += Matrix3::identity() * problem.inertia.weight[v];
        }
        for one in system.control.attachments.all() {
            let v = one.vertex as usize;
            let secant = one.law.secant(state.positions[v] - one.place);
            self.systems[self.label[v] as usize].hessian += Matrix3::identity() * secant;
        }
        for contact in &workspace.contacts.active {
            let sample = &contact.point;
            let (_, _, hessian) = contact
                .law
                .evaluate(&contact.plane, sample.position(&state.positions));
            self.systems[self.label[sample.vertices[0] as usize] as usize].hessian += hessian;
        }
        let before = workspace.potential(system, &state.positions, &problem.inertia);
        let mut trial = std::mem::take(&mut workspace.trial);
        trial.clone_from(&state.positions);
        for (x, &label) in trial.iter_mut().zip(&self.label) {
            *x += self.systems[label as usize].step();
        }
        if workspace.potential(system, &trial, &problem.inertia) < before {
            std::mem::swap(&mut state.positions, &mut trial);
        }
        workspace.trial = trial;
    }
}

impl PieceSystem {
    /// The Newton step of the translation (m); zero for a piece with a pin.
    fn step(&self) -> Vec3 {
        if self.has_pin {
            return Vec3::zeros();
        }
        self.hessian
            .cholesky()
            .map_or_else(Vec3::zeros, |c| -c.solve(&self.gradient))
    }
}
