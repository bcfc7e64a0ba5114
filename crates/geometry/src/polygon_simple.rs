//! What is wrong with an outline: crossings with itself, missing area, stray holes. Exact.
//!
//! # Decided with
//! - [`crate::rings`]: crossings of many rings, edge by edge.
//!
//! Called by crates `cut` and `nesting` (`check.rs` of each); crate `pattern`, `check.rs`, calls `rings`.

use crate::polygon::ring_area;
use crate::{Bounds2, EdgeTree, Location, Polygon, Vec2, orient2d, segments_cross};
use std::ops::ControlFlow;

/// How two edges of one outline meet where they should not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CrossingKind {
    /// The outline passes through itself.
    Cross,
    /// It touches itself at a point and turns back.
    Touch,
    /// Two edges share a stretch.
    Overlap,
}

/// A place where an outline meets itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Ring (0 is the outer one) and number of the first edge's start point.
    pub first: [usize; 2],
    /// Ring and number of the second edge's start point.
    pub second: [usize; 2],
    /// Where (m), rounded.
    pub point: Vec2,
    /// How.
    pub kind: CrossingKind,
}

/// Why a polygon does not bound a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PolygonDefect {
    /// A coordinate is not a finite number.
    NotFinite {
        /// Ring, 0 for the outer one.
        ring: usize,
        /// Number of the point in the ring.
        point: usize,
    },
    /// A ring has fewer than three different points.
    TooFewPoints {
        /// Ring, 0 for the outer one.
        ring: usize,
    },
    /// A ring encloses nothing.
    NoArea {
        /// Ring, 0 for the outer one.
        ring: usize,
    },
    /// The outline meets itself.
    Crossing(Crossing),
    /// A hole lies outside the outer ring or inside another hole.
    StrayHole {
        /// Number of the hole.
        hole: usize,
    },
}

/// On which side of a corner, interior at the left of `from -> at -> to`, a direction points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CornerSide {
    Left,
    On,
    Right,
}

/// The side of the corner `from -> at -> to` on which the ray from `at` towards `target` starts.
/// Exact.
pub(crate) fn corner_side(corner: [Vec2; 3], target: Vec2) -> CornerSide {
    let [from, at, to] = corner;
    let same_way = |p: Vec2| (p - at).dot(&(target - at)) > 0.0;
    let before = orient2d(from, at, target);
    let after = orient2d(at, to, target);
    if (before == 0.0 && same_way(from)) || (after == 0.0 && same_way(to)) {
        return CornerSide::On;
    }
    let turn = orient2d(from, at, to);
    let left = if turn > 0.0 {
        before > 0.0 && after > 0.0
    } else if turn == 0.0 && (from - at).dot(&(to - at)) > 0.0 {
        false
    } else {
        before > 0.0 || after > 0.0
    };
    if left {
        CornerSide::Left
    } else {
        CornerSide::Right
    }
}

/// Whether two segments cross at one point inside both. Exact.
pub(crate) fn cross_properly(a: [Vec2; 2], b: [Vec2; 2]) -> bool {
    let opposite = |s: [Vec2; 2], t: [Vec2; 2]| {
        let (p, q) = (orient2d(s[0], s[1], t[0]), orient2d(s[0], s[1], t[1]));
        (p > 0.0 && q < 0.0) || (p < 0.0 && q > 0.0)
    };
    opposite(a, b) && opposite(b, a)
}

/// Where two segments that cross properly meet (m), rounded.
pub fn crossing_point(a: [Vec2; 2], b: [Vec2; 2]) -> Vec2 {
    let from = orient2d(b[0], b[1], a[0]);
    let to = orient2d(b[0], b[1], a[1]);
    let along = from / (from - to);
    if along.is_finite() {
        a[0] + (a[1] - a[0]) * along
    } else {
        a[0]
    }
}

/// An edge of positive length with its neighbours in the ring.
struct Outline {
    edges: Vec<[Vec2; 2]>,
    origin: Vec<[usize; 2]>,
    previous: Vec<usize>,
    next: Vec<usize>,
}

impl Outline {
    fn of(polygon: &Polygon) -> Self {
        let mut outline = Self {
            edges: Vec::new(),
            origin: Vec::new(),
            previous: Vec::new(),
            next: Vec::new(),
        };
        for (ring, points) in polygon.rings().enumerate() {
            let start = outline.edges.len();
            for (k, edge) in crate::polygon::ring_edges(points).enumerate() {
                if edge[0] != edge[1] {
                    outline.edges.push(edge);
                    outline.origin.push([ring, k]);
                }
            }
            let end = outline.edges.len();
            for k in start..end {
                let before = if k == start { end - 1 } else { k - 1 };
                let after = if k + 1 == end { start } else { k + 1 };
                outline.previous.push(before);
                outline.next.push(after);
            }
        }
        outline
    }

