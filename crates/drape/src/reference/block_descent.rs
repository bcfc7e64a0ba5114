//! Vertex block descent: the potential lowered one vertex at a time, colour by colour.

use super::colours::Colours;
use super::pieces::Pieces;
use crate::contacts::Contacts;
use crate::methods::implicit::{Limits, Problem, Solver};
use crate::{Contact, NewtonReport, State, System, Workspace};
use nalgebra::Matrix3;
use rayon::prelude::*;
use toile_geometry::Vec3;

/// Vertex block descent (Chen, Liu, Yang and Yuksel 2024).
///
/// For every vertex i in turn, with the others held: H_i dx_i = f_i, x_i += dx_i, where
/// f_i = -b m_i (x_i - y_i) - grad_i E and H_i = b m_i I + the 3x3 block of the positive
/// semidefinite Hessian there (their equations 8 and 9). Vertices of one colour share no triangle,
/// bending stencil or elastic, so a colour is solved at once with the same result in any order.
/// Sweeps start from the lowest of x, y and y + g/b (their section 3.7 in one test).
///
/// With `CHEBYSHEV` each sweep k is followed by x_k = o_k (x_k - x_k-2) + x_k-2, o_1 = 1,
/// o_2 = 2 / (2 - r^2), o_k+1 = 4 / (4 - r^2 o_k), r = 0.95 (Wang 2015; their section 3.8), left
/// out at vertices that touch a surface and given up when the potential rises.
///
/// Converges linearly, slowly where stiffness is large against b m: a stiff cloth at a long step is
/// left softer than it is. What sweeps move least is a piece as a whole; so each unpinned piece is
/// shifted by its own Newton step before the sweeps, every eight of them and after them
/// ([`Pieces::shift`]; not in the paper), which keeps linear momentum. Angular momentum is kept only
/// as far as the sweeps converged.
#[derive(Default)]
pub struct BlockDescent<const CHEBYSHEV: bool> {
    colours: Colours,
    pieces: Pieces,
    touching: Touching,
    results: Vec<(Vec3, f64)>,
    before: Vec<Vec3>,
    two_before: Vec<Vec3>,
    best: Vec<Vec3>,
    lagged: Vec<Vec3>,
}

/// Contacts by the vertices they act on.
#[derive(Default)]
struct Touching {
    start: Vec<u32>,
    entries: Vec<(u32, f64)>,
}

/// Estimate of the sweeps' spectral radius.
const RADIUS: f64 = 0.95;

/// Sweeps between two shifts of the pieces, and between two checks that an accelerated descent
/// still descends.
const CHECK: usize = 8;

/// Longest move of a vertex near solid surfaces in one sweep [m]: twice what contact is found
/// within.
const LONGEST_MOVE: f64 = 0.02;

/// Vertices of one colour handled by one task.
const CHUNK: usize = 128;

