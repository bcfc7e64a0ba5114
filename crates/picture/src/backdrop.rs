//! What is behind the surfaces: a vertical gradient, and shadows where the ground is.

use crate::colour::{Rgb, linear_from_srgb, mix};
use crate::prepare::Floor;
use toile_geometry::Vec3;

/// A background of two colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Backdrop {
    /// At the top of the picture.
    pub top: Rgb,
    /// At the bottom.
    pub bottom: Rgb,
    /// How dark the shadow on the ground is, 0..=1.
    pub shadow: f64,
}

impl Default for Backdrop {
    /// A light, slightly warm studio.
    fn default() -> Self {
        Self {
            top: [0.957, 0.953, 0.945],
            bottom: [0.878, 0.871, 0.859],
            shadow: 0.8,
        }
    }
}

impl Backdrop {
    /// White paper without shadows, for pictures that are read.
    pub const PAPER: Self = Self {
        top: [1.0; 3],
        bottom: [1.0; 3],
        shadow: 0.0,
    };

    /// Linear light at a height of the picture, 0 at the top, without shadows.
    pub(crate) fn plain(&self, height: f64) -> [f64; 3] {
        linear_from_srgb(mix(self.top, self.bottom, height))
    }

    /// Linear light at a height of the picture, 0 at the top, along a line of sight.
    pub(crate) fn light(
        &self,
        height: f64,
        (start, direction): (Vec3, Vec3),
        floor: Option<&Floor>,
    ) -> [f64; 3] {
        let colour = self.plain(height);
        let Some(floor) = floor else { return colour };
        if self.shadow == 0.0 || direction.y > -1e-6 || start.y < floor.height {
            return colour;
        }
        let hit = start + direction * ((floor.height - start.y) / direction.y);
        let light = 1.0 - self.shadow * (1.0 - floor.light(hit));
        colour.map(|c| c * light)
    }
}
