//! The 3D picture: mannequin and garment, drawn by the graphics card.

pub mod orbit;
mod renderer;
pub mod solid;

pub use renderer::{CornerBuffer, StageRenderer};
