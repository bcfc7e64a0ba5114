//! Collision of cloth with cloth: which pairs might touch, which do, what they cost, how far a
//! motion may go, and how what has crossed is led apart.

mod apart;
mod bound;
mod boxes;
mod cloth_contact;
mod clusters;
mod contact;
mod coupling;
mod curvature;
mod fade;
mod feature_pair;
mod front;
mod impact;
pub(crate) mod layer_order;
mod layers;
mod memory;
mod motions;
mod moves;
mod nearness;
#[cfg(test)]
#[path = "../../tests/support/numbers.rs"]
mod numbers;
mod proximity;
mod reach;
mod regions;
mod sieve;
mod surface;
mod surface_view;
mod tangle;
mod trajectories;
mod zones;

pub use bound::{ImpactStats, bound_moves};
pub use boxes::{Bounds, BoxTree, Node, Region};
pub use cloth_contact::ClothContact;
pub use contact::{ClothContacts, Tally};
pub use coupling::Couplings;
pub use curvature::Clearance;
pub use feature_pair::FeaturePair;
pub use impact::{edge_edge_impact, vertex_face_impact};
pub use layer_order::{BETWEEN_LAYERS, layer_order};
pub use layers::{Knots, Stray, layers_of, strays, strays_from};
pub use memory::{ClothMemory, ContactFrictionState, RecoveryDirection};
pub use motions::Motions;
pub use nearness::Nearness;
pub use proximity::nearnesses;
pub use reach::{Ahead, Reach};
pub use surface::{ClothSurface, Near};
pub use tangle::{Piercing, crossings, keep_on, piercings};
pub use trajectories::LinearTrajectories;
