//! DXF: markers written for cutters, and patterns of other programs read.
//!
//! # Decided with
//! - [`crate::dxf::tags`], [`crate::dxf::text`]: pairs of lines, and the encodings of their texts;
//! - [`crate::dxf::drawing`]: blocks and what is drawn in them;
//! - [`crate::dxf::labels`], [`crate::dxf::block_piece`], [`crate::dxf::outlines`]: texts, layers and outlines
//!   of pieces;
//! - [`crate::dxf::sizes`], [`crate::drawn::unit`]: sizes and unit;
//! - [`crate::dxf::rule_table`], [`crate::dxf::with_table`], [`crate::dxf::graded_blocks`]: grade rule tables, and blocks graded by them;
//! - [`crate::dxf::nest`], [`crate::dxf::nest_piece`], [`crate::dxf::rule_numbers`]: lines with as many vertices in all sizes, and their
//!   rules, written;
//! - [`crate::dxf::pattern_reader`], [`crate::dxf::pattern_writer`]: patterns;
//! - [`crate::drawn`]: the document that is made of them;
//! - [`crate::marker_plot::write_marker_dxf`]: markers that are written.

mod block_piece;
mod drawing;
mod graded_blocks;
mod labels;
mod nest;
mod nest_piece;
mod outlines;
mod pattern_reader;
mod pattern_writer;
mod placed;
mod rule_numbers;
mod rule_table;
mod sizes;
mod tags;
mod text;
mod with_table;
mod writer;

pub(crate) use pattern_reader::read_dxf;
pub(crate) use pattern_writer::{DxfWriting, write_dxf};
pub(crate) use rule_table::{is_rule_table, rule_table_names};
pub(crate) use writer::DxfWriter;
