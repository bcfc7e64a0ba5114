//! Where cloth has crossed cloth, exactly, and the way out: each edge that crosses a face is moved
//! so that the line of intersection grows shorter (Volino and Magnenat-Thalmann 2006, Resolving
//! surface collisions through intersection contour minimization).

use super::candidate_search::Near;
use super::surface::ClothSurface;
use toile_geometry::{Vec3, segment_intersects_triangle};

/// An edge that crosses a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeFaceIntersection {
    /// Ends of the edge, then corners of the face.
    pub vertices: [u32; 5],
    /// Weights of the common point on the edge, and negative ones on the face.
    pub weights: [f64; 5],
    /// Unit direction in which the edge is to move against the face: against the gradient of the
    /// contour's length or, between two layers, out.
    pub direction: Vec3,
}

/// The cosine between edge and face's normal is not taken smaller than this: a move along the face
/// cannot help an edge that lies in it.
const FLAT: f64 = 0.15;

/// The directions out of some crossings, as [`crossings`] gives them, by their contour. An edge in the
/// plane of the face has none, and neither has one in the middle of a flat sheet.
pub fn edge_face_intersections(
    surface: &ClothSurface,
    crossings: &[[u32; 2]],
    x: &[Vec3],
) -> Vec<EdgeFaceIntersection> {
    let found = crossings.iter();
    found
        .filter_map(|&[e, t]| along_contour(surface, e as usize, t as usize, x))
        .collect()
}

/// Every edge and face that cross, exactly, and share no vertex, of those that are near, sorted.
pub fn crossings<'a>(
    surface: &ClothSurface,
    near: impl Into<Near<'a>>,
    x: &[Vec3],
) -> Vec<[u32; 2]> {
    let mut found = surface.edges_and_faces(near, |[e, t]| {
        let ends = surface.edges[e as usize].map(|v| x[v as usize]);
        let corners = surface.triangles[t as usize].map(|v| x[v as usize]);
        let apart = (0..3).any(|k| {
            let (low, high) = (ends[0][k].min(ends[1][k]), ends[0][k].max(ends[1][k]));
            corners.iter().all(|c| c[k] < low) || corners.iter().all(|c| c[k] > high)
        });
        !apart && segment_intersects_triangle(ends, corners)
    });
    found.sort_unstable();
    found
}

/// The direction in which an edge shortens its contour with a face; none where the edge lies in the face or
/// no direction shortens it.
fn along_contour(
    surface: &ClothSurface,
    e: usize,
    t: usize,
    x: &[Vec3],
) -> Option<EdgeFaceIntersection> {
    let [a, b] = surface.edges[e];
    let face = surface.triangles[t];
    let (pa, pb) = (x[a as usize], x[b as usize]);
    let [p, q, r] = face.map(|v| x[v as usize]);
    let along = (pb - pa).try_normalize(0.0)?;
    let normal = (q - p).cross(&(r - p)).try_normalize(0.0)?;
    let (da, db) = ((pa - p).dot(&normal), (pb - p).dot(&normal));
    let s = if da == db {
        0.5
    } else {
        (da / (da - db)).clamp(0.0, 1.0)
    };
    let point = pa + (pb - pa) * s;
    let slope = along.dot(&normal);
    let slope = slope.abs().max(FLAT) * if slope < 0.0 { -1.0 } else { 1.0 };
    let mut gradient = Vec3::zeros();
    for &of in &surface.edge_triangles[e] {
        let Some(third) = surface.triangles[of as usize]
            .into_iter()
            .find(|v| ![a, b].contains(v))
        else {
            continue;
        };
        let inward = x[third as usize] - point;
        let own = along.cross(&inward);
        let Some(line) = own.cross(&normal).try_normalize(0.0) else {
            continue;
        };
        let inward = inward - along * inward.dot(&along);
        let line = if line.dot(&inward) < 0.0 { -line } else { line };
        gradient += line - normal * (2.0 * along.dot(&line) / slope);
    }
    let direction = gradient.try_normalize(1e-3)?;
    let w = toile_geometry::closest_on_face(point, [p, q, r]);
    Some(EdgeFaceIntersection {
        vertices: [a, b, face[0], face[1], face[2]],
        weights: [1.0 - s, s, -w[0], -w[1], -w[2]],
        direction,
    })
}
