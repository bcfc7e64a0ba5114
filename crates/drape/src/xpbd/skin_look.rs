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
    /// Area of cloth that meets it [m2].
    pub area: f64,
    /// Distance from the solid that the cloth is kept at [m].
    pub offset: f64,
}

/// The cloth at the start of a step, and the length of the step over that of its first part.
#[derive(Clone, Copy)]
pub struct StepStart<'a> {
    pub positions: &'a [Vec3],
    pub velocities: &'a [Vec3],
    /// Length of the first part [s], and how many parts there are.
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

impl Look<'_> {
    /// A place of the solid that comes nearer to a point of the cloth in the step than it should, by the present speeds.
    /// Cloth that is nearer to a wall that faces the other way is on the far side of something, unless both are a pinch.
    pub fn met(&self, mut near: Near, point: Vec3) -> Option<Near> {
        let Self {
            system,
            surface,
            start,
            ..
        } = self;
        let (normal, own) = (near.place.normal, near.place.triangle);
        let velocity: Vec3 = (near.vertices.iter().zip(near.weights))
            .map(|(&v, w)| start.velocities[v as usize] * w)
            .sum();
        let moved = surface.displacement(own, near.place.weights, [0.0, 1.0]);
        let comes = normal.dot(&(moved - velocity * start.part)) * f64::from(start.parts);
        let gap = normal.dot(&(point - near.place.point));
        if gap - comes.max(0.0) >= NEAR * system.contact.offset {
            return None;
        }
        let (offset, thickness) = (system.contact.offset, system.contact.cloth_offset);
        let kept = kept_offset(surface, (&near.place, 0.0), offset, thickness)?;
        let wall = surface.closest_point(point, 0.0, REACH * offset, Some(own))?;
        if kept == offset && wall.normal.dot(&normal) <= 0.0 {
            return None;
        }
        near.offset = kept.min(OFFSET * offset);
        Some(near)
    }
}
