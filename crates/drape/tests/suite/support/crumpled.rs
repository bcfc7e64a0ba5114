//! Crumpled sheets, and all that may be near in them.

use super::numbers::Numbers;
use super::sheets::sheet;
use toile_drape::collision::FeaturePair;
use toile_geometry::{TriangleMesh, Vec3};

/// A sheet crumpled by a few waves.
pub fn crumpled(seed: u64, n: usize) -> TriangleMesh {
    let mut numbers = Numbers(seed + 1);
    let waves: Vec<(Vec3, f64, f64, f64)> = (0..6)
        .map(|_| {
            let (a, b, c) = (numbers.next(), numbers.next(), numbers.next());
            (numbers.vector(0.15), 12.0 * a, 12.0 * b, 6.3 * c)
        })
        .collect();
    sheet([n; 2], [1.0; 2], |u, v| {
        let flat = Vec3::new(0.4 * u, 0.0, 0.4 * v);
        flat + waves
            .iter()
            .map(|&(way, a, b, c)| way * (a * u + b * v + c).sin())
            .sum::<Vec3>()
    })
}

/// Every vertex with every face, and every two edges, that share no vertex.
pub fn all_pairs(mesh: &TriangleMesh) -> Vec<FeaturePair> {
    let edges = mesh.topology().edges;
    let mut pairs = Vec::new();
    for v in 0..mesh.positions.len() as u32 {
        for face in mesh.triangles.iter().filter(|face| !face.contains(&v)) {
            pairs.push(FeaturePair::VertexFace([v, face[0], face[1], face[2]]));
        }
    }
    for (k, &[a, b]) in edges.iter().enumerate() {
        for &[c, d] in edges[k + 1..]
            .iter()
            .filter(|e| !e.contains(&a) && !e.contains(&b))
        {
            pairs.push(FeaturePair::EdgeEdge([a, b, c, d]));
        }
    }
    pairs
}
