//! Fairing: small bumps of a mesh taken away without shrinking it.

use toile_geometry::{TriangleMesh, Vec3};

/// Passes of shrinking and swelling: bumps shorter than about six edges go, longer forms stay.
const PASSES: usize = 6;
/// Share of the way to the neighbours' mean in the shrinking half of a pass.
const SHRINK: f64 = 0.5;
/// The same for the swelling half: slightly larger, so that the mesh keeps its volume
/// (Taubin 1995, pass band 0.1).
const SWELL: f64 = -0.526;

/// Fairs a mesh in place. Vertices for which `fixed` holds stay.
pub(crate) fn fair(mesh: &mut TriangleMesh, fixed: impl Fn(usize, Vec3) -> bool) {
    let edges = mesh.topology().edges;
    let mut count = vec![0.0; mesh.positions.len()];
    for &[a, b] in &edges {
        count[a as usize] += 1.0;
        count[b as usize] += 1.0;
    }
    let held: Vec<bool> = mesh
        .positions
        .iter()
        .enumerate()
        .map(|(v, &p)| fixed(v, p))
        .collect();
    for _ in 0..PASSES {
        for share in [SHRINK, SWELL] {
            let mut sum = vec![Vec3::zeros(); mesh.positions.len()];
            for &[a, b] in &edges {
                sum[a as usize] += mesh.positions[b as usize];
                sum[b as usize] += mesh.positions[a as usize];
            }
            for v in 0..sum.len() {
                if !held[v] && count[v] > 0.0 {
                    let p = mesh.positions[v];
                    mesh.positions[v] = p + (sum[v] / count[v] - p) * share;
                }
            }
        }
    }
}
