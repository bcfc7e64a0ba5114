//! A loop of edges as straight chords with the cloth at their left.

use crate::{Corner, EdgeIndex, SeamEdge};
use toile_geometry::{Curve, Vec2, orient2d, ring_area};

/// Largest distance of chords from the curves (m): a tenth of what a cutter resolves.
pub const FLATNESS: f64 = 5e-6;

/// Factor by which the flattening of edges with tight bends is finer (1).
const FINER: f64 = 8.0;

/// A straight piece of an edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chord {
    pub from: Vec2,
    pub to: Vec2,
    /// Number of the chord's edge in [`Ring::edges`].
    pub edge: usize,
    /// Length along the edge, in the ring's direction, at which the chord starts (m).
    pub at: f64,
    /// Length of the chord (m), above 0.
    pub length: f64,
    /// Unit vector away from the cloth.
    pub normal: Vec2,
}

impl Chord {
    /// Unit vector from the chord's start to its end.
    pub fn along(&self) -> Vec2 {
        Vec2::new(-self.normal.y, self.normal.x)
    }
}

/// An edge of a ring, in the ring's direction.
#[derive(Clone, Debug)]
pub(crate) struct RingEdge {
    /// Number of the edge in the loop as given.
    pub source: usize,
    /// Width of the allowance (m).
    pub width: f64,
    /// Shape of the corner at the edge's start. In its name, previous and next refer to the ring's direction.
    pub corner: Corner,
    /// Limit of the cut line's distance from that corner, over the wider allowance (1).
    pub limit: f64,
    /// Chords of the edge, as a range of [`Ring::chords`].
    pub chords: std::ops::Range<usize>,
    /// Length of all chords (m).
    pub length: f64,
    /// Outward normals of the curve at its start and end. The normals of the first and last chord differ from
    /// these by up to some hundredths, which is half a millimetre at the end of a wide allowance.
    pub ends: [Vec2; 2],
}

/// Points along an edge. Where the edge bends as tightly as its allowance is wide, flattening moves the cut
/// line more than the chords, so such an edge is flattened finer.
fn flattened(edge: &SeamEdge) -> Vec<Vec2> {
    let points = edge.curve.flatten(FLATNESS);
    let is_tight = |p: &[Vec2]| {
        let (a, b) = (p[1] - p[0], p[2] - p[1]);
        let turn = a.perp(&b).atan2(a.dot(&b)).abs();
        turn * edge.width > a.norm().min(b.norm())
    };
    match points.windows(3).any(is_tight) {
        true => edge.curve.flatten(FLATNESS / FINER),
        false => points,
    }
}

impl RingEdge {
    /// Sets the normals at the edge's ends to those of the curve, where the tangent of the curve is close to
    /// the chord.
    fn set_ends(&mut self, chords: &[Chord], curve: &Curve, reversed: bool) {
        let sign = if reversed { -1.0 } else { 1.0 };
        for end in 0..2 {
            let at = if (end == 1) == reversed { 0.0 } else { 1.0 };
            let chord = match end {
                0 => &chords[self.chords.start],
                _ => &chords[self.chords.end - 1],
            };
            let along = curve.derivative(at) * sign;
            let Some(normal) = Vec2::new(along.y, -along.x).try_normalize(0.0) else {
                continue;
            };
            let (sin, cos) = (normal.perp(&chord.normal), normal.dot(&chord.normal));
            let outer = (sin < 0.0) == (end == 1);
            // Outside a tight bend, the curve's normal would move the end of the allowance nearer to the
            // chord.
            let exact = self.width * (1.0 - cos) < FLATNESS;
            if exact || (!outer && cos > 0.95) {
                self.ends[end] = normal;
            }
        }
    }
}

/// A loop of chords that has the cloth at its left: the outline runs counter-clockwise, a hole
/// clockwise. Edges without length are left out.
#[derive(Clone, Debug)]
pub(crate) struct Ring {
    /// Number of the loop: 0 is the outline.
    pub number: usize,
    /// Whether the ring runs against the loop as given.
    pub reversed: bool,
    pub edges: Vec<RingEdge>,
    pub chords: Vec<Chord>,
}

