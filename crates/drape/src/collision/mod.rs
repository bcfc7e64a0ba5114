//! Collision of cloth with cloth: which pairs might touch, which do, what they cost, how far a
//! motion may go, and how what has crossed is led apart.

mod apart;
mod bound;
mod boxes;
mod bvtt_front;
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
#[path = "../../tests/support/numbers.rs"]
mod numbers;
mod proximity;
mod reach;
mod recovery;
mod regions;
mod separation_filter;
mod surface;
mod surface_view;
mod tally;
mod trajectories;
mod zones;

pub use bound::{ImpactStats, truncate_moves};
pub use boxes::{Bounds, BoxTree, Node, Region};
pub use cloth_contact::ClothContact;
pub use contact_set::ContactSet;
pub use coupling::Couplings;
pub use curvature::Clearance;
pub use detector::ContactDetector;
pub use exemptions::ContactExemptions;
pub use feature_pair::FeaturePair;
pub use impact::{edge_edge_impact, vertex_face_impact};
pub use intersections::{EdgeFaceIntersection, crossings, edge_face_intersections};
pub use layer_order::{BETWEEN_LAYERS, layer_order};
pub use layers::{LayerViolation, layer_violations, layer_violations_of, layers_of};
pub use memory::{ClothMemory, ContactFrictionState, RecoveryDirection};
pub use motions::Motions;
pub use nearness::Nearness;
pub use proximity::nearnesses;
pub use reach::{Ahead, Reach};
pub use recovery::Recovery;
pub use surface::{ClothSurface, Near};
pub use tally::Tally;
pub use trajectories::LinearTrajectories;
