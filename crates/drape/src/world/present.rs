//! A world with its present state: surfaces of objects, prescribed vertices, and pairs of vertices that may merge.

use super::object::{Kind, MeshVertex, ObjectId};
use super::{VertexMap, World};
use crate::merge::joinable;
use crate::{DrapeError, State, System};
use toile_geometry::{TriangleMesh, Vec3};

/// A world with its present structure and state.
pub(super) struct Present<'a> {
    pub world: &'a World,
    pub map: &'a VertexMap,
    pub system: &'a System,
    pub state: &'a State,
}

impl Present<'_> {
    /// The present surface of an object; none after its removal.
    pub fn mesh_of(&self, id: ObjectId) -> Option<TriangleMesh> {
        let object = self.world.object(id)?;
        let mesh = &object.mesh;
        Some(match (self.map.vertices_of(id), object.kind) {
            (Some(own), _) => {
                let position = |&v: &u32| self.state.positions[v as usize];
                moved(mesh, own.iter().map(position).collect())
            }
            (None, Kind::Animated) => moved(mesh, object.animated_positions(self.state.time)),
            _ => TriangleMesh::clone(mesh),
        })
    }

    /// The present surface of a cloth, its triangles between merged vertices.
    pub fn merged_surface_of(&self, id: ObjectId) -> Option<TriangleMesh> {
        let own = self.map.vertices_of(id)?;
        let triangles = self.world.object(id)?.mesh.triangles.iter();
        Some(TriangleMesh {
            positions: self.state.positions.clone(),
            triangles: triangles.map(|t| t.map(|v| own[v as usize])).collect(),
        })
    }

    /// Marks of the merged vertices that are pinned or gripped, and of those that are gripped.
    pub fn prescribed(&self) -> (Vec<bool>, Vec<bool>) {
        let mut gripped = vec![false; self.state.positions.len()];
        for grip in &self.system.prescribed.led {
            gripped[grip.vertex as usize] = true;
        }
        let mut prescribed = gripped.clone();
        for pin in self.world.pins(self.map) {
            prescribed[pin as usize] = true;
        }
        (prescribed, gripped)
    }

    /// For each pair of mesh vertices whether it may merge. Two prescribed vertices may only where both are pinned at
    /// the same position.
    fn joinable(&self, pairs: &[[MeshVertex; 2]]) -> Vec<bool> {
        let (prescribed, gripped) = self.prescribed();
        let x = &self.state.positions;
        let together = |a: u32, b: u32| {
            let [a, b] = [a as usize, b as usize];
            x[a] == x[b] && !gripped[a] && !gripped[b]
        };
        let present = pairs.iter().map(|pair| {
            let [a, b] = pair.map(|vertex| self.map.vertex(vertex));
            a.zip(b).map(|(a, b)| [a, b])
        });
        joinable(present, &prescribed, together)
    }

    /// Refuses to merge vertices that are prescribed to different positions.
    pub fn check_joinable(&self, pairs: &[[MeshVertex; 2]]) -> Result<(), DrapeError> {
        let may = self.joinable(pairs);
        let Some((pair, _)) = pairs.iter().zip(may).find(|(_, may)| !may) else {
            return Ok(());
        };
        let object = self.world.existing(pair[0].object)?;
        let what = format!(
            "its vertex {} and the one it is merged with are held apart",
            pair[0].vertex
        );
        Err(object.refuse(&what, "let one of the two go, or pin both at one place"))
    }

    /// Pairs of vertices that may merge and are within the merging distance of their attachment.
    pub fn closed_pairs(&self) -> Vec<[MeshVertex; 2]> {
        let x = &self.state.positions;
        let close = self.world.attachments().filter_map(|(_, attachment)| {
            let within = attachment.merge_within?;
            let ends = self.world.cloth_ends(attachment)?;
            let [a, b] = ends.map(|end| self.map.vertex(end));
            let (a, b) = (a? as usize, b? as usize);
            (a != b && (x[a] - x[b]).norm() <= within).then_some(MeshVertex::pair(ends))
        });
        let pairs: Vec<[MeshVertex; 2]> = close.collect();
        if pairs.is_empty() {
            return pairs;
        }
        let may = self.joinable(&pairs);
        let allowed = pairs.into_iter().zip(may).filter(|&(_, may)| may);
        allowed.map(|(pair, _)| pair).collect()
    }
}

/// A surface with its vertices at other positions (m).
fn moved(mesh: &TriangleMesh, positions: Vec<Vec3>) -> TriangleMesh {
    TriangleMesh {
        positions,
        triangles: mesh.triangles.clone(),
    }
}
