//! What acts on every object of a world alike.

use crate::{Air, ContactSettings, DrapeError};
use toile_geometry::Vec3;

/// Rayleigh damping (Rayleigh 1877): forces -(mass M + stiffness K) v. The stiffness part acts on
/// strain rates of membrane and bending, so that no rigid motion feels it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Damping {
    /// In proportion to mass [1/s].
    pub mass: f64,
    /// In proportion to stiffness, beside each material's own [s].
    pub stiffness: f64,
}

/// What acts on every object alike.
#[derive(Clone, Debug, PartialEq)]
pub struct Environment {
    /// Acceleration of gravity [m/s2].
    pub gravity: Vec3,
    /// The air.
    pub air: Air,
    /// Damping of everything alike.
    pub damping: Damping,
    /// How cloth meets surfaces, and itself.
    pub contact: ContactSettings,
    /// Where layers pass through each other, the distance [m] that each is kept farther from solids than the
    /// one below it; none where they keep their order. It is taken up when a structure is made.
    pub(crate) layers_apart: Option<f64>,
}

/// Refuses a number that is not finite or below the least that it may be.
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
    /// Refuses numbers that nothing can be computed with.
    ///
    /// # Errors
    /// The first of them, with the remedy.
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
