//! Plane sections of a mesh and the girth a tight tape would measure round them.

use crate::{TriangleMesh, Vec2, Vec3};

/// Points where the edges of some triangles cross the horizontal plane at `height` (m), as
/// (x, z). Vertices that lie in the plane count as above it.
pub fn horizontal_section(
    mesh: &TriangleMesh,
    triangles: impl IntoIterator<Item = usize>,
    height: f64,
) -> Vec<Vec2> {
    let mut points = Vec::new();
    for t in triangles {
        let corners = mesh.corners(t);
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            if let Some(p) = crossing(a, b, height) {
                points.push(Vec2::new(p.x, p.z));
            }
        }
    }
    points
}

/// Where the segment crosses the plane at `height`, the same from both ends.
fn crossing(a: Vec3, b: Vec3, height: f64) -> Option<Vec3> {
    if (a.y >= height) == (b.y >= height) {
        return None;
    }
    let (low, high) = if a.y < b.y { (a, b) } else { (b, a) };
    Some(low + (high - low) * ((height - low.y) / (high.y - low.y)))
}

/// Length of a closed polygon (m).
pub fn closed_length(polygon: &[Vec2]) -> f64 {
    (0..polygon.len())
        .map(|k| (polygon[(k + 1) % polygon.len()] - polygon[k]).norm())
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::convex_hull;

    /// An open tube of `n` sides with half-axes `a` and `b`.
    fn tube(a: f64, b: f64, n: usize) -> TriangleMesh {
        let mut mesh = TriangleMesh::default();
        for y in [0.0, 1.0] {
            for k in 0..n {
                let t = std::f64::consts::TAU * k as f64 / n as f64;
                mesh.positions.push(Vec3::new(a * t.cos(), y, b * t.sin()));
            }
        }
        let n = n as u32;
        for k in 0..n {
            let next = (k + 1) % n;
            mesh.triangles.push([k, next, n + next]);
            mesh.triangles.push([k, n + next, n + k]);
        }
        mesh
    }

    #[test]
    fn tape_round_a_cylinder_and_an_ellipse() {
        let girth = |a: f64, b: f64| {
            let mesh = tube(a, b, 400);
            let section = horizontal_section(&mesh, 0..mesh.triangles.len(), 0.4321);
            closed_length(&convex_hull(&section))
        };
        assert!((girth(0.15, 0.15) - std::f64::consts::TAU * 0.15).abs() < 1e-4);
        // Ramanujan 1914, exact to 1e-9 at this axis ratio.
        let (a, b) = (0.2f64, 0.13f64);
        let h = ((a - b) / (a + b)).powi(2);
        let exact =
            std::f64::consts::PI * (a + b) * (1.0 + 3.0 * h / (10.0 + (4.0 - 3.0 * h).sqrt()));
        assert!((girth(a, b) - exact).abs() < 1e-4);
    }

    #[test]
    fn sections_through_vertices_and_beside_the_mesh() {
        let mesh = tube(0.1, 0.1, 12);
        let all = 0..mesh.triangles.len();
        assert!(horizontal_section(&mesh, all.clone(), 2.0).is_empty());
        assert!(!horizontal_section(&mesh, all.clone(), 1.0).is_empty());
        assert!(horizontal_section(&mesh, all, f64::NAN).is_empty());
        assert_eq!(closed_length(&[]), 0.0);
    }
}
