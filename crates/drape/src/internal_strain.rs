//! Internal strain of a relaxing material: plain data of a state.

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
