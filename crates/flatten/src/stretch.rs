//! How far a panel is stretched on its surface.

use crate::Region;
use crate::energy::{Sides, right_strain};
use toile_geometry::Vec2;

/// Stretch of a triangle from the panel to the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stretch {
    /// Relative change of length in the direction in which it is largest (1).
    pub most: f64,
    /// Relative change of length in the direction in which it is least (1).
    pub least: f64,
}

impl Stretch {
    /// The larger of both without its sign (1).
    pub fn size(&self) -> f64 {
        self.most.abs().max(self.least.abs())
    }
}

/// The stretch of each triangle; infinite where it is flipped.
pub fn stretch_of(region: &Region, flat: &[Vec2]) -> Vec<Stretch> {
    (region.mesh().triangles.iter().zip(region.flat()))
        .map(|(triangle, corners)| {
            let Some(rest) = Sides::new(triangle.map(|v| flat[v as usize])) else {
                let most = f64::INFINITY;
                return Stretch { most, least: most };
            };
            let right = right_strain(corners, &rest);
            let mean = 0.5 * (right[(0, 0)] + right[(1, 1)]);
            let radius = (0.5 * (right[(0, 0)] - right[(1, 1)])).hypot(right[(0, 1)]);
            Stretch {
                most: (mean + radius).sqrt() - 1.0,
                least: (mean - radius).max(0.0).sqrt() - 1.0,
            }
        })
        .collect()
}

/// The size of stretch that is not exceeded on a share of the surface's area (1).
pub fn stretch_quantile(region: &Region, stretch: &[Stretch], share: f64) -> f64 {
    let mut sizes: Vec<(f64, f64)> = (stretch.iter().zip(region.flat()))
        .map(|(s, corners)| (s.size(), 0.5 * corners[1].perp(&corners[2])))
        .collect();
    sizes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let whole: f64 = sizes.iter().map(|s| s.1).sum();
    let mut below = 0.0;
    for &(size, area) in &sizes {
        below += area;
        if below >= share * whole {
            return size;
        }
    }
    sizes.last().map_or(0.0, |s| s.0)
}
