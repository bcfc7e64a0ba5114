//! A closed polygon round cloth; each side is tagged with the edge it comes from.

use crate::SegmentKind;
use crate::ring::Ring;
use toile_geometry::Vec2;

/// The edge that a side of a chain comes from, and the kind of cloth that the side bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tag {
    /// Number of the edge in the ring.
    pub edge: usize,
    pub kind: SegmentKind,
    /// Index of the chord of the flattened edge that the side is parallel to, and the start and end of the
    /// side along that chord (shares of its length). `None` for a side at a corner, which follows no chord.
    pub beside: Option<(usize, [f64; 2])>,
}

/// A closed loop of tagged sides: side k runs from point k to the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct Chain {
    pub points: Vec<Vec2>,
    pub tags: Vec<Tag>,
}

impl Chain {
    pub fn side(&mut self, from: Vec2, tag: Tag) {
        self.points.push(from);
        self.tags.push(tag);
    }

    pub fn patch(points: Vec<Vec2>, tag: Tag) -> Self {
        let tags = vec![tag; points.len()];
        Self { points, tags }
    }
}

/// Tag of the sides that belong to the corner at the start of `edge`. A corner has the number of the edge
/// that starts there in the loop as given. In a ring that is walked backwards that is the edge before `edge`.
pub(crate) fn corner_tag(ring: &Ring, edge: usize) -> Tag {
    Tag {
        edge: corner_edge(ring, edge),
        kind: SegmentKind::Corner,
        beside: None,
    }
}

/// Number, in the ring, of the edge that stands for the corner at the start of `edge`.
pub(crate) fn corner_edge(ring: &Ring, edge: usize) -> usize {
    if ring.reversed {
        ring.before(edge)
    } else {
        edge
    }
}
