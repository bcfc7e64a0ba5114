//! Contact samples: points of the cloth that are tested against solids.

use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;

/// A point of the cloth that is tested against solids.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContactSample {
    /// The triangle it lies on; none for a sample at a vertex (then `vertices[0]`).
    pub triangle: Option<u32>,
    /// Vertices whose weighted mean it is.
    pub vertices: [u32; 3],
    /// Weights of the vertices.
    pub weights: [f64; 3],
    /// Area of cloth it represents (m2).
    pub area: f64,
    /// Friction coefficient.
    pub friction: f64,
    /// Coefficient of restitution; none where no material has one.
    pub restitution: Option<f64>,
    /// Contact offset beyond that of the settings (m): enlarged in triangles that cross a solid.
    pub extra_offset: f64,
}

impl ContactSample {
    /// Its position (m).
    #[inline]
    pub fn position(&self, x: &[Vec3]) -> Vec3 {
        let [a, b, c] = self.vertices.map(|v| x[v as usize]);
        a * self.weights[0] + b * self.weights[1] + c * self.weights[2]
    }
}
