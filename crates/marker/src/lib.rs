//! Markers of patterns: the cut pieces of drafts, laid on fabric by the rules of the trade.
//!
//! [`lay`] makes markers of drafts, one for each fabric and roll; a [`FinishedMarker`] is one of them, with
//! its summary, drawing and file. A [`DocumentMarker`] is a marker of a document with its pieces. Lengths are
//! in metres, x runs along the warp.
#![cfg_attr(test, allow(clippy::unwrap_used))]
#![cfg_attr(not(test), deny(clippy::wildcard_enum_match_arm))]

mod butting;
mod document_marker;
mod error;
mod file;
mod file_check;
mod finished_marker;
mod flaws;
mod items;
mod job;
mod marks;
mod matching;
mod options;
mod ordered;
mod pieces;
mod progress;
mod search;
mod starting_marker;
mod summary;

pub use butting::{LetGo, Obstacle};
pub use document_marker::{
    DocumentMarker, Found, LaidPiece, MarkerState, PieceOutside, PieceOverlap, Start, WaitingPiece,
};
pub use error::MarkerError;
pub use file::{MarkerFormat, marker_files};
pub use file_check::{Judged, judge_file};
pub use finished_marker::FinishedMarker;
pub use flaws::GivenFlaw;
pub use options::NestOptions;
pub use ordered::{MarkerPieces, SizeDrafts};
pub use pieces::Garments;
pub use progress::{SearchProgress, SearchWatcher};
pub use search::lay;
pub use summary::MarkerSummary;
