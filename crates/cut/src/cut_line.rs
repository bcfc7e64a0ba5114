//! A cut line: rings whose segments say where they come from.

use crate::{EdgeIndex, Finding};
use toile_geometry::{Polygon, Vec2};

/// The kind of a segment of a cut line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SegmentKind {
    /// A piece of an edge's cut line, in the edge's width beside it; of width 0 the edge itself.
    Edge,
    /// Cloth at a dart's mouth; the edge is the leg it lies beside.
    DartCap,
    /// A side of a corner, or the end of an allowance at a wider one; the edge is the one that
    /// starts at the corner.
    Corner,
}

/// Where a segment of a cut line comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Origin {
    /// The edge of the seam line.
    pub edge: EdgeIndex,
    /// Its kind.
    pub kind: SegmentKind,
}

/// A closed line to cut along.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CutRing {
    /// Its corners (m); the first is not repeated.
    pub points: Vec<Vec2>,
    /// Where the segment from each corner to the next comes from, one each.
    pub origins: Vec<Origin>,
}

/// Where a piece is cut, the cloth at the left: the outline runs counter-clockwise, holes run
/// clockwise. No ring crosses itself or another (exact signs); they may touch in a point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CutLine {
    /// Round the piece.
    pub outline: CutRing,
    /// Inside it: what remains of the holes, in their order, and bays that have grown shut.
    pub holes: Vec<CutRing>,
    /// Its faults.
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
