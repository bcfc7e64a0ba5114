//! The surface of the cloth as searches see it.

use super::boxes::BoxTree;
use super::feature_pair::FeaturePair;
use super::leaf_aabbs::Corners;

/// Share of the shortest edge nearby above which no distance is kept: neighbours are not contacts.
pub const ROOM: f64 = 0.5;

/// The cloth that is searched.
#[derive(Clone, Copy)]
pub struct SurfaceView<'a> {
    /// The tree over its triangles, fitted.
    pub tree: &'a BoxTree,
    /// The corners of each leaf's triangles, leaf after leaf; where those of each begin, and the end.
    pub leaf_vertices: [&'a [u32]; 2],
    /// Corners of the triangles.
    pub triangles: &'a [[u32; 3]],
    /// Ends of the edges.
    pub edges: &'a [[u32; 2]],
    /// Length of the shortest edge at each vertex [m].
    pub room: &'a [f64],
}

impl SurfaceView<'_> {
    /// The vertices of a leaf.
    pub fn leaf(&self, leaf: usize) -> &[u32] {
        let [vertices, starts] = self.leaf_vertices;
        &vertices[starts[leaf] as usize..starts[leaf + 1] as usize]
    }

    /// Its features.
    pub fn corners(&self) -> Corners<'_> {
        Corners {
            edges: self.edges,
            triangles: self.triangles,
        }
    }

    /// A vertex and a face; nothing where the face has the vertex.
    pub fn vertex_face(&self, [v, t]: [u32; 2]) -> Option<FeaturePair> {
        let [a, b, c] = self.triangles[t as usize];
        (v != a && v != b && v != c).then_some(FeaturePair::VertexFace([v, a, b, c]))
    }

    /// Two edges, the same whichever comes first; nothing where they share a vertex.
    pub fn edge_edge(&self, [e, f]: [u32; 2]) -> Option<FeaturePair> {
        let (e, f) = (e.min(f), e.max(f));
        let ([a, b], [c, d]) = (self.edges[e as usize], self.edges[f as usize]);
        let apart = a != c && a != d && b != c && b != d;
        apart.then_some(FeaturePair::EdgeEdge([a, b, c, d]))
    }

    /// Whether an edge and a face share no vertex.
    pub fn are_apart(&self, [e, t]: [u32; 2]) -> bool {
        let face = self.triangles[t as usize];
        !self.edges[e as usize].iter().any(|v| face.contains(v))
    }
}
