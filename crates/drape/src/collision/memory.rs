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
    /// How far off vertices on the wrong side of a layer are looked for at the next look [m]: zero where
    /// none can be, since layers that do not cross do not change sides; none before the first look.
    pub stray_reach: Option<f64>,
    /// Which way vertices at crossings were drawn, in order of the vertices.
    pub drawn: Vec<RecoveryDirection>,
    /// For how many looks each vertex has been at a crossing, those without taken off; empty where none is.
    pub crossed_for: Vec<u32>,
}

/// Which way a vertex at a crossing was drawn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecoveryDirection {
    /// The vertex.
    pub vertex: u32,
    /// Unit direction.
    pub way: Vec3,
    /// Looks since.
    pub looks: u32,
}
