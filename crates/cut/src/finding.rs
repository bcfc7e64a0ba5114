//! Faults of a cut line: allowances, corners, darts and notches that could not be made as asked.

use crate::EdgeIndex;
use toile_geometry::Vec2;
use toile_pattern::NotchId;

/// Reason why the mouth of a dart is cut straight across.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CapFault {
    /// The neighbour, the edge next to the leg that the dart is pressed towards, is a leg of a dart too.
    NoNeighbour,
    /// The leg runs along the neighbour's cut line or nearly so, or the mouth has no width.
    NoMeeting,
    /// The neighbour edge is too short, or the dart too wide: the mirror image of the cut line does not reach
    /// the fold line.
    TooShort,
    /// The cap would cross the dart's legs or itself.
    Crossing,
}

/// A fault of a cut line. Places along an edge are measured from the start of the edge as given.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding {
    /// Part of an edge has no cut line of its own, because other cloth or allowance lies there: the piece is
    /// cut farther out.
    Swallowed {
        /// The edge.
        edge: EdgeIndex,
        /// Start and end of that part (m).
        span: [f64; 2],
        /// Whether the part starts or ends at an inner corner or a dart, where allowances always overlap.
        inner_corner: bool,
    },
    /// On part of an edge the allowance, measured square to the seam line, is narrower than asked, because
    /// the shape of a corner cuts it.
    Narrow {
        /// The edge.
        edge: EdgeIndex,
        /// Start and end of that part (m).
        span: [f64; 2],
        /// Least width of the allowance there (m).
        least: f64,
    },
    /// A corner is too sharp for its allowance and cut off.
    CutOff {
        /// The edge that starts at the corner.
        corner: EdgeIndex,
        /// Distance from the seam line's corner that the uncut corner would reach (m).
        asked: f64,
        /// Distance from the seam line's corner at which it is cut off (m).
        kept: f64,
    },
    /// A corner is too blunt for the shape asked, which would reach too far, and is mitred.
    Mitred {
        /// The edge that starts at the corner.
        corner: EdgeIndex,
        /// Distance from the seam line's corner that the shape asked would reach (m).
        asked: f64,
    },
    /// The allowances along the two sides of a slit overlap: the slit is not cut open.
    SlitShut {
        /// The edges at the two ends of the slit's mouth, in counter-clockwise order round the piece.
        edges: [EdgeIndex; 2],
        /// Middle of the mouth on the seam line (m).
        mouth: Vec2,
        /// Greatest distance of the shut seam line from the cut line (m).
        depth: f64,
        /// Length of seam line shut in (m).
        length: f64,
    },
    /// The allowances round a bay of the outline meet at its mouth, so that the bay becomes a hole in the
    /// piece.
    BayShut {
        /// Number of the hole in [`crate::CutLine::holes`].
        hole: usize,
        /// Area of the hole (m2).
        area: f64,
    },
    /// A hole is filled by its allowance, or divided into parts.
    HoleShut {
        /// Number of the hole in the seam line.
        hole: usize,
        /// Number of parts that remain: 0, or more than 1.
        parts: usize,
    },
    /// A dart's mouth is cut straight across.
    StraightCap {
        /// Number of the dart.
        dart: usize,
        /// Reason why it is not shaped by folding.
        fault: CapFault,
    },
    /// Notches are cut less deep than usual, as the allowance is narrower.
    NotchesShort {
        /// The notches.
        notches: Vec<NotchId>,
        /// Depth of the shallowest of them (m).
        depth: f64,
    },
    /// Notches are drawn on the seam line, as there is no allowance to cut them into.
    NotchesDrawn {
        /// The notches.
        notches: Vec<NotchId>,
    },
}