    /// The corner of edge `k`'s chain at a point of it: its start, or a point inside it.
    fn corner(&self, k: usize, at: Vec2) -> Option<[Vec2; 3]> {
        let [start, end] = self.edges[k];
        if at == end {
            None
        } else if at == start {
            Some([self.edges[self.previous[k]][0], at, end])
        } else {
            Some([start, at, end])
        }
    }

    fn meeting(&self, i: usize, j: usize) -> Option<Crossing> {
        let (a, b) = (self.edges[i], self.edges[j]);
        let found = |point: Vec2, kind: CrossingKind| Crossing {
            first: self.origin[i],
            second: self.origin[j],
            point,
            kind,
        };
        let follows = self.next[i] == j;
        if follows || self.next[j] == i {
            let [from, at, to] = if follows {
                [a[0], a[1], b[1]]
            } else {
                [b[0], b[1], a[1]]
            };
            let back = orient2d(from, at, to) == 0.0 && (from - at).dot(&(to - at)) > 0.0;
            return back.then(|| found(at, CrossingKind::Overlap));
        }
        if !segments_cross(a, b) {
            return None;
        }
        if cross_properly(a, b) {
            return Some(found(crossing_point(a, b), CrossingKind::Cross));
        }
        if let Some(point) = shared_stretch(a, b) {
            return Some(found(point, CrossingKind::Overlap));
        }
        let at = [a[0], a[1], b[0], b[1]]
            .into_iter()
            .find(|&p| crate::segments_cross(a, [p, p]) && crate::segments_cross(b, [p, p]))?;
        let (one, other) = (self.corner(i, at)?, self.corner(j, at)?);
        let sides = [other[0], other[2]].map(|p| corner_side(one, p));
        let through = sides.contains(&CornerSide::Left) && sides.contains(&CornerSide::Right);
        let kind = if through {
            CrossingKind::Cross
        } else {
            CrossingKind::Touch
        };
        Some(found(at, kind))
    }
}

/// A point of the stretch that two collinear segments share, if it has a length. Exact.
fn shared_stretch(a: [Vec2; 2], b: [Vec2; 2]) -> Option<Vec2> {
    if orient2d(a[0], a[1], b[0]) != 0.0 || orient2d(a[0], a[1], b[1]) != 0.0 {
        return None;
    }
    let span = Bounds2::of(a).size();
    let key = |p: Vec2| if span.x >= span.y { p.x } else { p.y };
    let order = |s: [Vec2; 2]| {
        if key(s[0]) <= key(s[1]) {
            s
        } else {
            [s[1], s[0]]
        }
    };
    let (a, b) = (order(a), order(b));
    let low = if key(a[0]) >= key(b[0]) { a[0] } else { b[0] };
    let high = if key(a[1]) <= key(b[1]) { a[1] } else { b[1] };
    (key(low) < key(high)).then(|| low + (high - low) * 0.5)
}

