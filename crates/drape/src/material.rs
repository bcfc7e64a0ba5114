//! Laws made of the figures of a material: membrane, bending, viscosity.
//!
//! # Decided with
//! - [`toile_fabric::FIGURES`]: each figure with its default, its names, its unit and its domain;
//! - [`crate::laws`]: stress and energy of the laws;
//! - [`crate::Feature`]: the methods that take hardening, limits, viscosity, relaxation, restitution.

use crate::DrapeError;
use crate::laws::bending::{BendingMatrix, bending_matrix};
use crate::laws::stretch::MembraneLaw;
use toile_fabric::{FigureFault, Material};

/// Elastic laws of a material, and the check of its figures.
pub trait MaterialLaws {
    /// The law of the membrane, its stiffness matrix symmetric positive definite:
    /// C12 = nu sqrt(Y1 Y2) / (1 - nu^2), C11 = Y1 / (1 - nu^2), C22 = Y2 / (1 - nu^2).
    fn membrane(&self) -> MembraneLaw;

    /// Bending stiffness of curvature along warp, along weft, and of twist (N m). The twist term
    /// gives a fold at 45 degrees the bias stiffness (Cooper 1960):
    /// D_bias = (D_warp + D_weft + 2 D_nu + 2 D_twist) / 4, clamped to zero or above.
    fn bending(&self) -> [f64; 3];

    /// The bending stiffness as a matrix over the three curvatures, with the coupling.
    fn bending_matrix(&self) -> BendingMatrix;

    /// Checks every number.
    ///
    /// # Errors
    /// The first number out of range, with the remedy.
    fn check(&self, object: &str) -> Result<(), DrapeError>;
}

impl MaterialLaws for Material {
    fn membrane(&self) -> MembraneLaw {
        let spread = 1.0 - self.poisson * self.poisson;
        let [warp, weft] = self.stretch;
        MembraneLaw {
            hardening: self.hardening,
            limit: self.strain_limit,
            compression: self.compression,
            ..MembraneLaw::linear([
                warp / spread,
                weft / spread,
                self.poisson * (warp * weft).sqrt() / spread,
                self.shear,
            ])
        }
    }

    fn bending(&self) -> [f64; 3] {
        let [warp, weft, _, twist] = plate(self);
        [warp, weft, twist]
    }

    fn bending_matrix(&self) -> BendingMatrix {
        bending_matrix(plate(self))
    }

    fn check(&self, object: &str) -> Result<(), DrapeError> {
        self.in_domain().map_err(|fault| {
            let FigureFault {
                field,
                value,
                remedy,
            } = fault;
            DrapeError::Material {
                object: object.to_owned(),
                field,
                value,
                remedy,
            }
        })
    }
}

/// D_warp, D_weft, D_nu, D_twist (N m). A strip can curl across, so it is softer than a plate by the factor 1 -
/// nu^2: D_warp = B_warp / (1 - nu^2), D_nu = nu sqrt(D_warp D_weft).
fn plate(material: &Material) -> [f64; 4] {
    let spread = 1.0 - material.bend_poisson * material.bend_poisson;
    let [warp, weft, bias] = material.bend.map(|b| b / spread);
    let coupling = material.bend_poisson * (warp * weft).sqrt();
    let twist = ((4.0 * bias - warp - weft - 2.0 * coupling) / 2.0).max(0.0);
    [warp, weft, coupling, twist]
}

/// Laws of a material that lose energy.
pub(crate) trait DissipativeLaws {
    /// Viscous matrix of the membrane: uu, vv, uu-vv, gamma-gamma (N s/m).
    fn viscous_stretch(&self) -> [f64; 4];

    /// Viscous matrix of bending over the three curvatures (N m s).
    fn viscous_bend(&self) -> BendingMatrix;

    /// Whether stretch and bending are viscous.
    fn is_viscous(&self) -> [bool; 2];

    /// Whether stretch or bending relaxes.
    fn keeps_strain(&self) -> bool;
}

