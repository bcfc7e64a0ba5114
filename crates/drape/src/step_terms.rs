//! What a step holds fixed: viscosity, kept strain, air. One place for every method.
//!
//! Implicit methods add the terms to the potential they lower (viscosity as the dissipation
//! potential eta / (2 h) |E - E_n|^2 over the step, so that the Hessian stays symmetric); explicit
//! ones add the same forces at their velocities. While nothing moves (`hold_still`) only kept strain
//! and the push of the wind are left.
//!
//! Kept strain is a standard linear solid: S = C (E - p v) with v' = (E - v) / tau, p the kept share
//! and tau the relaxation time. Stress held for long falls to 1 - p of its first value; let go, the
//! cloth keeps p of the strain and recovers over tau / (1 - p). The same for curvature. During a step
//! v stands; after it v is moved exactly for the strain reached ([`relax`]).

use crate::laws::bending::BendingStencil;
use crate::laws::fold::{FoldTerm, along_normal, area_normal};
use crate::laws::membrane::green_strain;
use crate::laws::stretch::{MembraneLaw, StrainLaw};
use crate::{InternalStrain, Model, State};
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;
use toile_geometry::Vec3;
use toile_sparse::ScalarMatrix;

/// A membrane law during a step: shifted by kept strain, with viscosity.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HeldLaw<'a> {
    law: &'a MembraneLaw,
    term: Option<&'a StretchTerm>,
}

#[derive(Clone, Copy, Debug)]
struct StretchTerm {
    /// Strain without stress.
    kept: [f64; 3],
    /// Strain when the step began.
    start: [f64; 3],
    /// Viscous matrix over the step: uu, vv, uu-vv, gamma-gamma [N/m].
    viscous: [f64; 4],
}

impl StretchTerm {
    fn viscous_stress(&self, strain: [f64; 3]) -> ([f64; 3], f64) {
        let d = [0, 1, 2].map(|k| strain[k] - self.start[k]);
        let s = viscous_stress(self.viscous, d);
        (s, 0.5 * (s[0] * d[0] + s[1] * d[1] + s[2] * d[2]))
    }
}

fn viscous_stress([uu, vv, uv, gg]: [f64; 4], d: [f64; 3]) -> [f64; 3] {
    [uu * d[0] + uv * d[1], vv * d[1] + uv * d[0], gg * d[2]]
}

impl StrainLaw for HeldLaw<'_> {
    #[inline]
    fn stress(&self, strain: [f64; 3]) -> ([f64; 3], f64) {
        let Some(term) = self.term else {
            return self.law.stress(strain);
        };
        let (elastic, energy) = self.law.stress([0, 1, 2].map(|k| strain[k] - term.kept[k]));
        let (viscous, loss) = term.viscous_stress(strain);
        ([0, 1, 2].map(|k| elastic[k] + viscous[k]), energy + loss)
    }

    #[inline]
    fn slope(&self, strain: [f64; 3]) -> [f64; 6] {
        let Some(term) = self.term else {
            return self.law.slope(strain);
        };
        let mut slope = self.law.slope([0, 1, 2].map(|k| strain[k] - term.kept[k]));
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
    /// The middle of the triangle when the step began [m].
    start: Vec3,
    /// 1/h [1/s]; 0 while nothing moves.
    rate: f64,
    /// Velocity of the triangle then [m/s].
    velocity: Vec3,
    /// g [N].
    gradient: Vec3,
    /// H [N s/m].
    hessian: Matrix3<f64>,
}

/// The terms of a step; empty for a plain cloth in still air.
#[derive(Default)]
pub(crate) struct StepTerms {
    stretch: Vec<StretchTerm>,
    fold: Vec<FoldTerm>,
    air: Vec<AirTerm>,
    bending: Option<ScalarMatrix>,
}

/// Triangles handled by one task.
const CHUNK: usize = 256;