impl Polygon {
    /// Places where the outline meets itself, at most `limit` of them, in no promised order.
    /// Exact; about n log n for outlines whose neighbouring edges lie close together.
    pub fn crossings(&self, limit: usize) -> Vec<Crossing> {
        if !self.is_finite() || limit == 0 {
            return Vec::new();
        }
        let outline = Outline::of(self);
        let tree = EdgeTree::new(outline.edges.clone());
        let mut found = Vec::new();
        let _ = tree.own_pairs(&mut |i, j| {
            found.extend(outline.meeting(i, j));
            if found.len() < limit {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        });
        found
    }

    /// Whether no edge meets another but at the point they follow each other. Exact.
    pub fn is_simple(&self) -> bool {
        self.is_finite() && self.outer.len() > 2 && self.crossings(1).is_empty()
    }

    /// What keeps the polygon from bounding a region; empty for a sound one. At most sixteen
    /// crossings are listed.
    pub fn defects(&self) -> Vec<PolygonDefect> {
        let mut defects = Vec::new();
        for (ring, points) in self.rings().enumerate() {
            let bad = |p: &Vec2| !(p.x.is_finite() && p.y.is_finite());
            if let Some(point) = points.iter().position(bad) {
                defects.push(PolygonDefect::NotFinite { ring, point });
            }
        }
        if !defects.is_empty() {
            return defects;
        }
        for (ring, points) in self.rings().enumerate() {
            if crate::polygon::without_repeats(points).len() < 3 {
                defects.push(PolygonDefect::TooFewPoints { ring });
            } else if ring_area(points) == 0.0 {
                defects.push(PolygonDefect::NoArea { ring });
            }
        }
        if !defects.is_empty() {
            return defects;
        }
        defects.extend(self.crossings(16).into_iter().map(PolygonDefect::Crossing));
        defects.extend(self.stray_holes());
        defects
    }

    fn stray_holes(&self) -> Vec<PolygonDefect> {
        let place = |ring: &Vec<Vec2>, hole: &[Vec2]| {
            let ring = Self::new(ring.clone());
            let places = hole.iter().map(|&p| ring.locate(p));
            places
                .into_iter()
                .find(|&l| l != Location::Boundary)
                .unwrap_or(Location::Inside)
        };
        let stray = |&k: &usize| {
            let hole = &self.holes[k];
            place(&self.outer, hole) == Location::Outside
                || (0..self.holes.len())
                    .any(|m| m != k && place(&self.holes[m], hole) == Location::Inside)
        };
        (0..self.holes.len())
            .filter(stray)
            .map(|hole| PolygonDefect::StrayHole { hole })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn polygon(points: &[(f64, f64)]) -> Polygon {
        Polygon::new(points.iter().map(|&(x, y)| Vec2::new(x, y)).collect())
    }

    fn kinds(polygon: &Polygon) -> Vec<CrossingKind> {
        polygon.crossings(99).iter().map(|c| c.kind).collect()
    }

    #[test]
    fn outlines_that_cross_touch_or_fold_back() {
        let square = polygon(&[(0.0, 0.0), (0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]);
        assert!(square.is_simple() && square.defects().is_empty());
        let bow = polygon(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)]);
        assert_eq!(kinds(&bow), [CrossingKind::Cross]);
        assert_eq!(bow.crossings(9)[0].point, Vec2::new(1.0, 1.0));
        let pinched = [
            (0.0, 0.0),
            (1.0, 1.0),
            (2.0, 0.0),
            (2.0, 2.0),
            (1.0, 1.0),
            (0.0, 2.0),
        ];
        assert_eq!(kinds(&polygon(&pinched)), [CrossingKind::Touch]);
        let through = [
            (0.0, 0.0),
            (1.0, 1.0),
            (2.0, 2.0),
            (2.0, 0.0),
            (1.0, 1.0),
            (0.0, 2.0),
        ];
        assert_eq!(kinds(&polygon(&through)), [CrossingKind::Cross]);
        let tip = [(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (2.0, 0.0), (0.0, 2.0)];
        assert_eq!(kinds(&polygon(&tip)), [CrossingKind::Touch]);
        let spike = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (2.0, 1.0), (0.0, 2.0)];
        assert!(kinds(&polygon(&spike)).contains(&CrossingKind::Overlap));
        let shared = [
            (0.0, 0.0),
            (3.0, 0.0),
            (3.0, 1.0),
            (2.0, 0.0),
            (1.0, 0.0),
            (0.0, 1.0),
        ];
        assert!(kinds(&polygon(&shared)).contains(&CrossingKind::Overlap));
    }

    #[test]
    fn broken_polygons_are_named() {
        let nan = polygon(&[(0.0, 0.0), (f64::NAN, 0.0), (1.0, 1.0)]);
        assert_eq!(
            nan.defects(),
            [PolygonDefect::NotFinite { ring: 0, point: 1 }]
        );
        assert!(!nan.is_simple());
        assert_eq!(
            Polygon::default().defects(),
            [PolygonDefect::TooFewPoints { ring: 0 }]
        );
        let flat = polygon(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)]);
        assert_eq!(flat.defects(), [PolygonDefect::NoArea { ring: 0 }]);
        let mut holed = polygon(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
        holed
            .holes
            .push(holed.translated(Vec2::new(3.0, 0.0)).outer);
        assert_eq!(holed.defects(), [PolygonDefect::StrayHole { hole: 0 }]);
    }

    #[test]
    fn a_hundred_thousand_points_are_checked_at_once() {
        let n = 100_000;
        let mut points: Vec<Vec2> = (0..n)
            .map(|k| {
                let angle = std::f64::consts::TAU * f64::from(k) / f64::from(n);
                let radius = 1.0 + 0.2 * (angle * 40.0).sin() + 1e-4 * f64::from(k % 2);
                Vec2::new(radius * angle.cos(), radius * angle.sin())
            })
            .collect();
        assert!(Polygon::new(points.clone()).is_simple());
        points.swap(70_000, 70_100);
        assert!(!Polygon::new(points).is_simple());
    }

    proptest! {
        #[test]
        fn simple_means_that_no_two_distant_edges_meet(
            points in prop::collection::vec((0i32..12, 0i32..12), 3..9)
        ) {
            let points: Vec<Vec2> = points
                .iter()
                .map(|&(x, y)| Vec2::new(f64::from(x), f64::from(y)))
                .collect();
            let clean = crate::polygon::without_repeats(&points);
            prop_assume!(clean.len() > 2);
            let n = clean.len();
            let edge = |k: usize| [clean[k], clean[(k + 1) % n]];
            let mut sound = true;
            for i in 0..n {
                for j in i + 1..n {
                    let neighbours = j == i + 1 || (i == 0 && j == n - 1);
                    sound &= if neighbours {
                        let (a, b) = if j == i + 1 { (edge(i), edge(j)) } else { (edge(j), edge(i)) };
                        orient2d(a[0], a[1], b[1]) != 0.0
                            || (a[0] - a[1]).dot(&(b[1] - a[1])) < 0.0
                    } else {
                        !segments_cross(edge(i), edge(j))
                    };
                }
            }
            prop_assert_eq!(Polygon::new(points).is_simple(), sound);
        }
    }
}
