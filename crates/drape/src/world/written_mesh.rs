//! A mesh as it is written: its positions (m) and its triangles.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::sync::Arc;
use toile_geometry::{TriangleMesh, Vec3};

/// Writes a mesh.
pub(super) fn serialize<S: Serializer>(mesh: &TriangleMesh, to: S) -> Result<S::Ok, S::Error> {
    (&mesh.positions, &mesh.triangles).serialize(to)
}

/// Reads a mesh.
pub(super) fn deserialize<'de, D: Deserializer<'de>>(
    from: D,
) -> Result<Arc<TriangleMesh>, D::Error> {
    let (positions, triangles) = <(Vec<Vec3>, Vec<[u32; 3]>)>::deserialize(from)?;
    Ok(Arc::new(TriangleMesh {
        positions,
        triangles,
    }))
}
