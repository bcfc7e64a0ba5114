//! A cut line: rings whose segments say where they come from.

use crate::{EdgeIndex, Finding};
use toile_geometry::{Polygon, Vec2};

/// The kind of a segment of a cut line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SegmentKind {
    /// Part of an edge's own cut line, at the edge's width; for an edge of width 0, the edge itself.
    Edge,
    /// Boundary of the cloth at a dart's mouth; the edge is the leg that the boundary lies beside.
    DartCap,
    /// A side of the cloth of a corner, or the end of an allowance that is wider than the one beside it; the
    /// edge is the one that starts at the corner.
    Corner,
}

/// The edge and the kind of a segment of a cut line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Origin {
    /// The edge of the seam line.
    pub edge: EdgeIndex,
    /// Kind of the segment.
    pub kind: SegmentKind,
}

/// A closed line to cut along.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CutRing {
    /// Corners of the ring (m); the first is not repeated.
    pub points: Vec<Vec2>,
    /// Origins of the segments, one for the segment from each corner to the next.
    pub origins: Vec<Origin>,
}

/// The line that a piece is cut along, with the cloth at its left: the outline runs counter-clockwise, holes
/// run clockwise. No ring crosses itself or another (tested with exact signs); rings may touch in a point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CutLine {
    /// The ring round the piece.
    pub outline: CutRing,
    /// Rings inside the outline: first the remains of the holes, in their order, then bays whose mouth is
    /// closed by the allowances.
    pub holes: Vec<CutRing>,
    /// Faults of the cut line.
    pub findings: Vec<Finding>,
}

impl CutLine {
    /// The piece as cut, without the kinds of its segments.
    pub fn polygon(&self) -> Polygon {
        Polygon {
            outer: self.outline.points.clone(),
            holes: self.holes.iter().map(|ring| ring.points.clone()).collect(),
        }
    }
}
