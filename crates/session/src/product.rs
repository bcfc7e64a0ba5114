//! Writes a draped garment as glTF and OBJ, one group for each panel.

use crate::GarmentPart;
use crate::drape::Drape;
use std::ops::Range;
use toile_geometry::{TriangleMesh, Vec3};
use toile_interchange::{GlbMesh, GlbPrimitive, GlbScene, ObjGroup, ObjMesh};

/// For each panel, the range of its triangles in the merged mesh.
fn panel_triangles(drape: &Drape) -> Vec<Range<usize>> {
    let mut first = 0;
    drape
        .job
        .garment
        .panels
        .iter()
        .map(|panel| {
            let end = drape
                .origin
                .partition_point(|&t| (t as usize) < panel.triangles.end);
            let range = first..end;
            first = end;
            range
        })
        .collect()
}

/// One mesh for each garment worn, with a primitive for each panel. UVs are positions in the plane of the
/// piece (m).
pub(crate) fn garment_glb(drape: &Drape) -> GlbScene {
    let runs = panel_triangles(drape);
    let normals = drape.normals();
    let meshes = drape.job.parts.iter().map(|part| GlbMesh {
        name: part.name.clone(),
        primitives: part
            .panels
            .clone()
            .map(|panel| primitive(drape, panel, runs[panel].clone(), &normals))
            .collect(),
    });
    GlbScene {
        meshes: meshes.collect(),
    }
}

/// A panel with its own vertices.
fn primitive(drape: &Drape, panel: usize, run: Range<usize>, normals: &[Vec3]) -> GlbPrimitive {
    let garment = &drape.job.garment;
    let look = &drape.job.panels[panel];
    let panel = &garment.panels[panel];
    let merged = |v: usize| drape.target[v] as usize;
    let first = panel.vertices.start as u32;
    GlbPrimitive {
        name: panel.name.clone(),
        positions: panel
            .vertices
            .clone()
            .map(|v| drape.mesh.positions[merged(v)])
            .collect(),
        normals: panel.vertices.clone().map(|v| normals[merged(v)]).collect(),
        uvs: Some(
            garment.flat[panel.vertices.clone()]
                .iter()
                .map(|p| [p.x, p.y])
                .collect(),
        ),
        triangles: drape.origin[run]
            .iter()
            .map(|&t| garment.triangles[t as usize].map(|v| v - first))
            .collect(),
        colour: look.colour,
    }
}

/// The garment as one welded mesh with a group for each panel; texture coordinates are positions in the
/// planes of the pieces (m).
pub(crate) fn garment_obj(drape: &Drape) -> ObjMesh {
    let garment = &drape.job.garment;
    let apart: Vec<[u32; 3]> = drape
        .origin
        .iter()
        .map(|&t| garment.triangles[t as usize])
        .collect();
    ObjMesh {
        positions: drape.mesh.positions.clone(),
        triangles: drape.mesh.triangles.clone(),
        texture: garment.flat.clone(),
        texture_triangles: apart,
        normals: drape.normals(),
        normal_triangles: drape.mesh.triangles.clone(),
        groups: garment
            .panels
            .iter()
            .zip(panel_triangles(drape))
            .map(|(panel, triangles)| ObjGroup {
                name: panel.name.clone(),
                triangles,
            })
            .collect(),
    }
}

/// A body as OBJ.
pub(crate) fn body_obj(skin: &TriangleMesh) -> ObjMesh {
    ObjMesh {
        normals: skin.vertex_normals(),
        normal_triangles: skin.triangles.clone(),
        ..ObjMesh::from(skin.clone())
    }
}

impl Drape {
    /// The range of triangles of the draped mesh that belong to one of the garments worn.
    pub fn part_triangles(&self, part: &GarmentPart) -> Range<usize> {
        let bound = |at: usize| self.origin.partition_point(|&t| (t as usize) < at);
        bound(part.triangles.start)..bound(part.triangles.end)
    }

    /// Mesh of one of the garments worn, by itself.
    pub fn part_mesh(&self, part: &GarmentPart) -> TriangleMesh {
        let mut number = vec![u32::MAX; self.mesh.positions.len()];
        let mut mesh = TriangleMesh::default();
        for t in self.part_triangles(part) {
            let corners = self.mesh.triangles[t].map(|v| {
                let number = &mut number[v as usize];
                if *number == u32::MAX {
                    *number = mesh.positions.len() as u32;
                    mesh.positions.push(self.mesh.positions[v as usize]);
                }
                *number
            });
            mesh.triangles.push(corners);
        }
        mesh
    }

    /// One file for each garment if several are worn: `layer-1-shirt.obj`, innermost first. Empty for a
    /// single garment.
    pub fn part_files(&self) -> Vec<(String, ObjMesh)> {
        let mut parts: Vec<&GarmentPart> = self.job.parts.iter().collect();
        if parts.len() < 2 {
            return Vec::new();
        }
        parts.sort_by_key(|part| part.layer);
        let each = parts.into_iter().enumerate();
        each.map(|(k, part)| {
            let plain = |c: char| match c.is_alphanumeric() {
                true => c.to_ascii_lowercase(),
                false => '-',
            };
            let name: String = part.name.chars().map(plain).collect();
            let mesh = self.part_mesh(part);
            let obj = ObjMesh {
                normals: mesh.vertex_normals(),
                normal_triangles: mesh.triangles.clone(),
                ..ObjMesh::from(mesh)
            };
            (format!("layer-{}-{name}.obj", k + 1), obj)
        })
        .collect()
    }
}
