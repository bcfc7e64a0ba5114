//! Convex edges of a moving solid near edges of the cloth that cross over them.

use super::skin_look::{Look, NEAR, Near};
use rayon::prelude::*;
use toile_geometry::{MovingSurface, Vec3, closest_on_segments};

/// Share of an edge next to its ends: what comes nearest there is kept off by samples of the cloth, or by a vertex.
const END: f64 = 0.02;
/// Height of the arc that the surface makes under an edge of the cloth, over the contact offset, below which it is flat
/// there: the rest of the offset is left when the ends of the edge are kept off.
const FLAT: f64 = 0.4;
/// The same at a vertex for faces of the cloth: in a pinch samples keep off less than the offset.
const FLAT_IN_PINCH: f64 = 0.1;
/// Least cosine between the normal of an edge and the common normal of both edges, where the normals of the triangles at
/// the edge differ by less.
const FACING: f64 = 0.5;
/// Area of an equilateral triangle over the square of its side: the cloth that meets an edge.
const OF_SQUARE: f64 = 0.433;
/// Greatest depth of the cloth behind an edge at which it still is on the outer side, over the contact offset.
const DEPTH: f64 = 1.0;

/// How sharp the sides of a surface are at the start of a step, by triangle and side; those are left out that are far from
/// the cloth.
pub(super) struct Ridges(Vec<[Ridge; 3]>);

impl Ridges {
    /// Those that the cloth may come near in the step.
    pub fn of(look: &Look) -> Self {
        let surface = look.surface;
        let near = look.within();
        let triangles = surface.triangles().par_iter().enumerate();
        let ridges = triangles.with_min_len(512).map(|(t, corners)| {
            match corners.iter().any(|&v| near.contains(surface, v)) {
                true => [0, 1, 2].map(|side| Ridge::at(surface, t as u32, side)),
                false => Default::default(),
            }
        });
        Self(ridges.collect())
    }

    /// Whether the surface is sharp at each vertex for the longest edge of the cloth: elsewhere no face of the cloth comes
    /// nearer to it than its samples let.
    pub fn sharp_vertices(&self, look: &Look) -> Vec<bool> {
        let half = 0.5 * look.cloth.longest_side() as f32;
        let least = (FLAT_IN_PINCH * look.system.contact.offset) as f32;
        let mut sharp = vec![false; look.surface.starts().len()];
        for (corners, ridges) in look.surface.triangles().iter().zip(&self.0) {
            for (side, ridge) in ridges.iter().enumerate() {
                if ridge.over_chord(half) > least {
                    sharp[corners[side] as usize] = true;
                    sharp[corners[(side + 1) % 3] as usize] = true;
                }
            }
        }
        sharp
    }
}

/// All edges that come near an edge of the cloth in the step, in order of the latter.
pub(super) fn edges_near(look: &Look, Ridges(ridges): &Ridges) -> Vec<Near> {
    let triangles = look.cloth.triangles().par_iter().enumerate();
    let near = triangles.with_min_len(128).flat_map_iter(|(t, corners)| {
        let sides = (0..3).filter(move |&side| look.cloth.tells_of(t as u32, side));
        sides.flat_map(move |side| look.at_edge([corners[side], corners[(side + 1) % 3]], ridges))
    });
    near.collect()
}

/// How sharp a side of a triangle is at the start of a step.
#[derive(Clone, Copy, Default)]
struct Ridge {
    /// The angle by which the surface turns there (rad); zero where it is hollow, and where the triangle across tells of
    /// the edge.
    turn: f32,
    /// Height of the triangle over the side (m).
    height: f32,
}

impl Ridge {
    fn at(surface: &MovingSurface, triangle: u32, side: usize) -> Self {
        if !surface.tells_of(triangle, side) {
            return Self::default();
        }
        let Some([own, other]) = surface.normals_at_side(triangle, side) else {
            return Self::default();
        };
        let corners = surface.corners(triangle, 0.0);
        let along = corners[(side + 1) % 3] - corners[side];
        let sine = own.cross(&other).dot(&along) / along.norm();
        if sine <= 0.0 || sine.is_nan() {
            return Self::default();
        }
        let across = corners[(side + 2) % 3] - corners[side];
        let height = own.cross(&along).dot(&across) / along.norm();
        Self {
            turn: sine.atan2(own.dot(&other)) as f32,
            height: height as f32,
        }
    }

