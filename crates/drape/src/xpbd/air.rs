//! The drag of the air on triangles ([`crate::laws::air`]) as impulses at the start of a substep.
//!
//! With w the velocity of a triangle's middle relative to the air, w_n its component along the normal and w_t the one
//! in the plane, the impulse of a substep h is
//! ```text
//! p = -(r_n w_n + r_t w_t),   r_c = min(h rho A C_c |w_c| / 2, m / 2)
//! ```
//! m the mass of the triangle, a third of p to each corner. Taken at the velocities at the start, cloth that the wind
//! holds taut has the whole force of the wind, and the terminal velocity is exact. The minimum acts where a substep
//! would take half of w or more: then w is halved. With it |p| <= m |w| / 2, and since a vertex has a third of the mass of each
//! of its triangles, all impulses together never add kinetic energy relative to the air, at any substep, coefficient
//! and density (Cauchy and Schwarz over the triangles of a vertex).

use super::membrane::MembraneBatch;
use crate::System;
use crate::lane_arithmetic::{F32s, Number, Triple};
use crate::lanes::{Point, gather, lane_groups, scatter};
use pulp::{Simd, WithSimd};

/// Least twice the area of a triangle by which its normal is divided (m2): that of edges of 30 nm. Smaller ones have
/// next to no force, and their squares stay within single precision.
const MIN_SIZE: f32 = 1e-15;

/// The air during a substep.
#[derive(Clone, Debug)]
pub struct AirStep {
    /// Velocity of the wind (m/s).
    wind: [f32; 3],
    /// h rho C / 4 across and along the cloth (kg s/m3): times twice the area and the speed it is r.
    across: f32,
    along: f32,
    /// Mass per area of each material (kg/m2).
    densities: Vec<f32>,
}

impl AirStep {
    /// The air of a system in substeps of h (s); none where it exerts no force on triangles.
    pub fn new(system: &System, h: f64) -> Option<Self> {
        let air = system.control.air;
        let share = 0.25 * h * air.density;
        air.acts().then(|| Self {
            wind: [0, 1, 2].map(|k| air.wind[k] as f32),
            across: (share * air.normal) as f32,
            along: (share * air.tangential) as f32,
            densities: (system.materials.list.iter())
                .map(|material| material.density as f32)
                .collect(),
        })
    }
}

/// Adds the impulses of some triangles to sums at their corners (N s).
pub struct AddAirImpulses<'a> {
    /// The triangles.
    pub batches: &'a [MembraneBatch],
    /// The points of their region at the start of the substep.
    pub starts: &'a [Point],
    /// Their velocities (m/s).
    pub velocities: &'a [Point],
    /// The sums.
    pub sums: &'a mut [Point],
    /// The air.
    pub air: &'a AirStep,
}

impl WithSimd for AddAirImpulses<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for batch in self.batches {
            let density = self.air.densities[batch.law as usize];
            for lane_group in 0..lane_groups::<S>() {
                let third = impulse(
                    simd,
                    (batch, density, lane_group),
                    self.starts,
                    self.velocities,
                    self.air,
                );
                add_to_corners(simd, batch, lane_group, third, self.sums);
            }
        }
    }
}

/// A third of the impulse on the triangles of one lane group.
#[inline(always)]
fn impulse<S: Simd>(
    simd: S,
    (batch, density, lane_group): (&MembraneBatch, f32, usize),
    starts: &[Point],
    velocities: &[Point],
    air: &AirStep,
) -> Triple<F32s<S>> {
    let [a, b, c] = &batch.corners;
    let (x0, _) = gather(simd, starts, a, lane_group);
    let (x1, _) = gather(simd, starts, b, lane_group);
    let (x2, _) = gather(simd, starts, c, lane_group);
    let normal = (x1 - x0).cross(x2 - x0);
    // Twice the area; a triangle without area has no normal and no force.
    let size = normal.norm().max(F32s::splat(simd, MIN_SIZE));
    let (v0, _) = gather(simd, velocities, a, lane_group);
    let (v1, _) = gather(simd, velocities, b, lane_group);
    let (v2, _) = gather(simd, velocities, c, lane_group);
    let third = F32s::splat(simd, 1.0 / 3.0);
    let mut w = v0 + v1 + v2;
    for k in 0..3 {
        w.0[k] = w.0[k].mul_add(third, F32s::splat(simd, -air.wind[k]));
    }
    let across = w.dot(normal) / size;
    let zero = F32s::splat(simd, 0.0);
    let part = across / size;
    let along = w.add_scaled(normal, zero - part);
    let most = batch.rest_area(simd, lane_group) * density * 0.5;
    let of_normal = (size * (air.across * across.abs())).min(most) * part;
    let of_plane = (size * (air.along * along.norm())).min(most);
    let minus_third = F32s::splat(simd, -1.0 / 3.0);
    Triple::repeat(zero)
        .add_scaled(normal, of_normal * minus_third)
        .add_scaled(along, of_plane * minus_third)
}

/// Adds the same vector to the sums of the three corners.
#[inline(always)]
fn add_to_corners<S: Simd>(
    simd: S,
    batch: &MembraneBatch,
    lane_group: usize,
    add: Triple<F32s<S>>,
    sums: &mut [Point],
) {
    for k in 0..3 {
        let corner = &batch.corners[k];
        let (sum, w) = gather(simd, sums, corner, lane_group);
        scatter(sums, corner, lane_group, (sum + add, w));
    }
}
