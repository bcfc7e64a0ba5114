//! DXF: markers written for cutters, and patterns of other programs read.
//!
//! # Decided with
//! - [`crate::dxf::tags`], [`crate::dxf::text`]: pairs of lines, and the encodings of their texts;
//! - [`crate::dxf::drawing`]: blocks and what is drawn in them;
//! - [`crate::dxf::labels`], [`crate::dxf::block_piece`], [`crate::dxf::outlines`]: texts, layers and outlines
//!   of pieces;
//! - [`crate::dxf::sizes`], [`crate::drawn::unit`]: sizes and unit;
//! - [`crate::dxf::pattern_reader`], [`crate::dxf::pattern_writer`]: patterns;
//! - [`crate::drawn`]: the document that is made of them;
//! - [`crate::marker_plot::write_marker_dxf`]: markers that are written.

mod block_piece;
mod drawing;
mod labels;
mod outlines;
mod pattern_reader;
mod pattern_writer;
mod sizes;
mod tags;
mod text;
mod writer;

pub(crate) use pattern_reader::read_dxf;
pub(crate) use pattern_writer::write_dxf;
pub(crate) use writer::DxfWriter;
