//! The canvas: the drawing of the pattern on the table, the parts at a place, snapping.
//!
//! # Decided with
//! - [`crate::canvas::scene::Scene`], [`crate::canvas::panel_shape::PanelShape`],
//!   [`crate::canvas::paint::Picture`]: what is there; all of it painted in order, words clear of each other;
//! - [`crate::canvas::paint_overlay`], [`crate::canvas::paint_seams`], [`crate::canvas::paint_guides`]: a
//!   tool's overlay, seams, guides;
//! - [`crate::canvas::names`], [`crate::canvas::inside::roomiest`]: names of points and of panels;
//! - [`crate::canvas::table_layout::TableLayout`], [`crate::canvas::camera::TableCamera`]: where sheets lie;
//!   what is in view;
//! - [`crate::canvas::hit`], [`crate::canvas::snap`]: what a click hits and where it snaps;
//! - [`crate::canvas::allowance::CutLines`], [`crate::canvas::grading::Grading`], [`crate::theme::Palette`]:
//!   cut lines; all sizes; colours;
//! - [`crate::canvas::guides`], [`crate::canvas::drawn_guide`], [`crate::views::pattern`] (`guides.rs`),
//!   [`crate::inspector`] (`guide_place.rs`), [`toile_pattern::Guide`], [`toile_pattern::plan::add_guide`]:
//!   guides: near a place, drawn, dragged, typed; in the document, and their edits;
//! - [`crate::canvas::sheet_tag`], [`crate::canvas::rulers`], [`crate::canvas::selection`]: tags by which
//!   sheets are moved; rulers; what is selected.

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
pub mod suggested;
pub mod table_layout;
pub mod walked;

pub use panel_shape::along;