    /// Height of the surface over a chord of half a length (m): of an arc k l^2 / 8, where it turns evenly over the
    /// triangles, and of a roof l a / 4, where they reach farther than the chord.
    fn over_chord(&self, half: f32) -> f32 {
        0.5 * half * half * self.turn / self.height.min(half)
    }
}

impl Look<'_> {
    /// The sharp edges of the solid that come near one of the cloth in the step, by triangle and side.
    fn at_edge(&self, edge: [u32; 2], ridges: &[[Ridge; 3]]) -> Vec<Near> {
        let Self {
            system,
            surface,
            start,
            ..
        } = self;
        let object = system.policies.object_of_sample(&edge);
        if system.policies.ignores_solid(object, self.solid as usize) {
            return Vec::new();
        }
        let [a, b] = edge.map(|v| start.positions[v as usize]);
        let step = start.part * f64::from(start.parts);
        let ways = edge.map(|v| start.velocities[v as usize] * step);
        let (low, high) = (a.inf(&b), a.sup(&b));
        let (middle, half) = (a.lerp(&b, 0.5), 0.5 * (b - a).norm());
        let margin = NEAR * system.contact.offset;
        let least = (FLAT * system.contact.offset) as f32;
        // The boxes of the surface hold its whole way, those of the cloth its way at the present speeds.
        let low = low.inf(&(low + ways[0].inf(&ways[1])));
        let high = high.sup(&(high + ways[0].sup(&ways[1])));
        let mut near = Vec::new();
        surface.near_box(low, high, margin, |triangle| {
            let ridges = &ridges[triangle as usize];
            let sharp = |&side: &usize| ridges[side].over_chord(half as f32) > least;
            for side in (0..3).filter(sharp) {
                let corners = surface.triangles()[triangle as usize];
                let ends = [corners[side], corners[(side + 1) % 3]];
                let [p, q] = ends.map(|v| surface.starts()[v as usize]);
                let moved = ends.map(|v| surface.ends()[v as usize] - surface.starts()[v as usize]);
                let closing = (moved[0] - ways[0]).norm().max((moved[1] - ways[1]).norm());
                let reach = half + 0.5 * (q - p).norm() + margin + closing;
                if (p.lerp(&q, 0.5) - middle).norm_squared() < reach * reach {
                    near.push((triangle, side));
                }
            }
        });
        near.sort_unstable();
        let sides = near.into_iter();
        let found = sides.filter_map(|side| self.at_edges(edge, [a, b], side));
        found.collect()
    }

    /// An edge of the cloth and one of the solid that cross over each other and come near in the step; none where they are
    /// nearest at an end.
    fn at_edges(
        &self,
        edge: [u32; 2],
        [a, b]: [Vec3; 2],
        (triangle, side): (u32, usize),
    ) -> Option<Near> {
        let (surface, offset) = (self.surface, self.system.contact.offset);
        let corners = surface.corners(triangle, 0.0);
        let (p, q) = (corners[side], corners[(side + 1) % 3]);
        let [s, t] = closest_on_segments([a, b], [p, q]);
        let inside = END..1.0 - END;
        if !inside.contains(&s) || !inside.contains(&t) {
            return None;
        }
        let [first, second] = surface.normals_at_side(triangle, side)?;
        let outward = (first + second).try_normalize(0.0)?;
        let across = (b - a).cross(&(q - p)).try_normalize(0.0)?;
        let cosine = across.dot(&outward);
        if cosine.abs() < FACING.min(first.dot(&outward)) {
            return None;
        }
        let normal = across * cosine.signum();
        let (point, below) = (a.lerp(&b, s), p.lerp(&q, t));
        if normal.dot(&(point - below)) < -DEPTH * offset {
            return None;
        }
        let mut weights = [0.0; 3];
        (weights[side], weights[(side + 1) % 3]) = (1.0 - t, t);
        let place = surface.place(triangle, weights, normal, 0.0);
        let (vertices, weights) = ([edge[0], edge[1], edge[0]], [1.0 - s, s, 0.0]);
        let offset = self.kept_off(&place, (vertices, weights))?;
        Some(Near {
            solid: self.solid,
            place,
            side: Some(side as u8),
            vertices,
            weights,
            area: OF_SQUARE * (b - a).norm_squared(),
            offset,
        })
    }
}
