//! A world as it lies now: surfaces, what is held, and which vertices may become one.

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
    /// The surface of an object as it lies now; none where it was removed.
    pub fn mesh_of(&self, id: ObjectId) -> Option<TriangleMesh> {
        let object = self.world.object(id)?;
        let mesh = &object.mesh;
        Some(match (self.map.vertices_of(id), object.kind) {
            (Some(own), _) => {
                let place = |&v: &u32| self.state.positions[v as usize];
                moved(mesh, own.iter().map(place).collect())
            }
            (None, Kind::Animated) => {
                let pose = object.motion.as_ref()?.pose(self.state.time);
                moved(
                    mesh,
                    mesh.positions.iter().map(|&p| pose.apply(p)).collect(),
                )
            }
            _ => TriangleMesh::clone(mesh),
        })
    }

    /// The triangles of a cloth between the merged vertices, as they lie now.
    pub fn merged_surface_of(&self, id: ObjectId) -> Option<TriangleMesh> {
        let own = self.map.vertices_of(id)?;
        let triangles = self.world.object(id)?.mesh.triangles.iter();
        Some(TriangleMesh {
            positions: self.state.positions.clone(),
            triangles: triangles.map(|t| t.map(|v| own[v as usize])).collect(),
        })
    }

    /// Which merged vertices pins or grips hold, and which of them grips.
    pub fn held(&self) -> (Vec<bool>, Vec<bool>) {
        let mut gripped = vec![false; self.state.positions.len()];
        for grip in &self.system.prescribed.led {
            gripped[grip.vertex as usize] = true;
        }
        let mut held = gripped.clone();
        for pin in self.world.pins(self.map) {
            held[pin as usize] = true;
        }
        (held, gripped)
    }

    /// Of some pairs of mesh vertices, in order, those that may become one: two that are held only where both are
    /// pinned at one place.
    fn joinable(&self, pairs: &[[MeshVertex; 2]]) -> Vec<bool> {
        let (held, gripped) = self.held();
        let x = &self.state.positions;
        let together = |a: u32, b: u32| {
            let [a, b] = [a as usize, b as usize];
            x[a] == x[b] && !gripped[a] && !gripped[b]
        };
        let present = pairs.iter().map(|pair| {
            let [a, b] = pair.map(|vertex| self.map.vertex(vertex));
            a.zip(b).map(|(a, b)| [a, b])
        });
        joinable(present, &held, together)
    }

    /// Refuses to merge vertices that are held apart.
    pub fn check_held(&self, pairs: &[[MeshVertex; 2]]) -> Result<(), DrapeError> {
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

    /// Pairs of vertices that attachments have drawn close enough to become one, and may.
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

/// A surface with its vertices at other places [m].
fn moved(mesh: &TriangleMesh, positions: Vec<Vec3>) -> TriangleMesh {
    TriangleMesh {
        positions,
        triangles: mesh.triangles.clone(),
    }
}
