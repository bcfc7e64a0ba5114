//! Viscosity of stretch, shear and bending (Kelvin-Voigt), and damping in proportion to stiffness.
//!
//! A substep begins with
//! ```text
//! v = v - q(h W T) v
//! T v = sum over triangles of  A J^T V (J v)  +  A sum over k, l of  w_k n N_kl (n . sum_i w_l,i v_i)
//! ```
//! with J v the rates of the three strains and V their viscous matrix, w the weights of the three curvatures, n the
//! normal and N their viscous matrix: the dissipation of [`crate::Material`]'s viscosities at the positions at which the
//! substep begins. J v and the curvatures along the normal are zero where cloth moves rigidly, up to the strain of folds
//! within a triangle, so q keeps linear momentum and leaves rigid motion alone.
//!
//! q is the polynomial of the bending filter ([`super::bending::Filter`]), q'(0) = 1, in as many stages as the largest
//! rate h w needs: slow modes have their own viscosity on any mesh, that of modes which decay within a substep
//! is limited. T is symmetric and positive semidefinite and 0 <= q < 1, so no viscosity adds energy. Beyond the most stages it
//! is refused: a mode that matters would then decay within a substep.

use super::bending::{Filter, FilterBounds, Stencil, stencils};
use super::membrane::MembraneBatch;
use crate::lane_arithmetic::{F32s, Number, Triple};
use crate::lanes::{Corner, LANES, Point, Row, gather, lane_group_of, lane_groups, scatter};
use crate::material::{DissipativeLaws, MaterialLaws};
use crate::{DrapeError, Material, System};
use nalgebra::Matrix3;
use pulp::{Simd, WithSimd};

/// The viscosity of a model.
#[derive(Clone, Debug)]
pub struct Viscosity {
    /// Viscous matrix of stretch of each material: uu, vv, uu-vv, gamma-gamma (N s/m).
    pub stretch: Vec<[f32; 4]>,
    /// Upper bound of the largest rate of decay, the largest eigenvalue of W T (1/s).
    pub rate: f64,
    /// Time by which the viscosity of bending is in proportion to stiffness, at least, in every material (s).
    pub bending_time: f64,
}

/// Stretch of a thread up to which its viscosity is that of the law: beyond it the rate is bounded.
const STRETCHED: f32 = 1.25;

impl Viscosity {
    /// The viscosity of a model; none where no material has any.
    pub fn new(system: &System) -> Option<Self> {
        let materials = &system.materials.list;
        let viscous = materials.iter().any(|m| m.is_viscous().contains(&true));
        viscous.then(|| Self {
            stretch: (materials.iter())
                .map(|m| m.viscous_stretch().map(|x| x as f32))
                .collect(),
            rate: stretch_rate(system) + bending_rate(system),
            bending_time: (materials.iter().map(bending_time)).fold(f64::INFINITY, f64::min),
        })
    }

    /// The stencils of the triangles whose bending is viscous, each with all corners of its triangle.
    pub fn stencils(system: &System) -> Vec<Stencil> {
        if system.rest.viscous_bending.is_none() {
            return Vec::new();
        }
        let mut all = stencils(system, Material::viscous_bend);
        for stencil in &mut all {
            for corner in system.topology.triangles[stencil.triangle as usize] {
                if !stencil.vertices.contains(&corner) {
                    stencil.vertices.push(corner);
                    stencil.weights.push([0.0; 3]);
                }
            }
        }
        all
    }

    /// The filter for substeps of h (s).
    ///
    /// # Errors
    /// Viscosity that needs more stages than there are.
    pub fn filter(&self, h: f64) -> Result<Filter, DrapeError> {
        let unit = Filter {
            stages: vec![[0.0, 0.0, 1.0]],
            factor: 1.0,
        };
        match Filter::new(h * self.rate, FilterBounds::VISCOUS) {
            Some(filter) if filter.is_identity() => Ok(unit),
            Some(filter) => Ok(filter),
            None => Err(DrapeError::Scene {
                place: "viscosity".to_owned(),
                what: format!(
                    "it lets velocities decay by up to {:.1e} a second, too fast for substeps of {h:.1e} s",
                    self.rate
                ),
                remedy:
                    "give less viscosity or stiffness damping, more substeps, or a coarser mesh"
                        .to_owned(),
            }),
        }
    }
}

