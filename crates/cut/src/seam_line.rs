//! Input: the seam line of a piece, with allowances, corners and darts.

use crate::Corner;
use toile_geometry::{Curve, Vec2};

/// An edge of a seam line, and the allowance beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeamEdge {
    /// The line that is sewn (m); it ends where the next edge of its loop starts.
    pub curve: Curve,
    /// Width of the allowance (m), measured square to the curve; 0 for none.
    pub width: f64,
    /// Shape of the cut line at the corner at the edge's start.
    pub corner: Corner,
    /// Limit of the cut line's distance from that corner, over the wider allowance (1): usually
    /// [`crate::MITRE_LIMIT`], from 1 to 100.
    pub limit: f64,
}

/// A dart that is sewn shut and pressed to one side. It is drawn as two edges of the outline, its legs, that
/// meet in the apex; widths and corners of the legs are not used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dart {
    /// Numbers of the outline's edges: the leg before the apex and the leg after it.
    pub legs: [usize; 2],
    /// Leg that the cloth inside the dart is pressed towards: 0 or 1.
    pub pressed: usize,
}

/// The line that a piece is sewn along, unfolded. Loops may run either way.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SeamLine {
    /// The edges round the piece; the allowance lies outside.
    pub outline: Vec<SeamEdge>,
    /// The edges round each hole; the allowance lies inside the hole.
    pub holes: Vec<Vec<SeamEdge>>,
    /// The darts in the outline.
    pub darts: Vec<Dart>,
}

/// Number of an edge in a [`SeamLine`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EdgeIndex {
    /// The loop: 0 is the outline, `k + 1` is hole `k`.
    pub ring: usize,
    /// The edge in the loop.
    pub edge: usize,
}

/// Reason why a seam line has no cut line.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CutError {
    /// A coordinate is not a finite number.
    #[error("{0:?} has a coordinate that is not a finite number")]
    NotFinite(EdgeIndex),
    /// A width is negative or not a finite number.
    #[error("{0:?} has an allowance that is negative or not a finite number")]
    Width(EdgeIndex),
    /// A corner's limit is not from 1 to 100.
    #[error("{0:?} starts at a corner whose limit is not from 1 to 100")]
    Limit(EdgeIndex),
    /// An edge does not end where the next one starts.
    #[error("{0:?} ends {1} m from where the next edge starts")]
    Open(EdgeIndex, f64),
    /// A loop encloses nothing.
    #[error("loop {0} encloses nothing")]
    NoArea(usize),
    /// Two edges cross or touch other than end to start.
    #[error("{0:?} and {1:?} meet at {2:?}")]
    Crossing(EdgeIndex, EdgeIndex, Vec2),
    /// A hole lies outside the outline or in another hole.
    #[error("hole {0} lies outside the outline or in another hole")]
    StrayHole(usize),
    /// A dart is impossible: its legs do not follow each other, belong to another dart too, or point
    /// outwards, or `pressed` is neither 0 nor 1.
    #[error("dart {0} has legs that do not follow each other, are another dart's, or point out")]
    Dart(usize),
}

impl SeamLine {
    /// The edges of a loop: 0 is the outline, `k + 1` is hole `k`.
    pub fn edges(&self, ring: usize) -> Option<&[SeamEdge]> {
        match ring.checked_sub(1) {
            None => Some(&self.outline),
            Some(hole) => self.holes.get(hole).map(Vec::as_slice),
        }
    }
}
