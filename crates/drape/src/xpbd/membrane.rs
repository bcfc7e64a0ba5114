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
use crate::lanes::{
    Corner, LANES, Point, Row, add_scaled, blend, dot, gather, lane_groups, scatter, sub,
};
use crate::laws::stretch::{MembraneLaw, StrainLaw};
use pulp::Simd;

/// Up to sixteen triangles of one law without a shared vertex.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct MembraneBatch {
    /// Corners, as indices into the points of the region.
    pub corners: [Corner; 3],
    /// a_1 and a_2 [1/m]; a_0 is minus their sum.
    pub warp: [Row; 2],
    /// b_1 and b_2 [1/m].
    pub weft: [Row; 2],
    /// P, Q and R times sigma.
    products: [Row; 3],
    /// sigma / A [kg]: times the compliance of the law and kappa it is alpha / h^2, scaled.
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
    /// C11, C22, C12, G [N/m].
    stiffness: [f32; 4],
    /// Inverse of the 2x2 block of warp and weft: 11, 22, 12, and 1 / G [m/N].
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

    /// Areas of the rest shapes of one lane group; zero in unused lanes [m2].
    #[inline(always)]
    pub fn rest_area<S: Simd>(&self, simd: S, lane_group: usize) -> S::f32s {
        simd.div_f32s(
            self.scale.lane_group::<S>(lane_group),
            self.compliance_scale.lane_group::<S>(lane_group),
        )
    }
}

/// Inverse mass of a vertex [1/kg]; zero at pins.
pub fn inverse_mass(system: &System, vertex: u32) -> f64 {
    if system.prescribed.pinned[vertex as usize] {
        0.0
    } else {
        1.0 / system.rest.mass[vertex as usize]
    }
}

/// Least pivot of the 3x3 system over its diagonal entry: thirty times the rounding error.
const MIN_PIVOT_RATIO: f32 = 4e-6;

/// Solves every batch once, in order. `kappa` is (1 + drag h) / h^2 [1/s2]. With `multipliers` the multipliers of
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
    let [x0, y0, z0, w0] = gather(simd, points, &batch.corners[0], lane_group);
    let [x1, y1, z1, w1] = gather(simd, points, &batch.corners[1], lane_group);
    let [x2, y2, z2, w2] = gather(simd, points, &batch.corners[2], lane_group);
    let (p0, p1, p2) = ([x0, y0, z0], [x1, y1, z1], [x2, y2, z2]);
    let (d1, d2) = (sub(simd, p1, p0), sub(simd, p2, p0));
    let [a1, a2] = [
        batch.warp[0].lane_group::<S>(lane_group),
        batch.warp[1].lane_group::<S>(lane_group),
    ];
    let [b1, b2] = [
        batch.weft[0].lane_group::<S>(lane_group),
        batch.weft[1].lane_group::<S>(lane_group),
    ];
    let fu = blend(simd, d1, a1, d2, a2);
    let fv = blend(simd, d1, b1, d2, b2);
    let (uu, vv, uv) = (dot(simd, fu, fu), dot(simd, fv, fv), dot(simd, fu, fv));
    let half = simd.splat_f32s(0.5);
    let strain = [
        simd.mul_add_e_f32s(uu, half, simd.splat_f32s(-0.5)),
        simd.mul_add_e_f32s(vv, half, simd.splat_f32s(-0.5)),
        uv,
    ];
    let (target, compliance) = linearise(simd, law, strain);
    let compliance_scale = simd.mul_f32s(
        batch.compliance_scale.lane_group::<S>(lane_group),
        simd.splat_f32s(kappa),
    );
    let soft = [
        simd.mul_f32s(compliance_scale, compliance[0]),
        simd.mul_f32s(compliance_scale, compliance[1]),
        simd.mul_f32s(compliance_scale, compliance[2]),
        simd.mul_f32s(compliance_scale, compliance[3]),
    ];
    let products = [
        batch.products[0].lane_group::<S>(lane_group),
        batch.products[1].lane_group::<S>(lane_group),
        batch.products[2].lane_group::<S>(lane_group),
    ];
    let matrix = system(simd, products, [uu, vv, uv], soft);
    let mut residual = target;
    if let Some(multipliers) = &multipliers {
        let [l0, l1, l2] = [
            multipliers[0].lane_group::<S>(lane_group),
            multipliers[1].lane_group::<S>(lane_group),
            multipliers[2].lane_group::<S>(lane_group),
        ];
        residual[0] = simd.mul_add_e_f32s(soft[0], l0, residual[0]);
        residual[0] = simd.mul_add_e_f32s(soft[2], l1, residual[0]);
        residual[1] = simd.mul_add_e_f32s(soft[1], l1, residual[1]);
        residual[1] = simd.mul_add_e_f32s(soft[2], l0, residual[1]);
        residual[2] = simd.mul_add_e_f32s(soft[3], l2, residual[2]);
    }
    let z = solve_system(simd, matrix, residual);
    if let Some(multipliers) = multipliers {
        for k in 0..3 {
            let sum = simd.sub_f32s(multipliers[k].lane_group::<S>(lane_group), z[k]);
            multipliers[k].set_lane_group::<S>(lane_group, sum);
        }
    }
    // dx_i = -w_i sigma (a_i (f_u z_0 + f_v z_2) + b_i (f_v z_1 + f_u z_2)).
    let by_u = blend(simd, fu, z[0], fv, z[2]);
    let by_v = blend(simd, fv, z[1], fu, z[2]);
    let scale = batch.scale.lane_group::<S>(lane_group);
    let zero = simd.splat_f32s(0.0);
    let a0 = simd.sub_f32s(simd.sub_f32s(zero, a1), a2);
    let b0 = simd.sub_f32s(simd.sub_f32s(zero, b1), b2);
    let corners = [(p0, w0, a0, b0), (p1, w1, a1, b1), (p2, w2, a2, b2)];
    for k in 0..3 {
        let (p, w, a, b) = corners[k];
        let share = simd.sub_f32s(zero, simd.mul_f32s(w, scale));
        let p = add_scaled(simd, p, by_u, simd.mul_f32s(share, a));
        let [x, y, z] = add_scaled(simd, p, by_v, simd.mul_f32s(share, b));
        scatter(simd, points, &batch.corners[k], lane_group, [x, y, z, w]);
    }
}

