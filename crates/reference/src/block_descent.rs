//! Vertex block descent: the potential lowered one vertex at a time, colour by colour.

use super::colours::Colours;
use super::pieces::Pieces;
use nalgebra::Matrix3;
use rayon::prelude::*;
use toile_drape::methods::implicit::{Limits, Problem, Solver};
use toile_drape::{Contact, Contacts, NewtonReport, State, System, Workspace};
use toile_geometry::Vec3;

/// Vertex block descent (Chen, Liu, Yang and Yuksel 2024).
///
/// For every vertex i in turn, with the others fixed: H_i dx_i = f_i, x_i += dx_i, where
/// f_i = -b m_i (x_i - y_i) - grad_i E and H_i = b m_i I + the 3x3 block of the positive
/// semidefinite Hessian there (their equations 8 and 9). Vertices of one colour share no triangle,
/// bending stencil or elastic, so a colour is solved in parallel with the same result in any order.
/// Sweeps start from the lowest of x, y and y + g/b (their section 3.7 in one test).
///
/// With `CHEBYSHEV` each sweep k is followed by x_k = o_k (x_k - x_k-2) + x_k-2, o_1 = 1,
/// o_2 = 2 / (2 - r^2), o_k+1 = 4 / (4 - r^2 o_k), r = 0.95 (Wang 2015; their section 3.8), not at
/// vertices in contact, and not after the potential has risen.
///
/// Converges linearly, and slowly where stiffness is large against b m: the result is then that of a softer cloth.
/// Sweeps converge most slowly for the translation of a whole piece; so each unpinned piece is translated by its
/// own Newton step before the sweeps, after every eight of them and at the end ([`Pieces::shift`]; not in the
/// paper), which conserves linear momentum. Angular momentum is conserved only as far as the sweeps converge.
#[derive(Default)]
pub struct BlockDescent<const CHEBYSHEV: bool> {
    colours: Colours,
    pieces: Pieces,
    contacts: VertexContacts,
    results: Vec<(Vec3, f64)>,
    before: Vec<Vec3>,
    two_before: Vec<Vec3>,
    best: Vec<Vec3>,
    lagged: Vec<Vec3>,
}

/// Active contacts by the vertices on which they act.
#[derive(Default)]
struct VertexContacts {
    /// First entry of each vertex, and the end.
    start: Vec<u32>,
    /// Index of the contact, and weight of the vertex.
    entries: Vec<(u32, f64)>,
}

/// Estimated spectral radius of a sweep.
const RADIUS: f64 = 0.95;

/// Sweeps between two translations of pieces, and between two checks that accelerated sweeps lower the potential.
const CHECK_INTERVAL: usize = 8;

/// Longest displacement of a vertex in one sweep where there are solids (m): twice the detection range of contact.
const MAX_MOVE: f64 = 0.02;

/// Vertices of one colour per task.
const CHUNK: usize = 128;

impl VertexContacts {
    fn gather(&mut self, system: &System, contacts: &Contacts) {
        self.start.clear();
        self.start.resize(system.vertex_count() + 1, 0);
        let uses = |contact: &Contact| {
            let sample = &contact.point;
            let used = if sample.triangle.is_some() { 3 } else { 1 };
            sample.vertices.into_iter().zip(sample.weights).take(used)
        };
        for contact in &contacts.active {
            for (v, _) in uses(contact) {
                self.start[v as usize + 1] += 1;
            }
        }
        for v in 0..system.vertex_count() {
            self.start[v + 1] += self.start[v];
        }
        let mut next = self.start.clone();
        self.entries.clear();
        self.entries
            .resize(next[system.vertex_count()] as usize, (0, 0.0));
        for (at, contact) in contacts.active.iter().enumerate() {
            for (v, w) in uses(contact) {
                self.entries[next[v as usize] as usize] = (at as u32, w);
                next[v as usize] += 1;
            }
        }
    }

    fn of(&self, v: usize) -> &[(u32, f64)] {
        match self.start.get(v..v + 2) {
            Some(&[first, last]) => &self.entries[first as usize..last as usize],
            _ => &[],
        }
    }
}

