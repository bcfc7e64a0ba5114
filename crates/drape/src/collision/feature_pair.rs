//! Two features that might touch.

use serde::{Deserialize, Serialize};

/// Two features that might touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum FeaturePair {
    /// A vertex and the corners of a face.
    VertexFace([u32; 4]),
    /// The ends of an edge, and those of another.
    EdgeEdge([u32; 4]),
}

impl FeaturePair {
    /// How many of the vertices are the first feature's.
    pub fn first(&self) -> usize {
        match self {
            Self::VertexFace(_) => 1,
            Self::EdgeEdge(_) => 2,
        }
    }

    /// The four vertices.
    pub fn vertices(&self) -> [u32; 4] {
        let (Self::VertexFace(v) | Self::EdgeEdge(v)) = *self;
        v
    }
}
