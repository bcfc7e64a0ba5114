//! SVG: pattern drawings of other programs read, and patterns written so that they come back whole.
//!
//! # Decided with
//! - [`crate::svg::drawing`]: what is drawn, as lines in units of the file;
//! - [`crate::svg::scan`], [`crate::svg::style`], [`crate::svg::shape`], [`crate::svg::scale`]: elements,
//!   transformations, what is hidden, curves, and the size of a unit;
//! - [`crate::svg::ampersands`]: signs `&` that begin no entity;
//! - [`crate::svg::join`], [`crate::svg::region`]: open lines joined, and which line lies in which;
//! - [`crate::svg::freesewing`], [`crate::svg::plain`], [`crate::svg::layers`]: pieces of FreeSewing, of any
//!   other program, and of layers that this program wrote;
//! - [`crate::svg::pattern_reader`], [`crate::svg::pattern_writer`]: patterns;
//! - [`crate::svg::kinds`], [`crate::svg::panel_lines`]: what this program marks its lines with, and writes of a
//!   panel;
//! - [`crate::svg::back`], [`crate::svg::likeness`]: panels that were edited in a file of this program;
//! - [`crate::drawn`]: the document that is made of pieces.

mod ampersands;
mod back;
mod drawing;
mod freesewing;
mod join;
mod kinds;
mod layers;
mod likeness;
mod panel_lines;
mod pattern_reader;
mod pattern_writer;
mod piece;
mod plain;
mod reading;
mod region;
mod scale;
mod scan;
mod shape;
mod style;
mod viewport;

pub(crate) use pattern_reader::read_svg;
pub(crate) use pattern_writer::write_svg;
pub(crate) use reading::SvgReading;
