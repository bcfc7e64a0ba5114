//! Settings of contact with solids and of cloth with cloth: offsets, stiffness, friction.
//!
//! # Decided with
//! - [`crate::system::SystemBuilder::offset_layers`]: panels apart by layers while sewn;
//! - [`crate::contact_refinement`] (`EXTRA_OFFSET`): farther off where a triangle crosses the body;
//! - [`crate::collision`] (`surface.rs`, `surface_view.rs`, `OFFSET_PER_EDGE`): nearer where edges of the
//!   cloth are short;
//! - [`crate::laws::contact::HARDER`], [`crate::laws::contact::TANGENTIAL_RATIO`]: stiffness where cloth lies
//!   deep; stiffness of friction;
//! - [`crate::collision`] (`detector.rs`, `HARD_FROM`): depth beyond which two cloths push harder;
//! - [`crate::xpbd`] (`contact.rs`, `of_sample`), crate `reference` (`patches/`: `patch_contacts.rs`, `update_force`):
//!   stiffness in XPBD, in patches;
//! - [`crate::garment::GarmentSetup::sewing_environment`]: no contact of cloth with cloth and no friction
//!   while a garment is sewn;
//! - [`crate::world::World::furnish`] (`compile.rs`), [`crate::garment`] (`tight.rs`, `largest_recess`): nearer
//!   while a tight garment is put on;
//! - [`crate::xpbd`] (`carried_plane.rs`, `kept_offset`; `skin_look.rs`, `kept_off`): nearer where walls of a
//!   moving solid face each other.
//!
//! A cloth offset of 0 means that nothing keeps cloth from passing through cloth.
//! Asked in crates `interchange` (`scene.rs`, `contact`) and `session` (`setup.rs`, `CLOTH_OFFSET`).

use crate::laws::contact::{ContactLaw, TANGENTIAL_RATIO};
use crate::{DrapeError, Material};
use serde::{Deserialize, Serialize};

/// Distance from a solid to which its distance field extends (m).
pub const FIELD_REACH: f64 = 0.03;

/// Largest extra offset of the contact samples of a triangle that crosses a solid (m): a crossing that remains then is
/// not cured by distance.
pub(crate) const MAX_EXTRA: f64 = 8e-3;

/// Largest contact offset from solids (m): the extent of the distance field less the largest extra offset.
pub const MAX_OFFSET: f64 = FIELD_REACH - MAX_EXTRA;

/// Settings of contact with solids and of cloth with cloth.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContactSettings {
    /// Distance of the middle of the cloth from a solid at which contact begins (m), at most [`MAX_OFFSET`]; half the
    /// cloth's thickness where that is more ([`Self::for_cloth`]). It must exceed the sagitta of an edge on the
    /// tightest curve of the body, e^2 / (8 R).
    pub offset: f64,
    /// Normal stiffness per area of cloth (N/m3): pressure per depth.
    pub stiffness: f64,
    /// Whether friction acts.
    pub friction: bool,
    /// Distance between the middles of two cloths at which contact begins (m), the cloth's thickness where that is
    /// more; at 0 cloth passes through cloth.
    pub cloth_offset: f64,
}

impl Default for ContactSettings {
    /// 4 mm: over the 3.1 mm sagitta of a 20 mm edge on a wrist of 16 mm radius.
    /// 1e6 N/m3: 100 Pa (a close fit) sinks 0.1 mm. Cloth passes through cloth.
    fn default() -> Self {
        Self {
            offset: 4e-3,
            stiffness: 1e6,
            friction: true,
            cloth_offset: 0.0,
        }
    }
}

impl ContactSettings {
    /// The settings for cloth of some materials: the offset from solids is at least half of the largest thickness, that
    /// of cloth with cloth, unless it is zero, at least all of it.
    #[must_use]
    pub fn for_cloth<'a>(self, materials: impl IntoIterator<Item = &'a Material>) -> Self {
        let each = materials.into_iter().map(|material| material.thickness);
        let thickness = each.fold(0.0, f64::max);
        let has_cloth_contact = self.cloth_offset > 0.0;
        Self {
            offset: self.offset.max(0.5 * thickness),
            cloth_offset: match has_cloth_contact {
                true => self.cloth_offset.max(thickness),
                false => 0.0,
            },
            ..self
        }
    }

    /// The laws of contact of an area of cloth (m2) with a coefficient of friction, soft at any depth.
    pub fn law(&self, area: f64, friction: f64) -> ContactLaw {
        let normal = self.stiffness * area;
        ContactLaw {
            normal,
            tangential: TANGENTIAL_RATIO * normal,
            friction: self.friction_of(friction),
            hard_from: f64::INFINITY,
        }
    }

    /// The coefficient of friction that acts: that of the cloth, or zero without friction.
    pub fn friction_of(&self, friction: f64) -> f64 {
        if self.friction { friction } else { 0.0 }
    }

    /// Refuses an offset that exceeds the extent of distance fields.
    ///
    /// # Errors
    /// An offset beyond [`MAX_OFFSET`]; `place` is named in the message.
    pub(crate) fn check_reach(&self, place: &str) -> Result<(), DrapeError> {
        if self.offset <= MAX_OFFSET {
            return Ok(());
        }
        Err(DrapeError::Scene {
            place: place.to_owned(),
            what: format!(
                "the middle of the cloth would keep {} m from surfaces; they are felt to {MAX_OFFSET} m at most",
                self.offset
            ),
            remedy: format!(
                "give a collision.offset of at most {MAX_OFFSET} and cloth at most {} m thick",
                2.0 * MAX_OFFSET
            ),
        })
    }
}
