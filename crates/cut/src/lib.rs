//! Pieces as they are cut: the seam line of a piece grown by the allowance of each of its edges.
//!
//! The cut line is the boundary of a union of convex pieces of cloth (a rectangle outside each chord, a wedge
//! at each outer bend, a patch at each corner, a cap at each dart), so that it cannot cross itself and no
//! loops have to be taken out. Every segment of it says which edge it belongs to; whatever could not be done
//! as asked is listed. A [`CutPiece`] is a piece of a draft with all that is drawn on it, and its [`Drawing`]
//! is shown by prints, markers, files and the window. Lengths in metres. `docs/methods/cut.md` has the
//! equations.

#![cfg_attr(test, allow(clippy::unwrap_used))]

mod allowance;
mod chain;
mod check;
mod corner;
mod cut_line;
mod cut_list;
mod dart;
mod drawing;
mod finding;
mod fold;
mod label;
mod label_block;
mod names;
mod notch;
mod notch_place;
mod notch_room;
mod options;
mod outline;
mod piece;
mod press;
mod region;
mod ring;
mod seam_line;
mod seams;
mod trace;
mod uncovered;
mod words;

pub use corner::{Corner, MITRE_LIMIT};
pub use cut_line::{CutLine, CutRing, Origin, SegmentKind};
pub use cut_list::{CutList, CutListPiece, cut_list};
pub use drawing::{Drawing, Stroke, StrokeKind, StrokeName, Writing};
pub use finding::{CapFault, Finding};
pub use label_block::Words;
pub use notch::{CutNotch, NOTCH_DEPTH};
pub use options::{CutOptions, Shrinkage};
pub use outline::cut_line;
pub use piece::{
    CutPiece, Drill, HalfPlane, InsideLine, PieceError, PieceRing, PieceSegment, PieceText,
    TextKind,
};
pub use press::FoldTick;
pub use ring::FLATNESS;
pub use seam_line::{CutError, Dart, EdgeIndex, SeamEdge, SeamLine};
pub use words::{concerns_cutter, cut_diagnostics};
