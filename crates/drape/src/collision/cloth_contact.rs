//! A contact of cloth with cloth: the laws of contact with a surface, on the vector between two
//! features in place of the point.

use super::feature_pair::FeaturePair;
use crate::laws::contact::{ContactLaw, ContactPlane};
use toile_geometry::Vec3;

/// A contact of two features.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClothContact {
    /// The four vertices.
    pub vertices: [u32; 4],
    /// Their weights; they sum to zero.
    pub weights: [f64; 4],
    /// The plane; its point is the vector from the second feature to the first.
    pub plane: ContactPlane,
    /// The laws.
    pub law: ContactLaw,
    /// Share of the speed of an impact that comes back, where any of the vertices says it.
    pub restitution: Option<f64>,
    /// The features; none for a crossing that is being undone.
    pub pair: Option<FeaturePair>,
}

impl ClothContact {
    /// The vector between the features.
    pub fn between(&self, x: &[Vec3]) -> Vec3 {
        let four = self.vertices.into_iter().zip(self.weights);
        four.map(|(v, w)| x[v as usize] * w).sum()
    }
}
