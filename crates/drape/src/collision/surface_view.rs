//! What searches read of the cloth's surface: the tree of boxes and the topology.

use super::boxes::BoxTree;
use super::feature_pair::FeaturePair;
use super::leaf_aabbs::Corners;

/// Largest contact offset, as a share of the shortest edge nearby. A larger one would make contacts of features two
/// edges apart in a flat mesh.
pub const OFFSET_PER_EDGE: f64 = 0.5;

/// Borrowed view of the surface that is searched.
#[derive(Clone, Copy)]
pub struct SurfaceView<'a> {
    /// Tree over the triangles, fitted.
    pub tree: &'a BoxTree,
    /// Vertices of each leaf's triangles, leaf after leaf; start of each leaf in that list, and its end.
    pub leaf_vertices: [&'a [u32]; 2],
    /// Corners of the triangles.
    pub triangles: &'a [[u32; 3]],
    /// Ends of the edges.
    pub edges: &'a [[u32; 2]],
    /// Length of the shortest edge at each vertex (m).
    pub shortest_edge: &'a [f64],
}

impl SurfaceView<'_> {
    /// Vertices of a leaf's triangles, each once.
    pub fn leaf(&self, leaf: usize) -> &[u32] {
        let [vertices, starts] = self.leaf_vertices;
        &vertices[starts[leaf] as usize..starts[leaf + 1] as usize]
    }

    /// Vertices of the edges and triangles.
    pub fn corners(&self) -> Corners<'_> {
        Corners {
            edges: self.edges,
            triangles: self.triangles,
        }
    }

    /// Pair of a vertex and a face; none where the face has the vertex.
    pub fn vertex_face(&self, [v, t]: [u32; 2]) -> Option<FeaturePair> {
        let [a, b, c] = self.triangles[t as usize];
        (v != a && v != b && v != c).then_some(FeaturePair::VertexFace([v, a, b, c]))
    }

    /// Pair of two edges, the same in either order; none where they share a vertex.
    pub fn edge_edge(&self, [e, f]: [u32; 2]) -> Option<FeaturePair> {
        let (e, f) = (e.min(f), e.max(f));
        let ([a, b], [c, d]) = (self.edges[e as usize], self.edges[f as usize]);
        let disjoint = a != c && a != d && b != c && b != d;
        disjoint.then_some(FeaturePair::EdgeEdge([a, b, c, d]))
    }

    /// Whether an edge and a face share no vertex.
    pub fn are_disjoint(&self, [e, t]: [u32; 2]) -> bool {
        let face = self.triangles[t as usize];
        !self.edges[e as usize].iter().any(|v| face.contains(v))
    }
}
