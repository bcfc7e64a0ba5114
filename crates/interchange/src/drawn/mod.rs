//! Pieces as another program drew them, and the document that is made of them. DXF and SVG are read into
//! these.
//!
//! # Decided with
//! - [`crate::drawn::piece`]: pieces and lines, in metres;
//! - [`crate::drawn::chain`]: open lines joined to closed ones;
//! - [`crate::drawn::unit`]: unit, by the sizes of pieces;
//! - [`crate::drawn::corners`], [`crate::drawn::spline`]: corners of a line, and curves between them;
//! - [`crate::drawn::allowance`]: seam allowances, from the distance of two lines;
//! - [`crate::drawn::inset`]: a sew line inside a cut line;
//! - [`crate::drawn::graded`]: points that follow sizes;
//! - [`crate::drawn::builder`]: the document.

pub(crate) mod allowance;
pub(crate) mod builder;
pub(crate) mod chain;
pub(crate) mod corners;
pub(crate) mod graded;
pub(crate) mod inset;
pub(crate) mod piece;
pub(crate) mod spline;
pub(crate) mod unit;
