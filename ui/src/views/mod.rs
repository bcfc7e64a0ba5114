//! Views: each draws a part of the session and turns input into events.

pub mod garment;
pub mod laid_loop;
pub mod marker;
mod marker_names;
mod marker_paint;
mod marker_piece;
pub mod pattern;
