//! Vectors of R3 padded to a register.

use toile_geometry::Vec3;

/// A vector of R3 with a fourth component that stays zero: it fills a 256-bit register and is aligned to it, so
/// that it never crosses a cache line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub struct Lane([f64; 4]);

impl From<Vec3> for Lane {
    fn from(v: Vec3) -> Self {
        Self([v.x, v.y, v.z, 0.0])
    }
}

impl From<Lane> for Vec3 {
    fn from(Lane([x, y, z, _]): Lane) -> Self {
        Self::new(x, y, z)
    }
}

impl Lane {
    /// From its coordinates.
    #[inline(always)]
    pub fn new(x: f64, y: f64, z: f64) -> Self {
        Self([x, y, z, 0.0])
    }

    /// Its coordinates.
    #[inline(always)]
    pub fn coordinates(self) -> [f64; 3] {
        let Self([x, y, z, _]) = self;
        [x, y, z]
    }

    /// self + s b.
    #[inline(always)]
    pub fn add_scaled(self, b: Self, s: f64) -> Self {
        let (a, b) = (self.0, b.0);
        Self([
            b[0].mul_add(s, a[0]),
            b[1].mul_add(s, a[1]),
            b[2].mul_add(s, a[2]),
            b[3].mul_add(s, a[3]),
        ])
    }

    /// self - b.
    #[inline(always)]
    pub fn minus(self, b: Self) -> Self {
        let (a, b) = (self.0, b.0);
        Self([a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]])
    }

    /// self + b.
    #[inline(always)]
    pub fn plus(self, b: Self) -> Self {
        let (a, b) = (self.0, b.0);
        Self([a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]])
    }

    /// s times self.
    #[inline(always)]
    pub fn scaled(self, s: f64) -> Self {
        let a = self.0;
        Self([a[0] * s, a[1] * s, a[2] * s, a[3] * s])
    }

    /// The inner product self . b.
    #[inline(always)]
    pub fn dot(self, b: Self) -> f64 {
        let (a, b) = (self.0, b.0);
        a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
    }
}
