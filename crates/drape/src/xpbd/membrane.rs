//! The membrane as constraints: the three strains of a triangle solved together.
//!
//! C = (E_uu, E_vv, gamma), energy A/2 C . S C with the law's stiffness S, compliance
//! alpha = (A S)^-1. XPBD (Macklin, Müller and Chentanez 2016, equation 18) for the block:
//! (J W J^T + alpha / h^2) dlambda = -(C + alpha / h^2 lambda), dx = W J^T dlambda.
//!
//! The gradients are a_i f_u, b_i f_v and a_i f_v + b_i f_u, so J W J^T needs only
//! P = sum w a^2, Q = sum w b^2, R = sum w a b and the products of f_u and f_v:
//! ```text
//! P uu        R uv        P uv + R uu
//!             Q vv        R vv + Q uv
//!                         P vv + 2 R uv + Q uu
//! ```
//! Everything is scaled by sigma = 1 / (P + Q), so that it stays near one in single precision.
//! A nonlinear law is linearised at the present strain: with stress s and tangent stiffness D, C becomes D^-1 s and
//! S becomes D.

use crate::System;
use crate::lane_arithmetic::{F32s, Number};
use crate::lanes::{Corner, LANES, Point, Row, gather, lane_group_of, lane_groups, scatter};
use crate::laws::stretch::{MembraneLaw, StrainLaw};
use pulp::Simd;

/// Up to sixteen triangles of one law without a shared vertex.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct MembraneBatch {
    /// Corners, as indices into the points of the region.
    pub corners: [Corner; 3],
    /// a_1 and a_2 (1/m); a_0 is minus their sum.
    pub warp: [Row; 2],
    /// b_1 and b_2 (1/m).
    pub weft: [Row; 2],
    /// P, Q and R times sigma.
    products: [Row; 3],
    /// sigma / A (kg): times the compliance of the law and kappa it is alpha / h^2, scaled.
    compliance_scale: Row,
    /// sigma.
    scale: Row,
    /// Index of the law and of the material.
    pub law: u32,
    /// Number of triangles.
    count: u32,
}

/// XPBD multipliers of a batch over the substep, scaled by sigma and, with drag, by 1 / (1 + drag h).
pub type Multipliers = [Row; 3];

/// A membrane law in single precision.
#[derive(Clone, Copy, Debug)]
pub struct LawRow {
    /// C11, C22, C12, G (N/m).
    stiffness: [f32; 4],
    /// Inverse of the 2x2 block of warp and weft: 11, 22, 12, and 1 / G (m/N).
    compliance: [f32; 4],
    /// The law itself where it is nonlinear.
    curve: Option<MembraneLaw>,
}

impl LawRow {
    /// The single-precision form of a law.
    pub fn new(law: &MembraneLaw) -> Self {
        let [c11, c22, c12, g] = law.stiffness;
        let determinant = c11 * c22 - c12 * c12;
        let compliance = [
            c22 / determinant,
            c11 / determinant,
            -c12 / determinant,
            1.0 / g,
        ];
        Self {
            stiffness: law.stiffness.map(|x| x as f32),
            compliance: compliance.map(|x| x as f32),
            curve: (!law.is_linear()).then_some(*law),
        }
    }
}

impl MembraneBatch {
    /// A batch of up to sixteen triangles; `local` is the index of a vertex in the region, where index 0 is a fixed
    /// point for unused lanes.
    pub fn new(system: &System, triangles: &[u32], local: impl Fn(u32) -> u32) -> Self {
        let mut batch = Self {
            corners: [Corner([0; LANES]); 3],
            warp: [Row::splat(0.0); 2],
            weft: [Row::splat(0.0); 2],
            products: [Row::splat(0.0); 3],
            compliance_scale: Row::splat(1.0),
            scale: Row::splat(0.0),
            law: triangles
                .first()
                .map_or(0, |&t| u32::from(system.materials.of_triangle[t as usize])),
            count: triangles.len() as u32,
        };
        for (lane, &t) in triangles.iter().enumerate() {
            let element = &system.rest.elements[t as usize];
            let vertices = system.topology.triangles[t as usize];
            let weight = vertices.map(|v| inverse_mass(system, v));
            let (a, b) = (element.warp, element.weft);
            let sum = |f: &dyn Fn(usize) -> f64| (0..3).map(|i| weight[i] * f(i)).sum::<f64>();
            let products = [
                sum(&|i| a[i] * a[i]),
                sum(&|i| b[i] * b[i]),
                sum(&|i| a[i] * b[i]),
            ];
            let sigma = 1.0 / (products[0] + products[1]);
            for k in 0..3 {
                batch.corners[k].0[lane] = local(vertices[k]);
                batch.products[k].0[lane] = (products[k] * sigma) as f32;
            }
            for k in 0..2 {
                batch.warp[k].0[lane] = a[k + 1] as f32;
                batch.weft[k].0[lane] = b[k + 1] as f32;
            }
            batch.compliance_scale.0[lane] = (sigma / element.area) as f32;
            batch.scale.0[lane] = sigma as f32;
        }
        batch
    }

    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.count as usize
    }

    /// Areas of the rest shapes of one lane group; zero in unused lanes (m2).
    #[inline(always)]
    pub fn rest_area<S: Simd>(&self, simd: S, lane_group: usize) -> F32s<S> {
        let compliance_scale = self.compliance_scale.lane_group(simd, lane_group);
        self.scale.lane_group(simd, lane_group) / compliance_scale
    }
}

