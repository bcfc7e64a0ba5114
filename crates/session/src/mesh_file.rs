//! Meshes of files: read, turned right side out, and set upright if they are of a person.

use crate::SessionError;
use crate::open::read_bytes;
use std::path::Path;
use toile_body::{AskedStance, BodyError, Stance};
use toile_geometry::TriangleMesh;
use toile_interchange::{ExpectedKind, FormatError, read_mesh};

/// A mesh read from a file, with notes on corrections.
pub(crate) struct OpenedMesh {
    pub mesh: TriangleMesh,
    pub notes: Vec<String>,
}

/// Reads a mesh (OBJ or PLY). Triangles that are inside out are turned round.
///
/// # Errors
/// The file cannot be read, or is no mesh.
pub(crate) fn open_mesh(path: &Path) -> Result<OpenedMesh, SessionError> {
    let bytes = read_bytes(path, ExpectedKind::Mesh)?;
    let read = read_mesh(&bytes).map_err(|error| SessionError::Format {
        path: path.to_owned(),
        error,
    })?;
    let mut mesh = read.into_triangle_mesh();
    let (turned, all) = (mesh.orient(), mesh.triangles.len());
    let notes = match turned {
        0 => Vec::new(),
        _ if turned == all => vec![format!(
            "{}: it is inside out: its triangles were turned round",
            path.display()
        )],
        _ => vec![format!(
            "{}: {turned} of its {all} triangles face the other way than their neighbours: they were turned round",
            path.display()
        )],
    };
    Ok(OpenedMesh { mesh, notes })
}

/// Reads a mesh of a person and sets it upright, by the stance asked for or detected: in metres, Y up, facing
/// +Z.
///
/// # Errors
/// Those of [`open_mesh`]; and a mesh whose axes or unit cannot be detected.
pub(crate) fn open_person(
    path: &Path,
    asked: &AskedStance,
) -> Result<(OpenedMesh, Stance), SessionError> {
    let mut opened = open_mesh(path)?;
    let stance = Stance::of(&opened.mesh, asked).map_err(|error| {
        let hint =
            "--up, --forward and --unit say how it stands, as in --up z --forward -y --unit cm";
        stance_error(path, &error, hint)
    })?;
    for p in &mut opened.mesh.positions {
        *p = stance.place(*p);
    }
    if *asked == AskedStance::default() && !stance.is_ours() {
        opened.notes.push(format!(
            "{}: {stance}: it was set upright in metres, y up, facing z; \
             --up, --forward and --unit say otherwise",
            path.display()
        ));
    }
    Ok((opened, stance))
}

/// Error for a mesh whose stance cannot be detected; `hint` is the remedy.
pub(crate) fn stance_error(path: &Path, error: &BodyError, hint: &str) -> SessionError {
    SessionError::Format {
        path: path.to_owned(),
        error: FormatError::new("the mesh", error.to_string(), hint),
    }
}
