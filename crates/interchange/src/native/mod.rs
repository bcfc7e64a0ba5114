//! The native formats: readable, versioned JSON.
//!
//! A pattern file (`*.toile.json`) names its unit once; bare numbers in it are lengths in that
//! unit and angles in degrees, texts are formulas. Ids are left out where counting gives them.

mod item;
mod json;
mod read;
mod read_panel;
mod units;
mod words;
mod write;
mod write_panel;

pub use read::read_pattern;
pub use write::write_pattern;