/// Largest rate of decay by the viscosity of stretch: the largest of any one triangle with a third of its mass at each
/// corner (Irons and Treharne 1971), in the worst of all shapes with threads stretched up to [`STRETCHED`]. Rates are
/// convex in the products of f_u and f_v, so that the worst has both along one line.
fn stretch_rate(system: &System) -> f64 {
    let largest = |(t, element): (usize, &crate::laws::membrane::MembraneElement)| {
        let material = system.materials.of(t);
        let [uu, vv, uv, gg] = material.viscous_stretch();
        let viscous = Matrix3::new(uu, uv, 0.0, uv, vv, 0.0, 0.0, 0.0, gg);
        let (a, b) = (element.warp, element.weft);
        let sum = |f: &dyn Fn(usize) -> f64| (0..3).map(f).sum::<f64>();
        let (p, q) = (sum(&|i| a[i] * a[i]), sum(&|i| b[i] * b[i]));
        let r = sum(&|i| a[i] * b[i]);
        let of_line = |s: f64| {
            let (uu_g, vv_g) = (s * p + r, s * q + r);
            let rows = Matrix3::new(
                p,
                s * r,
                uu_g,
                s * r,
                q,
                vv_g,
                uu_g,
                vv_g,
                p + q + 2.0 * s * r,
            );
            // The eigenvalues of a product of two matrices are at most the product of the largest.
            let root = viscous.symmetric_eigen();
            let half = root.eigenvectors
                * Matrix3::from_diagonal(&root.eigenvalues.map(|x| x.max(0.0).sqrt()))
                * root.eigenvectors.transpose();
            (half * rows * half).symmetric_eigenvalues().max()
        };
        3.0 / material.density * of_line(1.0).max(of_line(-1.0))
    };
    let stretched = f64::from(STRETCHED * STRETCHED);
    let all = system.rest.elements.iter().enumerate().map(largest);
    stretched * all.fold(0.0, f64::max)
}

/// Largest rate of decay by the viscosity of bending, by Gershgorin's circles.
fn bending_rate(system: &System) -> f64 {
    let Some(viscous) = &system.rest.viscous_bending else {
        return 0.0;
    };
    let rate = |v: usize| {
        let (_, values) = viscous.row_entries(v);
        values.iter().map(|value| value.abs()).sum::<f64>() / system.rest.mass[v]
    };
    (0..system.vertex_count()).map(rate).fold(0.0, f64::max)
}

/// Time by which a material's viscosity of bending is in proportion to stiffness, at least (s).
fn bending_time(material: &Material) -> f64 {
    let mut stiffness = material.bending_matrix();
    // Over curvatures of equal viscosity: that of twist is twice that of the others.
    stiffness[(1, 1)] *= 0.5;
    let largest = stiffness.symmetric_eigenvalues().max();
    let own = match largest > 0.0 {
        true => material.bend_viscosity / largest,
        false => f64::INFINITY,
    };
    own + material.stiffness_damping
}

/// Up to sixteen triangles with viscous bending, their stencils of the same size and without a shared vertex.
#[derive(Clone, Debug)]
pub struct ViscousBatch {
    corners: Vec<Corner>,
    /// Weights of each corner in the three curvatures along the principal directions of the viscous matrix (1/m2).
    weights: Vec<[Row; 3]>,
    /// A N of the three (N m3 s).
    viscous: [Row; 3],
    /// Corners of the triangles.
    triangles: [Corner; 3],
}

