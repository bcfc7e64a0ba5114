//! Bending terms beside the quadratic energy of [`super::bending`]: internal strain (permanent folds) and viscosity.
//!
//! Both act on the curvatures measured along the triangle's normal, s_c = n . kappa_c, so that a
//! rigid rotation has no energy:
//! E = -q . s + 1/2 (s - s_0) . V (s - s_0),
//! with q = A D r the moment of the relaxed fraction of the internal curvature, r = p v (A/2 |kappa - r n|^2_D
//! less the quadratic energy and a constant), V = A N / h of the viscous matrix N over a step h, and s_0 the
//! curvature when the step began.
//!
//! # Decided with
//! - [`toile_fabric::FIGURES`] (`relaxed_fraction`, `relaxation_time`): the figures;
//! - [`crate::internal_strain::InternalStrain`], [`crate::materials::Materials::keep_strain`]: the strain remembered, and whether;
//! - [`crate::incremental_potential::relax`]: relaxation in time;
//! - [`crate::world`] (`transfer.rs`, `internal_strain`): carried over an edit or a merge;
//! - [`crate::method::MethodKind::supports`] (`features.rs`): methods without it.

use nalgebra::{Matrix3, Vector3};
use toile_geometry::Vec3;

/// The fold terms of one triangle during a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoldTerm {
    /// Moment q of the internal curvature (N m2).
    pub internal_moment: Vector3<f64>,
    /// s_0 (1/m).
    pub start: Vector3<f64>,
    /// V (N m3).
    pub viscous: Matrix3<f64>,
}

/// Twice the area times the unit normal of a triangle (m2).
pub fn area_normal(x: [Vec3; 3]) -> Vec3 {
    (x[1] - x[0]).cross(&(x[2] - x[0]))
}

/// Curvatures along the unit normal `n` (1/m); `curvature` are x_uu, x_uv, x_vv.
pub fn along_normal(n: Vec3, curvature: [Vec3; 3]) -> Vector3<f64> {
    Vector3::from(curvature.map(|k| n.dot(&k)))
}

impl FoldTerm {
    /// Energy (J) at curvatures along the normal.
    pub fn energy(&self, s: Vector3<f64>) -> f64 {
        let change = s - self.start;
        -self.internal_moment.dot(&s) + 0.5 * change.dot(&(self.viscous * change))
    }

    /// Gradient of the energy with respect to the three curvature vectors (N m2), and to the corners through the normal
    /// (N). None for a triangle without area, which has no normal.
    pub fn gradient(&self, x: [Vec3; 3], curvature: [Vec3; 3]) -> Option<([Vec3; 3], [Vec3; 3])> {
        let normal = area_normal(x);
        let size = normal.norm();
        if size <= 0.0 || !size.is_finite() {
            return None;
        }
        let n = normal / size;
        let s = along_normal(n, curvature);
        let slope = self.viscous * (s - self.start) - self.internal_moment;
        let by_curvature = [0, 1, 2].map(|c| n * slope[c]);
        // d(n.k) = dN.(k - n (n.k)) / |N|, and dN/dx_i . p = p x e_i with e_i the edge opposite.
        let k = curvature[0] * slope[0] + curvature[1] * slope[1] + curvature[2] * slope[2];
        let p = (k - n * n.dot(&k)) / size;
        let edges = [x[2] - x[1], x[0] - x[2], x[1] - x[0]];
        Some((by_curvature, edges.map(|e| p.cross(&e))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(-1.0f64..1.0).prop_map(Vec3::from)
    }

    proptest! {
        #[test]
        fn gradient_is_the_slope_of_the_energy(
            corners in prop::array::uniform3(vector()),
            weights in prop::array::uniform9(-3.0f64..3.0),
            others in prop::array::uniform3(vector()),
        ) {
            prop_assume!(area_normal(corners).norm() > 0.1);
            let term = FoldTerm {
                internal_moment: Vector3::new(0.3, -0.1, 0.7),
                start: Vector3::new(1.0, 0.2, -0.4),
                viscous: Matrix3::new(2.0, 0.1, 0.3, 0.1, 1.0, 0.0, 0.3, 0.0, 3.0),
            };
            // Curvatures that depend on the corners, too.
            let curvature = |x: [Vec3; 3]| {
                [0, 1, 2].map(|c| {
                    others[c] + x[0] * weights[3 * c] + x[1] * weights[3 * c + 1] + x[2] * weights[3 * c + 2]
                })
            };
            let energy = |x: [Vec3; 3]| {
                term.energy(along_normal(area_normal(x).normalize(), curvature(x)))
            };
            let (by_curvature, by_corner) = term.gradient(corners, curvature(corners)).unwrap();
            for i in 0..3 {
                for k in 0..3 {
                    let step = 1e-6;
                    let (mut up, mut down) = (corners, corners);
                    up[i][k] += step;
                    down[i][k] -= step;
                    let slope = (energy(up) - energy(down)) / (2.0 * step);
                    let got = by_corner[i][k]
                        + (0..3).map(|c| by_curvature[c][k] * weights[3 * c + i]).sum::<f64>();
                    prop_assert!((slope - got).abs() < 1e-4 * (1.0 + got.abs()), "{} {}", slope, got);
                }
            }
        }
    }

    #[test]
    fn a_triangle_without_area_has_no_force() {
        let term = FoldTerm {
            internal_moment: Vector3::repeat(1.0),
            start: Vector3::zeros(),
            viscous: Matrix3::identity(),
        };
        assert!(term.gradient([Vec3::x(); 3], [Vec3::y(); 3]).is_none());
    }
}
