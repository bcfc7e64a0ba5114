//! The background behind the surfaces: a vertical gradient, and shadows on the ground.

use crate::colour::{Rgb, linear_from_srgb, mix};
use crate::floor::Floor;
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
            shadow: 1.0,
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

    /// How much light the shadow on the ground leaves along a line of sight, at a place from 0 to 1
    /// to the right. Shadows end softly at the sides, where another picture may follow.
    pub(crate) fn on_floor(
        &self,
        across: f64,
        (start, direction): (Vec3, Vec3),
        floor: &Floor,
    ) -> f64 {
        if self.shadow == 0.0 || direction.y > -1e-6 || start.y < floor.height {
            return 1.0;
        }
        let hit = start + direction * ((floor.height - start.y) / direction.y);
        let inward = (across.min(1.0 - across) / 0.25).clamp(0.0, 1.0);
        let dark = self.shadow * inward * inward * (3.0 - 2.0 * inward);
        1.0 - dark * (1.0 - floor.light(hit))
    }
}
