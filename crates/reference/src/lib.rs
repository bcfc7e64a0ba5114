//! Methods of the literature, for comparison: no garment uses them, and a scene only where it gives their name.
//!
//! Their names, what each supports and what is refused with them are in crate `drape`, so that a remedy can name any
//! method; only what they compute is here.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod patches;

use patches::PatchVerlet;
use toile_drape::methods::explicit::Explicit;
use toile_drape::methods::{Guarded, VelocityVerlet};
use toile_drape::{DrapeError, Method, MethodKind, MethodSettings};

/// A new method without memory of a run, any of the list: a [`toile_drape::MethodBuilder`].
///
/// # Errors
/// Those of [`MethodSettings::build`], which makes the methods that are not for comparison.
pub fn build(settings: &MethodSettings) -> Result<Box<dyn Method>, DrapeError> {
    Ok(match settings.kind {
        MethodKind::PatchVerlet => {
            let fallback = Explicit::<VelocityVerlet>::new(settings);
            Guarded::boxed(PatchVerlet::new(settings, Box::new(fallback)))
        }
        _ => return settings.build(),
    })
}
