//! Collision of cloth with cloth: which pairs of features might touch, which do, what a contact costs, how far a motion
//! may go, and how cloth that has crossed is led apart.
//!
//! # Decided with
//! - [`crate::collision::detector::ContactDetector`]: all of one detection: near pairs, their contacts,
//!   tangles;
//! - [`crate::collision::candidate_search`]: which pairs are near, and which need no look;
//! - `step_truncation.rs`: moves of Newton's method cut before cloth meets;
//! - [`crate::collision::impact_resolution`], [`crate::collision::impact`], `zones.rs`: impacts in a motion
//!   of XPBD found and resolved;
//! - `separation_filter.rs`, [`crate::collision::impact_pair`]: pairs that cannot meet; the gap of those that
//!   can;
//! - [`crate::collision::entanglement`]: a tangle noticed and led apart;
//! - [`crate::collision::layer_order`](mod@crate::collision::layer_order), [`crate::collision::layers`]: the
//!   order of garments worn over one another;
//! - [`crate::collision::exemptions`], [`crate::collision::memory::ClothMemory`]: pairs that are let through;
//!   what a state remembers of contact with cloth.

mod boxes;
mod bvtt_front;
mod candidate_search;
mod closest_vectors;
mod cloth_contact;
mod contact_set;
mod coupling;
mod curvature;
mod detector;
mod entanglement;
mod exemptions;
mod feature_pair;
mod friction_memory;
mod front_entry;
mod front_query;
mod impact;
mod impact_pair;
mod impact_resolution;
mod intersections;
pub(crate) mod layer_order;
mod layers;
mod leaf_aabbs;
mod memory;
mod mollifier;
mod motions;
mod moves;
mod nearness;
mod neighbour_lists;
#[cfg(test)]
#[path = "../../tests/suite/support/numbers.rs"]
mod numbers;
mod proximity;
mod reach;
mod recovery;
mod regions;
mod separation_filter;
mod step_truncation;
mod surface;
mod surface_view;
mod tally;
mod trajectories;
mod zones;

pub use boxes::{Bounds, BoxTree, Node, Region};
pub use candidate_search::Near;
pub use cloth_contact::ClothContact;
pub use contact_set::ContactSet;
pub use coupling::Couplings;
pub use curvature::Clearance;
pub use detector::ContactDetector;
pub use exemptions::ContactExemptions;
pub use feature_pair::FeaturePair;
pub use impact::{edge_edge_impact, vertex_face_impact};
pub use impact_resolution::ImpactStats;
pub use intersections::{EdgeFaceIntersection, crossings, edge_face_intersections};
pub use layer_order::{BETWEEN_LAYERS, layer_order};
pub use layers::{LayerViolation, layer_violations, layer_violations_of, layers_of};
pub use memory::{ClothMemory, ContactFrictionState, RecoveryDirection};
pub use motions::Motions;
pub use nearness::Nearness;
pub use proximity::nearnesses;
pub use reach::{Ahead, Reach};
pub use recovery::Recovery;
pub use step_truncation::truncate_moves;
pub use surface::ClothSurface;
pub use tally::Tally;
pub use trajectories::LinearTrajectories;