impl Touching {
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
    /// Force on one vertex and the block of the Hessian there.
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
        let uses =
            system.topology.corner_start[v] as usize..system.topology.corner_start[v + 1] as usize;
        for &corner in &system.topology.corners[uses] {
            let (t, i) = (corner as usize / 3, corner as usize % 3);
            let places = system.topology.triangles[t].map(|u| x[u as usize]);
            let (g, h) = system.rest.elements[t].corner(&terms.law(system, t), places, i);
            gradient += g;
            hessian += h;
            if system.control.air.acts() {
                let mut blocks = [Matrix3::zeros(); 6];
                terms.add_hessian(t, &mut blocks);
                let starts = system.topology.triangles[t].map(|u| self.before[u as usize]);
                let moved = places.iter().sum::<Vec3>() - starts.iter().sum::<Vec3>();
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
        for &(at, w) in self.touching.of(v) {
            let contact = &workspace.contacts.active[at as usize];
            let place = contact.point.position(x);
            let (_, g, h) = contact.law.evaluate(&contact.plane, place);
            gradient += g * w;
            hessian += h * (w * w);
        }
        (-gradient, hessian)
    }

    /// Gradient of folds and air where the sweep starts, less what [`Self::local`] finds itself of
    /// it: their part that is linear about there.
    fn lag(&mut self, system: &System, workspace: &Workspace) {
        self.lagged.clear();
        let plain = system.rest.viscous_bending.is_none() && !system.materials.keep_strain();
        if plain && !system.control.air.acts() {
            return;
        }
        let (terms, x) = (&workspace.increment, &self.before);
        let (held, elastic) = (terms.bending(system), &system.rest.bending);
        self.lagged
            .extend((0..x.len()).map(|v| elastic.row_times(v, x) - held.row_times(v, x)));
        terms.add_gradient(system, x, &mut self.lagged);
    }

    /// Every vertex once; returns the sum of the squared forces met [N2].
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
            let (this, places) = (&*self, &*x);
            results
                .par_chunks_mut(CHUNK)
                .zip(vertices.par_chunks(CHUNK))
                .for_each(|(out, vertices)| {
                    for (out, &v) in out.iter_mut().zip(vertices) {
                        *out = if problem.system.prescribed.pinned[v as usize] {
                            (Vec3::zeros(), 0.0)
                        } else {
                            let (force, hessian) =
                                this.local(problem, workspace, places, v as usize);
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

    /// Puts the state at the lowest of where it is, where inertia takes it, and that with gravity.
    fn start(&self, problem: &Problem, state: &mut State, workspace: &mut Workspace) {
        let system = problem.system;
        let farthest = problem.longest_move(LONGEST_MOVE);
        let here = state.positions.clone();
        let lowest = |workspace: &mut Workspace, state: &State, x: &[Vec3]| {
            workspace.contacts.refresh(system, state, x);
            workspace.potential(system, x, &problem.inertia)
        };
        let mut best = lowest(workspace, state, &here);
        for fall in [Vec3::zeros(), system.control.gravity / problem.weight] {
            let mut there = problem.inertia.target.to_vec();
            let mut longest = 0.0f64;
            for (v, x) in there.iter_mut().enumerate() {
                if !system.prescribed.pinned[v] {
                    *x += fall;
                }
                longest = longest.max((*x - here[v]).norm());
            }
            if longest > farthest {
                continue;
            }
            let energy = lowest(workspace, state, &there);
            if energy < best {
                best = energy;
                state.positions = there;
            }
        }
    }

    /// Over-relaxes the vertices that touch nothing.
    fn accelerate(&self, factor: f64, x: &mut [Vec3]) {
        for (v, x) in x.iter_mut().enumerate() {
            if self.touching.of(v).is_empty() {
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

    fn lower(
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
        self.start(problem, state, workspace);
        let longest = problem.longest_move(LONGEST_MOVE);
        let mut report = NewtonReport {
            sound: true,
            fraction: 1.0,
            ..NewtonReport::default()
        };
        let mut factor = 1.0;
        let mut accelerating = CHEBYSHEV;
        self.best.clone_from(&state.positions);
        for sweep in 0..problem.limits.iterations {
            if sweep % CHECK == 0 {
                self.pieces.shift(problem, state, workspace);
            }
            workspace.contacts.refresh(system, state, &state.positions);
            self.touching.gather(system, &workspace.contacts);
            if accelerating && sweep % CHECK == 0 {
                let now = workspace.potential(system, &state.positions, &problem.inertia);
                if now > workspace.potential(system, &self.best, &problem.inertia) {
                    state.positions.clone_from(&self.best);
                    accelerating = false;
                }
                self.best.clone_from(&state.positions);
            }
            self.two_before.clone_from(&self.before);
            self.before.clone_from(&state.positions);
            self.lag(system, workspace);
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
        report.sound = after <= before + 1e-12 * before.abs().max(1.0);
        report
    }
}
