//! The force law of elastics: springs of rest length zero.

use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;

/// The force law of an elastic of rest length zero: proportional to the gap up to a largest
/// force, constant beyond, so that distant panels are not accelerated too much.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ElasticLaw {
    /// Stiffness at small gaps (N/m).
    pub stiffness: f64,
    /// Largest force (N); infinite for a plain spring.
    #[serde(with = "toile_fabric::exact")]
    pub largest_force: f64,
}

impl ElasticLaw {
    /// Energy (J) at a gap vector (m): k g^2 / 2 within F/k, then F g - F^2 / (2 k)
    /// (the Huber function, convex).
    pub fn energy(&self, gap: Vec3) -> f64 {
        let length = gap.norm();
        let (k, largest) = (self.stiffness, self.largest_force);
        if k * length <= largest {
            0.5 * k * length * length
        } else {
            largest * length - 0.5 * largest * largest / k
        }
    }

    /// Secant stiffness (N/m): the force is this times the gap. Used as an isotropic Hessian it
    /// majorises the true one, so a Newton step never overshoots.
    #[inline]
    pub fn secant(&self, gap: Vec3) -> f64 {
        let length = gap.norm();
        if self.stiffness * length <= self.largest_force {
            self.stiffness
        } else {
            self.largest_force / length
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn force_is_the_slope_of_the_energy_and_never_exceeds_its_limit() {
        let law = ElasticLaw {
            stiffness: 200.0,
            largest_force: 0.5,
        };
        for length in [1e-4, 1e-3, 2.4e-3, 2.6e-3, 0.1, 3.0] {
            let at = |l: f64| Vec3::new(0.6, 0.0, 0.8) * l;
            let slope = (law.energy(at(length + 1e-7)) - law.energy(at(length - 1e-7))) / 2e-7;
            let force = law.secant(at(length)) * length;
            assert!((slope - force).abs() < 1e-6, "{length}: {slope} {force}");
            assert!(force <= 0.5 + 1e-15);
        }
    }
}
