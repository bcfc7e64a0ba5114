//! The incremental potential of a step (Ortiz and Stainier 1999): viscosity, internal strain and air, linearised
//! or frozen at the state in which the step begins. All methods use these terms.
//!
//! Implicit methods add the terms to the potential that they minimise (viscosity as the dissipation
//! potential eta / (2 h) |E - E_n|^2 over the step, so that the Hessian stays symmetric); explicit
//! methods add the same forces at their velocities ([`add_forces_of_motion`]). In statics
//! ([`IncrementalPotential::begin_static`]) only internal strain and the steady force of the wind are left.
//!
//! Internal strain is that of a standard linear solid: S = C (E - p v) with v' = (E - v) / tau, p the relaxed fraction
//! and tau the relaxation time. Under constant strain the stress falls to 1 - p of its first value; released, the cloth
//! retains p of the strain at first and recovers over tau / (1 - p). The same holds for curvature. v is constant during
//! a step; at its end it is integrated exactly for the strain reached ([`relax`]).

use crate::laws::bending::BendingStencil;
use crate::laws::fold::{FoldTerm, along_normal, area_normal};
use crate::laws::membrane::green_strain;
use crate::laws::stretch::{MembraneLaw, StrainLaw};
use crate::material::{DissipativeLaws, MaterialLaws};
use crate::{InternalStrain, State, System};
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;
use toile_geometry::Vec3;
use toile_sparse::ScalarMatrix;

/// A membrane law during a step: measured from the internal strain, with viscosity.
#[derive(Clone, Copy, Debug)]
pub struct IncrementalLaw<'a> {
    law: &'a MembraneLaw,
    term: Option<&'a StretchTerm>,
}

#[derive(Clone, Copy, Debug)]
struct StretchTerm {
    /// Internal strain times the relaxed fraction: the strain without elastic stress.
    internal: [f64; 3],
    /// Strain when the step began.
    start: [f64; 3],
    /// Viscous matrix over the step: uu, vv, uu-vv, gamma-gamma (N/m).
    viscous: [f64; 4],
}

impl StretchTerm {
    #[inline]
    fn viscous_stress(&self, strain: [f64; 3]) -> ([f64; 3], f64) {
        let d = [0, 1, 2].map(|k| strain[k] - self.start[k]);
        let s = viscous_stress(self.viscous, d);
        (s, 0.5 * (s[0] * d[0] + s[1] * d[1] + s[2] * d[2]))
    }
}

fn viscous_stress([uu, vv, uv, gg]: [f64; 4], d: [f64; 3]) -> [f64; 3] {
    [uu * d[0] + uv * d[1], vv * d[1] + uv * d[0], gg * d[2]]
}

impl StrainLaw for IncrementalLaw<'_> {
    #[inline]
    fn stress(&self, strain: [f64; 3]) -> ([f64; 3], f64) {
        let Some(term) = self.term else {
            return self.law.stress(strain);
        };
        let (elastic, energy) = self
            .law
            .stress([0, 1, 2].map(|k| strain[k] - term.internal[k]));
        let (viscous, loss) = term.viscous_stress(strain);
        ([0, 1, 2].map(|k| elastic[k] + viscous[k]), energy + loss)
    }

    #[inline]
    fn slope(&self, strain: [f64; 3]) -> [f64; 6] {
        let Some(term) = self.term else {
            return self.law.slope(strain);
        };
        let mut slope = self
            .law
            .slope([0, 1, 2].map(|k| strain[k] - term.internal[k]));
        for (s, v) in slope.iter_mut().zip(term.viscous) {
            *s += v;
        }
        slope
    }
}

/// Drag of one triangle over a step, linear about the velocity at its start (as Baraff and Witkin
/// 1998 treat every force): with w the velocity relative to the air, the potential over the step is
/// (g.(w - w_0) + 1/2 (w - w_0).H.(w - w_0)) h, convex, its steady state that of the full law.
#[derive(Clone, Copy, Debug)]
struct AirTerm {
    /// The middle of the triangle when the step began (m).
    start: Vec3,
    /// 1/h (1/s); 0 while nothing moves.
    rate: f64,
    /// Velocity of the triangle then (m/s).
    velocity: Vec3,
    /// g (N).
    gradient: Vec3,
    /// H (N s/m).
    hessian: Matrix3<f64>,
}

