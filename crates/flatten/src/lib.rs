//! Surfaces with one outline flattened to panels: the flat shape of fabric that takes the least energy to cover the
//! surface, and darts where it would stretch too far. It knows nothing of patterns, bodies or files.
//!
//! [`flatten()`] does all of it: [`Region`] checks that the surface can be flattened, [`conformal`], [`tutte`] and [`arap`]
//! give a start, [`RestEnergy`] and [`minimise`] the shape of least energy, [`dart`] cuts. [`cut_out`] takes a region out of
//! any surface along shortest paths, and [`flatten_surface()`] flattens it.
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
mod flatten_surface;
mod geodesic;
mod grain;
mod hollows;
mod loop_error;
mod options;
mod ordered;
mod outline;
mod panel_dart;
mod region;
mod remesh;
mod search;
mod split_mesh;
mod stretch;
mod surface_loop;
pub mod tutte;

pub use cubics::Cubic;
pub use descent::{MAX_STEPS, Minimum, minimise};
pub use energy::RestEnergy;
pub use error::FlattenError;
pub use flatten::{Flattened, flatten, flatten_region};
pub use flatten_surface::flatten_surface;
pub use geodesic::{PathNode, shortest_path};
pub use grain::Grain;
pub use hollows::Spanning;
pub use loop_error::LoopError;
pub use options::{Options, SHARE_WITHIN};
pub use outline::{OutlineDart, OutlineEdge, PanelOutline, panel_outline};
pub use panel_dart::Dart;
pub use region::Region;
pub use remesh::{MAX_EDGE, MAX_TRIANGLES, MIN_EDGE, Remeshed};
pub use split_mesh::SplitMesh;
pub use stretch::{Stretch, stretch_of, stretch_quantile};
pub use surface_loop::{
    MAX_CUTS, MAX_OFF, MAX_PLACES, MIN_PLACES, SurfaceLoop, SurfaceRegion, cut_out, surface_path,
};
