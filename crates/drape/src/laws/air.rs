//! Aerodynamic force on a triangle.
//!
//! With the triangle's mean velocity relative to the air w = v - wind, its components w_n along the normal
//! and w_t in the plane, F = -rho A / 2 (C_n |w_n| w_n + C_t |w_t| w_t): form drag and skin
//! friction of a plate (Ling, Damodaran and Gay 1996; Hoerner 1965, 3-15 for the coefficients).
//! F is minus the gradient with respect to w of rho A / 6 (C_n |w_n|^3 + C_t |w_t|^3), which is convex.
//!
//! # Decided with
//! - [`crate::environment::Environment::check`]: air that is refused;
//! - [`crate::incremental_potential`] (`AirTerm`),
//!   [`crate::incremental_potential::IncrementalPotential::begin_step`]: air in implicit steps;
//! - [`crate::incremental_potential::add_forces_of_motion`]: air in explicit methods;
//! - [`crate::xpbd`] (`air.rs`, `AddAirImpulses`, `triangle_sums.rs`): air in XPBD; sums at vertices;
//! - [`crate::xpbd::Losses`]: left out where only an equilibrium is sought;
//! - crate `reference` (`block_descent.rs`): air vertex by vertex;
//! - crate `reference` (`patches/`: `is_plain`): patches leave air to velocity Verlet;
//! - [`crate::garment::GarmentSetup::worn_environment`]: garments hang in still air.

use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;

/// Properties of the air.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Air {
    /// Drag per mass (1/s): a free velocity decays as exp(-drag t). A crude model, but cheap.
    pub drag: f64,
    /// Density (kg/m3); 0 for none, 1.2 at sea level.
    pub density: f64,
    /// Drag coefficient across the cloth: 1.2 for a square plate, 2 for a long one.
    pub normal: f64,
    /// Drag coefficient along the cloth, both sides together: 0.01 to 0.05.
    pub tangential: f64,
    /// Velocity of the wind (m/s).
    pub wind: Vec3,
}

impl Default for Air {
    /// No air (density 0), with the coefficients of a square plate, so that a density is enough to make it act.
    fn default() -> Self {
        Self {
            drag: 0.0,
            density: 0.0,
            normal: 1.2,
            tangential: 0.02,
            wind: Vec3::zeros(),
        }
    }
}

impl Air {
    /// Density at sea level and 20 degrees (kg/m3) (ISO 2533).
    pub const SEA_LEVEL: f64 = 1.204;

    /// Whether it exerts a force on triangles.
    #[inline]
    pub fn acts(&self) -> bool {
        self.density > 0.0 && (self.normal > 0.0 || self.tangential > 0.0)
    }

    /// Largest acceleration of resting cloth of `mass` per area (kg/m2) by the wind (m/s2).
    pub fn largest_acceleration(&self, mass: f64) -> f64 {
        0.5 * self.density * (self.normal + self.tangential) * self.wind.norm_squared() / mass
    }

    /// The drag law of a triangle: area (m2), unit normal.
    pub fn on(&self, area: f64, normal: Vec3) -> AirPull {
        let half = 0.5 * self.density * area;
        AirPull {
            normal,
            across: half * self.normal,
            along: half * self.tangential,
        }
    }
}

/// Quadratic drag of one triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AirPull {
    /// Unit normal.
    pub normal: Vec3,
    /// rho A C_n / 2 (kg/m).
    pub across: f64,
    /// rho A C_t / 2 (kg/m).
    pub along: f64,
}

impl AirPull {
    /// Components of w: along the normal, in the plane, and the length of the latter.
    fn split(&self, w: Vec3) -> (f64, Vec3, f64) {
        let across = w.dot(&self.normal);
        let along = w - self.normal * across;
        (across, along, along.norm())
    }

    /// Potential of the force at a velocity relative to the air (m/s): a third of the dissipated power (W).
    pub fn potential(&self, w: Vec3) -> f64 {
        let (across, _, along) = self.split(w);
        (self.across * across.abs().powi(3) + self.along * along.powi(3)) / 3.0
    }

    /// Gradient of the potential with respect to the velocity: minus the force on the triangle (N).
    pub fn gradient(&self, w: Vec3) -> Vec3 {
        let (across, along, speed) = self.split(w);
        self.normal * (self.across * across.abs() * across) + along * (self.along * speed)
    }

    /// Hessian of the potential with respect to the velocity, positive semidefinite (N s/m).
    pub fn hessian(&self, w: Vec3) -> Matrix3<f64> {
        let (across, along, speed) = self.split(w);
        let nn = self.normal * self.normal.transpose();
        let mut hessian = nn * (2.0 * self.across * across.abs())
            + (Matrix3::identity() - nn) * (self.along * speed);
        if speed > 0.0 {
            hessian += along * along.transpose() * (self.along / speed);
        }
        hessian
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn gradient_and_hessian_are_slopes_and_the_hessian_is_positive(
            w in prop::array::uniform3(-9.0f64..9.0), n in prop::array::uniform3(-1.0f64..1.0),
        ) {
            let Some(normal) = Vec3::from(n).try_normalize(1e-3) else { return Ok(()) };
            let air = Air { density: 1.2, tangential: 0.1, ..Air::default() };
            let (pull, w) = (air.on(0.03, normal), Vec3::from(w));
            let (gradient, hessian) = (pull.gradient(w), pull.hessian(w));
            prop_assert!(hessian.symmetric_eigenvalues().min() >= -1e-12);
            for k in 0..3 {
                let step = Vec3::ith(k, 1e-5);
                let slope = (pull.potential(w + step) - pull.potential(w - step)) / 2e-5;
                prop_assert!((slope - gradient[k]).abs() < 1e-6);
                let slope = (pull.gradient(w + step) - pull.gradient(w - step)) / 2e-5;
                prop_assert!((slope - hessian.column(k)).norm() < 1e-4);
            }
            prop_assert!(gradient.dot(&w) >= 0.0);
        }
    }

    #[test]
    fn there_is_no_force_on_still_cloth_in_still_air() {
        let pull = Air {
            density: 1.2,
            ..Air::default()
        }
        .on(1.0, Vec3::z());
        assert_eq!(pull.gradient(Vec3::zeros()), Vec3::zeros());
        assert_eq!(pull.hessian(Vec3::zeros()), Matrix3::zeros());
        assert!((pull.gradient(Vec3::z() * 2.0).z - 0.5 * 1.2 * 1.2 * 4.0).abs() < 1e-12);
    }
}
