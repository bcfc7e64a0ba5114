//! Contact planes that go with a triangle of a moving surface.
//!
//! The closest point of the surface is found once a step and where a point of the cloth has slipped far against it. In
//! between the closest point stays at the same place of its triangle and the normal keeps its direction in the frame of
//! that triangle.

use nalgebra::Matrix3;
use toile_geometry::{ClosestPoint, MovingSurface, Room, Vec3};

/// A plane at a place of a triangle, its normal in the frame of the triangle.
#[derive(Clone, Copy, Debug)]
pub struct CarriedPlane {
    /// The triangle of the surface, or [`NO_TRIANGLE`].
    pub triangle: u32,
    /// Barycentric weights of its first two corners.
    weights: [f32; 2],
    /// The normal in the frame of the triangle.
    normal: [f32; 3],
    /// Distance from the surface that it keeps the cloth at [m].
    offset: f32,
}

/// In place of a triangle's number: no point of the surface was asked for yet.
const NO_TRIANGLE: u32 = u32::MAX;

/// A plane at two times of a step.
pub struct CarriedMotion {
    /// A point of the surface at the second time [m].
    pub point: Vec3,
    /// The normal at the second time.
    pub normal: Vec3,
    /// Distance from the surface that the cloth is kept at [m].
    pub offset: f64,
    /// Displacement of the point from the first time to the second [m].
    pub displacement: Vec3,
    /// Rotation of the triangle from the first time to the second.
    pub rotation: Matrix3<f64>,
}

impl Default for CarriedPlane {
    fn default() -> Self {
        Self {
            triangle: NO_TRIANGLE,
            weights: [0.0; 2],
            normal: [0.0; 3],
            offset: 0.0,
        }
    }
}

impl CarriedPlane {
    /// The plane at a closest point that was found at a time of the step, and how far it keeps the cloth off [m].
    pub fn new(
        surface: &MovingSurface,
        (closest, time): (&ClosestPoint, f64),
        offset: f64,
    ) -> Self {
        let frame = frame(surface.corners(closest.triangle, time));
        let normal = frame.tr_mul(&closest.normal);
        Self {
            triangle: closest.triangle,
            weights: [0, 1].map(|k| closest.weights[k] as f32),
            normal: [0, 1, 2].map(|k| normal[k] as f32),
            offset: offset as f32,
        }
    }

    /// The triangle of the surface that was closest before; none before the first query.
    pub fn known_triangle(&self) -> Option<u32> {
        (self.triangle != NO_TRIANGLE).then_some(self.triangle)
    }

    /// The plane at two times of the step.
    pub fn at(&self, surface: &MovingSurface, times: [f64; 2]) -> CarriedMotion {
        let corners = times.map(|time| surface.corners(self.triangle, time));
        let [a, b] = self.weights.map(f64::from);
        let points = corners.map(|[p, q, r]| p * a + q * b + r * (1.0 - a - b));
        let [from, to] = corners.map(frame);
        let normal = to * Vec3::from(self.normal.map(f64::from));
        CarriedMotion {
            point: points[1],
            normal: normal.try_normalize(0.0).unwrap_or_default(),
            offset: f64::from(self.offset),
            displacement: points[1] - points[0],
            rotation: to * from.transpose(),
        }
    }
}

/// Share of the room in a pinch that is used: between two walls that each took its half a point would never rest.
const OF_PINCH: f64 = 0.9;

/// How far from a place of a surface cloth is kept that would lie at `offset` from it [m]: where another wall faces it so
/// near that cloths of a thickness [m] on both find no room, nearly half of what there is. None where the place lies inside
/// another part of the surface: nothing can be kept off both (Baraff, Witkin and Kass 2003).
pub fn kept_offset(
    surface: &MovingSurface,
    (place, time): (&ClosestPoint, f64),
    offset: f64,
    thickness: f64,
) -> Option<f64> {
    match surface.room(place, time, 2.0 * offset + thickness) {
        Room::Free => Some(offset),
        Room::Pinch(gap) => {
            // The walls may come nearer until the step ends.
            let later = surface.place(place.triangle, place.weights, place.normal, 1.0);
            let gap = match surface.room(&later, 1.0, gap) {
                Room::Pinch(later) => gap.min(later),
                Room::Free | Room::Buried => gap,
            };
            let half = (0.5 * (gap - thickness)).max(0.25 * gap);
            Some(offset.min(OF_PINCH * half))
        }
        Room::Buried => None,
    }
}

/// Unit axes of a triangle: along its first side, across it in the plane, and its normal; the axes of the world where
/// it has no area.
fn frame([a, b, c]: [Vec3; 3]) -> Matrix3<f64> {
    let along = (b - a).try_normalize(0.0);
    let normal = (b - a).cross(&(c - a)).try_normalize(0.0);
    match (along, normal) {
        (Some(along), Some(normal)) => {
            Matrix3::from_columns(&[along, normal.cross(&along), normal])
        }
        _ => Matrix3::identity(),
    }
}
