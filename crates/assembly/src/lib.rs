//! Draft to seam-matched, triangulated, placed panels.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod boundary;
mod chain;
mod edges;
mod error;
mod garment;
mod links;
mod mesh;
mod planar;
mod quality;
mod refinement;
mod sampling;
mod size_field;
mod smoothing;
mod wearer;

pub use error::{AssemblyError, Diagnostic, Severity};
pub use garment::{Garment, GarmentPanel, Stitch};
pub use mesh::{PieceMesh, PieceMeshes, mesh_pieces};
pub use quality::{MeshQuality, combine, smallest_angle};
pub use wearer::{Levels, Limb, Wearer};
