//! Materials of cloth, in SI units.

use crate::DrapeError;
use crate::laws::bending::{BendingMatrix, bending_matrix};
use crate::laws::stretch::{Compression, MembraneLaw};
use serde::{Deserialize, Serialize};

/// An orthotropic cloth: membrane, bending, mass, surface, and how it loses energy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Mass per area (kg/m2).
    pub density: f64,
    /// Thickness (m): contact offsets are at least half of it from solids and all of it between two cloths
    /// ([`crate::ContactSettings::for_cloth`]).
    pub thickness: f64,
    /// Stretch stiffness along warp and weft (N/m).
    pub stretch: [f64; 2],
    /// Shear stiffness (N/m): force per length at a shear angle of one radian.
    pub shear: f64,
    /// Poisson ratio of warp to weft, at most 0.95 of the limit of a stable membrane.
    pub poisson: f64,
    /// Hardening k along warp and weft: stress C (E + k E^3) in tension. 0 is a linear law; a
    /// weave whose stiffness doubles at 5 % of stretch has 130.
    pub hardening: [f64; 2],
    /// Stretch beyond which warp and weft are 100 times as stiff, as a share of the rest length; infinite for none.
    /// Usual:
    /// 0.01 to 0.1.
    #[serde(with = "crate::exact::pair")]
    pub strain_limit: [f64; 2],
    /// Law of the membrane under compression.
    pub compression: Compression,
    /// Bending stiffness of strips cut along warp, weft and bias (N m).
    pub bend: [f64; 3],
    /// Poisson ratio in bending: curvature of the weft opposed to that of the warp. Rarely measured; 0 for
    /// cloth.
    pub bend_poisson: f64,
    /// Viscosity of stretch and shear (Kelvin-Voigt) (N s/m).
    pub viscosity: f64,
    /// Viscosity of bending (Kelvin-Voigt) (N m s).
    pub bend_viscosity: f64,
    /// Rayleigh damping: viscosity in proportion to stiffness (s).
    pub stiffness_damping: f64,
    /// Relaxed fraction p of the stress of stretch and of bending, 0 to 0.95: under constant strain the stress falls to
    /// 1 - p of its first value, and released the cloth retains p of the strain at first.
    pub relaxed_fraction: [f64; 2],
    /// Time tau over which the internal strain follows the strain (s).
    pub relaxation_time: f64,
    /// Coulomb friction coefficient against solids; between two cloths the mean of both is used.
    pub friction: f64,
    /// Coefficient of restitution, 0 to 1; none where the contact spring alone decides. Only `xpbd` supports it.
    pub restitution: Option<f64>,
}

impl Default for Material {
    /// A plain cotton weave. Round figures inside the ranges of measured fabrics: mass and bending
    /// near the medians 0.197 kg/m2 and 13.8 uN m of 618 fabrics (Feng et al. 2022); the stretch
    /// stiffness is that of a soft weave, so that a drape has strains of a few per cent. Elastic,
    /// without limit, hardening or relaxation.
    fn default() -> Self {
        Self {
            density: 0.2,
            thickness: 0.5e-3,
            stretch: [600.0, 600.0],
            shear: 60.0,
            poisson: 0.2,
            hardening: [0.0; 2],
            strain_limit: [f64::INFINITY; 2],
            compression: Compression::Full,
            bend: [1.5e-5, 1.5e-5, 1.2e-5],
            bend_poisson: 0.0,
            viscosity: 0.0,
            bend_viscosity: 0.0,
            stiffness_damping: 0.0,
            relaxed_fraction: [0.0; 2],
            relaxation_time: 10.0,
            friction: 0.4,
            restitution: None,
        }
    }
}

/// A field in [`Material::check`]: name, value, whether it is valid, remedy.
type Field = (&'static str, f64, bool, &'static str);

const POSITIVE: &str = "give a number above zero";
const NOT_NEGATIVE: &str = "give zero or a number above it";

fn positive(name: &'static str, value: f64) -> Field {
    (name, value, value > 0.0 && value.is_finite(), POSITIVE)
}

fn not_negative(name: &'static str, value: f64) -> Field {
    (name, value, value >= 0.0 && value.is_finite(), NOT_NEGATIVE)
}

