//! Where the vertices and triangles of the objects' own meshes are in the one cloth that is simulated.

use super::{MeshVertex, ObjectId, World};
use crate::merge::{keeps_corners, merge_map};
use std::ops::Range;

/// The vertices and triangles of one object among those of all cloths, not yet merged.
#[derive(Clone, Debug)]
struct ClothSpan {
    object: ObjectId,
    vertices: Range<u32>,
    triangles: Range<u32>,
}

/// From the objects' own meshes to the merged cloth and back.
#[derive(Clone, Debug, Default)]
pub struct VertexMap {
    /// In order of the objects.
    spans: Vec<ClothSpan>,
    /// Merged vertex of each vertex of the objects' meshes, laid end to end.
    pub target: Vec<u32>,
    /// How many merged vertices there are.
    pub count: usize,
    /// For each triangle of the merged cloth the one of the objects' meshes, laid end to end.
    pub triangles: Vec<u32>,
}

impl VertexMap {
    /// Of the deformable objects of a world.
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
        let stays = |t: &u32| keeps_corners(corners[*t as usize], &target);
        map.triangles = (0..corners.len() as u32).filter(stays).collect();
        (map.target, map.count) = (target, count);
        map
    }

    fn span(&self, object: ObjectId) -> Option<&ClothSpan> {
        let found = self.spans.binary_search_by_key(&object, |s| s.object);
        found.ok().map(|at| &self.spans[at])
    }

    /// The place of a vertex among those of all cloths, laid end to end.
    fn unmerged(&self, vertex: MeshVertex) -> Option<u32> {
        let span = self.span(vertex.object)?;
        let v = span.vertices.start + vertex.vertex;
        span.vertices.contains(&v).then_some(v)
    }

    /// The merged vertex that a vertex of an object's mesh is; none where the object is no cloth.
    pub fn vertex(&self, vertex: MeshVertex) -> Option<u32> {
        self.unmerged(vertex).map(|v| self.target[v as usize])
    }

    /// The merged vertices of an object, in the order of its mesh; none where it is no cloth.
    pub fn vertices_of(&self, object: ObjectId) -> Option<&[u32]> {
        let span = self.span(object)?;
        let own = span.vertices.start as usize..span.vertices.end as usize;
        Some(&self.target[own])
    }

    /// Objects that are cloth, in order.
    pub fn objects(&self) -> impl Iterator<Item = ObjectId> + '_ {
        self.spans.iter().map(|span| span.object)
    }

    /// The object and its own number of a triangle laid end to end.
    pub(super) fn triangle(&self, unmerged: u32) -> Option<(ObjectId, u32)> {
        let at = (self.spans).partition_point(|span| span.triangles.end <= unmerged);
        let span = self.spans.get(at)?;
        Some((span.object, unmerged - span.triangles.start))
    }
}