impl ViscousBatch {
    /// A batch of up to sixteen stencils; `local` is the index of a vertex in the region, where index 0 is a fixed point
    /// for unused lanes.
    pub fn new(system: &System, members: &[&Stencil], local: impl Fn(u32) -> u32) -> Self {
        let size = members.first().map_or(0, |s| s.vertices.len());
        let mut batch = Self {
            corners: vec![Corner([0; LANES]); size],
            weights: vec![[Row::splat(0.0); 3]; size],
            viscous: [Row::splat(0.0); 3],
            triangles: [Corner([0; LANES]); 3],
        };
        for (lane, stencil) in members.iter().enumerate() {
            for (k, (&v, weights)) in stencil.vertices.iter().zip(&stencil.weights).enumerate() {
                batch.corners[k].0[lane] = local(v);
                for row in 0..3 {
                    batch.weights[k][row].0[lane] = weights[row] as f32;
                }
            }
            for row in 0..3 {
                batch.viscous[row].0[lane] = stencil.stiffness[row] as f32;
                let corner = system.topology.triangles[stencil.triangle as usize][row];
                batch.triangles[row].0[lane] = local(corner);
            }
        }
        batch
    }
}

/// Velocities of the stages of the filter at some vertices (m/s).
pub struct ViscousStage<'a> {
    /// Before the first stage.
    pub unfiltered: &'a [Point],
    /// After the last stage.
    pub last: &'a [Point],
    /// After the one before; overwritten by those of the new stage.
    pub new: &'a mut [Point],
    /// T v after the last stage (N).
    pub forces: &'a [Point],
    /// Points with their inverse masses.
    pub starts: &'a [Point],
}

impl ViscousStage<'_> {
    /// Computes a stage in substeps of h (s) by its coefficients mu, nu, kappa.
    pub fn advance(self, [mu, nu, kappa]: [f32; 3], h: f32) {
        let known = self.unfiltered.iter().zip(self.last).zip(self.forces);
        for ((new, start), ((v, last), force)) in self.new.iter_mut().zip(self.starts).zip(known) {
            let share = kappa * h * start[3];
            for k in 0..3 {
                let recursion = mu * (last[k] - v[k]) - nu * (new[k] - v[k]);
                new[k] = v[k] + (recursion - share * force[k]);
            }
        }
    }
}

/// Adds T v of some triangles to sums at their vertices (N).
pub struct AddViscousForces<'a> {
    /// The viscosity.
    pub viscosity: &'a Viscosity,
    /// The triangles.
    pub membrane: &'a [MembraneBatch],
    /// Those with viscous bending.
    pub bending: &'a [ViscousBatch],
    /// The points of their region at the start of the substep.
    pub starts: &'a [Point],
    /// Their velocities (m/s).
    pub velocities: &'a [Point],
    /// The sums.
    pub sums: &'a mut [Point],
}

impl WithSimd for AddViscousForces<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let (starts, velocities) = (self.starts, self.velocities);
        for batch in self.membrane {
            let viscous = self.viscosity.stretch[batch.law as usize];
            if viscous == [0.0; 4] {
                continue;
            }
            for lane_group in 0..lane_groups::<S>() {
                add_stretch(
                    simd,
                    (batch, viscous, lane_group),
                    starts,
                    velocities,
                    self.sums,
                );
            }
        }
        for batch in self.bending {
            for lane_group in 0..lane_groups::<S>() {
                add_bending(simd, (batch, lane_group), starts, velocities, self.sums);
            }
        }
    }
}

/// Two sides of the triangles of one lane group: differences of the second and the third corner to the first.
#[inline(always)]
fn sides<S: Simd>(
    simd: S,
    corners: &[Corner; 3],
    points: &[Point],
    lane_group: usize,
) -> [Triple<F32s<S>>; 2] {
    let (p0, _) = gather(simd, points, &corners[0], lane_group);
    let (p1, _) = gather(simd, points, &corners[1], lane_group);
    let (p2, _) = gather(simd, points, &corners[2], lane_group);
    [p1 - p0, p2 - p0]
}

/// f shortened to [`STRETCHED`].
#[inline(always)]
fn bounded<S: Simd>(simd: S, f: Triple<F32s<S>>) -> Triple<F32s<S>> {
    let most = F32s::splat(simd, STRETCHED);
    f * (most / f.norm().max(most))
}

