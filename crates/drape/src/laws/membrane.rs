//! The orthotropic Saint Venant-Kirchhoff membrane on a linear triangle.
//!
//! With warp and weft tangents f_u = sum a_i x_i and f_v = sum b_i x_i, Green strain
//! E_uu = (f_u.f_u - 1) / 2, E_vv = (f_v.f_v - 1) / 2, gamma = f_u.f_v, the energy per area is
//! W = 1/2 (C11 E_uu^2 + C22 E_vv^2 + 2 C12 E_uu E_vv + G gamma^2), or that of another law in
//! [`crate::laws::stretch`] (Volino, Magnenat-Thalmann and Faure 2009, section 3).
//!
//! # Decided with
//! - [`crate::laws::stretch::MembraneLaw`]: stress and energy by strain;
//! - [`crate::materials::Materials::law`]: the law of a triangle, made from the figures of its material;
//! - [`crate::incremental_potential::IncrementalPotential::law`]: the law of a triangle with viscosity and
//!   kept strain;
//! - [`crate::newton`]: energy, force and Hessian summed over triangles;
//! - [`crate::xpbd`] (`membrane.rs`), crate `reference` (`patches/`: `tensions.rs`): stretch in XPBD, in patches;
//! - [`crate::measure::stretch_per_triangle`]: stretch of a picture: the larger of warp and weft.

use crate::laws::stretch::StrainLaw;
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};
use toile_geometry::{Vec2, Vec3};

/// A triangle at rest: the weights of its corners in the tangents, and its area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MembraneElement {
    /// Weights a_i of the corners in f_u (1/m).
    pub warp: [f64; 3],
    /// Weights b_i of the corners in f_v (1/m).
    pub weft: [f64; 3],
    /// Area at rest (m2).
    pub area: f64,
}

/// Share of the negative curvature of compression in a Hessian, 0..=1. With 1 the Hessian is exact, and indefinite
/// where cloth is about to buckle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curvature(pub f64);

impl Curvature {
    /// The exact Hessian.
    pub const EXACT: Self = Self(1.0);
    /// No negative curvature: a positive semidefinite Hessian.
    pub const CONVEX: Self = Self(0.0);

    /// Twice the omitted share, at least [`Self::FINEST`]: the next try after a Hessian that is not positive definite.
    pub fn less(self) -> Self {
        let left_out = (2.0 * (1.0 - self.0)).max(Self::FINEST);
        Self((1.0 - left_out).max(0.0))
    }

    /// The omitted share times 0.7, or zero where that is less than [`Self::FINEST`]: the next try after a full step.
    pub fn more(self) -> Self {
        let left_out = 0.7 * (1.0 - self.0);
        if left_out < Self::FINEST {
            Self::EXACT
        } else {
            Self(1.0 - left_out)
        }
    }

    /// Least omitted share other than zero.
    pub const FINEST: f64 = 0.02;
}

impl Default for Curvature {
    /// No negative curvature, the choice that is always positive semidefinite.
    fn default() -> Self {
        Self::CONVEX
    }
}

/// Strain of a triangle along its directions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Strain {
    /// Relative change of length along the warp: |f_u| - 1.
    pub warp: f64,
    /// Relative change of length along the weft: |f_v| - 1.
    pub weft: f64,
    /// Shear angle (rad).
    pub shear: f64,
}

impl MembraneElement {
    /// The element with these corners in the material plane, warp along the first axis (m); none for a triangle without
    /// area.
    pub fn new(rest: [Vec2; 3]) -> Option<Self> {
        let (d1, d2) = (rest[1] - rest[0], rest[2] - rest[0]);
        let twice = d1.perp(&d2);
        let longest = d1.norm_squared().max(d2.norm_squared());
        if !twice.is_finite() || twice.abs() <= 1e-12 * longest {
            return None;
        }
        // Gradients of the barycentric weights.
        let g1 = Vec2::new(d2.y, -d2.x) / twice;
        let g2 = Vec2::new(-d1.y, d1.x) / twice;
        Some(Self {
            warp: [-g1.x - g2.x, g1.x, g2.x],
            weft: [-g1.y - g2.y, g1.y, g2.y],
            area: 0.5 * twice.abs(),
        })
    }

