//! Quality of a triangle mesh: angles and edge lengths.

use toile_geometry::Vec2;

/// Smallest inner angle of a triangle (rad); zero where it has no area.
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
    /// Smallest angle over triangles that no narrow outline corner forces to be sharp (rad).
    pub smallest_free_angle: f64,
    /// Triangles whose smallest angle is under 20 degrees, corner triangles left out.
    pub under_20: usize,
    /// Mean of the smallest angles of all triangles (rad).
    pub mean_smallest_angle: f64,
    /// Mean edge length (m).
    pub mean_edge: f64,
    /// Shortest edge (m).
    pub shortest_edge: f64,
    /// Longest edge (m).
    pub longest_edge: f64,
    /// Triangles with all three corners on the boundary that do not cut off one corner of it.
    pub bridging: usize,
}

/// Sums up several meshes: worst of the worst, means weighted by triangles.
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