/// The incremental terms of a step; empty for an elastic cloth without viscosity in still air.
#[derive(Default)]
pub struct IncrementalPotential {
    stretch: Vec<StretchTerm>,
    fold: Vec<FoldTerm>,
    air: Vec<AirTerm>,
    bending: Option<ScalarMatrix>,
}

/// Triangles of one parallel task.
const CHUNK: usize = 256;

fn corners(system: &System, t: usize, x: &[Vec3]) -> [Vec3; 3] {
    system.topology.triangles[t].map(|v| x[v as usize])
}

fn curvature(stencil: &BendingStencil, x: &[Vec3]) -> [Vec3; 3] {
    let mut k = [Vec3::zeros(); 3];
    // Weights sum to zero: differences keep the rounding small.
    let Some(&first) = stencil.vertices.first() else {
        return k;
    };
    for (&v, w) in stencil.vertices.iter().zip(&stencil.weights) {
        let d = x[v as usize] - x[first as usize];
        for c in 0..3 {
            k[c] += d * w[c];
        }
    }
    k
}

fn curvature_along_normal(system: &System, t: usize, x: &[Vec3]) -> Vector3<f64> {
    match area_normal(corners(system, t, x)).try_normalize(0.0) {
        Some(n) => along_normal(n, curvature(&system.rest.stencils[t], x)),
        None => Vector3::zeros(),
    }
}

fn strain(system: &System, t: usize, x: &[Vec3]) -> [f64; 3] {
    green_strain(system.rest.elements[t].tangents(corners(system, t, x)))
}

impl IncrementalPotential {
    /// Sets the terms of an equilibrium problem.
    pub fn begin_static(&mut self, system: &System, state: &State) {
        self.begin_step(system, state, 0.0);
    }

    /// Sets the terms of a step from a state; `rate` is 1/h (1/s), 0 in statics.
    pub fn begin_step(&mut self, system: &System, state: &State, rate: f64) {
        let x = &state.positions;
        let count = system.topology.triangles.len();
        self.stretch.clear();
        self.fold.clear();
        self.air.clear();
        self.bending = None;
        let moving = rate > 0.0;
        let internal = |t: usize| state.internal_strain.get(t).copied().unwrap_or_default();
        let relaxes = !state.internal_strain.is_empty();
        if relaxes || moving && system.materials.have_viscous_stretch() {
            self.stretch.extend((0..count).map(|t| {
                let material = system.materials.of(t);
                StretchTerm {
                    internal: internal(t)
                        .stretch
                        .map(|v| v * material.relaxed_fraction[0]),
                    start: strain(system, t, x),
                    viscous: material.viscous_stretch().map(|v| v * rate),
                }
            }));
        }
        let flows = moving && system.rest.viscous_bending.is_some();
        if !system.rest.stencils.is_empty() && (relaxes || flows) {
            self.fold.extend((0..count).map(|t| {
                let material = system.materials.of(t);
                let (stencil, area) = (&system.rest.stencils[t], system.rest.elements[t].area);
                let curvature = Vector3::from(internal(t).curvature) * material.relaxed_fraction[1];
                FoldTerm {
                    internal_moment: stencil.stiffness(material.bending_matrix())
                        * curvature
                        * area,
                    start: curvature_along_normal(system, t, x),
                    viscous: stencil.stiffness(material.viscous_bend()) * (area * rate),
                }
            }));
        }
        if let Some(viscous) = system.rest.viscous_bending.as_ref().filter(|_| moving) {
            self.bending = Some(system.rest.bending.plus(viscous, rate));
        }
        if system.control.air.acts() && (moving || system.control.air.wind != Vec3::zeros()) {
            self.air.extend((0..count).map(|t| {
                let at = corners(system, t, x);
                let normal = area_normal(at);
                let unit = normal.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
                let pull = system.control.air.on(0.5 * normal.norm(), unit);
                let velocity = if moving {
                    corners(system, t, &state.velocities).iter().sum::<Vec3>() / 3.0
                } else {
                    Vec3::zeros()
                };
                let w = velocity - system.control.air.wind;
                AirTerm {
                    start: at.iter().sum::<Vec3>() / 3.0,
                    rate,
                    velocity,
                    gradient: pull.gradient(w),
                    hessian: pull.hessian(w),
                }
            }));
        }
    }

