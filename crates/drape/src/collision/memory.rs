//! Memory of contact of cloth with cloth from step to step: plain data of a state.

use super::feature_pair::FeaturePair;
use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;

/// Friction state of a contact that pressed in the last step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContactFrictionState {
    /// The features.
    pub pair: FeaturePair,
    /// Tangential displacement of the first feature relative to the second since they stuck (m).
    pub slip: Vec3,
    /// Normal force in the last step (N).
    pub force: f64,
}

/// Memory of contact of cloth with cloth after the last step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClothMemory {
    /// Positions of the vertices at the end of that step (m).
    pub positions: Vec<Vec3>,
    /// Friction of the contacts that pressed, in order of their features.
    pub friction: Vec<ContactFrictionState>,
    /// Distance within which the next detection searches for vertices on the wrong side of a layer (m). Zero once no
    /// layers cross and no vertex is on a wrong side: sides change only through a crossing. None before the first
    /// detection.
    pub layer_reach: Option<f64>,
    /// Recovery directions of vertices at crossings, in order of the vertices.
    pub recovery_directions: Vec<RecoveryDirection>,
    /// Persistence of the crossing at each vertex: up by one in a detection that finds the vertex at a crossing, down
    /// by one but not below zero in any other; empty where all are zero.
    pub crossing_counts: Vec<u32>,
}

/// The direction in which a recovery force pulled a vertex at a crossing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecoveryDirection {
    /// The vertex.
    pub vertex: u32,
    /// Unit direction.
    pub direction: Vec3,
    /// Detections since then.
    pub detections: u32,
}
