//! Places of notches on an outline: at a corner, or at a share of the edge between two corners.

use super::allowance::nearest;
use super::cubics::Cubics;
use super::piece::{Chords, DrawnLine, DrawnNotch};
use toile_geometry::Vec2;

/// Largest distance of a notch from the line of an edge that it belongs to beyond the corner (m).
const ON_LINE: f64 = 2e-4;
/// Largest distance of a notch from the sew line that still lies on it, not on the cut line (m).
const ON_SEW_LINE: f64 = 1e-3;
/// Distances from a notch that differ by less count as one (m): at an allowance of 10 mm this is 1 mm along the
/// line, nearer than notches are set to a corner.
const AS_NEAR: f64 = 5e-5;
/// Longest way from the sew line, or from a corner of it, to a notch on the cut line that belongs to it (m).
const MAX_REACH: f64 = 0.06;

/// A place on an outline.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum OutlinePlace {
    /// At the vertex of this number, a corner.
    Corner(usize),
    /// On the edge between two vertices.
    Between {
        /// Numbers of the vertices at the corners, the second after the first in the order of the line.
        corners: [usize; 2],
        /// Share of the length of the edge before the place, in each size.
        shares: Vec<f64>,
    },
}

/// An outline with its corners, and the cubics of the edges that start at them.
pub(crate) struct Marked<'a> {
    pub outline: &'a DrawnLine,
    pub corners: &'a [usize],
    pub curves: &'a [Option<Cubics>],
    /// Index of the base size.
    pub base: usize,
    /// Number of sizes, at least 1.
    pub sizes: usize,
}

impl Marked<'_> {
    /// The place of a notch; `None` if it lies far from the outline.
    pub fn place(&self, notch: &DrawnNotch) -> Option<OutlinePlace> {
        let chords = self.outline.chords(self.base);
        if let Some(corner) = corner_of(notch.at, &chords, self.corners) {
            return Some(OutlinePlace::Corner(corner));
        }
        let near = nearest(notch.at, &chords.points);
        let found = near.filter(|found| found.distance <= MAX_REACH)?;
        let count = self.outline.len();
        let (vertex, part) = chords.place(found.chord, found.share);
        let c = self.corners.iter().rposition(|&corner| corner <= vertex);
        let c = c.unwrap_or(self.corners.len() - 1);
        let from = self.corners[c];
        let next = self.corners[(c + 1) % self.corners.len()];
        let to = if next > from { next } else { next + count };
        let along = |(vertex, part): (usize, f64)| match vertex >= from {
            true => (vertex - from) as f64 + part,
            false => (vertex + count - from) as f64 + part,
        };
        let share = |size: usize| {
            // The place of its own in this size, if that lies between the same corners.
            let given = notch.in_sizes.get(size).copied().flatten();
            let given = given.and_then(|at| {
                let own = self.outline.chords(size);
                let found = nearest(at, &own.points)?;
                Some(along(own.place(found.chord, found.share)))
            });
            let stretch = given.filter(|given| *given <= (to - from) as f64);
            let own = self.outline.in_size(size);
            let lengths = match self.curves.get(c) {
                Some(Some(cubics)) => cubics.lengths(size),
                Some(None) | None => (from..to)
                    .map(|k| (own[(k + 1) % count] - own[k % count]).norm())
                    .collect(),
            };
            share_before(&lengths, stretch.unwrap_or_else(|| along((vertex, part))))
        };
        Some(OutlinePlace::Between {
            corners: [from, to % count],
            shares: (0..self.sizes).map(share).collect(),
        })
    }
}

/// Share of the length of stretches before a place, given as the number of a stretch and a share of it.
fn share_before(lengths: &[f64], place: f64) -> f64 {
    let whole: f64 = lengths.iter().sum();
    let full = (place.floor().max(0.0) as usize).min(lengths.len());
    let before: f64 = lengths[..full].iter().sum();
    let part = lengths
        .get(full)
        .map_or(0.0, |length| length * (place - full as f64));
    ((before + part) / whole.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
}

/// The corner of a sew line that a place on the cut line belongs to: it lies on the line of one of the edges
/// that meet there, beyond the corner, or no place is nearer to it than the corner.
fn corner_of(place: Vec2, chords: &Chords, corners: &[usize]) -> Option<usize> {
    let vertices = &chords.points;
    let count = vertices.len();
    let beyond = |corner: usize, before: usize| {
        let along = vertices[corner] - vertices[before % count];
        let length = along.norm();
        let out = place - vertices[corner];
        let reach = out.dot(&along) / length;
        let off = (along.perp(&out) / length).abs();
        off <= ON_LINE && reach > ON_LINE && reach <= MAX_REACH
    };
    // At two edges that run on almost straight, a place square to the cut line is as near to their corner as to any
    // other place.
    let nearest = nearest(place, vertices).map_or(0.0, |found| found.distance);
    // A place on the line itself belongs there, though another edge may point at it.
    let is_apart = nearest > ON_SEW_LINE;
    let is_as_near = |corner: usize| (vertices[corner] - place).norm() <= nearest + AS_NEAR;
    let mut all = corners.iter().copied();
    all.find(|&vertex| {
        let corner = chords.starts[vertex];
        is_as_near(corner)
            || is_apart && (beyond(corner, corner + count - 1) || beyond(corner, corner + 1))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_pattern::NotchKind;

    /// A rectangle of 300 x 100 mm with a corner in the middle of its lower side, and a vertex on it.
    fn place(at: [f64; 2]) -> Option<OutlinePlace> {
        let ring = [
            [0.0, 0.0],
            [0.1, 0.0],
            [0.15, 0.0],
            [0.3, 0.0],
            [0.3, 0.1],
            [0.0, 0.1],
        ];
        let outline = DrawnLine::one(ring.map(Vec2::from).to_vec(), true);
        let marked = Marked {
            outline: &outline,
            corners: &[0, 2, 3, 4, 5],
            curves: &[],
            base: 0,
            sizes: 1,
        };
        marked.place(&DrawnNotch {
            at: at.into(),
            in_sizes: Vec::new(),
            kind: NotchKind::Slit,
        })
    }

    #[track_caller]
    fn assert_between(at: [f64; 2], expected: [usize; 2], share: f64) {
        let Some(OutlinePlace::Between { corners, shares }) = place(at) else {
            panic!("between");
        };
        assert_eq!(corners, expected);
        assert!((shares[0] - share).abs() < 1e-9, "{shares:?}");
    }

    #[test]
    fn a_notch_on_the_line_stays_where_it_is_though_the_edge_before_points_at_it() {
        assert_between([0.18, 0.0], [2, 3], 0.2);
        assert_eq!(place([0.15, 0.0]), Some(OutlinePlace::Corner(2)));
        assert_between([0.0, 0.05], [5, 0], 0.5);
        assert_between([0.05, 0.0], [0, 2], 1.0 / 3.0);
        assert_between([0.18, 8e-4], [2, 3], 0.2);
    }

    #[test]
    fn a_notch_beyond_a_corner_belongs_to_it_and_one_far_away_nowhere() {
        assert_eq!(place([0.31, 0.0]), Some(OutlinePlace::Corner(3)));
        assert_between([0.2, -0.01], [2, 3], 1.0 / 3.0);
        assert_eq!(place([0.2, -0.2]), None);
    }
}