/// Inverse mass of a vertex (1/kg); zero at pins.
pub fn inverse_mass(system: &System, vertex: u32) -> f64 {
    if system.prescribed.pinned[vertex as usize] {
        0.0
    } else {
        1.0 / system.rest.mass[vertex as usize]
    }
}

/// Least pivot of the 3x3 system over its diagonal entry: thirty times the rounding error.
const MIN_PIVOT_RATIO: f32 = 4e-6;

/// Solves every batch once, in order. `kappa` is (1 + drag h) / h^2 (1/s2). With `multipliers` the multipliers of
/// earlier iterations enter and are updated; without, they are zero.
#[inline(always)]
pub fn solve<S: Simd>(
    simd: S,
    batches: &[MembraneBatch],
    mut multipliers: Option<&mut [Multipliers]>,
    laws: &[LawRow],
    kappa: f32,
    points: &mut [Point],
) {
    for (at, batch) in batches.iter().enumerate() {
        let law = &laws[batch.law as usize];
        for lane_group in 0..lane_groups::<S>() {
            let multipliers = multipliers.as_mut().map(|multipliers| &mut multipliers[at]);
            solve_lane_group(simd, batch, lane_group, multipliers, law, kappa, points);
        }
    }
}

#[inline(always)]
#[allow(clippy::too_many_arguments)]
fn solve_lane_group<S: Simd>(
    simd: S,
    batch: &MembraneBatch,
    lane_group: usize,
    multipliers: Option<&mut Multipliers>,
    law: &LawRow,
    kappa: f32,
    points: &mut [Point],
) {
    let (p0, w0) = gather(simd, points, &batch.corners[0], lane_group);
    let (p1, w1) = gather(simd, points, &batch.corners[1], lane_group);
    let (p2, w2) = gather(simd, points, &batch.corners[2], lane_group);
    let (d1, d2) = (p1 - p0, p2 - p0);
    let [a1, a2] = lane_group_of(simd, &batch.warp, lane_group);
    let [b1, b2] = lane_group_of(simd, &batch.weft, lane_group);
    let fu = (d1 * a1).add_scaled(d2, a2);
    let fv = (d1 * b1).add_scaled(d2, b2);
    let (uu, vv, uv) = (fu.dot(fu), fv.dot(fv), fu.dot(fv));
    let (half, minus_half) = (F32s::splat(simd, 0.5), F32s::splat(simd, -0.5));
    let strain = [
        uu.mul_add(half, minus_half),
        vv.mul_add(half, minus_half),
        uv,
    ];
    let (target, compliance) = linearise(simd, law, strain);
    let compliance_scale = batch.compliance_scale.lane_group(simd, lane_group) * kappa;
    let soft = [
        compliance_scale * compliance[0],
        compliance_scale * compliance[1],
        compliance_scale * compliance[2],
        compliance_scale * compliance[3],
    ];
    let products = lane_group_of(simd, &batch.products, lane_group);
    let matrix = system(products, [uu, vv, uv], soft);
    let mut residual = target;
    if let Some(multipliers) = &multipliers {
        let [l0, l1, l2] = lane_group_of(simd, multipliers, lane_group);
        residual[0] = soft[0].mul_add(l0, residual[0]);
        residual[0] = soft[2].mul_add(l1, residual[0]);
        residual[1] = soft[1].mul_add(l1, residual[1]);
        residual[1] = soft[2].mul_add(l0, residual[1]);
        residual[2] = soft[3].mul_add(l2, residual[2]);
    }
    let z = solve_system(matrix, residual);
    if let Some(multipliers) = multipliers {
        for k in 0..3 {
            let sum = multipliers[k].lane_group(simd, lane_group) - z[k];
            multipliers[k].set_lane_group(lane_group, sum);
        }
    }
    // dx_i = -w_i sigma (a_i (f_u z_0 + f_v z_2) + b_i (f_v z_1 + f_u z_2)).
    let by_u = (fu * z[0]).add_scaled(fv, z[2]);
    let by_v = (fv * z[1]).add_scaled(fu, z[2]);
    let scale = batch.scale.lane_group(simd, lane_group);
    let zero = F32s::splat(simd, 0.0);
    let (a0, b0) = (zero - a1 - a2, zero - b1 - b2);
    let corners = [(p0, w0, a0, b0), (p1, w1, a1, b1), (p2, w2, a2, b2)];
    for k in 0..3 {
        let (p, w, a, b) = corners[k];
        let share = zero - w * scale;
        let p = p.add_scaled(by_u, share * a).add_scaled(by_v, share * b);
        scatter(points, &batch.corners[k], lane_group, (p, w));
    }
}