    /// Whether only terms of stretch are set.
    pub fn are_of_stretch(&self) -> bool {
        self.fold.is_empty() && self.air.is_empty() && self.bending.is_none()
    }

    /// The membrane law of a triangle during the step.
    #[inline]
    pub fn law<'a>(&'a self, system: &'a System, t: usize) -> IncrementalLaw<'a> {
        IncrementalLaw {
            law: system.materials.law(t),
            term: self.stretch.get(t),
        }
    }

    /// The Hessian of bending during the step.
    #[inline]
    pub fn bending<'a>(&'a self, system: &'a System) -> &'a ScalarMatrix {
        self.bending.as_ref().unwrap_or(&system.rest.bending)
    }

    /// Energy of folds and air at some positions (J).
    pub fn energy(&self, system: &System, x: &[Vec3]) -> f64 {
        if self.fold.is_empty() && self.air.is_empty() {
            return 0.0;
        }
        let parts: Vec<f64> = (0..system.topology.triangles.len().div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let mut energy = 0.0;
                for t in chunk * CHUNK..((chunk + 1) * CHUNK).min(system.topology.triangles.len()) {
                    if let Some(term) = self.fold.get(t) {
                        energy += term.energy(curvature_along_normal(system, t, x));
                    }
                    if let Some(air) = self.air.get(t) {
                        energy += air.energy(corners(system, t, x));
                    }
                }
                energy
            })
            .collect();
        parts.iter().sum()
    }

    /// Adds the gradient of [`Self::energy`].
    pub fn add_gradient(&self, system: &System, x: &[Vec3], gradient: &mut [Vec3]) {
        for (t, term) in self.fold.iter().enumerate() {
            add_fold(system, t, term, x, gradient);
        }
        for (t, air) in self.air.iter().enumerate() {
            let slope = air.gradient(corners(system, t, x)) / 3.0;
            for v in system.topology.triangles[t] {
                gradient[v as usize] += slope;
            }
        }
    }

    /// Adds the Hessian of the air to the blocks of a triangle's corner pairs.
    #[inline]
    pub fn add_hessian(&self, t: usize, blocks: &mut [Matrix3<f64>; 6]) {
        if let Some(air) = self.air.get(t) {
            let block = air.hessian * (air.rate / 9.0);
            for b in blocks {
                *b += block;
            }
        }
    }
}

impl AirTerm {
    /// Change of velocity since the step began (m/s).
    fn change(&self, corners: [Vec3; 3]) -> Vec3 {
        (corners.iter().sum::<Vec3>() / 3.0 - self.start) * self.rate - self.velocity
    }

    fn energy(&self, corners: [Vec3; 3]) -> f64 {
        if self.rate > 0.0 {
            let d = self.change(corners);
            (self.gradient + self.hessian * d * 0.5).dot(&d) / self.rate
        } else {
            self.gradient
                .dot(&(corners.iter().sum::<Vec3>() / 3.0 - self.start))
        }
    }

    fn gradient(&self, corners: [Vec3; 3]) -> Vec3 {
        if self.rate > 0.0 {
            self.gradient + self.hessian * self.change(corners)
        } else {
            self.gradient
        }
    }
}

