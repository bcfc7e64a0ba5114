//! Gravity, air, damping and contact of a world, the same for all objects.
//!
//! # Decided with
//! - [`crate::world::World::furnish`] (`compile.rs`), [`crate::world::World::panels`] (`compile.rs`):
//!   gravity, air and drag given to the system; stiffness damping made part of the viscosity;
//! - [`crate::garment::GarmentSetup::sewing_environment`],
//!   [`crate::garment::GarmentSetup::worn_environment`]: environment of a garment while it is sewn, and when
//!   worn;
//! - [`crate::sew`] (`DRAG`), [`crate::kinetic_damping`] (`DRAG`): drag of a garment while sewn and in the
//!   swing;
//! - [`crate::methods`] (`rules.rs`), [`crate::xpbd::Xpbd::advance`], crate `reference` (`patches/`: `sheet.rs`,
//!   `advance`): drag by mass: each method takes it itself;
//! - [`crate::incremental_potential::IncrementalPotential`], [`crate::xpbd`] (`viscosity.rs`): forces of
//!   viscosity;
//! - [`crate::measure::weight_norm`]: the weight that a residual is measured by.
//!
//! Asked for in crates `interchange` (`scene.rs`) and `session` (`setup.rs`). By hand: `check` lists the
//! numbers.

use crate::{Air, ContactSettings, DrapeError};
use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;

/// Rayleigh damping (Rayleigh 1877): forces -(mass M + stiffness K) v. The stiffness part acts on
/// strain rates of membrane and bending, so that rigid motion is not damped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Damping {
    /// Coefficient of mass (1/s).
    pub mass: f64,
    /// Coefficient of stiffness, added to that of each material (s).
    pub stiffness: f64,
}

/// Gravity, air, damping and contact, the same for all objects.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Environment {
    /// Acceleration of gravity (m/s2).
    pub gravity: Vec3,
    /// The air.
    pub air: Air,
    /// Rayleigh damping.
    pub damping: Damping,
    /// Contact settings.
    pub contact: ContactSettings,
    /// Extra contact offset from solids of each layer over that of the next inner one (m), while layers pass through
    /// each other; none where contact keeps their order. It applies when a structure is compiled.
    pub(crate) layers_apart: Option<f64>,
    /// By how much solids are thinner than they are drawn (m): contact with them begins so much deeper. A garment that
    /// is tight is sewn round a thinner body; the steps of sewing heed it, XPBD and explicit methods do not.
    pub(crate) recess: f64,
}

/// A load or a setting of the environment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Parameter {
    /// Acceleration of gravity (m/s2).
    Gravity(Vec3),
    /// The air with its wind.
    Air(Air),
    /// Rayleigh damping.
    Damping(Damping),
    /// Contact.
    Contact(ContactSettings),
}

/// Refuses a number that is not finite or below `least`.
pub(crate) fn check_number(field: &str, value: f64, least: f64) -> Result<(), DrapeError> {
    match value.is_finite() && value >= least {
        true => Ok(()),
        false => Err(DrapeError::Scene {
            place: field.to_owned(),
            what: format!("{value} is out of range"),
            remedy: format!("give a finite number of {least} or more"),
        }),
    }
}

impl Environment {
    /// The environment with another value of one parameter.
    #[must_use]
    pub fn with(&self, parameter: Parameter) -> Self {
        let mut changed = self.clone();
        match parameter {
            Parameter::Gravity(gravity) => changed.gravity = gravity,
            Parameter::Air(air) => changed.air = air,
            Parameter::Damping(damping) => changed.damping = damping,
            Parameter::Contact(contact) => changed.contact = contact,
        }
        changed
    }

    /// Refuses numbers out of range.
    ///
    /// # Errors
    /// The first such number, with the remedy.
    pub(crate) fn check(&self) -> Result<(), DrapeError> {
        for (field, value) in [
            ("air drag", self.air.drag),
            ("air density", self.air.density),
            ("drag coefficient of the air across", self.air.normal),
            ("drag coefficient of the air along", self.air.tangential),
            ("mass damping", self.damping.mass),
            ("stiffness damping", self.damping.stiffness),
            ("contact offset", self.contact.offset),
            ("contact stiffness", self.contact.stiffness),
            ("cloth offset", self.contact.cloth_offset),
        ] {
            check_number(field, value, 0.0)?;
        }
        let refuse = |place: &str, what: &str, remedy: &str| {
            Err(DrapeError::Scene {
                place: place.to_owned(),
                what: what.to_owned(),
                remedy: remedy.to_owned(),
            })
        };
        if !self.gravity.iter().all(|x| x.is_finite()) {
            let remedy = "give three finite numbers in m/s2";
            return refuse("gravity", "it is not finite", remedy);
        }
        if !self.air.wind.iter().all(|x| x.is_finite()) {
            let remedy = "give three finite numbers in m/s";
            return refuse("wind", "it is not finite", remedy);
        }
        if self.air.wind != Vec3::zeros() && self.air.density == 0.0 {
            let remedy = "give the air a density, 1.204 kg/m3 at sea level, or leave the wind out";
            return refuse("wind", "air of density 0 carries none", remedy);
        }
        self.contact.check_reach("collision.offset")
    }
}