impl<const CHEBYSHEV: bool> BlockDescent<CHEBYSHEV> {
    /// Negative gradient on one vertex (N) and the diagonal block of the Hessian there (N/m).
    fn local(
        &self,
        problem: &Problem,
        workspace: &Workspace,
        x: &[Vec3],
        v: usize,
    ) -> (Vec3, Matrix3<f64>) {
        let (system, terms) = (problem.system, &workspace.increment);
        let weight = problem.inertia.weight[v];
        let bending = terms.bending(system);
        let mut gradient = bending.row_times(v, x) - system.control.gravity * system.rest.mass[v]
            + (x[v] - problem.inertia.target[v]) * weight;
        let mut hessian = Matrix3::identity() * (weight + bending.diagonal(v));
        if let Some(lagged) = self.lagged.get(v) {
            gradient += lagged;
        }
        for &corner in system.topology.corners_of(v) {
            let (t, i) = (corner as usize / 3, corner as usize % 3);
            let positions = system.topology.triangles[t].map(|u| x[u as usize]);
            let (g, h) = system.rest.elements[t].corner(&terms.law(system, t), positions, i);
            gradient += g;
            hessian += h;
            if system.control.air.acts() {
                let mut blocks = [Matrix3::zeros(); 6];
                terms.add_hessian(t, &mut blocks);
                let starts = system.topology.triangles[t].map(|u| self.before[u as usize]);
                let moved = positions.iter().sum::<Vec3>() - starts.iter().sum::<Vec3>();
                gradient += blocks[0] * moved;
                hessian += blocks[0];
            }
        }
        for (e, other) in system.elastics_at(v) {
            let gap = x[v] - other.position(x);
            let secant = system.elastic_law(e).secant(gap);
            gradient += gap * secant;
            hessian += Matrix3::identity() * secant;
        }
        for &(at, w) in self.contacts.of(v) {
            let contact = &workspace.contacts.active[at as usize];
            let position = contact.point.position(x);
            let (_, g, h) = contact.law.evaluate(&contact.plane, position);
            gradient += g * w;
            hessian += h * (w * w);
        }
        (-gradient, hessian)
    }

    /// Computes the lagged gradient: that of internal strain, viscous folds and air at the start of the sweep, minus
    /// the terms linear in the displacement since, which [`Self::local`] adds.
    fn update_lagged(&mut self, system: &System, workspace: &Workspace) {
        self.lagged.clear();
        let without_internal_strain =
            system.rest.viscous_bending.is_none() && !system.materials.keep_strain();
        if without_internal_strain && !system.control.air.acts() {
            return;
        }
        let (terms, x) = (&workspace.increment, &self.before);
        let (effective, elastic) = (terms.bending(system), &system.rest.bending);
        self.lagged
            .extend((0..x.len()).map(|v| elastic.row_times(v, x) - effective.row_times(v, x)));
        terms.add_gradient(system, x, &mut self.lagged);
    }

    /// Solves every vertex once, colour by colour; returns the sum of the squared forces (N2).
    fn sweep(
        &mut self,
        problem: &Problem,
        workspace: &Workspace,
        x: &mut [Vec3],
        longest: f64,
    ) -> f64 {
        let mut squares = 0.0;
        for colour in 0..self.colours.count() {
            let vertices = self.colours.vertices(colour);
            let mut results = std::mem::take(&mut self.results);
            results.resize(vertices.len(), (Vec3::zeros(), 0.0));
            let (this, positions) = (&*self, &*x);
            results
                .par_chunks_mut(CHUNK)
                .zip(vertices.par_chunks(CHUNK))
                .for_each(|(out, vertices)| {
                    for (out, &v) in out.iter_mut().zip(vertices) {
                        *out = if problem.system.prescribed.pinned[v as usize] {
                            (Vec3::zeros(), 0.0)
                        } else {
                            let (force, hessian) =
                                this.local(problem, workspace, positions, v as usize);
                            let step = hessian.cholesky().map(|c| c.solve(&force));
                            let step = step.unwrap_or_else(Vec3::zeros);
                            (step.cap_magnitude(longest), force.norm_squared())
                        };
                    }
                });
            for (&v, (step, square)) in self.colours.vertices(colour).iter().zip(&results) {
                x[v as usize] += step;
                squares += square;
            }
            self.results = results;
        }
        squares
    }

