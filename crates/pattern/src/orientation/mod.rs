//! Right and wrong sides: which side of the cloth each piece of a garment shows.
//!
//! Seen from its right side the outline of a piece runs counter-clockwise. Where two pieces that both
//! show their right side are sewn, their outlines run against each other along the seam; where they run
//! the same way, one of the two shows its wrong side. So every seam links the sides of two pieces.
//!
//! # Decided with
//! - [`crate::orientation::meetings::meetings`]: what lies across a seam, and on which side;
//! - [`crate::orientation::exchange::choose`], [`crate::drafting`] (`seams`): the other copy or half taken
//!   where the draft is made;
//! - [`crate::orientation::turned::turned_pieces`], [`crate::evaluate::Evaluation::check_sides`]
//!   (`check.rs`): pieces turned inside out;
//! - [`crate::orientation::words`]: told in words;
//! - [`crate::plan::turns_over`], [`crate::plan::twin`]: which copy the seam tool sews.

mod colouring;
mod exchange;
mod meetings;
mod turned;
mod words;

pub(crate) use exchange::{SeamSpan, Taken, Twin, choose};
pub(crate) use meetings::{Meeting, SidePart, meetings};
pub(crate) use turned::turned_pieces;
pub(crate) use words::exchange_words;
