//! Smooths small bumps of a mesh without shrinking it.

use toile_geometry::{TriangleMesh, Vec3};

/// Number of passes of shrinking and swelling: bumps shorter than about six edges vanish, longer forms stay.
const PASSES: usize = 6;
/// Share of the way to the neighbours' mean in the shrinking half of a pass.
const SHRINK: f64 = 0.5;
/// Share of that way in the swelling half: slightly larger, so that the mesh keeps its volume (Taubin 1995,
/// pass band 0.1).
const SWELL: f64 = -0.526;

/// Fairs a closed oriented mesh in place. Vertices for which `fixed` is true do not move.
pub(crate) fn fair(mesh: &mut TriangleMesh, fixed: impl Fn(usize, Vec3) -> bool) {
    // In a closed oriented mesh every neighbour of a vertex is exactly once the end of an edge that starts at
    // the vertex.
    let mut count = vec![0.0; mesh.positions.len()];
    for &v in mesh.triangles.iter().flatten() {
        count[v as usize] += 1.0;
    }
    let held: Vec<bool> = mesh
        .positions
        .iter()
        .enumerate()
        .map(|(v, &p)| fixed(v, p) || count[v] == 0.0)
        .collect();
    let mut sum = vec![Vec3::zeros(); mesh.positions.len()];
    for _ in 0..PASSES {
        for share in [SHRINK, SWELL] {
            sum.fill(Vec3::zeros());
            for &[a, b, c] in &mesh.triangles {
                let [pa, pb, pc] = [a, b, c].map(|v| mesh.positions[v as usize]);
                sum[a as usize] += pb;
                sum[b as usize] += pc;
                sum[c as usize] += pa;
            }
            for (v, p) in mesh.positions.iter_mut().enumerate() {
                if !held[v] {
                    *p += (sum[v] / count[v] - *p) * share;
                }
            }
        }
    }
}