/// The strain at which a linear law of the tangent stiffness has the stress of the law, and the compliance 11, 22,
/// 12, 33.
#[inline(always)]
fn linearise<S: Simd>(simd: S, law: &LawRow, strain: [S::f32s; 3]) -> ([S::f32s; 3], [S::f32s; 4]) {
    let Some(curve) = &law.curve else {
        let [c11, c22, c12, c33] = law.compliance;
        let compliance = [
            simd.splat_f32s(c11),
            simd.splat_f32s(c22),
            simd.splat_f32s(c12),
            simd.splat_f32s(c33),
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
    strain: [S::f32s; 3],
) -> ([S::f32s; 3], [S::f32s; 4]) {
    let _ = simd;
    let mut rows = [Row::splat(0.0); 3];
    for (row, strain) in rows.iter_mut().zip(strain) {
        row.set_lane_group::<S>(0, strain);
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
        target.map(|row| row.lane_group::<S>(0)),
        compliance.map(|row| row.lane_group::<S>(0)),
    )
}

/// The matrix J W J^T + alpha / h^2, scaled by sigma: 11, 22, 33, 12, 13, 23.
#[inline(always)]
fn system<S: Simd>(
    simd: S,
    [p, q, r]: [S::f32s; 3],
    [uu, vv, uv]: [S::f32s; 3],
    soft: [S::f32s; 4],
) -> [S::f32s; 6] {
    let (p_uv, r_uv, q_uv) = (
        simd.mul_f32s(p, uv),
        simd.mul_f32s(r, uv),
        simd.mul_f32s(q, uv),
    );
    let m33 = simd.mul_add_e_f32s(p, vv, soft[3]);
    let m33 = simd.mul_add_e_f32s(q, uu, m33);
    [
        simd.mul_add_e_f32s(p, uu, soft[0]),
        simd.mul_add_e_f32s(q, vv, soft[1]),
        simd.add_f32s(m33, simd.add_f32s(r_uv, r_uv)),
        simd.add_f32s(r_uv, soft[2]),
        simd.mul_add_e_f32s(r, uu, p_uv),
        simd.mul_add_e_f32s(r, vv, q_uv),
    ]
}

/// Solves the symmetric positive definite system by L D L^T.
#[inline(always)]
fn solve_system<S: Simd>(
    simd: S,
    [m11, m22, m33, m12, m13, m23]: [S::f32s; 6],
    [c1, c2, c3]: [S::f32s; 3],
) -> [S::f32s; 3] {
    let one = simd.splat_f32s(1.0);
    let min_ratio = simd.splat_f32s(MIN_PIVOT_RATIO);
    let i1 = simd.div_f32s(one, m11);
    let (l21, l31) = (simd.mul_f32s(m12, i1), simd.mul_f32s(m13, i1));
    let d2 = simd.max_f32s(
        subtract_product(simd, m22, l21, m12),
        simd.mul_f32s(min_ratio, m22),
    );
    let t = subtract_product(simd, m23, l31, m12);
    let i2 = simd.div_f32s(one, d2);
    let l32 = simd.mul_f32s(t, i2);
    let d3 = subtract_product(simd, subtract_product(simd, m33, l31, m13), l32, t);
    let d3 = simd.max_f32s(d3, simd.mul_f32s(min_ratio, m33));
    let y2 = subtract_product(simd, c2, l21, c1);
    let y3 = subtract_product(simd, subtract_product(simd, c3, l31, c1), l32, y2);
    let z3 = simd.div_f32s(y3, d3);
    let z2 = subtract_product(simd, simd.mul_f32s(y2, i2), l32, z3);
    let z1 = subtract_product(
        simd,
        subtract_product(simd, simd.mul_f32s(c1, i1), l21, z2),
        l31,
        z3,
    );
    [z1, z2, z3]
}

/// a - b c.
#[inline(always)]
fn subtract_product<S: Simd>(simd: S, a: S::f32s, b: S::f32s, c: S::f32s) -> S::f32s {
    simd.negate_mul_add_e_f32s(b, c, a)
}