fn add_fold(system: &System, t: usize, term: &FoldTerm, x: &[Vec3], gradient: &mut [Vec3]) {
    let stencil = &system.rest.stencils[t];
    let Some((by_curvature, by_corner)) =
        term.gradient(corners(system, t, x), curvature(stencil, x))
    else {
        return;
    };
    for (&v, w) in stencil.vertices.iter().zip(&stencil.weights) {
        gradient[v as usize] +=
            by_curvature[0] * w[0] + by_curvature[1] * w[1] + by_curvature[2] * w[2];
    }
    for (v, g) in system.topology.triangles[t].into_iter().zip(by_corner) {
        gradient[v as usize] += g;
    }
}

/// Adds the forces that depend on velocity, for explicit methods: viscosity and the change that
/// motion makes to the force of the air (N).
pub(crate) fn add_forces_of_motion(system: &System, state: &State, force: &mut [Vec3]) {
    let (x, v) = (&state.positions, &state.velocities);
    let viscous = system.materials.have_viscous_stretch();
    let folds = system.rest.viscous_bending.is_some() && !system.rest.stencils.is_empty();
    if !(viscous || folds || system.control.air.acts()) {
        return;
    }
    for t in 0..system.topology.triangles.len() {
        let material = system.materials.of(t);
        let (at, speed) = (corners(system, t, x), corners(system, t, v));
        if viscous {
            let element = &system.rest.elements[t];
            let ([fu, fv], [gu, gv]) = (element.tangents(at), element.tangents(speed));
            let rate = [fu.dot(&gu), fv.dot(&gv), fu.dot(&gv) + fv.dot(&gu)];
            let [uu, vv, uv] = viscous_stress(material.viscous_stretch(), rate);
            let by_u = (fu * uu + fv * uv) * element.area;
            let by_v = (fv * vv + fu * uv) * element.area;
            for (k, vertex) in system.topology.triangles[t].into_iter().enumerate() {
                force[vertex as usize] -= by_u * element.warp[k] + by_v * element.weft[k];
            }
        }
        let normal = area_normal(at);
        if folds && let Some(n) = normal.try_normalize(0.0) {
            let stencil = &system.rest.stencils[t];
            let area = system.rest.elements[t].area;
            let rate = along_normal(n, curvature(stencil, v));
            let moment = stencil.stiffness(material.viscous_bend()) * rate * area;
            for (&vertex, w) in stencil.vertices.iter().zip(&stencil.weights) {
                force[vertex as usize] -= n * moment.dot(&Vector3::from(*w));
            }
        }
        if system.control.air.acts() {
            let area = 0.5 * normal.norm();
            let normal = normal.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
            let pull = system.control.air.on(area, normal);
            let wind = system.control.air.wind;
            let change =
                pull.gradient(speed.iter().sum::<Vec3>() / 3.0 - wind) - pull.gradient(-wind);
            for vertex in system.topology.triangles[t] {
                force[vertex as usize] -= change / 3.0;
            }
        }
    }
}

/// Integrates the internal strain over `h` (s), the strain being constant:
/// v <- E + (v - E) exp(-h / tau).
pub(crate) fn relax(system: &System, state: &mut State, h: f64) {
    if !system.materials.keep_strain() {
        return;
    }
    state
        .internal_strain
        .resize(system.topology.triangles.len(), InternalStrain::default());
    let x = &state.positions;
    state
        .internal_strain
        .par_chunks_mut(CHUNK)
        .enumerate()
        .for_each(|(chunk, internal)| {
            for (k, internal) in internal.iter_mut().enumerate() {
                let t = chunk * CHUNK + k;
                let material = system.materials.of(t);
                let share = -(-h / material.relaxation_time).exp_m1();
                if material.relaxed_fraction[0] > 0.0 {
                    let now = strain(system, t, x);
                    for (v, e) in internal.stretch.iter_mut().zip(now) {
                        *v += (e - *v) * share;
                    }
                }
                if material.relaxed_fraction[1] > 0.0 {
                    let now = curvature_along_normal(system, t, x);
                    for (v, e) in internal.curvature.iter_mut().zip(now.iter()) {
                        *v += (e - *v) * share;
                    }
                }
            }
        });
}