impl Ring {
    pub fn new(edges: &[SeamEdge], number: usize) -> Self {
        let count = edges.len();
        let mut flat: Vec<Vec<Vec2>> = (0..count)
            .map(|k| {
                let mut points = flattened(&edges[k]);
                if let Some(last) = points.last_mut() {
                    *last = edges[(k + 1) % count].curve.start();
                }
                points
            })
            .collect();
        let all: Vec<Vec2> = flat.iter().flatten().copied().collect();
        let reversed = (ring_area(&all) < 0.0) == (number == 0);
        if reversed {
            flat.iter_mut().for_each(|points| points.reverse());
        }
        let mut ring = Self {
            number,
            reversed,
            edges: Vec::with_capacity(count),
            chords: Vec::new(),
        };
        for step in 0..count {
            let source = if reversed { count - 1 - step } else { step };
            let (corner, limit) = if reversed {
                let next = &edges[(source + 1) % count];
                (next.corner.reversed(), next.limit)
            } else {
                (edges[source].corner, edges[source].limit)
            };
            ring.push(&flat[source], source, edges[source].width, (corner, limit));
            if let Some(edge) = ring.edges.last_mut().filter(|edge| edge.source == source) {
                edge.set_ends(&ring.chords, &edges[source].curve, reversed);
            }
        }
        ring
    }

    fn push(&mut self, points: &[Vec2], source: usize, width: f64, (corner, limit): (Corner, f64)) {
        let start = self.chords.len();
        let mut at = 0.0;
        for pair in points.windows(2) {
            let way = pair[1] - pair[0];
            let length = way.norm();
            let normal = Vec2::new(way.y, -way.x) / length;
            if pair[0] != pair[1] && normal.x.is_finite() && normal.y.is_finite() {
                self.chords.push(Chord {
                    from: pair[0],
                    to: pair[1],
                    edge: self.edges.len(),
                    at,
                    length,
                    normal,
                });
                at += length;
            }
        }
        if self.chords.len() > start {
            self.edges.push(RingEdge {
                source,
                width,
                corner,
                limit,
                chords: start..self.chords.len(),
                length: at,
                ends: [self.chords[start], self.chords[self.chords.len() - 1]].map(|c| c.normal),
            });
        }
    }

    /// Number, in the loop as given, of the edge that chord `k` is a part of.
    pub fn source_of(&self, k: usize) -> usize {
        self.edges[self.chords[k].edge].source
    }

    /// Number of an edge in the seam line as given.
    pub fn index(&self, edge: usize) -> EdgeIndex {
        EdgeIndex {
            ring: self.number,
            edge: self.edges[edge].source,
        }
    }

    /// Number of the edge before `edge` in the ring.
    pub fn before(&self, edge: usize) -> usize {
        (edge + self.edges.len() - 1) % self.edges.len()
    }

    /// Number of the edge after `edge` in the ring.
    pub fn after(&self, edge: usize) -> usize {
        (edge + 1) % self.edges.len()
    }

    /// First chord of an edge.
    pub fn first(&self, edge: usize) -> &Chord {
        &self.chords[self.edges[edge].chords.start]
    }

    /// Last chord of an edge.
    pub fn last(&self, edge: usize) -> &Chord {
        &self.chords[self.edges[edge].chords.end - 1]
    }

    /// Vector from a chord's start (0) or end (1) to the outer end of its allowance (m).
    pub fn out(&self, k: usize, end: usize) -> Vec2 {
        let edge = &self.edges[self.chords[k].edge];
        let at_end = match end {
            0 => k == edge.chords.start,
            _ => k + 1 == edge.chords.end,
        };
        match at_end {
            true => edge.ends[end] * edge.width,
            false => self.chords[k].normal * edge.width,
        }
    }

    /// Distance of a place from the start of its edge as given (m); `at` is the distance in the ring's
    /// direction (m).
    pub fn given_place(&self, edge: usize, at: f64) -> f64 {
        if self.reversed {
            self.edges[edge].length - at
        } else {
            at
        }
    }

    /// The legs of a dart as edges of the ring, in the ring's order. `None`: a leg is missing or they do not
    /// meet.
    pub fn legs(&self, legs: [usize; 2]) -> Option<[usize; 2]> {
        let find = |source: usize| self.edges.iter().position(|e| e.source == source);
        let [a, b] = [find(legs[0])?, find(legs[1])?];
        let ordered = if self.reversed { [b, a] } else { [a, b] };
        (self.after(ordered[0]) == ordered[1]).then_some(ordered)
    }

    /// Whether two legs cut into the cloth: whether their apex is an inner corner.
    pub fn is_notch(&self, legs: [usize; 2]) -> bool {
        self.legs(legs).is_some_and(|[a, b]| {
            let (from, apex, to) = (self.first(a).from, self.first(b).from, self.last(b).to);
            self.edges.len() > 2 && orient2d(from, apex, to) < 0.0
        })
    }
}