impl Material {
    /// The law of the membrane, its stiffness matrix symmetric positive definite:
    /// C12 = nu sqrt(Y1 Y2) / (1 - nu^2), C11 = Y1 / (1 - nu^2), C22 = Y2 / (1 - nu^2).
    pub fn membrane(&self) -> MembraneLaw {
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

    /// Bending stiffness of curvature along warp, along weft, and of twist (N m). The twist term
    /// gives a fold at 45 degrees the bias stiffness (Cooper 1960):
    /// D_bias = (D_warp + D_weft + 2 D_nu + 2 D_twist) / 4, clamped to zero or above.
    pub fn bending(&self) -> [f64; 3] {
        let [warp, weft, _, twist] = self.plate();
        [warp, weft, twist]
    }

    /// The bending stiffness as a matrix over the three curvatures, with the coupling.
    pub fn bending_matrix(&self) -> BendingMatrix {
        bending_matrix(self.plate())
    }

    /// D_warp, D_weft, D_nu, D_twist (N m). A strip can curl across, so it is softer than a plate by the factor 1 -
    /// nu^2: D_warp = B_warp / (1 - nu^2), D_nu = nu sqrt(D_warp D_weft).
    fn plate(&self) -> [f64; 4] {
        let spread = 1.0 - self.bend_poisson * self.bend_poisson;
        let [warp, weft, bias] = self.bend.map(|b| b / spread);
        let coupling = self.bend_poisson * (warp * weft).sqrt();
        let twist = ((4.0 * bias - warp - weft - 2.0 * coupling) / 2.0).max(0.0);
        [warp, weft, coupling, twist]
    }

    /// Viscous matrix of the membrane: uu, vv, uu-vv, gamma-gamma (N s/m).
    pub(crate) fn viscous_stretch(&self) -> [f64; 4] {
        let [c11, c22, c12, g] = self.membrane().stiffness;
        let (eta, beta) = (self.viscosity, self.stiffness_damping);
        [
            eta + beta * c11,
            eta + beta * c22,
            beta * c12,
            0.5 * eta + beta * g,
        ]
    }

    /// Viscous matrix of bending over the three curvatures (N m s).
    pub(crate) fn viscous_bend(&self) -> BendingMatrix {
        let eta = self.bend_viscosity;
        bending_matrix([eta, eta, 0.0, eta]) + self.bending_matrix() * self.stiffness_damping
    }

    /// Whether stretch and bending are viscous.
    pub(crate) fn is_viscous(&self) -> [bool; 2] {
        let damped = self.stiffness_damping > 0.0;
        [
            self.viscosity > 0.0 || damped,
            self.bend_viscosity > 0.0 || damped,
        ]
    }

    /// Whether stretch or bending relaxes.
    pub(crate) fn keeps_strain(&self) -> bool {
        self.relaxed_fraction.iter().any(|&share| share > 0.0)
    }

    /// Checks every number.
    ///
    /// # Errors
    /// The first number out of range, with the remedy.
    pub fn check(&self, object: &str) -> Result<(), DrapeError> {
        // An exhaustive pattern: a new field does not compile before it is checked.
        let &Self {
            density,
            thickness,
            stretch,
            shear,
            poisson,
            hardening,
            strain_limit,
            compression: Compression::Full | Compression::TensionField,
            bend,
            bend_poisson,
            viscosity,
            bend_viscosity,
            stiffness_damping,
            relaxed_fraction,
            relaxation_time,
            friction,
            restitution,
        } = self;
        let bounce = restitution.unwrap_or_default();
        let ratio = |name, value: f64| {
            let good = (0.0..=0.95).contains(&value);
            (name, value, good, "give a number from 0 to 0.95")
        };
        let limit = |name, value: f64| {
            let good = value > 0.0;
            (
                name,
                value,
                good,
                "give a share above zero as in 0.05, or none",
            )
        };
        let fields = [
            positive("density [kg/m2]", density),
            not_negative("thickness [m]", thickness),
            positive("stretch along warp [N/m]", stretch[0]),
            positive("stretch along weft [N/m]", stretch[1]),
            positive("shear [N/m]", shear),
            ratio("Poisson ratio", poisson),
            not_negative("hardening along warp", hardening[0]),
            not_negative("hardening along weft", hardening[1]),
            limit("strain limit along warp", strain_limit[0]),
            limit("strain limit along weft", strain_limit[1]),
            not_negative("bend along warp [N m]", bend[0]),
            not_negative("bend along weft [N m]", bend[1]),
            not_negative("bend along bias [N m]", bend[2]),
            ratio("Poisson ratio in bending", bend_poisson),
            not_negative("viscosity [N s/m]", viscosity),
            not_negative("bending viscosity [N m s]", bend_viscosity),
            not_negative("stiffness damping [s]", stiffness_damping),
            ratio("kept share of stretch", relaxed_fraction[0]),
            ratio("kept share of folds", relaxed_fraction[1]),
            positive("relaxation time [s]", relaxation_time),
            not_negative("friction", friction),
            (
                "restitution",
                bounce,
                (0.0..=1.0).contains(&bounce),
                "give a share from 0 to 1",
            ),
        ];
        for (field, value, good, remedy) in fields {
            if !good {
                let object = object.to_owned();
                return Err(DrapeError::Material {
                    object,
                    field,
                    value,
                    remedy,
                });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

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
