//! Friction of contact samples with solids from step to step: plain data of a state.
//!
//! # Decided with
//! - [`crate::contacts::Contacts::remember_step`]: anchors after a step;
//! - [`crate::xpbd`] (`friction.rs`, `contact.rs`, `recall`): XPBD: taken from the state and stored;
//! - crate `reference` (`patches/`: `patch_contacts.rs`, `start`, `finish`): patches: taken from the state and stored;
//! - [`crate::world`] (`transfer.rs`, `samples`, `carry_triangle_samples`): carried over an edit or a merge;
//!   another mesh starts without;
//! - [`crate::kinetic_damping::KineticDamping::advance`], [`crate::submodel`] (`own_friction`): discarded at the end
//!   of the swing; the share of a region;
//! - [`crate::contact_refinement`]: kept under other rest shapes;
//! - [`crate::world::Simulation::reset_motion`]: wiped when motion is reset;
//! - [`crate::collision`] (`friction_memory.rs`): the same for cloth on cloth.

use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;

/// Friction state of the contact of a sample with a solid that pressed in the last step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SolidFriction {
    /// Index of the contact sample.
    pub sample: u32,
    /// Index of the solid among the model's.
    pub solid: u32,
    /// Friction anchor: the place to which the sample sticks (m).
    pub anchor: Vec3,
    /// Normal force in the last step (N).
    pub force: f64,
}

impl SolidFriction {
    /// The order of a state's list: by sample, then by solid.
    pub fn key(&self) -> (u32, u32) {
        (self.sample, self.solid)
    }

    /// The friction of a sample with a solid in a list in order of [`Self::key`].
    pub fn find(list: &[Self], sample: u32, solid: u32) -> Option<&Self> {
        let at = list
            .binary_search_by_key(&(sample, solid), Self::key)
            .ok()?;
        Some(&list[at])
    }
}
