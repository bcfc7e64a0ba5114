//! Points of the cloth that are tested against solid surfaces.

use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;

/// A point of the cloth that is tested against surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContactSample {
    /// The triangle it lies on; none for a sample at a vertex (then `vertices[0]`).
    pub triangle: Option<u32>,
    /// Vertices it hangs on.
    pub vertices: [u32; 3],
    /// Their weights.
    pub weights: [f64; 3],
    /// Area of cloth it stands for [m2].
    pub area: f64,
    /// Friction coefficient there.
    pub friction: f64,
    /// Share of the normal speed of an impact that comes back there, where any cloth says it.
    pub restitution: Option<f64>,
    /// Distance kept beyond the usual offset [m]: raised where a triangle went on crossing.
    pub extra_offset: f64,
}

impl ContactSample {
    /// Its place [m].
    pub fn place(&self, x: &[Vec3]) -> Vec3 {
        let [a, b, c] = self.vertices.map(|v| x[v as usize]);
        a * self.weights[0] + b * self.weights[1] + c * self.weights[2]
    }
}
