//! DXF: markers written for cutters, and patterns of other programs read.
//!
//! # Decided with
//! - [`crate::dxf::tags`], [`crate::dxf::text`]: pairs of lines, and the encodings of their texts;
//! - [`crate::dxf::drawing`]: blocks and what is drawn in them;
//! - [`crate::dxf::labels`], [`crate::dxf::block_piece`]: texts and layers of pieces;
//! - [`crate::dxf::pattern_reader`]: patterns that are read;
//! - [`crate::drawn`]: the document that is made of them;
//! - [`crate::marker_plot::write_marker_dxf`]: markers that are written.

mod block_piece;
mod drawing;
mod labels;
mod pattern_reader;
mod tags;
mod text;
mod writer;

pub(crate) use pattern_reader::read_dxf;
pub(crate) use writer::DxfWriter;
