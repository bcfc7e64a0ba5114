//! Strain that cloth has crept into: plain data of a state.

use serde::{Deserialize, Serialize};

/// The internal variable v of a triangle's standard linear solid, for stretch and for bending: the strain
/// that its relaxed share of the stress is measured from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InternalStrain {
    /// Green strain E_uu, E_vv, gamma.
    pub stretch: [f64; 3],
    /// Curvatures along the normal: uu, uv, vv [1/m].
    pub curvature: [f64; 3],
}
