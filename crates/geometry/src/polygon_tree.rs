//! A box tree over the edges of an outline, for pairs of edges that may meet.
//!
//! Consecutive edges lie close together, so the tree halves the outline's own order: building it
//! is linear and needs no sorting.

use crate::polygon::{RayHit, crosses_ray};
use crate::{Bounds2, Location, Polygon, Vec2};
use std::ops::ControlFlow;

const LEAF: usize = 4;

/// Edges in the order of the outline with a binary tree of boxes above them.
#[derive(Clone, Debug)]
pub struct EdgeTree {
    edges: Vec<[Vec2; 2]>,
    /// Complete binary tree: the children of node k are 2k + 1 and 2k + 2.
    boxes: Vec<Bounds2>,
    leaves: usize,
}

impl EdgeTree {
    /// Builds the tree in linear time.
    pub fn new(edges: Vec<[Vec2; 2]>) -> Self {
        let leaves = edges.len().div_ceil(LEAF).max(1).next_power_of_two();
        let mut boxes = vec![Bounds2::EMPTY; 2 * leaves - 1];
        for (k, chunk) in edges.chunks(LEAF).enumerate() {
            boxes[leaves - 1 + k] = Bounds2::of(chunk.iter().flatten().copied());
        }
        for k in (0..leaves - 1).rev() {
            boxes[k] = boxes[2 * k + 1].union(&boxes[2 * k + 2]);
        }
        Self {
            edges,
            boxes,
            leaves,
        }
    }

    /// The tree over all edges of a polygon's rings.
    pub fn of(polygon: &Polygon) -> Self {
        Self::new(polygon.edges().collect())
    }

    /// The edges, by number.
    pub fn edges(&self) -> &[[Vec2; 2]] {
        &self.edges
    }

    /// The box of everything; [`Bounds2::EMPTY`] without edges.
    pub fn bounds(&self) -> Bounds2 {
        self.boxes[0]
    }

    fn leaf(&self, node: usize) -> Option<std::ops::Range<usize>> {
        let k = node.checked_sub(self.leaves - 1)?;
        let end = self.edges.len();
        Some((k * LEAF).min(end)..((k + 1) * LEAF).min(end))
    }

    /// Calls `visit` for every edge in a leaf whose box, and those above it, `near` accepts.
    pub fn visit(&self, near: &mut dyn FnMut(&Bounds2) -> bool, visit: &mut dyn FnMut(usize)) {
        let mut stack = vec![0];
        while let Some(node) = stack.pop() {
            if !near(&self.boxes[node]) {
                continue;
            }
            match self.leaf(node) {
                Some(leaf) => leaf.for_each(&mut *visit),
                None => stack.extend([2 * node + 2, 2 * node + 1]),
            }
        }
    }

    /// Where a point lies in the region that the edges bound, by the even-odd rule. Exact, as [`Polygon::locate`] is.
    pub fn locate(&self, point: Vec2) -> Location {
        let (mut inside, mut is_on) = (false, false);
        let mut near = |bounds: &Bounds2| {
            bounds.max.x >= point.x && bounds.min.y <= point.y && bounds.max.y >= point.y
        };
        self.visit(&mut near, &mut |k| {
            let [a, b] = self.edges[k];
            match crosses_ray(a, b, point) {
                RayHit::On => is_on = true,
                RayHit::Crossed => inside = !inside,
                RayHit::Missed => {}
            }
        });
        match (is_on, inside) {
            (true, _) => Location::Boundary,
            (false, true) => Location::Inside,
            (false, false) => Location::Outside,
        }
    }

    /// Distance from a point to the nearest edge (m); infinite without edges.
    pub fn point_distance(&self, point: Vec2) -> f64 {
        self.distance_below(point, f64::INFINITY)
    }

