//! Pieces as another program drew them, and the document that is made of them. DXF and SVG are read into
//! these.
//!
//! # Decided with
//! - [`crate::drawn::piece`]: pieces and lines, in metres;
//! - [`crate::drawn::chain`]: open lines joined to closed ones;
//! - [`crate::drawn::unit`]: unit, by the sizes of pieces;
//! - [`crate::drawn::corners`], [`crate::drawn::cubics`], [`crate::drawn::fit`], [`crate::drawn::spline`]: corners of a
//!   line, and curves between them;
//! - [`crate::drawn::curved`], [`crate::drawn::cut_tangents`]: a line as corners and curves, whose ends the corners of the
//!   cut line may turn;
//! - [`crate::drawn::twin`]: points of curves that the file has between the vertices;
//! - [`crate::drawn::allowance`], [`crate::drawn::cut_fit`]: seam allowances and corners, from the distance of two lines;
//! - [`crate::drawn::holes`]: cut-outs within an outline;
//! - [`crate::drawn::inset`]: a sew line inside a cut line;
//! - [`crate::drawn::marks`], [`crate::drawn::drill`]: places of notches; marks of drill holes;
//! - [`crate::drawn::graded`]: points that follow sizes;
//! - [`crate::drawn::builder`]: the document.

pub(crate) mod allowance;
pub(crate) mod builder;
pub(crate) mod chain;
pub(crate) mod corners;
pub(crate) mod cubics;
pub(crate) mod curved;
pub(crate) mod cut_fit;
pub(crate) mod cut_tangents;
pub(crate) mod drill;
pub(crate) mod fit;
pub(crate) mod graded;
pub(crate) mod holes;
pub(crate) mod inset;
pub(crate) mod marks;
pub(crate) mod piece;
pub(crate) mod spline;
pub(crate) mod twin;
pub(crate) mod unit;
