//! Reads a mesh in OBJ or PLY and recognises the format by its content.
//!
//! # Decided with
//! - [`crate::obj_read::read_obj`], [`crate::ply::read_ply`]: the formats;
//! - [`crate::polygon::triangles_of`], [`toile_geometry::polygon_triangles`]: faces that are polygons;
//! - [`toile_geometry::MeshDefect`]: defects of a mesh;
//! - [`toile_body::Stance`]: how a person stands in a file.
//!
//! Turned right side out and stood upright in crate `session`, `mesh_file.rs`.

use crate::ply::looks_like_ply;
use crate::{FormatError, ObjMesh, read_obj, read_ply};

/// Reads a mesh: PLY if the file begins with the PLY signature, else OBJ.
///
/// # Errors
/// Those of [`read_ply`] and [`read_obj`].
pub fn read_mesh(bytes: &[u8]) -> Result<ObjMesh, FormatError> {
    match looks_like_ply(bytes) {
        true => read_ply(bytes),
        false => read_obj(bytes),
    }
}