    /// Sets the state to the one of lowest potential among the present positions, the inertial target, and the target
    /// displaced by gravity.
    fn choose_start(&self, problem: &Problem, state: &mut State, workspace: &mut Workspace) {
        let system = problem.system;
        let farthest = problem.longest_move(MAX_MOVE);
        let present = state.positions.clone();
        let potential = |workspace: &mut Workspace, state: &State, x: &[Vec3]| {
            workspace.contacts.refresh(system, state, x);
            workspace.potential(system, x, &problem.inertia)
        };
        let mut lowest = potential(workspace, state, &present);
        for fall in [Vec3::zeros(), system.control.gravity / problem.weight] {
            let mut candidate = problem.inertia.target.to_vec();
            let mut longest = 0.0f64;
            for (v, x) in candidate.iter_mut().enumerate() {
                if !system.prescribed.pinned[v] {
                    *x += fall;
                }
                longest = longest.max((*x - present[v]).norm());
            }
            if longest > farthest {
                continue;
            }
            let energy = potential(workspace, state, &candidate);
            if energy < lowest {
                lowest = energy;
                state.positions = candidate;
            }
        }
    }

    /// Chebyshev over-relaxation of the vertices without contact.
    fn accelerate(&self, factor: f64, x: &mut [Vec3]) {
        for (v, x) in x.iter_mut().enumerate() {
            if self.contacts.of(v).is_empty() {
                *x = self.two_before[v] + (*x - self.two_before[v]) * factor;
            }
        }
    }
}

impl<const CHEBYSHEV: bool> Solver for BlockDescent<CHEBYSHEV> {
    const STAGE: &'static str = "vertex block descent";
    const LIMITS: Limits = Limits {
        iterations: 100,
        tolerance: 1e-6,
    };
    const CONVERGES: bool = false;

    fn minimise(
        &mut self,
        problem: &Problem,
        state: &mut State,
        workspace: &mut Workspace,
    ) -> NewtonReport {
        let system = problem.system;
        workspace.fit(system);
        if self.colours.fit(system) {
            self.pieces.fit(system);
        }
        let first = state.positions.clone();
        self.choose_start(problem, state, workspace);
        let longest = problem.longest_move(MAX_MOVE);
        let mut report = NewtonReport {
            succeeded: true,
            fraction: 1.0,
            ..NewtonReport::default()
        };
        let mut factor = 1.0;
        let mut accelerating = CHEBYSHEV;
        self.best.clone_from(&state.positions);
        for sweep in 0..problem.limits.iterations {
            if sweep % CHECK_INTERVAL == 0 {
                self.pieces.shift(problem, state, workspace);
            }
            workspace.contacts.refresh(system, state, &state.positions);
            self.contacts.gather(system, &workspace.contacts);
            if accelerating && sweep % CHECK_INTERVAL == 0 {
                let now = workspace.potential(system, &state.positions, &problem.inertia);
                if now > workspace.potential(system, &self.best, &problem.inertia) {
                    state.positions.clone_from(&self.best);
                    accelerating = false;
                }
                self.best.clone_from(&state.positions);
            }
            self.two_before.clone_from(&self.before);
            self.before.clone_from(&state.positions);
            self.update_lagged(system, workspace);
            let squares = self.sweep(problem, workspace, &mut state.positions, longest);
            report.iterations += 1;
            report.gradient = squares.sqrt();
            if report.gradient <= problem.limits.tolerance || !squares.is_finite() {
                break;
            }
            if accelerating && sweep > 0 {
                let r2 = RADIUS * RADIUS;
                factor = if sweep == 1 {
                    2.0 / (2.0 - r2)
                } else {
                    4.0 / (4.0 - r2 * factor)
                };
                self.accelerate(factor, &mut state.positions);
            }
        }
        self.pieces.shift(problem, state, workspace);
        workspace.contacts.refresh(system, state, &state.positions);
        let before = workspace.potential(system, &first, &problem.inertia);
        let after = workspace.potential(system, &state.positions, &problem.inertia);
        report.succeeded = after <= before + 1e-12 * before.abs().max(1.0);
        report
    }
}
