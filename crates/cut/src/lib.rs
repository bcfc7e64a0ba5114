//! Pieces as they are cut: the seam line of a piece grown by the allowance of each of its edges.
//!
//! The cut line is the boundary of a union of convex pieces of cloth (a rectangle outside each
//! chord, a wedge at each outer bend, a patch at each corner, a cap at each dart), so that it
//! cannot cross itself and no loops have to be taken out. Every segment of it says which edge it
//! belongs to; what could not be done as asked is listed. Lengths in metres.
//! `docs/methods/cut.md` has the equations.

#![cfg_attr(test, allow(clippy::unwrap_used))]

mod allowance;
mod chain;
mod check;
mod corner;
mod cut_line;
mod dart;
mod finding;
mod outline;
mod region;
mod ring;
mod seam_line;
mod stretch;
mod trace;

pub use corner::{Corner, MITRE_LIMIT};
pub use cut_line::{CutLine, CutRing, Origin, SegmentKind};
pub use finding::{CapFault, Finding};
pub use outline::cut_line;
pub use ring::FLATNESS;
pub use seam_line::{CutError, Dart, EdgeIndex, SeamEdge, SeamLine};
