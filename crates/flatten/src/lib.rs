//! Surfaces with one outline flattened to panels: the flat shape of fabric that takes the least energy to cover the
//! surface, and darts where it would stretch too far. It knows nothing of patterns, bodies or files.
//!
//! [`flatten()`] does all of it: [`Region`] checks that the surface can be flattened, [`conformal`], [`tutte`] and [`arap`]
//! give a start, [`RestEnergy`] and [`minimise`] the shape of least energy, [`dart`] cuts.
#![cfg_attr(test, allow(clippy::unwrap_used))]

pub mod arap;
pub mod conformal;
mod cotangent;
mod cubics;
pub mod dart;
mod descent;
mod energy;
mod error;
mod flatten;
mod grain;
mod options;
mod outline;
mod panel_dart;
mod region;
mod search;
mod stretch;
pub mod tutte;

pub use cubics::Cubic;
pub use descent::{MAX_STEPS, Minimum, minimise};
pub use energy::RestEnergy;
pub use error::FlattenError;
pub use flatten::{Flattened, flatten, flatten_region};
pub use grain::Grain;
pub use options::{Options, SHARE_WITHIN};
pub use outline::{OutlineDart, OutlineEdge, PanelOutline, panel_outline};
pub use panel_dart::Dart;
pub use region::Region;
pub use stretch::{Stretch, stretch_of, stretch_quantile};