    /// Corners in the material plane, the first at the origin (m): those of [`Self::new`] up to translation.
    pub fn rest(&self) -> [Vec2; 3] {
        // The gradients of the weights of corners 1 and 2 are dual to the edges from corner 0.
        let determinant = self.warp[1] * self.weft[2] - self.warp[2] * self.weft[1];
        let first = Vec2::new(self.weft[2], -self.warp[2]) / determinant;
        let second = Vec2::new(-self.weft[1], self.warp[1]) / determinant;
        [Vec2::zeros(), first, second]
    }

    /// The tangents f_u and f_v.
    #[inline]
    pub fn tangents(&self, x: [Vec3; 3]) -> [Vec3; 2] {
        let [a, b] = [self.warp, self.weft];
        [
            x[0] * a[0] + x[1] * a[1] + x[2] * a[2],
            x[0] * b[0] + x[1] * b[1] + x[2] * b[2],
        ]
    }

    /// Energy (J).
    pub fn energy(&self, law: &impl StrainLaw, x: [Vec3; 3]) -> f64 {
        self.area * law.stress(green_strain(self.tangents(x))).1
    }

    /// Energy (J) and its gradient with respect to the corners (N).
    pub fn gradient(&self, law: &impl StrainLaw, x: [Vec3; 3]) -> (f64, [Vec3; 3]) {
        let [fu, fv] = self.tangents(x);
        let ([s_uu, s_vv, s_uv], density) = law.stress(green_strain([fu, fv]));
        let by_u = (fu * s_uu + fv * s_uv) * self.area;
        let by_v = (fv * s_vv + fu * s_uv) * self.area;
        let gradient = [0, 1, 2].map(|i| by_u * self.warp[i] + by_v * self.weft[i]);
        (self.area * density, gradient)
    }

    /// Gradient with respect to one corner (N) and the positive semidefinite diagonal block of the Hessian (N/m): one
    /// corner of [`Self::gradient`] and [`Self::hessian`].
    pub fn corner(&self, law: &impl StrainLaw, x: [Vec3; 3], i: usize) -> (Vec3, Matrix3<f64>) {
        let [fu, fv] = self.tangents(x);
        let strain = green_strain([fu, fv]);
        let (s, _) = law.stress(strain);
        let [c11, c22, c12, g, c13, c23] = law.slope(strain);
        let (a, b) = (self.warp[i], self.weft[i]);
        let by_u = fu * s[0] + fv * s[2];
        let by_v = fv * s[1] + fu * s[2];
        let [s_uu, s_vv, s_uv] = tension_part(s);
        // Derivatives of E_uu, E_vv and gamma with respect to the corner.
        let (e_uu, e_vv, e_uv) = (fu * a, fv * b, fv * a + fu * b);
        let geometric = s_uu * a * a + s_vv * b * b + 2.0 * s_uv * a * b;
        let hessian = Matrix3::identity() * geometric
            + e_uu * (e_uu * c11 + e_vv * c12 + e_uv * c13).transpose()
            + e_vv * (e_uu * c12 + e_vv * c22 + e_uv * c23).transpose()
            + e_uv * (e_uu * c13 + e_vv * c23 + e_uv * g).transpose();
        ((by_u * a + by_v * b) * self.area, hessian * self.area)
    }

