//! What a place of a moving solid sees of the cloth near it at the start of a step.

use super::carried_plane::kept_offset;
use crate::System;
use toile_geometry::{ClosestPoint, MovingSurface, Vec3};

/// Distance that a vertex keeps a face off, over the contact offset. An edge of 15 mm over a limb of 40 mm radius comes
/// 0.7 mm nearer to it than its ends, which is less than the half that is left.
const OFFSET: f64 = 0.5;
/// Distance within which a face is looked for, over the contact offset; and the one that a vertex or an edge may come to
/// in the step by the present speeds for its face or edge of the cloth to be watched.
pub const REACH: f64 = 2.5;
pub const NEAR: f64 = 1.0;

/// A place of a moving solid and the point of the cloth that it is near to.
pub struct Near {
    pub solid: u32,
    /// On a vertex or an edge of the solid, with the normal that keeps the cloth off.
    pub place: ClosestPoint,
    /// The side of its triangle, where it is an edge.
    pub side: Option<u8>,
    /// Vertices of the cloth.
    pub vertices: [u32; 3],
    /// Their barycentric weights.
    pub weights: [f64; 3],
    /// Area of cloth that meets it (m2).
    pub area: f64,
    /// Distance from the solid that the cloth is kept at (m).
    pub offset: f64,
}

/// The cloth at the start of a step, and the length of the step over that of its first part.
#[derive(Clone, Copy)]
pub struct StepStart<'a> {
    pub positions: &'a [Vec3],
    pub velocities: &'a [Vec3],
    /// Length of the first part (s), and how many parts there are.
    pub part: f64,
    pub parts: u32,
}

/// A look at the cloth from one solid.
pub struct Look<'a> {
    pub system: &'a System,
    pub cloth: &'a MovingSurface,
    pub surface: &'a MovingSurface,
    pub start: &'a StepStart<'a>,
    pub solid: u32,
}

/// A box that holds the cloth throughout a step, and as much round it as contacts reach (m).
pub struct Within {
    low: Vec3,
    high: Vec3,
    /// Parts of the step; surfaces are given for the first one.
    parts: f64,
}

impl Within {
    /// Whether a vertex of a moving surface comes into it, as far as boxes tell.
    pub fn contains(&self, surface: &MovingSurface, vertex: u32) -> bool {
        let [a, b] = [surface.starts(), surface.ends()].map(|places| places[vertex as usize]);
        let b = a.lerp(&b, self.parts);
        (0..3).all(|k| a[k].max(b[k]) >= self.low[k] && a[k].min(b[k]) <= self.high[k])
    }
}

impl Look<'_> {
    /// The box outside of which the surface cannot meet the cloth in the step. Its margin is wider than any side of the
    /// surface is long, so that a triangle that meets the cloth has its corners inside.
    pub fn within(&self) -> Within {
        let StepStart {
            positions,
            velocities,
            part,
            parts,
        } = *self.start;
        let step = part * f64::from(parts);
        let nothing = [Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY)];
        let [low, high] = positions
            .iter()
            .zip(velocities)
            .fold(nothing, |[low, high], (p, v)| {
                let end = p + v * step;
                [low.inf(p).inf(&end), high.sup(p).sup(&end)]
            });
        let margin = Vec3::repeat(REACH * self.system.contact.offset + self.surface.longest_side());
        Within {
            low: low - margin,
            high: high + margin,
            parts: f64::from(parts),
        }
    }

    /// The distance at which a place of the solid is to keep the cloth off (m), where it comes nearer to it in the step than
    /// it should, by the present speeds; `vertices` and `weights` are those of the point of the cloth. Cloth that is nearer
    /// to a wall that faces the other way is on the far side of something, unless both are a pinch.
    pub fn kept_off(
        &self,
        place: &ClosestPoint,
        (vertices, weights): ([u32; 3], [f64; 3]),
    ) -> Option<f64> {
        let Self {
            system,
            surface,
            start,
            ..
        } = self;
        let sum = |of: &[Vec3]| -> Vec3 {
            let corners = vertices.iter().zip(weights);
            corners.map(|(&v, w)| of[v as usize] * w).sum()
        };
        let point = sum(start.positions);
        let moved = surface.displacement(place.triangle, place.weights, [0.0, 1.0]);
        let closing = moved - sum(start.velocities) * start.part;
        let comes = place.normal.dot(&closing) * f64::from(start.parts);
        let gap = place.normal.dot(&(point - place.point));
        let (offset, thickness) = (system.contact.offset, system.contact.cloth_offset);
        if gap - comes.max(0.0) >= NEAR * offset {
            return None;
        }
        let kept = kept_offset(surface, (place, 0.0), offset, thickness)?;
        let wall = surface.closest_point(point, 0.0, REACH * offset, Some(place.triangle))?;
        let is_beyond = kept == offset && wall.normal.dot(&place.normal) <= 0.0;
        (!is_beyond).then_some(kept.min(OFFSET * offset))
    }
}
