//! Clips by their names: our own gaits and standing poses, and files of other programs.

use crate::SessionError;
use crate::open::read_input;
use std::path::Path;
use toile_body::{Clip, Skeleton};
use toile_interchange::{ExpectedKind, read_bvh, read_x3d};

/// Finds one of our own clips by its name.
pub(crate) fn own_clip(name: &str, skeleton: &Skeleton) -> Option<Clip> {
    match name {
        "walk" => Some(Clip::walk(skeleton)),
        "run" => Some(Clip::run(skeleton)),
        "stand" => Some(Clip::stand(skeleton)),
        "astride" => Some(Clip::astride(skeleton)),
        _ => None,
    }
}

/// Reads a BVH, X3D or VRML file as a clip for a skeleton, with notes on parts of the file that were left
/// out.
///
/// # Errors
/// The file cannot be read.
pub(crate) fn open_clip(
    path: &Path,
    skeleton: &Skeleton,
) -> Result<(Clip, Vec<String>), SessionError> {
    let ending = path.extension().map(|end| end.to_ascii_lowercase());
    let text = read_input(path, ExpectedKind::Motion)?;
    let read = match ending.as_ref().and_then(|end| end.to_str()) {
        Some("wrl" | "vrml" | "x3d" | "x3dv") => read_x3d(&text, skeleton),
        _ => read_bvh(&text, skeleton).map(|clip| (clip, Vec::new())),
    };
    read.map_err(|error| SessionError::Format {
        path: path.to_owned(),
        error,
    })
}
