//! DXF: markers written for cutters, and patterns of other programs read.
//!
//! # Decided with
//! - [`crate::dxf::tags`], [`crate::dxf::text`]: pairs of lines, and the encodings of their texts;
//! - [`crate::dxf::groups`], [`crate::dxf::entities`], [`crate::dxf::curves`]: entities, and curves as points;
//! - [`crate::dxf::drawing`], [`crate::dxf::drawing_reader`]: blocks and what is drawn in them;
//! - [`crate::dxf::labels`], [`crate::dxf::block_piece`], [`crate::dxf::outlines`], [`crate::dxf::placed`], [`crate::dxf::blocks`]: texts,
//!   layers and outlines of pieces;
//! - [`crate::dxf::sized_pieces`], [`crate::dxf::sizes`], [`crate::drawn::unit`]: pieces in their sizes, and unit;
//! - [`crate::dxf::piece_maker`], [`crate::dxf::piece_lines`], [`crate::dxf::piece_marks`]: a piece in metres;
//! - [`crate::dxf::rule_table`], [`crate::dxf::with_table`], [`crate::dxf::graded_blocks`]: grade rule tables, and blocks graded by them;
//! - [`crate::dxf::nest`], [`crate::dxf::nest_piece`], [`crate::dxf::rule_numbers`]: lines with as many vertices in all sizes, and their
//!   rules, written;
//! - [`crate::dxf::pattern_reader`], [`crate::dxf::pattern_writer`]: patterns;
//! - [`crate::drawn`]: the document that is made of them;
//! - [`crate::marker_plot::write_marker_dxf`]: markers that are written.

mod block_piece;
mod blocks;
mod curves;
mod drawing;
mod drawing_reader;
mod entities;
mod graded_blocks;
mod groups;
mod labels;
mod limits;
mod nest;
mod nest_piece;
mod outlines;
mod pattern_reader;
mod pattern_writer;
mod piece_lines;
mod piece_maker;
mod piece_marks;
mod placed;
mod rule_numbers;
mod rule_table;
mod sized_pieces;
mod sizes;
mod tags;
mod text;
mod with_table;
mod writer;

pub(crate) use pattern_reader::read_dxf;
pub(crate) use pattern_writer::{DxfWriting, write_dxf};
pub(crate) use rule_table::{is_rule_table, rule_table_names};
pub(crate) use writer::DxfWriter;
