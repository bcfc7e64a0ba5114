//! Closed rings of chords under a box tree: where they cross, and what is inside.

use crate::{EdgeTree, Vec2, crossing_point, orient2d, point_segment_distance, segments_cross};
use std::ops::ControlFlow;

/// Rings of straight chords, each with the number of the part it belongs to.
pub struct Rings {
    tree: EdgeTree,
    /// Of each chord: its part, and the chord that follows it in its ring.
    parts: Vec<(usize, usize)>,
}

/// What looking for crossings found.
pub struct RingCrossings {
    /// Pairs of parts and a point near where they meet (m), at most as many as asked for.
    pub found: Vec<([usize; 2], Vec2)>,
    /// Whether the whole search was done within the budget.
    pub complete: bool,
}

/// Pairs of chords with boxes that meet which are looked at before the search gives up: seconds,
/// not minutes.
const BUDGET: usize = 20_000_000;

impl Rings {
    /// From rings of points, each point with the number of the part that starts there or runs
    /// through it. Rings are closed; repeated points are dropped.
    pub fn new(rings: &[Vec<(Vec2, usize)>]) -> Self {
        let mut edges = Vec::new();
        let mut parts: Vec<(usize, usize)> = Vec::new();
        for points in rings {
            let first = edges.len();
            for (k, &(start, part)) in points.iter().enumerate() {
                let end = points[(k + 1) % points.len()].0;
                if start != end {
                    edges.push([start, end]);
                    parts.push((part, edges.len()));
                }
            }
            if let Some(last) = parts[first..].last_mut() {
                last.1 = first;
            }
        }
        Self {
            tree: EdgeTree::new(edges),
            parts,
        }
    }

    /// The first pairs of chords that cross or touch, those left out that follow each other and
    /// only share their common end. Signs are exact (Shewchuk 1997).
    pub fn crossings(&self, limit: usize) -> RingCrossings {
        let mut result = RingCrossings {
            found: Vec::new(),
            complete: true,
        };
        let mut spent = 0;
        let _ = self.tree.own_pairs(&mut |a, b| {
            spent += 1;
            if spent > BUDGET {
                result.complete = false;
                return ControlFlow::Break(());
            }
            result.found.extend(self.meeting(a, b));
            match result.found.len() >= limit {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        });
        result
    }

    /// Where two chords meet, if they may not.
    fn meeting(&self, a: usize, b: usize) -> Option<([usize; 2], Vec2)> {
        let (first, second) = (self.tree.edges()[a], self.tree.edges()[b]);
        let parts = [self.parts[a].0, self.parts[b].0];
        let parts = [parts[0].min(parts[1]), parts[0].max(parts[1])];
        let follows = |from: usize, to: usize| {
            self.parts[from].1 == to && self.tree.edges()[from][1] == self.tree.edges()[to][0]
        };
        let folded = |from: [Vec2; 2], then: [Vec2; 2]| {
            orient2d(from[0], from[1], then[1]) == 0.0
                && (from[1] - from[0]).dot(&(then[1] - then[0])) < 0.0
        };
        let ahead = follows(a, b);
        let behind = follows(b, a);
        if ahead || behind {
            let back = (ahead && folded(first, second)) || (behind && folded(second, first));
            let corner = if ahead { first[1] } else { first[0] };
            return back.then_some((parts, corner));
        }
        segments_cross(first, second).then(|| (parts, crossing_point(first, second)))
    }

    /// Whether a point is inside the rings (even-odd) or within `tolerance` (m) of one.
    pub fn holds(&self, point: Vec2, tolerance: f64) -> bool {
        let mut inside = false;
        let mut touches = false;
        self.tree.visit(
            &mut |bounds| {
                let level =
                    point.y >= bounds.min.y - tolerance && point.y <= bounds.max.y + tolerance;
                level && point.x <= bounds.max.x + tolerance
            },
            &mut |k| {
                let [a, b] = self.tree.edges()[k];
                touches |= point_segment_distance(point, [a, b]) <= tolerance;
                let upward = a.y <= point.y && point.y < b.y;
                let downward = b.y <= point.y && point.y < a.y;
                let side = orient2d(a, b, point);
                if (upward && side > 0.0) || (downward && side < 0.0) {
                    inside = !inside;
                }
            },
        );
        inside || touches
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn closed(points: &[Vec2]) -> Vec<(Vec2, usize)> {
        points.iter().enumerate().map(|(k, p)| (*p, k)).collect()
    }

    fn brute_force(points: &[Vec2]) -> Vec<[usize; 2]> {
        let count = points.len();
        let end = |k: usize| points[(k + 1) % count];
        let mut pairs = Vec::new();
        for a in 0..count {
            for b in a + 2..count {
                let neighbours = a == 0 && b == count - 1;
                if !neighbours && segments_cross([points[a], end(a)], [points[b], end(b)]) {
                    pairs.push([a, b]);
                }
            }
        }
        pairs
    }

    proptest! {
        #[test]
        fn agrees_with_brute_force(
            places in prop::collection::vec((0.0..1.0, 0.0..1.0), 4..40),
        ) {
            let points: Vec<Vec2> = places.iter().map(|&(x, y)| Vec2::new(x, y)).collect();
            let tree = Rings::new(&[closed(&points)]);
            let mut found: Vec<_> = tree.crossings(usize::MAX).found.iter().map(|c| c.0).collect();
            found.sort_unstable();
            prop_assert_eq!(found, brute_force(&points));
            for k in 0..20 {
                let p = Vec2::new(f64::from(k) / 20.0, 0.37);
                let mut inside = false;
                for (k, a) in points.iter().enumerate() {
                    let b = points[(k + 1) % points.len()];
                    if (a.y > p.y) != (b.y > p.y)
                        && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x
                    {
                        inside = !inside;
                    }
                }
                prop_assert_eq!(tree.holds(p, 0.0), inside);
            }
        }
    }

    fn star(count: i32, inner: f64) -> Rings {
        let points: Vec<Vec2> = (0..count)
            .map(|k| {
                let angle = std::f64::consts::TAU * f64::from(k) / f64::from(count);
                let radius = if k % 2 == 0 { 1.0 } else { inner };
                Vec2::new(angle.cos(), angle.sin()) * radius
            })
            .collect();
        Rings::new(&[closed(&points)])
    }

    #[test]
    fn a_hundred_thousand_edges_are_checked_within_the_budget() {
        let toothed = star(100_000, 0.998);
        let crossings = toothed.crossings(10);
        assert!(crossings.complete && crossings.found.is_empty());
        assert!(toothed.holds(Vec2::zeros(), 1e-9));
        assert!(!toothed.holds(Vec2::new(1.1, 0.0), 1e-9));
        let needles = star(100_000, 0.1).crossings(10);
        assert!(
            needles.found.is_empty(),
            "gives up, and says so, rather than be wrong"
        );
        assert!(!needles.complete);
    }

    #[test]
    fn touching_and_folding_back_are_found() {
        let v = Vec2::new;
        let touching = [v(0., 0.), v(2., 0.), v(2., 2.), v(1., 0.), v(0., 2.)];
        assert!(
            !Rings::new(&[closed(&touching)])
                .crossings(9)
                .found
                .is_empty()
        );
        let spike = [v(0., 0.), v(2., 0.), v(1., 0.), v(1., 2.)];
        assert!(!Rings::new(&[closed(&spike)]).crossings(9).found.is_empty());
        let square = [v(0., 0.), v(1., 0.), v(1., 1.), v(0., 1.)];
        assert!(Rings::new(&[closed(&square)]).crossings(9).found.is_empty());
    }
}