impl DissipativeLaws for Material {
    fn viscous_stretch(&self) -> [f64; 4] {
        let [c11, c22, c12, g] = self.membrane().stiffness;
        let (eta, beta) = (self.viscosity, self.stiffness_damping);
        [
            eta + beta * c11,
            eta + beta * c22,
            beta * c12,
            0.5 * eta + beta * g,
        ]
    }

    fn viscous_bend(&self) -> BendingMatrix {
        let eta = self.bend_viscosity;
        bending_matrix([eta, eta, 0.0, eta]) + self.bending_matrix() * self.stiffness_damping
    }

    fn is_viscous(&self) -> [bool; 2] {
        let damped = self.stiffness_damping > 0.0;
        [
            self.viscosity > 0.0 || damped,
            self.bend_viscosity > 0.0 || damped,
        ]
    }

    fn keeps_strain(&self) -> bool {
        self.relaxed_fraction.iter().any(|&share| share > 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::stretch::StrainLaw;
    use proptest::prelude::*;
    use toile_fabric::KesValues;
    use toile_fabric::kes::KES_LOAD;

    #[test]
    fn numbers_that_are_none_are_refused() {
        let bad: [fn(&mut Material); 9] = [
            |m| m.density = f64::NAN,
            |m| m.stretch[1] = f64::NAN,
            |m| m.hardening[0] = f64::NAN,
            |m| m.strain_limit[0] = f64::NAN,
            |m| m.strain_limit[1] = 0.0,
            |m| m.relaxed_fraction[1] = 1.0,
            |m| m.relaxation_time = f64::INFINITY,
            |m| m.viscosity = -1.0,
            |m| m.bend_poisson = f64::NAN,
        ];
        for spoil in bad {
            let mut material = Material::default();
            spoil(&mut material);
            assert!(material.check("x").is_err(), "{material:?}");
        }
        assert!(Material::default().check("x").is_ok());
    }

    #[test]
    fn the_curve_passes_its_end_point_with_its_linearity() {
        let values = KesValues {
            bending: [0.136; 2],
            bending_hysteresis: [0.062; 2],
            shear: 0.968,
            shear_hysteresis: 1.2,
            extension: [6.0, 4.0],
            linearity: [0.61, 0.75],
            resilience: [62.0; 2],
            thickness: 0.75,
            weight: 26.4,
            friction: 0.21,
        };
        let material = values.material();
        assert!(material.check("wool").is_ok());
        let law = material.membrane();
        let force = |e: f64| law.stress([e + 0.5 * e * e, 0.0, 0.0]).0[0] * (1.0 + e);
        assert!((force(0.06) - KES_LOAD).abs() < 1e-6);
        let steps = 1000;
        let h = 0.06 / f64::from(steps);
        let area: f64 = (0..steps)
            .map(|i| force((f64::from(i) + 0.5) * h) * h)
            .sum();
        let linearity = area / (0.5 * 0.06 * KES_LOAD);
        assert!((linearity - 0.61).abs() < 0.025, "{linearity}");
        assert!((values.kept_fold() - 0.0912).abs() < 1e-3);
    }

    proptest! {
        #[test]
        fn bending_is_positive_and_the_bias_strip_costs_what_is_asked(
            bend in prop::array::uniform3(1e-6f64..1e-4), nu in 0.0f64..0.95,
        ) {
            let material = Material { bend, bend_poisson: nu, ..Material::default() };
            let d = material.bending_matrix();
            prop_assert!(d.symmetric_eigenvalues().min() >= -1e-18);
            // Curvature k along the bias: uu = uv = vv = k / 2.
            let fold = nalgebra::Vector3::repeat(0.5);
            let bias = fold.dot(&(d * fold)) * (1.0 - nu * nu);
            prop_assert!(bias >= bend[2] * (1.0 - 1e-12));
            if material.bending()[2] > 0.0 {
                prop_assert!((bias - bend[2]).abs() < 1e-12);
            }
        }
    }
}
