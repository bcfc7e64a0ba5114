//! What contact of cloth with cloth remembers from step to step: plain data of a state.

use super::feature_pair::FeaturePair;
use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;

/// What a contact remembers from step to step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContactFrictionState {
    /// The features.
    pub pair: FeaturePair,
    /// How far they have slid against each other since they stuck [m].
    pub slip: Vec3,
    /// Normal force in the last step [N].
    pub force: f64,
}

/// What contact of cloth with cloth remembers of the last step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClothMemory {
    /// Positions then [m].
    pub places: Vec<Vec3>,
    /// Contacts that pressed, in order of their features.
    pub held: Vec<ContactFrictionState>,
    /// Distance within which the next detection searches for vertices on the wrong side of a layer [m]: zero where
    /// there can be none, since layers that do not cross do not change sides; none before the first detection.
    pub layer_reach: Option<f64>,
    /// Directions in which vertices at crossings were pulled, in order of the vertices.
    pub drawn: Vec<RecoveryDirection>,
    /// A count for each vertex, up by one in a detection that finds it at a crossing and down by one, not below
    /// zero, in any other; empty where all are zero.
    pub crossed_for: Vec<u32>,
}

/// The direction in which a vertex at a crossing was pulled.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecoveryDirection {
    /// The vertex.
    pub vertex: u32,
    /// Unit direction.
    pub direction: Vec3,
    /// Detections since.
    pub detections: u32,
}