#[inline(always)]
fn add_stretch<S: Simd>(
    simd: S,
    (batch, viscous, lane_group): (&MembraneBatch, [f32; 4], usize),
    starts: &[Point],
    velocities: &[Point],
    sums: &mut [Point],
) {
    let [a1, a2] = lane_group_of(simd, &batch.warp, lane_group);
    let [b1, b2] = lane_group_of(simd, &batch.weft, lane_group);
    let [d1, d2] = sides(simd, &batch.corners, starts, lane_group);
    let fu = bounded(simd, (d1 * a1).add_scaled(d2, a2));
    let fv = bounded(simd, (d1 * b1).add_scaled(d2, b2));
    let [e1, e2] = sides(simd, &batch.corners, velocities, lane_group);
    let gu = (e1 * a1).add_scaled(e2, a2);
    let gv = (e1 * b1).add_scaled(e2, b2);
    let area = batch.rest_area(simd, lane_group);
    let rates = [
        area * fu.dot(gu),
        area * fv.dot(gv),
        area * (fu.dot(gv) + fv.dot(gu)),
    ];
    let [uu, vv, uv, gg] = [
        F32s::splat(simd, viscous[0]),
        F32s::splat(simd, viscous[1]),
        F32s::splat(simd, viscous[2]),
        F32s::splat(simd, viscous[3]),
    ];
    let stress_u = uu.mul_add(rates[0], uv * rates[1]);
    let stress_v = vv.mul_add(rates[1], uv * rates[0]);
    let stress_g = gg * rates[2];
    let by_a = (fu * stress_u).add_scaled(fv, stress_g);
    let by_b = (fv * stress_v).add_scaled(fu, stress_g);
    let zero = F32s::splat(simd, 0.0);
    let corners = [(zero - a1 - a2, zero - b1 - b2), (a1, b1), (a2, b2)];
    for k in 0..3 {
        let (a, b) = corners[k];
        let (sum, w) = gather(simd, sums, &batch.corners[k], lane_group);
        let sum = sum.add_scaled(by_a, a).add_scaled(by_b, b);
        scatter(sums, &batch.corners[k], lane_group, (sum, w));
    }
}

/// Least length of twice the area's normal by which it is divided (m2): that of edges of 30 nm.
const MIN_SIZE: f32 = 1e-15;

#[inline(always)]
fn add_bending<S: Simd>(
    simd: S,
    (batch, lane_group): (&ViscousBatch, usize),
    starts: &[Point],
    velocities: &[Point],
    sums: &mut [Point],
) {
    let Some(first) = batch.corners.first() else {
        return;
    };
    let [d1, d2] = sides(simd, &batch.triangles, starts, lane_group);
    let normal = d1.cross(d2);
    let share = 1.0 / normal.norm().max(F32s::splat(simd, MIN_SIZE));
    let zero = F32s::splat(simd, 0.0);
    let normal = Triple::repeat(zero).add_scaled(normal, share);
    let (origin, _) = gather(simd, velocities, first, lane_group);
    let mut moments = [zero; 3];
    for (corner, weights) in batch.corners.iter().zip(&batch.weights).skip(1) {
        let (velocity, _) = gather(simd, velocities, corner, lane_group);
        let speed = normal.dot(velocity - origin);
        for k in 0..3 {
            let weight = weights[k].lane_group(simd, lane_group);
            moments[k] = weight.mul_add(speed, moments[k]);
        }
    }
    for k in 0..3 {
        moments[k] = moments[k] * batch.viscous[k].lane_group(simd, lane_group);
    }
    for (corner, weights) in batch.corners.iter().zip(&batch.weights) {
        let mut force = zero;
        for k in 0..3 {
            let weight = weights[k].lane_group(simd, lane_group);
            force = weight.mul_add(moments[k], force);
        }
        let (sum, w) = gather(simd, sums, corner, lane_group);
        scatter(sums, corner, lane_group, (sum.add_scaled(normal, force), w));
    }
}
