//! A closed polygon round cloth; each side is tagged with the edge it comes from.

use crate::SegmentKind;
use crate::ring::Ring;
use toile_geometry::Vec2;

/// The edge that a side of a chain comes from, and the kind of cloth it bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tag {
    /// Edge of the ring.
    pub edge: usize,
    pub kind: SegmentKind,
    /// The chord that the side runs along, with the side's start and end on it (shares of the chord's
    /// length).
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

/// Tag of the sides that belong to the corner at an edge's start. In a ring that is walked backwards the
/// corner is named after the edge before, which starts there as given.
pub(crate) fn corner_tag(ring: &Ring, edge: usize) -> Tag {
    Tag {
        edge: corner_edge(ring, edge),
        kind: SegmentKind::Corner,
        beside: None,
    }
}

/// The edge of the ring that the corner at an edge's start is named after.
pub(crate) fn corner_edge(ring: &Ring, edge: usize) -> usize {
    if ring.reversed {
        ring.before(edge)
    } else {
        edge
    }
}
