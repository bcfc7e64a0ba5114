//! The canvas: how a pattern is seen on the table, what is at a place of it, what a place means.

mod allowance;
pub mod boards;
pub mod camera;
pub mod drawn_guide;
pub mod fill;
pub mod grading;
pub mod guides;
pub mod hit;
mod inside;
mod names;
pub mod paint;
mod paint_guides;
mod paint_seams;
mod paint_sheet_tag;
mod paint_walk;
mod panel_shape;
pub mod placed;
pub mod rulers;
pub mod scene;
pub mod seams;
pub mod selection;
pub mod sheet_tag;
pub mod snap;
pub mod walked;

pub use panel_shape::along;