/// The strain at which a linear law of the tangent stiffness has the stress of the law, and the compliance 11, 22,
/// 12, 33.
#[inline(always)]
fn linearise<S: Simd>(simd: S, law: &LawRow, strain: [F32s<S>; 3]) -> ([F32s<S>; 3], [F32s<S>; 4]) {
    let Some(curve) = &law.curve else {
        let [c11, c22, c12, c33] = law.compliance;
        let compliance = [
            F32s::splat(simd, c11),
            F32s::splat(simd, c22),
            F32s::splat(simd, c12),
            F32s::splat(simd, c33),
        ];
        return (strain, compliance);
    };
    curve_of(simd, law, curve, strain)
}

/// [`linearise`] for a nonlinear law: lane by lane in double precision.
#[inline(never)]
fn curve_of<S: Simd>(
    simd: S,
    law: &LawRow,
    curve: &MembraneLaw,
    strain: [F32s<S>; 3],
) -> ([F32s<S>; 3], [F32s<S>; 4]) {
    let mut rows = [Row::splat(0.0); 3];
    for (row, strain) in rows.iter_mut().zip(strain) {
        row.set_lane_group(0, strain);
    }
    let mut target = [Row::splat(0.0); 3];
    let mut compliance = [Row::splat(0.0); 4];
    let min_stiffness =
        1e-3 * f64::from(law.stiffness[0].min(law.stiffness[1]).min(law.stiffness[3]));
    for lane in 0..S::F32_LANES {
        let strain = [0, 1, 2].map(|k| f64::from(rows[k].0[lane]));
        let (stress, _) = curve.stress(strain);
        let [d11, d22, d12, d33, ..] = curve.slope(strain);
        let (d11, d22, d33) = (
            d11 + min_stiffness,
            d22 + min_stiffness,
            d33 + min_stiffness,
        );
        let determinant = d11 * d22 - d12 * d12;
        let inverse = [
            d22 / determinant,
            d11 / determinant,
            -d12 / determinant,
            1.0 / d33,
        ];
        let linear_strain = [
            inverse[0] * stress[0] + inverse[2] * stress[1],
            inverse[1] * stress[1] + inverse[2] * stress[0],
            inverse[3] * stress[2],
        ];
        for k in 0..3 {
            target[k].0[lane] = linear_strain[k] as f32;
        }
        for k in 0..4 {
            compliance[k].0[lane] = inverse[k] as f32;
        }
    }
    (
        lane_group_of(simd, &target, 0),
        lane_group_of(simd, &compliance, 0),
    )
}

/// The matrix J W J^T + alpha / h^2, scaled by sigma: 11, 22, 33, 12, 13, 23.
#[inline(always)]
fn system<S: Simd>(
    [p, q, r]: [F32s<S>; 3],
    [uu, vv, uv]: [F32s<S>; 3],
    soft: [F32s<S>; 4],
) -> [F32s<S>; 6] {
    let r_uv = r * uv;
    let m33 = q.mul_add(uu, p.mul_add(vv, soft[3]));
    [
        p.mul_add(uu, soft[0]),
        q.mul_add(vv, soft[1]),
        m33 + (r_uv + r_uv),
        r_uv + soft[2],
        r.mul_add(uu, p * uv),
        r.mul_add(vv, q * uv),
    ]
}

/// Solves the symmetric positive definite system by L D L^T.
#[inline(always)]
fn solve_system<S: Simd>(
    [m11, m22, m33, m12, m13, m23]: [F32s<S>; 6],
    [c1, c2, c3]: [F32s<S>; 3],
) -> [F32s<S>; 3] {
    let i1 = 1.0 / m11;
    let (l21, l31) = (m12 * i1, m13 * i1);
    let d2 = (m22.subtract_product(l21, m12)).max(MIN_PIVOT_RATIO * m22);
    let t = m23.subtract_product(l31, m12);
    let i2 = 1.0 / d2;
    let l32 = t * i2;
    let d3 = m33.subtract_product(l31, m13).subtract_product(l32, t);
    let d3 = d3.max(MIN_PIVOT_RATIO * m33);
    let y2 = c2.subtract_product(l21, c1);
    let y3 = c3.subtract_product(l31, c1).subtract_product(l32, y2);
    let z3 = y3 / d3;
    let z2 = (y2 * i2).subtract_product(l32, z3);
    let z1 = (c1 * i1)
        .subtract_product(l21, z2)
        .subtract_product(l31, z3);
    [z1, z2, z3]
}
