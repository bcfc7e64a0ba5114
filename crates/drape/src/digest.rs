//! Digests: whether a checkpoint is of the same scene or setup.

use toile_geometry::{Vec2, Vec3};

/// FNV-1a over the bits of numbers.
pub(crate) struct Digest(u64);

impl Digest {
    /// Of nothing yet.
    pub fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn bytes(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    /// Takes in whole numbers and how many they are.
    pub fn whole(&mut self, numbers: impl IntoIterator<Item = u32>) {
        let numbers: Vec<u32> = numbers.into_iter().collect();
        self.bytes(&(numbers.len() as u64).to_le_bytes());
        for number in numbers {
            self.bytes(&number.to_le_bytes());
        }
    }

    /// Takes in vectors in space.
    pub fn places(&mut self, places: &[Vec3]) {
        for number in places.iter().flat_map(Vec3::iter) {
            self.bytes(&number.to_bits().to_le_bytes());
        }
    }

    /// Takes in triangles of the plane.
    pub fn shapes(&mut self, shapes: &[[Vec2; 3]]) {
        for number in shapes.iter().flatten().flat_map(Vec2::iter) {
            self.bytes(&number.to_bits().to_le_bytes());
        }
    }

    /// Takes in words.
    pub fn text(&mut self, words: &str) {
        self.bytes(words.as_bytes());
    }

    /// The digest.
    pub fn value(&self) -> u64 {
        self.0
    }
}
