//! What a cloth is made of, in SI units.

use crate::DrapeError;
use crate::laws::bending::{BendingMatrix, bending_matrix};
use crate::laws::stretch::MembraneLaw;

/// An orthotropic cloth: membrane, bending, mass, surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Mass per area [kg/m2].
    pub density: f64,
    /// Thickness [m]; half of it is kept between the middle of the cloth and any surface.
    pub thickness: f64,
    /// Stretch stiffness along warp and weft [N/m].
    pub stretch: [f64; 2],
    /// Shear stiffness [N/m]: force per length at a shear angle of one radian.
    pub shear: f64,
    /// Poisson ratio of warp to weft, at most 0.95 of what keeps the membrane stable.
    pub poisson: f64,
    /// Bending stiffness along warp, weft and bias [N m].
    pub bend: [f64; 3],
    /// Coulomb friction coefficient against solid surfaces.
    pub friction: f64,
}

impl Default for Material {
    /// A plain cotton weave. Round figures inside the ranges of measured fabrics: mass and bending
    /// near the medians 0.197 kg/m2 and 13.8 uN m of 618 fabrics (Feng et al. 2022); the stretch
    /// stiffness is that of a soft weave, so that a drape keeps strains of a few per cent.
    fn default() -> Self {
        Self {
            density: 0.2,
            thickness: 0.5e-3,
            stretch: [600.0, 600.0],
            shear: 60.0,
            poisson: 0.2,
            bend: [1.5e-5, 1.5e-5, 1.2e-5],
            friction: 0.4,
        }
    }
}

impl Material {
    /// The law of the membrane, its stiffness matrix symmetric positive definite: C12 = nu sqrt(Y1 Y2) / (1 - nu^2), C11 = Y1 / (1 - nu^2), C22 = Y2 / (1 - nu^2).
    pub fn membrane(&self) -> MembraneLaw {
        let spread = 1.0 - self.poisson * self.poisson;
        let [warp, weft] = self.stretch;
        MembraneLaw::linear([
            warp / spread,
            weft / spread,
            self.poisson * (warp * weft).sqrt() / spread,
            self.shear,
        ])
    }

    /// Bending stiffness of curvature along warp, along weft, and of twist [N m]. The twist term
    /// is what makes a fold at 45 degrees cost the bias stiffness (Cooper 1960):
    /// D_bias = (D_warp + D_weft + 2 D_nu + 2 D_twist) / 4, kept at zero or above.
    pub fn bending(&self) -> [f64; 3] {
        let [warp, weft, bias] = self.bend;
        [warp, weft, ((4.0 * bias - warp - weft) / 2.0).max(0.0)]
    }

    /// The same as a matrix over the three curvatures.
    pub fn bending_matrix(&self) -> BendingMatrix {
        let [warp, weft, twist] = self.bending();
        bending_matrix([warp, weft, 0.0, twist])
    }

    /// Checks every number.
    ///
    /// # Errors
    /// Names the first number that cannot be simulated and what would be right.
    pub fn check(&self, object: &str) -> Result<(), DrapeError> {
        let positive = "give a number above zero";
        let not_negative = "give zero or a number above it";
        let fields = [
            (
                "density [kg/m2]",
                self.density,
                self.density > 0.0,
                positive,
            ),
            (
                "thickness [m]",
                self.thickness,
                self.thickness >= 0.0,
                not_negative,
            ),
            (
                "stretch along warp [N/m]",
                self.stretch[0],
                self.stretch[0] > 0.0,
                positive,
            ),
            (
                "stretch along weft [N/m]",
                self.stretch[1],
                self.stretch[1] > 0.0,
                positive,
            ),
            ("shear [N/m]", self.shear, self.shear > 0.0, positive),
            (
                "Poisson ratio",
                self.poisson,
                (0.0..=0.95).contains(&self.poisson),
                "give a number from 0 to 0.95",
            ),
            (
                "bend along warp [N m]",
                self.bend[0],
                self.bend[0] >= 0.0,
                not_negative,
            ),
            (
                "bend along weft [N m]",
                self.bend[1],
                self.bend[1] >= 0.0,
                not_negative,
            ),
            (
                "bend along bias [N m]",
                self.bend[2],
                self.bend[2] >= 0.0,
                not_negative,
            ),
            (
                "friction",
                self.friction,
                self.friction >= 0.0,
                not_negative,
            ),
        ];
        for (field, value, good, remedy) in fields {
            if !(good && value.is_finite()) {
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
