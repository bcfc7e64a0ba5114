//! Collision of cloth with cloth: which pairs might touch, which do, what they cost, how far a
//! motion may go, and how what has crossed is led apart.

mod apart;
mod bound;
mod boxes;
mod clusters;
mod contact;
mod coupling;
mod curvature;
mod fade;
mod front;
mod impact;
mod layers;
mod moves;
#[cfg(test)]
#[path = "../../tests/support/numbers.rs"]
mod numbers;
mod proximity;
mod reach;
mod regions;
mod sieve;
mod surface;
mod tangle;
mod zones;

pub use bound::{Kept, Motions, bound_moves};
pub use boxes::{Bounds, BoxTree, Node, Region};
pub use contact::{ClothContact, ClothContacts, ClothMemory, Held, Tally};
pub use coupling::Couplings;
pub use curvature::Clearance;
pub use impact::{edge_edge_impact, vertex_face_impact};
pub use layers::{BETWEEN_LAYERS, Knots, Stray, layer_order, layers_of, strays, strays_from};
pub use proximity::{Nearness, nearnesses};
pub use reach::{Ahead, Reach};
pub use regions::Ways;
pub use surface::{ClothSurface, FeaturePair, Near};
pub use tangle::{Drawn, Piercing, crossings, keep_on, piercings};
