//! Ties: springs from points of cloth to points of cloth and of solids, which XPBD alone follows.

use crate::Motion;
use crate::laws::elastic::ElasticLaw;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use toile_geometry::Vec3;

/// A point within a triangle, as a weighted mean of three vertices; of a single vertex, one with the whole weight.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrianglePoint {
    /// The vertices.
    pub vertices: [u32; 3],
    /// Their weights, of sum 1.
    pub weights: [f64; 3],
}

impl TrianglePoint {
    /// A vertex alone.
    pub fn vertex(vertex: u32) -> Self {
        Self {
            vertices: [vertex; 3],
            weights: [1.0, 0.0, 0.0],
        }
    }

    /// Its place where the vertices are at some places (m).
    pub fn of(&self, positions: &[Vec3]) -> Vec3 {
        let terms = self.vertices.iter().zip(self.weights);
        terms.map(|(&v, w)| positions[v as usize] * w).sum()
    }
}

/// What a point of cloth is tied to. Solids are numbered as in [`crate::ModelParts::colliders`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum TieEnd {
    /// A point in space (m).
    Place(Vec3),
    /// A point that moves as a whole.
    Frame {
        /// The point in the frame (m).
        point: Vec3,
        /// The motion of the frame.
        motion: Arc<Motion>,
    },
    /// A point of the surface of a solid whose vertices move one by one.
    Surface {
        /// The solid.
        solid: u32,
        /// The point of its surface.
        point: TrianglePoint,
    },
    /// A point in a frame of a solid's track.
    TrackFrame {
        /// The solid.
        solid: u32,
        /// The frame.
        frame: u16,
        /// The point in the frame (m).
        point: Vec3,
    },
    /// A point of cloth.
    Cloth(TrianglePoint),
}

/// A spring of rest length zero from a point of cloth. Only XPBD supports it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tie {
    /// The point of cloth.
    pub from: TrianglePoint,
    /// The other end.
    pub to: TieEnd,
    /// Its force law.
    pub law: ElasticLaw,
}

impl Tie {
    /// The vertices of cloth that it pulls at.
    pub fn vertices(&self) -> impl Iterator<Item = u32> + '_ {
        let to = match &self.to {
            TieEnd::Cloth(point) => &point.vertices[..],
            _ => &[],
        };
        self.from.vertices.iter().chain(to).copied()
    }
}