    /// Distance from a point to the nearest edge (m) where it is below `most`, else `most`. What lies farther away is not
    /// looked at, and the nearer half of the edges first.
    pub fn distance_below(&self, point: Vec2, most: f64) -> f64 {
        let here = Bounds2::of([point]);
        let with_distance = |node: usize| (node, self.boxes[node].distance(&here));
        let mut least = most;
        let mut stack = vec![with_distance(0)];
        while let Some((node, distance)) = stack.pop() {
            if distance >= least {
                continue;
            }
            if let Some(leaf) = self.leaf(node) {
                let distances = leaf.map(|k| point_segment_distance(point, self.edges[k]));
                least = distances.fold(least, f64::min);
                continue;
            }
            let [a, b] = [2 * node + 1, 2 * node + 2].map(with_distance);
            stack.extend(if a.1 < b.1 { [b, a] } else { [a, b] });
        }
        least
    }

    /// Calls `visit` for every pair of an edge here and an edge there whose boxes, moved apart by
    /// less than `reach` (m), meet. Stops when `visit` breaks.
    pub fn pairs(
        &self,
        other: &Self,
        reach: f64,
        visit: &mut dyn FnMut(usize, usize) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        self.descend(0, other, 0, &mut |a, b| a.distance(b) <= reach, visit)
    }

    fn descend(
        &self,
        a: usize,
        other: &Self,
        b: usize,
        near: &mut dyn FnMut(&Bounds2, &Bounds2) -> bool,
        visit: &mut dyn FnMut(usize, usize) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        if !near(&self.boxes[a], &other.boxes[b]) {
            return ControlFlow::Continue(());
        }
        match (self.leaf(a), other.leaf(b)) {
            (Some(here), Some(there)) => {
                for i in here {
                    let edge = Bounds2::of(self.edges[i]);
                    for j in there.clone() {
                        if near(&edge, &Bounds2::of(other.edges[j])) {
                            visit(i, j)?;
                        }
                    }
                }
                ControlFlow::Continue(())
            }
            (None, leaf) if leaf.is_some() || self.is_larger(a, other, b) => {
                self.descend(2 * a + 1, other, b, near, visit)?;
                self.descend(2 * a + 2, other, b, near, visit)
            }
            _ => {
                self.descend(a, other, 2 * b + 1, near, visit)?;
                self.descend(a, other, 2 * b + 2, near, visit)
            }
        }
    }

    fn is_larger(&self, a: usize, other: &Self, b: usize) -> bool {
        let size = |s: Vec2| s.x + s.y;
        size(self.boxes[a].size()) >= size(other.boxes[b].size())
    }

    /// Calls `visit` once for every pair `i < j` of edges here whose closed boxes meet.
    pub fn own_pairs(
        &self,
        visit: &mut dyn FnMut(usize, usize) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut stack = vec![0];
        while let Some(node) = stack.pop() {
            if let Some(leaf) = self.leaf(node) {
                for i in leaf.clone() {
                    let edge = Bounds2::of(self.edges[i]);
                    for j in i + 1..leaf.end {
                        if edge.meets(&Bounds2::of(self.edges[j])) {
                            visit(i, j)?;
                        }
                    }
                }
            } else {
                let (left, right) = (2 * node + 1, 2 * node + 2);
                self.descend(left, self, right, &mut |a, b| a.meets(b), visit)?;
                stack.push(right);
                stack.push(left);
            }
        }
        ControlFlow::Continue(())
    }

    /// Least distance between an edge here and an edge there (m); infinite without edges.
    pub fn distance(&self, other: &Self) -> f64 {
        let mut best = f64::INFINITY;
        self.shrink(0, other, 0, &mut best);
        best
    }

    fn shrink(&self, a: usize, other: &Self, b: usize, best: &mut f64) {
        if self.boxes[a].distance(&other.boxes[b]) >= *best {
            return;
        }
        match (self.leaf(a), other.leaf(b)) {
            (Some(here), Some(there)) => {
                for i in here {
                    for j in there.clone() {
                        *best = best.min(segment_distance(self.edges[i], other.edges[j]));
                    }
                }
            }
            (None, leaf) if leaf.is_some() || self.is_larger(a, other, b) => {
                let mut children = [2 * a + 1, 2 * a + 2];
                let gap = |k: usize| self.boxes[k].distance(&other.boxes[b]);
                if gap(children[1]) < gap(children[0]) {
                    children.swap(0, 1);
                }
                children
                    .iter()
                    .for_each(|&k| self.shrink(k, other, b, best));
            }
            _ => {
                let mut children = [2 * b + 1, 2 * b + 2];
                let gap = |k: usize| self.boxes[a].distance(&other.boxes[k]);
                if gap(children[1]) < gap(children[0]) {
                    children.swap(0, 1);
                }
                children
                    .iter()
                    .for_each(|&k| self.shrink(a, other, k, best));
            }
        }
    }
}

