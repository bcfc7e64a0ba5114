//! Reads a mesh in OBJ or PLY and recognises the format by its content.

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
