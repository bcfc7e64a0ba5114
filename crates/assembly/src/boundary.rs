//! The sampled boundary of one piece: closed polygons that must not cross or touch.

use crate::AssemblyError;
use crate::edges::{EdgeTable, polygon_area};
use crate::sampling::Sampling;
use std::ops::Range;
use toile_geometry::{Vec2, orient2d, segments_cross};
use toile_pattern::Piece;

/// Whether a point lies inside a polygon, by the parity of the edges to its right.
fn inside(p: Vec2, polygon: &[Vec2]) -> bool {
    let crossed = |k: usize| {
        let (a, b) = (polygon[k], polygon[(k + 1) % polygon.len()]);
        (a.y > p.y) != (b.y > p.y) && (orient2d(a, b, p) > 0.0) == (b.y > a.y)
    };
    (0..polygon.len()).filter(|&k| crossed(k)).count() % 2 == 1
}

/// Sampled loops of one piece.
#[derive(Clone, Debug, Default)]
pub(crate) struct Boundary {
    /// Vertices, loop after loop (m).
    pub points: Vec<Vec2>,
    /// Vertex range of each loop, the outline first.
    pub loops: Vec<Range<usize>>,
    /// For each edge of the piece, the vertices of its samples.
    pub samples: Vec<Vec<usize>>,
    /// Whether the outline is counter-clockwise.
    pub counter_clockwise: bool,
}

impl Boundary {
    /// Samples the loops of a piece and checks them.
    pub fn new(
        piece: &Piece,
        index: usize,
        table: &EdgeTable,
        sampling: &Sampling,
    ) -> Result<Self, AssemblyError> {
        let boundary = Self::sampled(index, table, sampling);
        boundary.check(piece)?;
        Ok(boundary)
    }

    /// Samples the loops of a piece without checking that they can be meshed.
    pub fn sampled(index: usize, table: &EdgeTable, sampling: &Sampling) -> Self {
        let mut boundary = Self::default();
        let mut contour = usize::MAX;
        for edge in table.of_piece(index) {
            if table.edges[edge].contour != contour {
                contour = table.edges[edge].contour;
                let at = boundary.points.len();
                boundary.loops.push(at..at);
            }
            let fractions = &sampling.fractions[edge];
            let start = boundary.points.len();
            let count = fractions.len() - 1;
            boundary.points.extend(
                fractions[..count]
                    .iter()
                    .map(|&f| table.edges[edge].point(f)),
            );
            boundary.samples.push((start..=start + count).collect());
            if let Some(last) = boundary.loops.last_mut() {
                last.end = boundary.points.len();
            }
        }
        let first = table.first[index];
        for (local, samples) in boundary.samples.iter_mut().enumerate() {
            let range = &boundary.loops[table.edges[first + local].contour];
            if let Some(last) = samples.last_mut()
                && *last == range.end
            {
                *last = range.start;
            }
        }
        let outline = &boundary.points[boundary.loops[0].clone()];
        boundary.counter_clockwise = polygon_area(outline) > 0.0;
        boundary
    }

    /// Whether a point lies inside the outline and outside the holes.
    pub fn contains(&self, p: Vec2) -> bool {
        let within = |range: &Range<usize>| inside(p, &self.points[range.clone()]);
        within(&self.loops[0]) && !self.loops[1..].iter().any(within)
    }

    /// Boundary segments as vertex pairs, in loop order.
    pub fn segments(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        self.loops.iter().flat_map(|range| {
            range.clone().map(|v| {
                let next = v + 1;
                [v, if next == range.end { range.start } else { next }]
            })
        })
    }

    /// Checks that the loops enclose area and neither cross nor touch each other.
    ///
    /// # Errors
    /// The fault of the outline.
    pub fn check(&self, piece: &Piece) -> Result<(), AssemblyError> {
        let error = |reason: String, remedy: &str| AssemblyError::Outline {
            piece: piece.name.clone(),
            reason,
            remedy: remedy.to_owned(),
        };
        for (k, range) in self.loops.iter().enumerate() {
            let area = polygon_area(&self.points[range.clone()]);
            if range.len() < 3 || area.is_nan() || area.abs() <= 1e-10 {
                let what = if k == 0 { "outline" } else { "hole" };
                let reason = format!("the {what} encloses no area");
                return Err(error(
                    reason,
                    "draw it larger, or ask for a smaller edge length",
                ));
            }
        }
        if let Some(at) = self.first_crossing() {
            let (x, y) = (at.x * 1000.0, at.y * 1000.0);
            let reason = format!("the outline crosses or touches itself near ({x:.1}, {y:.1}) mm");
            return Err(error(
                reason,
                "move its points apart, or ask for a smaller edge length",
            ));
        }
        let outline = &self.points[self.loops[0].clone()];
        for hole in &self.loops[1..] {
            if !inside(self.points[hole.start], outline) {
                return Err(error(
                    "a hole lies outside the outline".to_owned(),
                    "move it inside",
                ));
            }
            for other in &self.loops[1..] {
                if other != hole && inside(self.points[hole.start], &self.points[other.clone()]) {
                    return Err(error(
                        "a hole lies inside another hole".to_owned(),
                        "remove one of them",
                    ));
                }
            }
        }
        Ok(())
    }

    /// First point at which two segments cross or touch, by a sweep over segments sorted by x.
    fn first_crossing(&self) -> Option<Vec2> {
        let mut segments: Vec<[usize; 2]> = self.segments().collect();
        for &[a, b] in &segments {
            if self.points[a] == self.points[b] {
                return Some(self.points[a]);
            }
        }
        let low = |s: &[usize; 2]| self.points[s[0]].x.min(self.points[s[1]].x);
        let high = |s: &[usize; 2]| self.points[s[0]].x.max(self.points[s[1]].x);
        segments.sort_by(|s, t| low(s).total_cmp(&low(t)).then(s.cmp(t)));
        for (k, s) in segments.iter().enumerate() {
            for t in segments[k + 1..].iter().take_while(|t| low(t) <= high(s)) {
                if self.meet(*s, *t) {
                    return Some((self.points[s[0]] + self.points[s[1]]) * 0.5);
                }
            }
        }
        None
    }

    fn meet(&self, s: [usize; 2], t: [usize; 2]) -> bool {
        let p = |v: usize| self.points[v];
        let folded = |a: usize, joint: usize, c: usize| {
            orient2d(p(a), p(joint), p(c)) == 0.0 && (p(a) - p(joint)).dot(&(p(c) - p(joint))) > 0.0
        };
        if s[1] == t[0] {
            folded(s[0], s[1], t[1])
        } else if t[1] == s[0] {
            folded(t[0], s[0], s[1])
        } else {
            segments_cross([p(s[0]), p(s[1])], [p(t[0]), p(t[1])])
        }
    }
}
