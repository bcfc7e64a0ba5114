//! One implicit solve: Newton's method on an incremental potential, with a positive semidefinite
//! Hessian, conjugate gradients and a line search.
//!
//! Phi(x) = sum_i w_i/2 |x_i - y_i|^2 + E_membrane + E_bending + E_elastics + E_contact - f_g.x
//!
//! With w = m/h^2 and y = x_n + h v_n a minimum of Phi is a step of implicit Euler (Martin et al.
//! 2011, equation 3). With y = x_n and growing h it is pseudo-transient continuation to rest.
//!
//! # Decided with
//! - [`crate::methods`] (`rules.rs`): inertia of a step in time: the weights w and the targets y;
//! - [`crate::incremental_potential::IncrementalPotential`]: viscosity, air and kept folds, taken at the
//!   start of a step;
//! - [`crate::newton::direction`]: direction and length of a step: linear solve, contact kinks, truncation;
//! - [`crate::hessian::Hessian`]: the matrix and its factor;
//! - [`crate::laws`]: energy, gradient and Hessian of each force;
//! - [`crate::newton::chord`], [`crate::newton::elimination`], [`crate::newton::prediction`]: further uses of
//!   the same factor;
//! - [`crate::step`] (`implicit_euler`): the rule of sewing;
//! - [`crate::methods`] (`newton_solver.rs`, `Newton`),
//!   [`crate::pseudo_transient::PseudoTransientContinuation`]: who minimises: steps in time, the way to rest.
//!
//! A new parallel sum is collected by fixed chunks and added in order, as in `potential` and
//! [`toile_sparse::dot`], so that it is the same at any number of threads.

mod chord;
mod contact_kinks;
mod direction;
mod elimination;
mod expansion;
mod prediction;

pub(crate) use chord::ChordLimits;
pub use expansion::Expansion;
pub(crate) use prediction::FirstOrder;

use crate::collision::Couplings;
use crate::contacts::Contacts;
use crate::hessian::{Direct, Hessian};
use crate::incremental_potential::{IncrementalPotential, add_forces_of_motion};
use crate::laws::membrane::Curvature;
use crate::{Model, State, System};
use nalgebra::Matrix3;
use rayon::prelude::*;
use toile_geometry::Vec3;
use toile_sparse::dot;
use toile_sparse::{BlockJacobi, Pcg, PcgLimits};

/// The inertial term sum w/2 |x - y|^2 of the potential.
pub struct Inertia<'a> {
    /// Weight w of each vertex (N/m).
    pub weight: &'a [f64],
    /// Inertial target y of each vertex (m).
    pub target: &'a [Vec3],
}

/// Settings of a solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonSettings {
    /// Most Newton iterations.
    pub iterations: usize,
    /// Stop when the gradient's norm is below this (N).
    pub tolerance: f64,
    /// Longest displacement of any vertex in one iteration (m).
    pub longest_move: f64,
    /// Limits of the linear solver.
    pub linear: LinearSolver,
    /// The Hessian tried first; ones with less destabilising curvature follow until one is positive definite. The
    /// convex one always is; the exact one converges quadratically near equilibrium and leaves saddle points at
    /// once. Only a factorisation detects indefiniteness: an iterative solver always uses the convex one.
    pub curvature: Curvature,
}

/// How the linear system of a Newton step is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LinearSolver {
    /// By conjugate gradients: best while inertia is large.
    Iterative(PcgLimits),
    /// By factorisation: best near equilibrium, where the system is ill-conditioned. Falls back to conjugate
    /// gradients where the matrix cannot be factorised.
    Direct {
        /// Limits of these conjugate gradients.
        otherwise: PcgLimits,
    },
}

/// The outcome of a solve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NewtonReport {
    /// Iterations taken.
    pub iterations: usize,
    /// Conjugate-gradient iterations taken in all.
    pub linear_iterations: usize,
    /// Norm of the gradient when the last iteration started (N).
    pub gradient: f64,
    /// Longest displacement of any vertex in the last iteration (m).
    pub moved: f64,
    /// Fraction of the last Newton step that the line search took.
    pub fraction: f64,
    /// Destabilising curvature in the Hessian of the last direction.
    pub curvature: Curvature,
    /// Whether every number stayed finite and the potential could be lowered.
    pub succeeded: bool,
}

