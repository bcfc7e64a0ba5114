//! Numbers that tests take for random ones.

use toile_geometry::Vec3;

/// Numbers in 0..1 that repeat from run to run; not all who share this file need each of them.
pub struct Numbers(pub u64);

#[allow(dead_code)]
impl Numbers {
    /// The next one.
    pub fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// The next one, between two bounds.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    /// Three of them as a vector, each component within `scale` of zero.
    pub fn vector(&mut self, scale: f64) -> Vec3 {
        Vec3::new(self.next() - 0.5, self.next() - 0.5, self.next() - 0.5) * (2.0 * scale)
    }
}
