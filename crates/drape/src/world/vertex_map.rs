//! The map from the vertices and triangles of the objects' meshes to those of the merged cloth.

use super::{MeshVertex, ObjectId, World};
use crate::merge::{keeps_corners, merge_map};
use std::ops::Range;

/// The ranges of one object's vertices and triangles in the concatenation of all cloths, before merging.
#[derive(Clone, Debug)]
struct ClothSpan {
    object: ObjectId,
    vertices: Range<u32>,
    triangles: Range<u32>,
}

/// The map from the objects' meshes to the merged cloth and back. The unmerged number of a vertex or triangle is that
/// in the concatenation of all cloths.
#[derive(Clone, Debug, Default)]
pub struct VertexMap {
    /// In order of the objects.
    spans: Vec<ClothSpan>,
    /// The merged vertex of each unmerged one.
    pub target: Vec<u32>,
    /// Number of merged vertices.
    pub count: usize,
    /// The unmerged triangle of each merged one.
    pub triangles: Vec<u32>,
}

impl VertexMap {
    /// The map of the deformable objects of a world.
    pub(super) fn new(world: &World) -> Self {
        let mut spans = Vec::new();
        let mut corners: Vec<[u32; 3]> = Vec::new();
        let mut vertices = 0;
        for (object, cloth) in world.cloths() {
            let first = corners.len() as u32;
            let own = cloth.triangles.iter();
            corners.extend(own.map(|t| t.map(|v| v + vertices)));
            let end = vertices + cloth.positions.len() as u32;
            spans.push(ClothSpan {
                object,
                vertices: vertices..end,
                triangles: first..corners.len() as u32,
            });
            vertices = end;
        }
        let mut map = Self {
            spans,
            ..Self::default()
        };
        let pairs = world.merged().filter_map(|pair| {
            let [a, b] = pair.map(|vertex| map.unmerged(vertex));
            Some([a?, b?])
        });
        let (target, count) = merge_map(vertices as usize, pairs);
        let keeps = |t: &u32| keeps_corners(corners[*t as usize], &target);
        map.triangles = (0..corners.len() as u32).filter(keeps).collect();
        (map.target, map.count) = (target, count);
        map
    }

    fn span(&self, object: ObjectId) -> Option<&ClothSpan> {
        let found = self.spans.binary_search_by_key(&object, |s| s.object);
        found.ok().map(|at| &self.spans[at])
    }

    /// The unmerged number of a vertex; none where the object is no cloth or has no such vertex.
    fn unmerged(&self, vertex: MeshVertex) -> Option<u32> {
        let span = self.span(vertex.object)?;
        let v = span.vertices.start + vertex.vertex;
        span.vertices.contains(&v).then_some(v)
    }

    /// The merged vertex of a vertex of an object's mesh; none where the object is no cloth.
    pub fn vertex(&self, vertex: MeshVertex) -> Option<u32> {
        self.unmerged(vertex).map(|v| self.target[v as usize])
    }

    /// The merged vertices of an object in the order of its mesh; none where it is no cloth.
    pub fn vertices_of(&self, object: ObjectId) -> Option<&[u32]> {
        let span = self.span(object)?;
        let own = span.vertices.start as usize..span.vertices.end as usize;
        Some(&self.target[own])
    }

    /// The deformable objects, in order.
    pub fn objects(&self) -> impl Iterator<Item = ObjectId> + '_ {
        self.spans.iter().map(|span| span.object)
    }

    /// The object of an unmerged triangle, and the triangle's number in the object's mesh.
    pub(super) fn triangle(&self, unmerged: u32) -> Option<(ObjectId, u32)> {
        let at = (self.spans).partition_point(|span| span.triangles.end <= unmerged);
        let span = self.spans.get(at)?;
        Some((span.object, unmerged - span.triangles.start))
    }
}
