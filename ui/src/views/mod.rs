//! Views: draw what the session holds, and turn what is done in them into events.

pub mod garment;
pub mod marker;
mod marker_piece;
pub mod pattern;
