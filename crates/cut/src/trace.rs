//! Finds the side of the cloth that every segment of the cleaned outline comes from.

use crate::chain::{Chain, Tag};
use crate::region::Frame;
use crate::ring::Ring;
use crate::{CutRing, Origin, SegmentKind};
use std::ops::ControlFlow;
use toile_geometry::{EdgeTree, Vec2, point_segment_distance};

/// Least distance of a corner from the line between its two neighbours at which the ring turns there, over
/// the distance to the nearer neighbour (1).
const TURN: f64 = 1e-4;

/// All sides of all chains of cloth: in coordinates of the frame (`tree`) and of the piece (`given`).
pub(crate) struct Sides {
    frame: Frame,
    tree: EdgeTree,
    given: Vec<[Vec2; 2]>,
    tags: Vec<Tag>,
}

/// A ring of the union, with the side of a chain that each of its segments lies on.
pub(crate) struct Traced {
    /// Corners (m), moved back from the frame to coordinates of the piece.
    pub points: Vec<Vec2>,
    /// Side of a chain that each segment lies on, as its number in [`Sides`].
    pub sides: Vec<usize>,
    /// Start and end of each segment on its side (shares of the side's length).
    pub spans: Vec<[f64; 2]>,
}

/// A part of a ring's segment that runs along a side of a chain.
struct Overlap {
    /// Start along the segment (m).
    from: f64,
    to: f64,
    side: usize,
}

/// Rank of a tag: where a segment lies along several sides, it gets the tag of the least rank.
fn rank(tag: &Tag) -> u8 {
    match (tag.kind, tag.beside) {
        (SegmentKind::Edge, Some(_)) => 0,
        (SegmentKind::Edge, None) => 1,
        (SegmentKind::DartCap, _) => 2,
        (SegmentKind::Corner, _) => 3,
    }
}

impl Sides {
    pub fn new(chains: &[Chain], frame: Frame) -> Self {
        let (mut given, mut tags) = (Vec::new(), Vec::new());
        for chain in chains {
            for (k, &from) in chain.points.iter().enumerate() {
                given.push([from, chain.points[(k + 1) % chain.points.len()]]);
                tags.push(chain.tags[k]);
            }
        }
        let snapped = given.iter().map(|side| side.map(|p| frame.snap(p)));
        Self {
            frame,
            tree: EdgeTree::new(snapped.collect()),
            given,
            tags,
        }
    }

    pub fn tag(&self, side: usize) -> &Tag {
        &self.tags[side]
    }

    /// The part of a segment that runs along a side in the same direction; `None`: no part does.
    fn overlap(&self, [p, q]: [Vec2; 2], side: usize) -> Option<Overlap> {
        let [a, b] = self.tree.edges()[side];
        let tolerance = self.frame.tolerance;
        let length = (q - p).norm();
        let along = (q - p) / length;
        let (start, end) = ((a - p).dot(&along), (b - p).dot(&along));
        let (from, to) = (start.max(0.0), end.min(length));
        if to - from <= tolerance.min(0.5 * length) {
            return None;
        }
        let off = |t: f64| {
            let share = (t - start) / (end - start);
            along.perp(&(a + (b - a) * share - p)).abs()
        };
        (off(from) <= tolerance && off(to) <= tolerance).then_some(Overlap { from, to, side })
    }

    /// The parts of each segment of a ring that run along sides.
    fn overlaps(&self, segments: &[[Vec2; 2]]) -> Vec<Vec<Overlap>> {
        let mut found: Vec<Vec<Overlap>> = segments.iter().map(|_| Vec::new()).collect();
        let tree = EdgeTree::new(segments.to_vec());
        let _ = tree.pairs(&self.tree, self.frame.tolerance, &mut |segment, side| {
            found[segment].extend(self.overlap(segments[segment], side));
            ControlFlow::Continue(())
        });
        found
    }

    fn nearest(&self, p: Vec2) -> usize {
        let distance = |k: &usize| point_segment_distance(p, self.tree.edges()[*k]);
        let order = |a: &usize, b: &usize| distance(a).total_cmp(&distance(b));
        (0..self.tags.len()).min_by(order).unwrap_or(0)
    }

