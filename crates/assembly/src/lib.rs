//! Makes triangulated panels from a draft, with matching vertices along seams, placed round a body.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod assemble;
mod boundary;
mod circumcircle;
mod closing;
mod creases;
mod edges;
mod error;
mod flare;
mod flared_row;
mod flat_pieces;
mod garment;
mod gores;
mod harmonic;
mod links;
mod mesh;
mod morph;
mod outline_curve;
mod part_frames;
mod placement;
mod placement_body;
mod planar;
mod quality;
mod refinement;
mod role;
mod rows;
mod sampling;
mod sanity;
mod seam_match;
mod size_field;
mod smoothing;
mod source;
mod surroundings;
mod wearer_side;
mod wrap;

pub use assemble::{Assembled, AssemblyOptions, assemble};
pub use error::{AssemblyError, Diagnostic, Severity};
pub use garment::{Garment, GarmentPanel, Stitch};
pub use mesh::{PieceMesh, PieceMeshes, mesh_pieces};
pub use morph::{MorphError, morph};
pub use placement_body::{Levels, Limb, PlacementBody};
pub use quality::{MeshQuality, combine, smallest_angle};
pub use role::body_part_by_name;
pub use sanity::{Sanity, sanity};
