//! Collision of cloth with cloth: which pairs might touch, which do, what they cost, how far a
//! motion may go, and how what has crossed is led apart.

mod impact;

pub use impact::{edge_edge_impact, vertex_face_impact};
