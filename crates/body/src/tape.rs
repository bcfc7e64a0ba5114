//! Girths and landmarks taken from a skin.

use crate::Part;
use toile_geometry::{TriangleMesh, Vec3, closed_length, convex_hull, horizontal_section};

/// Girth of one part at a height by a horizontal tape, the convex hull of the section [m]; zero
/// where the part has no section.
pub(crate) fn girth(mesh: &TriangleMesh, parts: &[Part], part: Part, height: f64) -> f64 {
    let triangles = (0..mesh.triangles.len()).filter(|&t| parts[t] == part);
    closed_length(&convex_hull(&horizontal_section(mesh, triangles, height)))
}

/// Girth of one part in the plane through `origin` across `normal` (a unit vector) [m].
pub(crate) fn girth_across(
    mesh: &TriangleMesh,
    parts: &[Part],
    part: Part,
    [origin, normal]: [Vec3; 2],
) -> f64 {
    let turn = nalgebra::Rotation3::rotation_between(&normal, &Vec3::y()).unwrap_or_else(|| {
        nalgebra::Rotation3::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI)
    });
    let turned = TriangleMesh {
        positions: mesh.positions.iter().map(|p| turn * (p - origin)).collect(),
        triangles: mesh.triangles.clone(),
    };
    girth(&turned, parts, part, 0.0)
}

/// The highest point of the skin over a place on the left side, searched along z at fixed `x`
/// above height `from` [m], leaving out the head above `to` [m].
pub(crate) fn ridge(mesh: &TriangleMesh, x: f64, [from, to]: [f64; 2]) -> Option<Vec3> {
    let mut best: Option<Vec3> = None;
    for t in 0..mesh.triangles.len() {
        let corners = mesh.corners(t);
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            if (a.x >= x) == (b.x >= x) {
                continue;
            }
            let p = a + (b - a) * ((x - a.x) / (b.x - a.x));
            if p.y >= from && p.y <= to && best.is_none_or(|q| p.y > q.y) {
                best = Some(p);
            }
        }
    }
    best
}