/// Line search fraction above which a step counts as good, and the next Hessian takes more destabilising curvature.
const GOOD_FRACTION: f64 = 0.2;

impl NewtonReport {
    /// Destabilising curvature for the next Hessian: more after a good step, less after one whose direction had to
    /// be shortened by the line search. With too little, cloth that is about to buckle leaves its saddle point by
    /// only a few per cent a step.
    pub fn next_curvature(&self) -> Curvature {
        if self.fraction > GOOD_FRACTION {
            self.curvature.more()
        } else {
            self.curvature.less()
        }
    }
}

/// Private memory of a solve, sized once for a model.
#[derive(Default)]
pub struct Workspace {
    /// Contacts detected last.
    pub contacts: Contacts,
    /// Terms of the step that was begun last.
    pub increment: IncrementalPotential,
    /// Gradient of the potential on each vertex where it was computed last (N).
    pub gradient: Vec<Vec3>,
    pub(crate) direction: Vec<Vec3>,
    /// Positions that a line search tries (m).
    pub trial: Vec<Vec3>,
    force: Vec<Vec3>,
    corner_gradients: Vec<[Vec3; 3]>,
    elements: Vec<[Matrix3<f64>; 6]>,
    diagonal: Vec<Matrix3<f64>>,
    blocks: Vec<Matrix3<f64>>,
    secants: Vec<f64>,
    cloth_contact_blocks: Couplings,
    pcg: Pcg,
    jacobi: BlockJacobi,
    direct: Option<Direct>,
    symbolic_factorisations: usize,
}

/// Elements handled by one task.
const CHUNK: usize = 256;

/// Armijo's constant: least decrease over that of the linear model that the line search accepts (Nocedal and
/// Wright 2006, 3.1).
const ARMIJO: f64 = 1e-4;

/// Most trial steps of the line search, each half of the last.
const MAX_TRIALS: usize = 12;

impl Workspace {
    /// Number of symbolic factorisations so far.
    pub fn symbolic_factorisations(&self) -> usize {
        self.symbolic_factorisations
    }

    /// Pairs of vertices that cloth contacts may couple, for which the symbolic factorisation was made, sorted. They
    /// determine the elimination order and with it the rounding errors, so that a checkpoint contains them. None
    /// without a factor for the model.
    pub(crate) fn eliminated_pairs(&self, model: &Model) -> Option<Vec<[u32; 2]>> {
        let direct = self.direct.as_ref().filter(|direct| direct.is_of(model))?;
        let mut pairs = direct.touching().to_vec();
        pairs.sort_unstable();
        pairs.dedup();
        Some(pairs)
    }

    /// Makes the symbolic factorisation for the pairs of a checkpoint, see [`Self::eliminated_pairs`].
    pub(crate) fn eliminate_pairs(&mut self, system: &System, pairs: &[[u32; 2]]) {
        self.symbolic_factorisations += 1;
        self.direct = Some(Direct::new(system, &system.topology.layout, pairs));
    }

    /// Clears the pairs of near cloth, and the factor whose structure contains them.
    pub(crate) fn forget_pairs(&mut self) {
        self.contacts.forget_cloth();
        if !self.contacts.cloth.is_empty() {
            self.direct = None;
        }
    }

    /// Sizes the buffers for a model.
    pub fn fit(&mut self, system: &System) {
        let n = system.vertex_count();
        self.gradient.resize(n, Vec3::zeros());
        self.direction.resize(n, Vec3::zeros());
        self.trial.resize(n, Vec3::zeros());
        self.diagonal.resize(n, Matrix3::zeros());
        self.corner_gradients
            .resize(system.topology.triangles.len(), [Vec3::zeros(); 3]);
        self.elements
            .resize(system.topology.triangles.len(), [Matrix3::zeros(); 6]);
        self.blocks
            .resize(system.topology.pattern.block_count(), Matrix3::zeros());
        self.secants.resize(system.elastic_count(), 0.0);
    }

