//! Marker making on plain outlines: places pieces on a strip of fabric without overlap, on grain, in the
//! shortest length. Independent of patterns, files and screens.
//!
//! The strip runs along +x: x is the warp (the length of the roll) from 0, y the weft from one selvedge at 0
//! to the other at the width. The grain of a piece is rotated to lie along +x.
//!
//! [`make_marker`] lays the pieces, [`improve_marker`] continues from a marker; [`judge`] checks any marker
//! on the original outlines and shares only the geometry functions with the placing.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod check;
mod clashes;
mod depth_raster;
mod error;
mod explore;
mod job;
mod layout;
mod layout_marker;
mod maps;
mod marker;
mod nofit;
mod pair;
mod poses;
mod queries;
mod random;
mod raster;
mod referee;
mod refine;
mod rolls;
mod rules;
mod search;
mod separate;
mod shape;
mod side_by_side;
mod simplify;
mod slide;
mod start;
mod tables;
mod turns;
mod violation;
mod words;

pub use clashes::{Clashes, Outside, Overlap, clashes};
pub use error::{ItemProblem, MAX_PIECES, NestingError, Refusal};
pub use marker::{
    Allowed, Flaw, Fold, FoldEdge, Item, Locked, Marker, MatchPoint, Mirror, Nap, Phase, Placement,
    Pose, Strip, Stripes, Unplaced,
};
pub use queries::{PairQueries, with_pair_queries};
pub use referee::{Verdict, judge};
pub use rolls::{RollMarker, RolledOut, make_markers_on_rolls};
pub use search::{Budget, Control, Progress, Search, improve_marker, make_marker};
pub use violation::{PENETRATION_LIMIT, Side, Violation};