fn corners(model: &Model, t: usize, x: &[Vec3]) -> [Vec3; 3] {
    model.triangles[t].map(|v| x[v as usize])
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

fn curvature_along_normal(model: &Model, t: usize, x: &[Vec3]) -> Vector3<f64> {
    match area_normal(corners(model, t, x)).try_normalize(0.0) {
        Some(n) => along_normal(n, curvature(&model.stencils[t], x)),
        None => Vector3::zeros(),
    }
}

fn strain(model: &Model, t: usize, x: &[Vec3]) -> [f64; 3] {
    green_strain(model.elements[t].tangents(corners(model, t, x)))
}

impl StepTerms {
    /// Holds a state while nothing moves.
    pub fn hold_still(&mut self, model: &Model, state: &State) {
        self.hold(model, state, 0.0);
    }

    /// Holds the start of a step; `rate` is 1/h [1/s].
    pub fn hold(&mut self, model: &Model, state: &State, rate: f64) {
        let x = &state.positions;
        let count = model.triangles.len();
        self.stretch.clear();
        self.fold.clear();
        self.air.clear();
        self.bending = None;
        let moving = rate > 0.0;
        let settled = |t: usize| state.settled.get(t).copied().unwrap_or_default();
        let keeps = !state.settled.is_empty();
        if keeps || moving && model.has_viscous_stretch() {
            self.stretch.extend((0..count).map(|t| {
                let material = &model.materials[model.material[t] as usize];
                let settled = settled(t).stretch;
                StretchTerm {
                    kept: settled.map(|v| v * material.kept[0]),
                    start: strain(model, t, x),
                    viscous: material.viscous_stretch().map(|v| v * rate),
                }
            }));
        }
        let flows = moving && model.viscous_bending.is_some();
        if !model.stencils.is_empty() && (keeps || flows) {
            self.fold.extend((0..count).map(|t| {
                let material = &model.materials[model.material[t] as usize];
                let (stencil, area) = (&model.stencils[t], model.elements[t].area);
                let kept = Vector3::from(settled(t).curvature) * material.kept[1];
                FoldTerm {
                    kept: stencil.stiffness(material.bending_matrix()) * kept * area,
                    start: curvature_along_normal(model, t, x),
                    viscous: stencil.stiffness(material.viscous_bend()) * (area * rate),
                }
            }));
        }
        if let Some(viscous) = model.viscous_bending.as_ref().filter(|_| moving) {
            self.bending = Some(model.bending.plus(viscous, rate));
        }
        if model.air.acts() && (moving || model.air.wind != Vec3::zeros()) {
            self.air.extend((0..count).map(|t| {
                let at = corners(model, t, x);
                let normal = area_normal(at);
                let unit = normal.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
                let pull = model.air.on(0.5 * normal.norm(), unit);
                let velocity = if moving {
                    corners(model, t, &state.velocities).iter().sum::<Vec3>() / 3.0
                } else {
                    Vec3::zeros()
                };
                let w = velocity - model.air.wind;
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

    /// Whether all of them belong to the stretch of a triangle.
    pub fn are_of_stretch(&self) -> bool {
        self.fold.is_empty() && self.air.is_empty() && self.bending.is_none()
    }

    /// The law of a triangle's membrane during the step.
    #[inline]
    pub fn law<'a>(&'a self, model: &'a Model, t: usize) -> HeldLaw<'a> {
        HeldLaw {
            law: &model.laws[model.material[t] as usize],
            term: self.stretch.get(t),
        }
    }

    /// The Hessian of bending during the step.
    pub fn bending<'a>(&'a self, model: &'a Model) -> &'a ScalarMatrix {
        self.bending.as_ref().unwrap_or(&model.bending)
    }

    /// Energy of folds and air at some positions [J].
    pub fn energy(&self, model: &Model, x: &[Vec3]) -> f64 {
        if self.fold.is_empty() && self.air.is_empty() {
            return 0.0;
        }
        let parts: Vec<f64> = (0..model.triangles.len().div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let mut energy = 0.0;
                for t in chunk * CHUNK..((chunk + 1) * CHUNK).min(model.triangles.len()) {
                    if let Some(term) = self.fold.get(t) {
                        energy += term.energy(curvature_along_normal(model, t, x));
                    }
                    if let Some(air) = self.air.get(t) {
                        energy += air.energy(corners(model, t, x));
                    }
                }
                energy
            })
            .collect();
        parts.iter().sum()
    }

    /// Adds the gradient of [`Self::energy`].
    pub fn add_gradient(&self, model: &Model, x: &[Vec3], gradient: &mut [Vec3]) {
        for (t, term) in self.fold.iter().enumerate() {
            add_fold(model, t, term, x, gradient);
        }
        for (t, air) in self.air.iter().enumerate() {
            let slope = air.gradient(corners(model, t, x)) / 3.0;
            for v in model.triangles[t] {
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
    /// Change of velocity since the step began [m/s].
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

fn add_fold(model: &Model, t: usize, term: &FoldTerm, x: &[Vec3], gradient: &mut [Vec3]) {
    let stencil = &model.stencils[t];
    let Some((by_curvature, by_corner)) =
        term.gradient(corners(model, t, x), curvature(stencil, x))
    else {
        return;
    };
    for (&v, w) in stencil.vertices.iter().zip(&stencil.weights) {
        gradient[v as usize] +=
            by_curvature[0] * w[0] + by_curvature[1] * w[1] + by_curvature[2] * w[2];
    }
    for (v, g) in model.triangles[t].into_iter().zip(by_corner) {
        gradient[v as usize] += g;
    }
}

/// Adds the forces that depend on velocity, for explicit methods: viscosity and the change that
/// motion makes to the push of the air [N].
pub(crate) fn add_forces_of_motion(model: &Model, state: &State, force: &mut [Vec3]) {
    let (x, v) = (&state.positions, &state.velocities);
    let viscous = model.has_viscous_stretch();
    let folds = model.viscous_bending.is_some() && !model.stencils.is_empty();
    if !(viscous || folds || model.air.acts()) {
        return;
    }
    for t in 0..model.triangles.len() {
        let material = &model.materials[model.material[t] as usize];
        let (at, speed) = (corners(model, t, x), corners(model, t, v));
        if viscous {
            let element = &model.elements[t];
            let ([fu, fv], [gu, gv]) = (element.tangents(at), element.tangents(speed));
            let rate = [fu.dot(&gu), fv.dot(&gv), fu.dot(&gv) + fv.dot(&gu)];
            let [uu, vv, uv] = viscous_stress(material.viscous_stretch(), rate);
            let by_u = (fu * uu + fv * uv) * element.area;
            let by_v = (fv * vv + fu * uv) * element.area;
            for (k, vertex) in model.triangles[t].into_iter().enumerate() {
                force[vertex as usize] -= by_u * element.warp[k] + by_v * element.weft[k];
            }
        }
        let normal = area_normal(at);
        if folds && let Some(n) = normal.try_normalize(0.0) {
            let stencil = &model.stencils[t];
            let area = model.elements[t].area;
            let rate = along_normal(n, curvature(stencil, v));
            let moment = stencil.stiffness(material.viscous_bend()) * rate * area;
            for (&vertex, w) in stencil.vertices.iter().zip(&stencil.weights) {
                force[vertex as usize] -= n * moment.dot(&Vector3::from(*w));
            }
        }
        if model.air.acts() {
            let area = 0.5 * normal.norm();
            let normal = normal.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
            let pull = model.air.on(area, normal);
            let wind = model.air.wind;
            let change =
                pull.gradient(speed.iter().sum::<Vec3>() / 3.0 - wind) - pull.gradient(-wind);
            for vertex in model.triangles[t] {
                force[vertex as usize] -= change / 3.0;
            }
        }
    }
}

/// Moves what the cloth has settled into towards the strain it has, over `h` [s]:
/// v <- E + (v - E) exp(-h / tau).
pub(crate) fn relax(model: &Model, state: &mut State, h: f64) {
    if !model.keeps_strain() {
        return;
    }
    state
        .settled
        .resize(model.triangles.len(), InternalStrain::default());
    let x = &state.positions;
    state
        .settled
        .par_chunks_mut(CHUNK)
        .enumerate()
        .for_each(|(chunk, settled)| {
            for (k, settled) in settled.iter_mut().enumerate() {
                let t = chunk * CHUNK + k;
                let material = &model.materials[model.material[t] as usize];
                let share = -(-h / material.relaxation_time).exp_m1();
                if material.kept[0] > 0.0 {
                    let now = strain(model, t, x);
                    for (v, e) in settled.stretch.iter_mut().zip(now) {
                        *v += (e - *v) * share;
                    }
                }
                if material.kept[1] > 0.0 {
                    let now = curvature_along_normal(model, t, x);
                    for (v, e) in settled.curvature.iter_mut().zip(now.iter()) {
                        *v += (e - *v) * share;
                    }
                }
            }
        });
}
