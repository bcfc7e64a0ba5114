//! The loops of a piece as segments under a tree of boxes: where they cross, and what is inside.

use toile_geometry::{Vec2, orient2d, segments_cross};

/// One straight piece of a loop.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment {
    pub ends: [Vec2; 2],
    /// Index of the edge it belongs to, counted through all loops.
    pub edge: usize,
    /// Index of the segment that follows in its loop.
    next: usize,
}

/// A box around segments; an empty one overlaps nothing.
#[derive(Clone, Copy)]
struct Bounds {
    low: Vec2,
    high: Vec2,
}

impl Bounds {
    const EMPTY: Self = Self {
        low: Vec2::new(f64::INFINITY, f64::INFINITY),
        high: Vec2::new(f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    fn joined(self, other: Self) -> Self {
        Self {
            low: self.low.inf(&other.low),
            high: self.high.sup(&other.high),
        }
    }

    fn overlaps(self, other: Self) -> bool {
        self.low.x <= other.high.x
            && other.low.x <= self.high.x
            && self.low.y <= other.high.y
            && other.low.y <= self.high.y
    }
}

/// What looking for crossings found.
pub(crate) struct Crossings {
    /// Pairs of edges and a point near where they meet [m], at most as many as asked for.
    pub found: Vec<([usize; 2], Vec2)>,
    /// Whether the whole search was done within the budget.
    pub complete: bool,
}

/// Segments in the order of their loops under a binary tree of boxes: a heap whose leaves are the
/// segments, so that neighbours along an outline share boxes.
pub(crate) struct Segments {
    segments: Vec<Segment>,
    boxes: Vec<Bounds>,
    leaves: usize,
}

/// Pairs of boxes that are compared before the search gives up: seconds, not minutes.
const BUDGET: usize = 40_000_000;

impl Segments {
    /// From loops of points, each point with the index of the edge that starts there or runs
    /// through it. Loops are closed; repeated points are dropped.
    pub fn new(loops: &[Vec<(Vec2, usize)>]) -> Self {
        let mut segments = Vec::new();
        for points in loops {
            let first = segments.len();
            for (k, (start, edge)) in points.iter().enumerate() {
                let end = points[(k + 1) % points.len()].0;
                if *start != end {
                    segments.push(Segment {
                        ends: [*start, end],
                        edge: *edge,
                        next: segments.len() + 1,
                    });
                }
            }
            if let Some(last) = segments[first..].last_mut() {
                last.next = first;
            }
        }
        let leaves = segments.len().next_power_of_two();
        let mut boxes = vec![Bounds::EMPTY; 2 * leaves];
        for (k, segment) in segments.iter().enumerate() {
            let [a, b] = segment.ends;
            boxes[leaves + k] = Bounds {
                low: a.inf(&b),
                high: a.sup(&b),
            };
        }
        for k in (1..leaves).rev() {
            boxes[k] = boxes[2 * k].joined(boxes[2 * k + 1]);
        }
        Self {
            segments,
            boxes,
            leaves,
        }
    }

    /// The first pairs of segments that cross or touch, those left out that follow each other and
    /// only share their common end. Signs are exact (Shewchuk 1997).
    pub fn crossings(&self, limit: usize) -> Crossings {
        let mut result = Crossings {
            found: Vec::new(),
            complete: true,
        };
        let mut stack = vec![(1, 1)];
        let mut spent = 0;
        while let Some((a, b)) = stack.pop() {
            spent += 1;
            if spent > BUDGET {
                result.complete = false;
                break;
            }
            if !self.boxes[a].overlaps(self.boxes[b]) {
                continue;
            }
            if a < self.leaves {
                stack.push((2 * a + 1, 2 * b + 1));
                if a != b {
                    stack.push((2 * a + 1, 2 * b));
                }
                stack.push((2 * a, 2 * b + 1));
                stack.push((2 * a, 2 * b));
            } else if a != b
                && let Some(meeting) = self.meeting(a - self.leaves, b - self.leaves)
            {
                result.found.push(meeting);
                if result.found.len() >= limit {
                    break;
                }
            }
        }
        result
    }

    /// Where two segments meet, if they may not.
    fn meeting(&self, a: usize, b: usize) -> Option<([usize; 2], Vec2)> {
        let (first, second) = (self.segments[a], self.segments[b]);
        let edges = [first.edge.min(second.edge), first.edge.max(second.edge)];
        let follows = |from: &Segment, to: usize, then: &Segment| {
            from.next == to && from.ends[1] == then.ends[0]
        };
        let folded = |from: &Segment, then: &Segment| {
            orient2d(from.ends[0], from.ends[1], then.ends[1]) == 0.0
                && (from.ends[1] - from.ends[0]).dot(&(then.ends[1] - then.ends[0])) < 0.0
        };
        let ahead = follows(&first, b, &second);
        let behind = follows(&second, a, &first);
        if ahead || behind {
            let back = (ahead && folded(&first, &second)) || (behind && folded(&second, &first));
            let corner = if ahead { first.ends[1] } else { first.ends[0] };
            return back.then_some((edges, corner));
        }
        segments_cross(first.ends, second.ends)
            .then(|| (edges, meeting_point(first.ends, second.ends)))
    }

    /// Whether a point is inside the loops (even-odd) or within `tolerance` [m] of one.
    pub fn holds(&self, point: Vec2, tolerance: f64) -> bool {
        let mut inside = false;
        let mut stack = vec![1];
        while let Some(k) = stack.pop() {
            let bounds = self.boxes[k];
            let beside = point.y < bounds.low.y - tolerance || point.y > bounds.high.y + tolerance;
            if beside || point.x > bounds.high.x + tolerance {
                continue;
            }
            if k < self.leaves {
                stack.extend([2 * k, 2 * k + 1]);
                continue;
            }
            let [a, b] = self.segments[k - self.leaves].ends;
            if distance(point, [a, b]) <= tolerance {
                return true;
            }
            let upward = a.y <= point.y && point.y < b.y;
            let downward = b.y <= point.y && point.y < a.y;
            let side = orient2d(a, b, point);
            if (upward && side > 0.0) || (downward && side < 0.0) {
                inside = !inside;
            }
        }
        inside
    }
}

/// Distance of a point from a segment [m].
fn distance(point: Vec2, [a, b]: [Vec2; 2]) -> f64 {
    let way = b - a;
    let along = ((point - a).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
    (a + way * along - point).norm()
}

/// A point near the meeting of two segments that meet.
fn meeting_point(first: [Vec2; 2], second: [Vec2; 2]) -> Vec2 {
    let way = first[1] - first[0];
    let other = second[1] - second[0];
    let turn = way.perp(&other);
    let along = (second[0] - first[0]).perp(&other) / turn;
    if along.is_finite() {
        first[0] + way * along.clamp(0.0, 1.0)
    } else {
        second[0]
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
            let tree = Segments::new(&[closed(&points)]);
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

    fn star(count: i32, inner: f64) -> Segments {
        let points: Vec<Vec2> = (0..count)
            .map(|k| {
                let angle = std::f64::consts::TAU * f64::from(k) / f64::from(count);
                let radius = if k % 2 == 0 { 1.0 } else { inner };
                Vec2::new(angle.cos(), angle.sin()) * radius
            })
            .collect();
        Segments::new(&[closed(&points)])
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
            !Segments::new(&[closed(&touching)])
                .crossings(9)
                .found
                .is_empty()
        );
        let spike = [v(0., 0.), v(2., 0.), v(1., 0.), v(1., 2.)];
        assert!(
            !Segments::new(&[closed(&spike)])
                .crossings(9)
                .found
                .is_empty()
        );
        let square = [v(0., 0.), v(1., 0.), v(1., 1.), v(0., 1.)];
        assert!(
            Segments::new(&[closed(&square)])
                .crossings(9)
                .found
                .is_empty()
        );
    }
}