    /// The Hessian: blocks of the corner pairs 00, 01, 02, 11, 12, 22 (N/m).
    ///
    /// The material part is positive semidefinite. The geometric part is the 2x2 stress times the identity; its
    /// negative (compressive) principal stresses are multiplied by `curvature`: with 0 the matrix is exact in tension
    /// and positive semidefinite where the cloth buckles.
    pub fn hessian(
        &self,
        law: &impl StrainLaw,
        x: [Vec3; 3],
        curvature: Curvature,
    ) -> [Matrix3<f64>; 6] {
        let [fu, fv] = self.tangents(x);
        let strain = green_strain([fu, fv]);
        let (s, _) = law.stress(strain);
        let [c11, c22, c12, g, c13, c23] = law.slope(strain);
        let tension = tension_part(s);
        let [s_uu, s_vv, s_uv] = [0, 1, 2].map(|k| tension[k] + curvature.0 * (s[k] - tension[k]));
        let (uu, vv, uv) = (
            fu * fu.transpose(),
            fv * fv.transpose(),
            fu * fv.transpose(),
        );
        let identity = Matrix3::identity();
        let vu = uv.transpose();
        let cross = uv + vu;
        let h_uu = (identity * s_uu + uu * c11 + vv * g + cross * c13) * self.area;
        let h_vv = (identity * s_vv + vv * c22 + uu * g + cross * c23) * self.area;
        let h_uv = (identity * s_uv + uv * c12 + vu * g + uu * c13 + vv * c23) * self.area;
        let h_vu = h_uv.transpose();
        let (a, b) = (self.warp, self.weft);
        [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)].map(|(i, j)| {
            h_uu * (a[i] * a[j])
                + h_uv * (a[i] * b[j])
                + h_vu * (b[i] * a[j])
                + h_vv * (b[i] * b[j])
        })
    }

    /// Strain along warp and weft, and the shear angle.
    pub fn strain(&self, x: [Vec3; 3]) -> Strain {
        let [fu, fv] = self.tangents(x);
        let (u, v) = (fu.norm(), fv.norm());
        let sine = if u > 0.0 && v > 0.0 {
            fu.dot(&fv) / (u * v)
        } else {
            0.0
        };
        Strain {
            warp: u - 1.0,
            weft: v - 1.0,
            shear: sine.clamp(-1.0, 1.0).asin(),
        }
    }
}

/// Green strain E_uu, E_vv, gamma of two tangents.
#[inline]
pub fn green_strain([fu, fv]: [Vec3; 2]) -> [f64; 3] {
    [
        0.5 * (fu.norm_squared() - 1.0),
        0.5 * (fv.norm_squared() - 1.0),
        fu.dot(&fv),
    ]
}