    /// Sides along a segment, each with the place where it begins (m): at every place the side of the least
    /// rank, in order, without gaps.
    fn pieces(&self, segment: [Vec2; 2], overlaps: &[Overlap]) -> Vec<(f64, usize)> {
        let length = (segment[1] - segment[0]).norm();
        let covers = |overlap: &&Overlap, t: f64| overlap.from <= t && t <= overlap.to;
        let best = |t: f64| {
            let order = |o: &&Overlap| (rank(&self.tags[o.side]), o.side);
            overlaps.iter().filter(|o| covers(o, t)).min_by_key(order)
        };
        let mut breaks: Vec<f64> = overlaps.iter().flat_map(|o| [o.from, o.to]).collect();
        breaks.extend([0.0, length]);
        breaks.sort_by(f64::total_cmp);
        let mut pieces: Vec<(f64, usize)> = Vec::new();
        for pair in breaks.windows(2) {
            if pair[1] - pair[0] <= 2.0 * self.frame.tolerance
                && length > 8.0 * self.frame.tolerance
            {
                continue;
            }
            let Some(found) = best(0.5 * (pair[0] + pair[1])) else {
                continue;
            };
            if pieces.last().is_none_or(|&(_, side)| side != found.side) {
                pieces.push((pair[0], found.side));
            }
        }
        match pieces.first_mut() {
            Some(first) => first.0 = 0.0,
            None => pieces.push((0.0, self.nearest((segment[0] + segment[1]) * 0.5))),
        }
        pieces
    }

    /// A ring in the frame, with the side that each of its segments lies on; a segment along several sides is
    /// divided. If `exact`, corners that are ends of sides get the original coordinates of those ends.
    pub fn trace(&self, ring: &[Vec2], exact: bool) -> Traced {
        let count = ring.len();
        let segments: Vec<[Vec2; 2]> = (0..count)
            .map(|k| [ring[k], ring[(k + 1) % count]])
            .collect();
        let overlaps = self.overlaps(&segments);
        let (mut points, mut sides) = (Vec::with_capacity(count), Vec::with_capacity(count));
        for (segment, overlaps) in segments.iter().zip(&overlaps) {
            let along = (segment[1] - segment[0]).normalize();
            for (at, side) in self.pieces(*segment, overlaps) {
                points.push(segment[0] + along * at);
                sides.push(side);
            }
        }
        let count = points.len();
        let spans = (0..count)
            .map(|k| [points[k], points[(k + 1) % count]].map(|p| self.share(sides[k], p)))
            .collect();
        let given = (0..count).map(|k| {
            let local = points[k];
            let before = sides[(k + count - 1) % count];
            let ends = [(sides[k], 0), (before, 1), (sides[k], 1), (before, 0)];
            let near = |&&(side, end): &&(usize, usize)| {
                (self.tree.edges()[side][end] - local).norm() <= self.frame.tolerance
            };
            match ends.iter().find(near).filter(|_| exact) {
                Some(&(side, end)) => self.given[side][end],
                None => local + self.frame.origin,
            }
        });
        Traced {
            points: given.collect(),
            sides,
            spans,
        }
    }

    /// Place of a point along a side (share of the side's length).
    fn share(&self, side: usize, p: Vec2) -> f64 {
        let [a, b] = self.tree.edges()[side];
        let way = b - a;
        let share = (p - a).dot(&way) / way.norm_squared();
        if share.is_finite() {
            share.clamp(0.0, 1.0)
        } else {
            0.0
        }
    }
}

impl Traced {
    /// The ring as part of the cut line, with the edges as given. If `merged`, corners are left out at which
    /// the ring does not turn and no edge ends, such as between the cloth of a corner and the cut line that
    /// continues it.
    pub fn ring(&self, ring: &Ring, sides: &Sides, merged: bool) -> CutRing {
        let mut tags: Vec<Tag> = self.sides.iter().map(|&side| *sides.tag(side)).collect();
        let mut points = self.points.clone();
        let mut k = 0;
        while merged && k < points.len() && points.len() > 3 {
            let before = (k + points.len() - 1) % points.len();
            let after = points[(k + 1) % points.len()];
            let off = point_segment_distance(points[k], [points[before], after]);
            let shorter = (points[k] - points[before])
                .norm()
                .min((after - points[k]).norm());
            let straight = off <= sides.frame.tolerance && off <= TURN * shorter;
            let one = joined(ring, [&tags[before], &tags[k]]);
            match one.filter(|_| straight) {
                Some(tag) => {
                    tags[before] = tag;
                    points.remove(k);
                    tags.remove(k);
                }
                None => k += 1,
            }
        }
        let origin = |tag: Tag| Origin {
            edge: ring.index(tag.edge),
            kind: tag.kind,
        };
        CutRing {
            points,
            origins: tags.into_iter().map(origin).collect(),
        }
    }
}

/// The tag of the segment that two neighbouring segments on one line are joined to. A corner's segment
/// becomes part of the edge or dart cap beside it. `None`: they stay apart, as their tags do not fit
/// together.
fn joined(ring: &Ring, [a, b]: [&Tag; 2]) -> Option<Tag> {
    use SegmentKind::{Corner, DartCap, Edge};
    let beside = [ring.before(a.edge), a.edge, ring.after(a.edge)].contains(&b.edge);
    match (a.kind, b.kind) {
        (Edge, Corner) | (DartCap, Corner) if beside => Some(*a),
        (Corner, Edge) | (Corner, DartCap) if beside => Some(*b),
        (Corner, Corner) | (DartCap, DartCap) if a.edge == b.edge => Some(*a),
        _ => None,
    }
}
