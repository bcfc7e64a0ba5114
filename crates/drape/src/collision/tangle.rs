//! Where cloth has crossed cloth, exactly, and the way out: each edge that pierces a face is moved
//! so that the line of intersection grows shorter (Volino and Magnenat-Thalmann 2006, Resolving
//! surface collisions through intersection contour minimization).

use super::boxes::Bounds;
use super::surface::ClothSurface;
use rayon::prelude::*;
use toile_geometry::{Vec3, segment_intersects_triangle};

/// An edge that pierces a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piercing {
    /// Ends of the edge, then corners of the face.
    pub vertices: [u32; 5],
    /// Weights of the piercing point on the edge, and negative ones on the face.
    pub weights: [f64; 5],
    /// Unit direction in which the edge is to move against the face.
    pub way: Vec3,
}

/// The cosine between edge and face's normal is not taken smaller than this: a move along the face
/// cannot help an edge that lies in it.
const FLAT: f64 = 0.15;

/// The ways out of some crossings, as [`crossings`] gives them. An edge in the plane of the face has
/// none, and neither has one in the middle of a flat sheet.
pub fn piercings(surface: &ClothSurface, crossings: &[[u32; 2]], x: &[Vec3]) -> Vec<Piercing> {
    let found = crossings.iter();
    found
        .filter_map(|&[e, t]| way_out(surface, e as usize, t as usize, x))
        .collect()
}

/// Every edge and face that cross, exactly, and share no vertex, sorted; `near` are pairs of
/// triangles that may meet.
pub fn crossings(surface: &ClothSurface, near: &[[u32; 2]], x: &[Vec3]) -> Vec<[u32; 2]> {
    let found: Vec<Vec<[u32; 2]>> = near
        .par_chunks(512)
        .map(|pairs| {
            let mut found = Vec::new();
            for &[t, u] in pairs {
                let box_of = |t: u32| {
                    let corners = surface.triangles[t as usize].map(|v| x[v as usize]);
                    Bounds::round(&corners, 0.0)
                };
                if !box_of(t).meets(&box_of(u)) {
                    continue;
                }
                for (t, u) in [(t, u), (u, t)] {
                    surface.pierced_by_own(t, u, x, &mut found);
                }
            }
            found
        })
        .collect();
    let mut found = found.concat();
    found.sort_unstable();
    found.dedup();
    found
}

impl ClothSurface {
    fn pierced_by_own(&self, t: u32, u: u32, x: &[Vec3], out: &mut Vec<[u32; 2]>) {
        let face = self.triangles[u as usize];
        let corners = face.map(|v| x[v as usize]);
        for e in self.own_edges(t) {
            let [a, b] = self.edges[e as usize];
            if face.contains(&a) || face.contains(&b) {
                continue;
            }
            let ends = [x[a as usize], x[b as usize]];
            let apart = (0..3).any(|k| {
                let (low, high) = (ends[0][k].min(ends[1][k]), ends[0][k].max(ends[1][k]));
                corners.iter().all(|c| c[k] < low) || corners.iter().all(|c| c[k] > high)
            });
            if !apart && segment_intersects_triangle(ends, corners) {
                out.push([e, u]);
            }
        }
    }
}

/// The direction of a piercing, none where the edge lies in the face or nothing is to be gained.
fn way_out(surface: &ClothSurface, e: usize, t: usize, x: &[Vec3]) -> Option<Piercing> {
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
    let way = gradient.try_normalize(1e-3)?;
    let w = toile_geometry::closest_on_face(point, [p, q, r]);
    Some(Piercing {
        vertices: [a, b, face[0], face[1], face[2]],
        weights: [1.0 - s, s, -w[0], -w[1], -w[2]],
        way,
    })
}
