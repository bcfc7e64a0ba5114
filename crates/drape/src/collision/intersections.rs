//! Edge-face intersections of cloth with cloth, by exact predicates, and for each the direction in which the edge has
//! to move against the face so that the intersection contour grows shorter (Volino and Magnenat-Thalmann 2006,
//! Resolving surface collisions through intersection contour minimization).

use super::candidate_search::Near;
use super::surface::ClothSurface;
use toile_geometry::{Vec3, closest_on_face, segment_intersects_triangle};

/// An edge that crosses a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeFaceIntersection {
    /// Ends of the edge, then corners of the face.
    pub vertices: [u32; 5],
    /// Barycentric weights of the intersection point on the edge, and their negatives on the face.
    pub weights: [f64; 5],
    /// Unit direction in which the edge has to move against the face: the negative gradient of the contour's length
    /// or, between two layers, the outward normal of the inner one.
    pub direction: Vec3,
}

/// Lower bound of the cosine between the edge and the face's normal, by which the gradient divides: without it an
/// edge that nearly lies in the face would get a direction along the face alone.
const MIN_SLOPE: f64 = 0.15;

/// The intersections of `crossings` (edge and face, see [`crossings`]) with their contour directions. Pairs without a
/// direction are left out: edges in the plane of the face, and edges in the middle of a flat sheet.
pub fn edge_face_intersections(
    surface: &ClothSurface,
    crossings: &[[u32; 2]],
    x: &[Vec3],
) -> Vec<EdgeFaceIntersection> {
    let found = crossings.iter();
    found
        .filter_map(|&[e, t]| contour_direction(surface, e as usize, t as usize, x))
        .collect()
}

/// Every edge and face among the near pairs that intersect by exact predicates and share no vertex, sorted.
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

/// The geometry of an edge and a face that cross.
pub(super) struct CrossingGeometry {
    /// Ends of the edge.
    pub edge: [u32; 2],
    /// Corners of the face.
    pub face: [u32; 3],
    /// Positions of the corners (m).
    corners: [Vec3; 3],
    /// Unit normal of the face.
    pub normal: Vec3,
    /// Parameter of the intersection point on the edge, 0 at its first end.
    parameter: f64,
    /// The intersection point (m).
    pub point: Vec3,
}

impl CrossingGeometry {
    /// The edge `e` and the face `t` at positions `x`; none for a face without area.
    pub fn new(surface: &ClothSurface, e: usize, t: usize, x: &[Vec3]) -> Option<Self> {
        let (edge, face) = (surface.edges[e], surface.triangles[t]);
        let [start, end] = edge.map(|v| x[v as usize]);
        let corners = face.map(|v| x[v as usize]);
        let normal = area_vector(corners).try_normalize(0.0)?;
        let [above, below] = [start, end].map(|p| (p - corners[0]).dot(&normal));
        let parameter = match above == below {
            true => 0.5,
            false => (above / (above - below)).clamp(0.0, 1.0),
        };
        Some(Self {
            edge,
            face,
            corners,
            normal,
            parameter,
            point: start + (end - start) * parameter,
        })
    }

    /// The intersection, with the unit direction in which the edge has to move against the face.
    pub fn with_direction(&self, direction: Vec3) -> EdgeFaceIntersection {
        let ([a, b], [c, d, e]) = (self.edge, self.face);
        let w = closest_on_face(self.point, self.corners);
        EdgeFaceIntersection {
            vertices: [a, b, c, d, e],
            weights: [1.0 - self.parameter, self.parameter, -w[0], -w[1], -w[2]],
            direction,
        }
    }
}

/// Normal of a triangle, twice as long as its area (m2).
pub(super) fn area_vector([a, b, c]: [Vec3; 3]) -> Vec3 {
    (b - a).cross(&(c - a))
}

/// The intersection with the direction that shortens the contour of the edge with the face; none where the edge lies
/// in the face or no direction shortens it.
fn contour_direction(
    surface: &ClothSurface,
    e: usize,
    t: usize,
    x: &[Vec3],
) -> Option<EdgeFaceIntersection> {
    let crossing = CrossingGeometry::new(surface, e, t, x)?;
    let (normal, point) = (crossing.normal, crossing.point);
    let [a, b] = crossing.edge;
    let along = (x[b as usize] - x[a as usize]).try_normalize(0.0)?;
    let slope = along.dot(&normal);
    let slope = slope.abs().max(MIN_SLOPE) * if slope < 0.0 { -1.0 } else { 1.0 };
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
    Some(crossing.with_direction(direction))
}
