//! Digests of scenes and setups, for checkpoints.

use toile_geometry::{Vec2, Vec3};

/// FNV-1a over the bits of numbers (Fowler, Noll and Vo 1991).
#[derive(Clone, Debug)]
pub struct Digest(u64);

impl Digest {
    /// The digest of no data.
    #[allow(clippy::new_without_default)]
    pub fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn bytes(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    /// Adds integers and their count.
    pub fn whole(&mut self, numbers: impl IntoIterator<Item = u32>) {
        let numbers: Vec<u32> = numbers.into_iter().collect();
        self.bytes(&(numbers.len() as u64).to_le_bytes());
        for number in numbers {
            self.bytes(&number.to_le_bytes());
        }
    }

    /// Adds numbers.
    pub fn numbers(&mut self, numbers: &[f64]) {
        for number in numbers {
            self.bytes(&number.to_bits().to_le_bytes());
        }
    }

    /// Adds vectors in space.
    pub fn vectors(&mut self, vectors: &[Vec3]) {
        for number in vectors.iter().flat_map(Vec3::iter) {
            self.bytes(&number.to_bits().to_le_bytes());
        }
    }

    /// Adds triangles in the plane.
    pub fn shapes(&mut self, shapes: &[[Vec2; 3]]) {
        for number in shapes.iter().flatten().flat_map(Vec2::iter) {
            self.bytes(&number.to_bits().to_le_bytes());
        }
    }

    /// Adds a text.
    pub fn text(&mut self, text: &str) {
        self.bytes(text.as_bytes());
    }

    /// The digest of the data so far.
    pub fn value(&self) -> u64 {
        self.0
    }
}
