//! Contact planes that go with a triangle of a moving surface.
//!
//! The closest point of the surface is found once a step and where a point of the cloth has slipped far against it. In
//! between the closest point stays at the same place of its triangle and the normal keeps its direction in the frame of
//! that triangle.

use nalgebra::Matrix3;
use toile_geometry::{ClosestPoint, MovingSurface, Vec3};

/// A plane at a place of a triangle, its normal in the frame of the triangle.
#[derive(Clone, Copy, Debug)]
pub struct CarriedPlane {
    /// The triangle of the surface, or [`NO_TRIANGLE`].
    triangle: u32,
    /// Barycentric weights of its first two corners.
    weights: [f32; 2],
    /// The normal in the frame of the triangle.
    normal: [f32; 3],
}

/// In place of a triangle's number: no point of the surface was asked for yet.
const NO_TRIANGLE: u32 = u32::MAX;

/// A plane at two times of a step.
pub struct CarriedMotion {
    /// A point of the surface at the second time [m].
    pub point: Vec3,
    /// The normal at the second time.
    pub normal: Vec3,
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
        }
    }
}

impl CarriedPlane {
    /// The plane at a closest point that was found at a time of the step.
    pub fn new(surface: &MovingSurface, closest: &ClosestPoint, time: f64) -> Self {
        let frame = frame(surface.corners(closest.triangle, time));
        let normal = frame.tr_mul(&closest.normal);
        Self {
            triangle: closest.triangle,
            weights: [0, 1].map(|k| closest.weights[k] as f32),
            normal: [0, 1, 2].map(|k| normal[k] as f32),
        }
    }

    /// The triangle of the surface that was closest before; none before the first query.
    pub fn triangle(&self) -> Option<u32> {
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
            displacement: points[1] - points[0],
            rotation: to * from.transpose(),
        }
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
