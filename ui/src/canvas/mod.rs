//! The canvas: the drawing of the pattern on the table, the parts at a place, snapping.

mod allowance;
pub mod camera;
pub mod drawn_guide;
pub mod fill;
pub mod finding_marks;
pub mod grading;
pub mod guides;
pub mod hit;
mod inside;
mod names;
pub mod paint;
mod paint_guides;
mod paint_overlay;
mod paint_press;
mod paint_seams;
mod paint_sheet_tag;
mod panel_shape;
pub mod placed;
pub mod press;
pub mod rulers;
pub mod scene;
pub mod seams;
pub mod selection;
pub mod sheet_tag;
pub mod snap;
pub mod table_layout;
pub mod walked;

pub use panel_shape::along;
