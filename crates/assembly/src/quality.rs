//! Quality of a triangle mesh: angles and edge lengths.

use toile_geometry::Vec2;

/// Smallest inner angle of a triangle (rad); zero for a triangle without area.
pub fn smallest_angle(corners: [Vec2; 3]) -> f64 {
    let [a, b, c] = corners;
    let doubled = (b - a).perp(&(c - a)).abs();
    let angle = |p: Vec2, q: Vec2, r: Vec2| doubled.atan2((q - p).dot(&(r - p)));
    angle(a, b, c).min(angle(b, c, a)).min(angle(c, a, b))
}

/// Angles and edge lengths of a mesh in the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MeshQuality {
    /// Number of triangles.
    pub triangles: usize,
    /// Smallest angle (rad).
    pub smallest_angle: f64,
    /// Smallest angle of the triangles that are not forced to be sharp by a narrow corner of the outline
    /// (rad).
    pub smallest_free_angle: f64,
    /// Number of triangles with a smallest angle under 20 degrees, without those at narrow corners.
    pub under_20: usize,
    /// Mean of the smallest angles of all triangles (rad).
    pub mean_smallest_angle: f64,
    /// Mean edge length (m).
    pub mean_edge: f64,
    /// Shortest edge (m).
    pub shortest_edge: f64,
    /// Longest edge (m).
    pub longest_edge: f64,
    /// Number of triangles with all three corners on the boundary that do not just cut off a corner of it.
    pub bridging: usize,
}

/// Combines several meshes: the worst of the extremes, means weighted by triangles.
pub fn combine(parts: &[MeshQuality]) -> MeshQuality {
    let mut all = MeshQuality {
        smallest_angle: f64::INFINITY,
        smallest_free_angle: f64::INFINITY,
        shortest_edge: f64::INFINITY,
        ..MeshQuality::default()
    };
    for part in parts {
        let weight = part.triangles as f64;
        all.triangles += part.triangles;
        all.under_20 += part.under_20;
        all.bridging += part.bridging;
        all.smallest_angle = all.smallest_angle.min(part.smallest_angle);
        all.smallest_free_angle = all.smallest_free_angle.min(part.smallest_free_angle);
        all.shortest_edge = all.shortest_edge.min(part.shortest_edge);
        all.longest_edge = all.longest_edge.max(part.longest_edge);
        all.mean_edge += weight * part.mean_edge;
        all.mean_smallest_angle += weight * part.mean_smallest_angle;
    }
    let total = all.triangles.max(1) as f64;
    all.mean_edge /= total;
    all.mean_smallest_angle /= total;
    all
}