    /// Net force on every vertex at the state's positions, zero at pins (N): all forces but inertia, contact and
    /// friction (within its cone) included.
    pub fn net_force(&mut self, system: &System, state: &State) -> &[Vec3] {
        self.fit(system);
        self.increment.begin_static(system, state);
        self.contacts.refresh(system, state, &state.positions);
        self.fill_gradient(system, &state.positions, None);
        for g in &mut self.gradient {
            *g = -*g;
        }
        &self.gradient
    }

    /// [`Self::net_force`] plus the forces at the state's velocities (N): viscosity, the air on triangles, and the
    /// dashpots of contacts for a substep `h` (s). Drag per mass is left to the caller.
    pub(crate) fn force_in_motion(&mut self, system: &System, state: &State, h: f64) -> &[Vec3] {
        self.net_force(system, state);
        add_forces_of_motion(system, state, &mut self.gradient);
        self.contacts.damp(system, state, h, &mut self.gradient);
        for (force, &pinned) in self.gradient.iter_mut().zip(&system.prescribed.pinned) {
            if pinned {
                *force = Vec3::zeros();
            }
        }
        &self.gradient
    }

    /// The result of the last call of [`Self::net_force`] or [`Self::force_in_motion`] (N).
    pub(crate) fn last_force(&self) -> &[Vec3] {
        &self.gradient
    }

    /// Minimises the potential, starting from the state's positions, and stores the result there. Velocities,
    /// friction anchors and time are left to the caller.
    pub fn solve(
        &mut self,
        system: &System,
        state: &mut State,
        inertia: &Inertia,
        settings: &NewtonSettings,
    ) -> NewtonReport {
        self.fit(system);
        let mut report = NewtonReport {
            succeeded: true,
            fraction: 1.0,
            ..NewtonReport::default()
        };
        for _ in 0..settings.iterations {
            self.contacts.refresh(system, state, &state.positions);
            if !self.iterate(system, state, inertia, settings, &mut report) {
                break;
            }
        }
        report
    }

    /// One iteration with the contacts detected last; false where the gradient is below the tolerance or no step
    /// lowers the potential.
    fn iterate(
        &mut self,
        system: &System,
        state: &mut State,
        inertia: &Inertia,
        settings: &NewtonSettings,
        report: &mut NewtonReport,
    ) -> bool {
        self.fill_gradient(system, &state.positions, Some(inertia));
        report.gradient = dot(&self.gradient, &self.gradient).sqrt();
        report.succeeded = report.gradient.is_finite();
        if !report.succeeded || report.gradient <= settings.tolerance {
            return false;
        }
        report.iterations += 1;
        self.negate_gradient();
        self.find_direction(system, &state.positions, inertia, settings, report);
        self.truncate_length(settings.longest_move);
        self.truncate_by_contact(system, &state.positions);
        report.fraction = self.line_search(system, &state.positions, inertia);
        report.succeeded = report.fraction > 0.0;
        if report.succeeded {
            std::mem::swap(&mut state.positions, &mut self.trial);
            report.moved = self.longest_displacement() * report.fraction;
        }
        report.succeeded
    }

