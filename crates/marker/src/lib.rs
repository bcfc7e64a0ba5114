//! Markers of patterns: pieces of drafts as they are cut, laid on fabric by the rules of the trade.
//!
//! [`lay`] makes markers of drafts, one for each fabric and roll; a [`Laying`] is one of them, with
//! what is told, drawn and written of it. A [`LaidMarker`] is a marker of a document with its pieces. Lengths in metres, x along the warp.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod error;
mod file;
mod flaws;
mod follow;
mod going_on;
mod items;
mod job;
mod judging;
mod laid;
mod laying;
mod marks;
mod matching;
mod nested;
mod options;
mod ordered;
mod pieces;
mod search;

pub use error::MarkerError;
pub use file::{MarkerFormat, marker_files};
pub use flaws::GivenFlaw;
pub use follow::{Follow, Standing};
pub use judging::{Judged, judge_file};
pub use laid::{
    Found, LaidMarker, LaidPiece, MarkerState, PieceOutside, PieceOverlap, Start, WaitingPiece,
};
pub use laying::Laying;
pub use nested::Nested;
pub use options::NestOptions;
pub use ordered::{MarkerPieces, SizeDrafts};
pub use pieces::Garments;
pub use search::lay;
