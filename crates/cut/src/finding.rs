//! Faults of a cut line: allowances, corners, darts and notches that could not be made as asked.

use crate::EdgeIndex;
use toile_geometry::Vec2;
use toile_pattern::NotchId;

/// Reason why the mouth of a dart is cut straight across.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CapFault {
    /// The edge that the dart is pressed towards is a leg of a dart too.
    NoNeighbour,
    /// The leg runs along the neighbour's cut line or nearly so, or the mouth has no width.
    NoMeeting,
    /// The neighbour is too short, or the dart too wide: the mirror image of the cut line does
    /// not come to the fold line.
    TooShort,
    /// The cap would cross the dart's legs or itself.
    Crossing,
}

/// A fault of a cut line. Places along an edge are measured from the start of the edge as given.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding {
    /// Along a span of an edge the edge's own cut line is missing, because other cloth or allowance lies
    /// there: the piece is cut farther out.
    Swallowed {
        /// The edge.
        edge: EdgeIndex,
        /// The span, from and to (m).
        span: [f64; 2],
        /// Whether the span starts or ends at an inner corner or a dart, where allowances always overlap.
        inner_corner: bool,
    },
    /// Along a span of an edge the allowance, measured square to the seam line, is narrower than asked: a
    /// corner takes some of it.
    Narrow {
        /// The edge.
        edge: EdgeIndex,
        /// The span, from and to (m).
        span: [f64; 2],
        /// Least width (m).
        least: f64,
    },
    /// A corner is too sharp for its allowance and cut off.
    CutOff {
        /// The edge that starts at the corner.
        corner: EdgeIndex,
        /// Distance from the seam line's corner that the cut line would reach (m).
        asked: f64,
        /// Distance that it reaches (m).
        kept: f64,
    },
    /// A corner is too blunt for the shape asked, which would reach too far, and is mitred.
    Mitred {
        /// The edge that starts at the corner.
        corner: EdgeIndex,
        /// Distance from the seam line's corner that the shape asked would reach (m).
        asked: f64,
    },
    /// The allowances of a slit's sides meet: it is not cut open.
    SlitShut {
        /// The edges at the slit's mouth, in the cloth's order.
        edges: [EdgeIndex; 2],
        /// Middle of the mouth on the seam line (m).
        mouth: Vec2,
        /// Greatest distance of the shut seam line from the cut line (m).
        depth: f64,
        /// Length of seam line shut in (m).
        length: f64,
    },
    /// The allowances round a bay meet at its mouth and leave a hole in the piece.
    BayShut {
        /// Number of the hole in [`crate::CutLine::holes`].
        hole: usize,
        /// Area of the hole (m2).
        area: f64,
    },
    /// A hole is filled by its allowance, or falls into parts.
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
        /// Reason.
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
