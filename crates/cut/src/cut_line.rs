//! A cut line: rings whose segments say where they come from.

use crate::{EdgeIndex, Finding};
use toile_geometry::{Polygon, Vec2};

/// The kind of a segment of a cut line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SegmentKind {
    /// Part of an edge's own cut line, at the edge's width; of an edge of width 0 the edge itself.
    Edge,
    /// Boundary of the cloth at a dart's mouth; the edge is the leg it lies beside.
    DartCap,
    /// A side of a corner's cloth, or the end of an allowance beside a wider one; the edge is the one that
    /// starts at the corner.
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
    /// Origin of the segment from each corner to the next, one each.
    pub origins: Vec<Origin>,
}

/// The line that a piece is cut along, the cloth at the left: the outline runs counter-clockwise, holes run
/// clockwise. No ring crosses itself or another (exact signs); they may touch in a point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CutLine {
    /// The ring round the piece.
    pub outline: CutRing,
    /// Rings inside the outline: the remains of the holes, in their order, and bays that have grown shut.
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