    /// Potential at positions `x`, with the contact planes detected last (J).
    pub fn potential(&self, system: &System, x: &[Vec3], inertia: &Inertia) -> f64 {
        let elements: Vec<f64> = system
            .topology
            .triangles
            .par_chunks(CHUNK)
            .enumerate()
            .map(|(chunk, triangles)| {
                let mut energy = 0.0;
                for (k, corners) in triangles.iter().enumerate() {
                    let t = chunk * CHUNK + k;
                    let law = self.increment.law(system, t);
                    energy += system.rest.elements[t].energy(&law, corners.map(|v| x[v as usize]));
                }
                energy
            })
            .collect();
        let vertices: Vec<f64> = (0..x.len().div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let mut energy = 0.0;
                for v in chunk * CHUNK..((chunk + 1) * CHUNK).min(x.len()) {
                    let difference = x[v] - inertia.target[v];
                    energy += system.rest.bending.row_energy(v, x)
                        + 0.5 * inertia.weight[v] * difference.norm_squared()
                        - system.rest.mass[v] * system.control.gravity.dot(&x[v]);
                }
                energy
            })
            .collect();
        let mut energy = elements.iter().sum::<f64>() + vertices.iter().sum::<f64>();
        for elastic in system.elastics() {
            energy += elastic.law.energy(elastic.gap(x));
        }
        for contact in &self.contacts.active {
            let position = contact.point.position(x);
            energy += contact.law.energy(&contact.plane, position);
        }
        for contact in self.contacts.cloth.all() {
            energy += contact.law.energy(&contact.plane, contact.between(x));
        }
        energy + self.increment.energy(system, x)
    }

    /// Computes the gradient of the potential at `x` (N), zero at pins; without `inertia` the static one.
    pub fn fill_gradient(&mut self, system: &System, x: &[Vec3], inertia: Option<&Inertia>) {
        let terms = &self.increment;
        let each = self.corner_gradients.par_iter_mut().enumerate();
        each.with_min_len(CHUNK).for_each(|(t, out)| {
            let corners = system.topology.triangles[t].map(|v| x[v as usize]);
            *out = system.rest.elements[t]
                .gradient(&terms.law(system, t), corners)
                .1;
        });
        for (secant, elastic) in self.secants.iter_mut().zip(system.elastics()) {
            *secant = elastic.law.secant(elastic.gap(x));
        }
        let (corner_gradients, secants) = (&self.corner_gradients, &self.secants);
        let each = self.gradient.par_iter_mut().enumerate();
        each.with_min_len(CHUNK).for_each(|(v, out)| {
            let mut g =
                system.rest.bending.row_force(v, x) - system.control.gravity * system.rest.mass[v];
            let uses = system.topology.corner_start[v] as usize
                ..system.topology.corner_start[v + 1] as usize;
            for &corner in &system.topology.corners[uses] {
                g += corner_gradients[corner as usize / 3][corner as usize % 3];
            }
            for (e, other) in system.elastics_at(v) {
                g += (x[v] - other.position(x)) * secants[e];
            }
            if let Some(inertia) = inertia {
                g += (x[v] - inertia.target[v]) * inertia.weight[v];
            }
            *out = g;
        });
        for contact in &self.contacts.active {
            let sample = &contact.point;
            let (_, gradient, _) = contact.law.evaluate(&contact.plane, sample.position(x));
            for (&v, &w) in sample.vertices.iter().zip(&sample.weights) {
                self.gradient[v as usize] += gradient * w;
            }
        }
        for contact in self.contacts.cloth.all() {
            let (_, gradient, _) = contact.law.evaluate(&contact.plane, contact.between(x));
            for (v, w) in contact.vertices.into_iter().zip(contact.weights) {
                self.gradient[v as usize] += gradient * w;
            }
        }
        self.increment.add_gradient(system, x, &mut self.gradient);
        for (g, &pinned) in self.gradient.iter_mut().zip(&system.prescribed.pinned) {
            if pinned {
                *g = Vec3::zeros();
            }
        }
    }

    /// Computes the Hessian of the potential at `x` with a fraction of its destabilising curvature: positive
    /// semidefinite with [`Curvature::CONVEX`], otherwise possibly indefinite. Bending is not included: it is
    /// constant and part of the model.
    pub fn fill_hessian(
        &mut self,
        system: &System,
        x: &[Vec3],
        inertia: &Inertia,
        curvature: Curvature,
    ) {
        let terms = &self.increment;
        let each = self.elements.par_iter_mut().enumerate();
        each.with_min_len(CHUNK).for_each(|(t, out)| {
            let corners = system.topology.triangles[t].map(|v| x[v as usize]);
            let law = terms.law(system, t);
            *out = system.rest.elements[t].hessian(&law, corners, curvature);
            terms.add_hessian(t, out);
        });
        for (v, d) in self.diagonal.iter_mut().enumerate() {
            let pull: f64 = system.elastics_at(v).map(|(e, _)| self.secants[e]).sum();
            *d = Matrix3::identity() * (inertia.weight[v] + pull);
        }
        for contact in &self.contacts.active {
            let sample = &contact.point;
            let position = sample.position(x);
            let (_, _, mut hessian) = contact.law.evaluate(&contact.plane, position);
            hessian -= contact.law.missing_curvature(&contact.plane, position) * curvature.0;
            match sample.triangle {
                None => self.diagonal[sample.vertices[0] as usize] += hessian,
                Some(t) => {
                    let w = sample.weights;
                    let pairs = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];
                    for (block, (i, j)) in self.elements[t as usize].iter_mut().zip(pairs) {
                        *block += hessian * (w[i] * w[j]);
                    }
                }
            }
        }
        self.add_cloth_contact_hessian(x);
        system
            .topology
            .pattern
            .gather(&self.elements, &self.diagonal, &mut self.blocks);
    }

    /// Adds the Hessian of contacts of cloth with cloth.
    fn add_cloth_contact_hessian(&mut self, x: &[Vec3]) {
        self.cloth_contact_blocks.clear();
        for contact in self.contacts.cloth.all() {
            let (_, _, hessian) = contact.law.evaluate(&contact.plane, contact.between(x));
            if hessian == Matrix3::zeros() {
                continue;
            }
            for i in 0..4 {
                let (v, w) = (contact.vertices[i], contact.weights[i]);
                self.diagonal[v as usize] += hessian * (w * w);
                for j in 0..i {
                    let share = w * contact.weights[j];
                    if share != 0.0 {
                        self.cloth_contact_blocks
                            .add(v, contact.vertices[j], hessian * share);
                    }
                }
            }
        }
        self.cloth_contact_blocks.sort(x.len());
    }

    /// The Hessian computed last.
    pub(crate) fn hessian<'a>(&'a self, system: &'a System) -> Hessian<'a> {
        Hessian {
            system,
            bending: self.increment.bending(system),
            blocks: &self.blocks,
            secants: &self.secants,
            touching: &self.cloth_contact_blocks,
        }
    }

    /// The product of one row of the Hessian computed last with a vector.
    pub(crate) fn hessian_row(&self, system: &System, row: usize, p: &[Vec3]) -> Vec3 {
        self.hessian(system).row_times(row, p)
    }

    /// One row of the Hessian computed last as columns and blocks, without bending and without the off-diagonal
    /// blocks of elastics and cloth contacts, which are stored separately.
    pub fn hessian_blocks<'a>(
        &'a self,
        system: &'a System,
        row: usize,
    ) -> (&'a [u32], &'a [Matrix3<f64>]) {
        system.topology.pattern.row_entries(row, &self.blocks)
    }

    /// Backtracking line search: halves the step until the potential satisfies Armijo's condition; the new
    /// positions are in `trial`. Returns the fraction of the direction taken, 0 where none is accepted.
    fn line_search(&mut self, system: &System, x: &[Vec3], inertia: &Inertia) -> f64 {
        let start = self.potential(system, x, inertia);
        // `gradient` contains the negative gradient.
        let slope = -dot(&self.gradient, &self.direction);
        let mut fraction = 1.0;
        for _ in 0..MAX_TRIALS {
            for ((trial, x), d) in self.trial.iter_mut().zip(x).zip(&self.direction) {
                *trial = x + d * fraction;
            }
            let energy = self.potential(system, &self.trial, inertia);
            // A change below the rounding error of the potential counts as a decrease.
            let rounding = 1e-13 * start.abs().max(1.0);
            if energy <= start + ARMIJO * fraction * slope + rounding {
                return fraction;
            }
            fraction *= 0.5;
        }
        0.0
    }

    /// Longest displacement of a vertex in the direction (m).
    fn longest_displacement(&self) -> f64 {
        let squares = self.direction.iter().map(Vec3::norm_squared);
        squares.fold(0.0, f64::max).sqrt()
    }
}