/// Distance from a point to a closed segment (m).
pub fn point_segment_distance(point: Vec2, segment: [Vec2; 2]) -> f64 {
    (point - closest_on_segment(point, segment)).norm()
}

/// The point of a closed segment nearest to a point (m).
pub fn closest_on_segment(point: Vec2, [a, b]: [Vec2; 2]) -> Vec2 {
    let along = b - a;
    let squared = along.norm_squared();
    if squared == 0.0 {
        return a;
    }
    a + along * ((point - a).dot(&along) / squared).clamp(0.0, 1.0)
}

/// Distance between two closed segments (m), 0 exactly where they meet.
pub fn segment_distance(a: [Vec2; 2], b: [Vec2; 2]) -> f64 {
    if crate::segments_cross(a, b) {
        return 0.0;
    }
    point_segment_distance(a[0], b)
        .min(point_segment_distance(a[1], b))
        .min(point_segment_distance(b[0], a))
        .min(point_segment_distance(b[1], a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn segments(count: usize) -> impl Strategy<Value = Vec<[Vec2; 2]>> {
        let point = || (-1.0..1.0f64, -1.0..1.0f64).prop_map(|(x, y)| Vec2::new(x, y));
        let one = (point(), point()).prop_map(|(p, d)| [p, p + d * 0.3]);
        prop::collection::vec(one, 0..count)
    }

    proptest! {
        #[test]
        fn places_of_points_equal_brute_force(
            ring in prop::collection::vec((-4..5i32, -4..5i32), 0..40),
            point in (-5..6i32, -5..6i32),
        ) {
            let at = |(x, y): (i32, i32)| Vec2::new(f64::from(x), f64::from(y));
            let polygon = Polygon::new(ring.into_iter().map(at).collect());
            let tree = EdgeTree::of(&polygon);
            let point = at(point);
            prop_assert_eq!(tree.locate(point), polygon.locate(point));
            let least = polygon.edges().map(|edge| point_segment_distance(point, edge));
            let least = least.fold(f64::INFINITY, f64::min);
            prop_assert_eq!(tree.point_distance(point), least);
            prop_assert_eq!(tree.distance_below(point, 1.5), least.min(1.5));
        }
    }

    proptest! {
        #[test]
        fn pairs_and_distances_equal_brute_force(a in segments(30), b in segments(30)) {
            let (left, right) = (EdgeTree::new(a.clone()), EdgeTree::new(b.clone()));
            let mut found = Vec::new();
            let _ = left.pairs(&right, 0.1, &mut |i, j| {
                found.push((i, j));
                ControlFlow::Continue(())
            });
            found.sort_unstable();
            let mut want = Vec::new();
            let mut nearest = f64::INFINITY;
            for (i, s) in a.iter().enumerate() {
                for (j, t) in b.iter().enumerate() {
                    if Bounds2::of(*s).distance(&Bounds2::of(*t)) <= 0.1 {
                        want.push((i, j));
                    }
                    nearest = nearest.min(segment_distance(*s, *t));
                }
            }
            prop_assert_eq!(found, want);
            prop_assert_eq!(left.distance(&right), nearest);
            let mut own = Vec::new();
            let _ = left.own_pairs(&mut |i, j| {
                own.push((i, j));
                ControlFlow::Continue(())
            });
            own.sort_unstable();
            let mut want = Vec::new();
            for i in 0..a.len() {
                for j in i + 1..a.len() {
                    if Bounds2::of(a[i]).meets(&Bounds2::of(a[j])) {
                        want.push((i, j));
                    }
                }
            }
            prop_assert_eq!(own, want);
        }
    }
}