/// The positive semidefinite part of a symmetric 2x2 stress given as uu, vv, uv.
#[inline]
fn tension_part([uu, vv, uv]: [f64; 3]) -> [f64; 3] {
    let mean = 0.5 * (uu + vv);
    let half = 0.5 * (uu - vv);
    let radius = half.hypot(uv);
    let (high, low) = (mean + radius, mean - radius);
    if low >= 0.0 {
        return [uu, vv, uv];
    }
    if high <= 0.0 {
        return [0.0; 3];
    }
    // high * (projector on its direction); radius > 0 here.
    let (c, s) = (half / radius, uv / radius);
    [
        0.5 * high * (1.0 + c),
        0.5 * high * (1.0 - c),
        0.5 * high * s,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::stretch::MembraneLaw;
    use nalgebra::SMatrix;

    const STIFFNESS: [f64; 4] = [700.0, 450.0, 120.0, 60.0];

    fn law() -> MembraneLaw {
        MembraneLaw::linear(STIFFNESS)
    }

    fn element() -> MembraneElement {
        MembraneElement::new([
            Vec2::new(0.0, 0.0),
            Vec2::new(0.02, 0.003),
            Vec2::new(0.004, 0.017),
        ])
        .expect("has area")
    }

    fn deformed(scale: f64) -> [Vec3; 3] {
        [
            Vec3::new(0.001, 0.0, 0.002) * scale,
            Vec3::new(0.019, 0.004, -0.003) * scale,
            Vec3::new(0.005, 0.016, 0.006) * scale,
        ]
    }

    #[test]
    fn gradient_is_the_slope_of_the_energy() {
        let (element, x) = (element(), deformed(1.1));
        let (_, gradient) = element.gradient(&law(), x);
        for corner in 0..3 {
            for axis in 0..3 {
                let step = 1e-7;
                let (mut up, mut down) = (x, x);
                up[corner][axis] += step;
                down[corner][axis] -= step;
                let slope =
                    (element.energy(&law(), up) - element.energy(&law(), down)) / (2.0 * step);
                let got = gradient[corner][axis];
                assert!(
                    (slope - got).abs() < 1e-6 * gradient[corner].norm().max(1e-3),
                    "{slope} {got}"
                );
            }
        }
    }

    fn full(blocks: [Matrix3<f64>; 6]) -> SMatrix<f64, 9, 9> {
        let mut full = SMatrix::<f64, 9, 9>::zeros();
        for (block, (i, j)) in blocks
            .iter()
            .zip([(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)])
        {
            full.fixed_view_mut::<3, 3>(3 * i, 3 * j).copy_from(block);
            full.fixed_view_mut::<3, 3>(3 * j, 3 * i)
                .copy_from(&block.transpose());
        }
        full
    }

    #[test]
    fn one_corner_is_a_corner_of_all() {
        let (element, law) = (element(), MembraneLaw::linear(STIFFNESS));
        for scale in [0.6, 1.0, 1.3] {
            let x = deformed(scale);
            let gradient = element.gradient(&law, x).1;
            let hessian = element.hessian(&law, x, Curvature::CONVEX);
            for (i, block) in [(0, 0), (1, 3), (2, 5)] {
                let (g, h) = element.corner(&law, x, i);
                assert!((g - gradient[i]).norm() < 1e-12 * (1.0 + g.norm()));
                assert!((h - hessian[block]).norm() < 1e-9 * h.norm(), "{scale} {i}");
            }
        }
    }

    #[test]
    fn hessian_is_exact_in_tension() {
        let (element, x) = (element(), deformed(1.3));
        let hessian = full(element.hessian(&law(), x, Curvature::CONVEX));
        for corner in 0..3 {
            for axis in 0..3 {
                let step = 1e-7;
                let (mut up, mut down) = (x, x);
                up[corner][axis] += step;
                down[corner][axis] -= step;
                let (_, high) = element.gradient(&law(), up);
                let (_, low) = element.gradient(&law(), down);
                for other in 0..3 {
                    let slope = (high[other] - low[other]) / (2.0 * step);
                    for k in 0..3 {
                        let got = hessian[(3 * other + k, 3 * corner + axis)];
                        assert!(
                            (slope[k] - got).abs() < 1e-5 * hessian.norm(),
                            "{} {got}",
                            slope[k]
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn hessian_stays_positive_in_compression_and_collapse() {
        let stiff = MembraneLaw::linear([1e8, 1e8, 2e7, 1e6]);
        for scale in [1.0, 0.9, 0.5, 0.1, 0.0] {
            let hessian = full(element().hessian(&stiff, deformed(scale), Curvature::CONVEX));
            let smallest = hessian.symmetric_eigenvalues().min();
            assert!(
                smallest > -1e-9 * hessian.norm().max(1.0),
                "{scale}: {smallest}"
            );
        }
    }

    #[test]
    fn rigid_motion_costs_nothing_and_a_patch_has_its_stress() {
        let rest = [
            Vec2::new(0.1, 0.2),
            Vec2::new(0.13, 0.21),
            Vec2::new(0.11, 0.24),
        ];
        let element = MembraneElement::new(rest).expect("has area");
        for (got, corner) in element.rest().iter().zip(rest) {
            assert!((got - (corner - rest[0])).norm() < 1e-15);
        }
        let turn = nalgebra::Rotation3::from_euler_angles(0.3, -1.1, 2.0);
        let rigid = rest.map(|p| turn * Vec3::new(p.x, p.y, 0.0) + Vec3::new(1.0, 2.0, 3.0));
        assert!(element.energy(&law(), rigid) < 1e-20);
        let stretched = rest.map(|p| Vec3::new(p.x * 1.05, p.y, 0.0));
        let e_uu = 0.5 * (1.05f64 * 1.05 - 1.0);
        let expected = element.area * 0.5 * STIFFNESS[0] * e_uu * e_uu;
        assert!((element.energy(&law(), stretched) - expected).abs() < 1e-12 * expected);
        assert!((element.strain(stretched).warp - 0.05).abs() < 1e-12);
        assert!(MembraneElement::new([rest[0], rest[1], rest[0]]).is_none());
    }
}
