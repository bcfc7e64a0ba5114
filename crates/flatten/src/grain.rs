//! The grain on a surface and where it points on the flat shape.

use crate::{FlattenError, Region};
use toile_geometry::{Vec2, Vec3};

/// Least part of the grain that lies along the surface, on the average over its area (1).
pub const MIN_ALONG: f64 = 0.05;

/// Weights of the vertices that give the mean direction of the grain on the flat shape: sum of A d(place) / d(grain) over
/// the triangles. The grain lies along the surface as far as it can; where it stands square to it, it counts nothing.
#[derive(Clone, Debug)]
pub struct Grain {
    /// Weight of each vertex, in sum zero (1).
    weights: Vec<f64>,
}

impl Grain {
    /// The grain along a direction in space.
    ///
    /// # Errors
    /// The direction is zero or not finite, or square to the surface.
    pub fn new(region: &Region, direction: Vec3) -> Result<Self, FlattenError> {
        let direction = direction
            .try_normalize(0.0)
            .filter(|d| d.iter().all(|x| x.is_finite()))
            .ok_or(FlattenError::Grain)?;
        let mut weights = vec![0.0; region.vertex_count()];
        let (mut along, mut area) = (0.0, 0.0);
        for (t, corners) in region.flat().iter().enumerate() {
            let [a, b, c] = region.mesh().corners(t);
            let first = (b - a) / corners[1].x;
            let up = (c - a) - first * corners[2].x;
            let second = up / corners[2].y;
            let tangent = Vec2::new(direction.dot(&first), direction.dot(&second));
            let twice = corners[1].perp(&corners[2]);
            along += 0.5 * twice * tangent.norm();
            area += 0.5 * twice;
            for k in 0..3 {
                let side = corners[(k + 2) % 3] - corners[(k + 1) % 3];
                // Twice the area times the gradient of the corner's weight is the side turned to the left.
                let weight = 0.5 * Vec2::new(-side.y, side.x).dot(&tangent);
                weights[region.mesh().triangles[t][k] as usize] += weight;
            }
        }
        // A direction may lie along parts of the surface and still have no mean on it; then it is no grain either.
        let grain = Self { weights };
        let mean: Vec3 = (grain.weights.iter().zip(&region.mesh().positions))
            .map(|(weight, position)| position * *weight)
            .sum();
        if along < MIN_ALONG * area || mean.norm() < MIN_ALONG * area {
            return Err(FlattenError::Grain);
        }
        Ok(grain)
    }

    /// The mean direction of the grain on a flat shape, times the surface's area (m2).
    pub fn mean(&self, flat: &[Vec2]) -> Vec2 {
        (self.weights.iter().zip(flat))
            .map(|(weight, place)| place * *weight)
            .sum()
    }

    /// Weight of each vertex in [`Self::mean`] (m).
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Turns a flat shape so that the grain points along +y.
    pub fn set_upright(&self, flat: &mut [Vec2]) {
        let mean = self.mean(flat);
        let length = mean.norm();
        if length > 0.0 {
            let (sine, cosine) = (mean.x / length, mean.y / length);
            for p in flat {
                *p = Vec2::new(cosine * p.x - sine * p.y, sine * p.x + cosine * p.y);
            }
        }
    }
}
