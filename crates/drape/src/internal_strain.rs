//! Internal strain of a relaxing material: plain data of a state.
//!
//! # Decided with
//! - [`crate::materials::Materials::keep_strain`]: whether any material keeps strain;
//! - [`crate::incremental_potential::IncrementalPotential::law`], [`crate::incremental_potential::relax`]:
//!   its place in the law of a triangle; its relaxation in time;
//! - [`crate::laws::fold::FoldTerm`]: folds that stay;
//! - [`crate::world`] (`transfer.rs`, `internal_strain`): carried over an edit;
//! - [`crate::method::MethodKind::supports`] (`features.rs`), crate `reference` (`patches/`: `is_plain`): methods that
//!   do not know it.

use serde::{Deserialize, Serialize};

/// The internal variable v of a triangle's standard linear solid, for stretch and for bending: the strain from which
/// the relaxed fraction of the stress is measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InternalStrain {
    /// Green strain E_uu, E_vv, gamma.
    pub stretch: [f64; 3],
    /// Curvatures along the normal: uu, uv, vv (1/m).
    pub curvature: [f64; 3],
}
