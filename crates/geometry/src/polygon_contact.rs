//! Whether, and how deep, two polygons overlap; how far apart they are.

use crate::polygon_simple::{CornerSide, corner_side, cross_properly};
use crate::{
    Bounds2, EdgeTree, Location, Polygon, Vec2, closest_on_segment, no_fit_polygon, orient2d,
};
use std::ops::ControlFlow;

/// A polygon in standard form with the tree of its edges, for many questions about it.
#[derive(Clone, Debug)]
pub struct PreparedPolygon {
    polygon: Polygon,
    tree: EdgeTree,
    /// For every edge, the start of the edge before it.
    before: Vec<Vec2>,
    /// For every edge, the end of the edge after it.
    after: Vec<Vec2>,
}

impl PreparedPolygon {
    /// Prepares a polygon in linear time.
    pub fn new(polygon: &Polygon) -> Self {
        let polygon = polygon.oriented();
        let (mut before, mut after) = (Vec::new(), Vec::new());
        for ring in polygon.rings() {
            let n = ring.len();
            before.extend((0..n).map(|k| ring[(k + n - 1) % n]));
            after.extend((0..n).map(|k| ring[(k + 2) % n]));
        }
        Self {
            tree: EdgeTree::of(&polygon),
            polygon,
            before,
            after,
        }
    }

    /// The polygon in standard form.
    pub fn polygon(&self) -> &Polygon {
        &self.polygon
    }

    /// The box round it.
    pub fn bounds(&self) -> Bounds2 {
        self.tree.bounds()
    }

    /// Whether the interiors share a point; touching does not count. Exact for simple outlines.
    ///
    /// Where no two edges cross, the outlines meet at given points only, and at each of them it is
    /// enough to see on which side of the one corner the other's edges leave.
    pub fn overlaps(&self, other: &Self) -> bool {
        if !self.bounds().overlaps(&other.bounds()) {
            return false;
        }
        let mut overlap = false;
        let _ = self.tree.pairs(&other.tree, 0.0, &mut |i, j| {
            let (a, b) = (self.tree.edges()[i], other.tree.edges()[j]);
            overlap = cross_properly(a, b)
                || self.enters_at_vertex(i, other, j)
                || other.enters_at_vertex(j, self, i)
                || same_way(a, b);
            if overlap {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        overlap || self.reaches_into(other) || other.reaches_into(self)
    }

    /// Whether the first point of some ring lies inside the other polygon.
    fn reaches_into(&self, other: &Self) -> bool {
        let firsts = self.polygon.rings().filter_map(|ring| ring.first());
        firsts
            .into_iter()
            .any(|&p| other.bounds().contains(p) && other.polygon.locate(p) == Location::Inside)
    }

    /// Whether edge `j` of `other`, or the edge before it if edge `i` holds their common point,
    /// runs into the interior here from a point of edge `i`, or the other way round.
    fn enters_at_vertex(&self, i: usize, other: &Self, j: usize) -> bool {
        let [a0, a1] = self.tree.edges()[i];
        let [at, b1] = other.tree.edges()[j];
        let b0 = other.before[j];
        if orient2d(a0, a1, at) != 0.0 || !Bounds2::of([a0, a1]).contains(at) {
            return false;
        }
        let here = if at == a0 {
            [self.before[i], at, a1]
        } else if at == a1 {
            [a0, at, self.after[i]]
        } else {
            [a0, at, a1]
        };
        let there = [b0, at, b1];
        let inside =
            |corner: [Vec2; 3], target: Vec2| corner_side(corner, target) == CornerSide::Left;
        inside(here, b0) || inside(here, b1) || inside(there, here[0]) || inside(there, here[2])
    }

    /// Least distance between the regions (m); 0 where they touch or overlap.
    pub fn distance(&self, other: &Self) -> f64 {
        let apart = self.tree.distance(&other.tree);
        if apart > 0.0 && (self.reaches_into(other) || other.reaches_into(self)) {
            return 0.0;
        }
        apart
    }

    /// Whether all of the other polygon lies in this one, boundaries may touch. Exact for simple
    /// outlines without holes in `self`.
    pub fn covers(&self, other: &Self) -> bool {
        other
            .polygon
            .outer
            .iter()
            .all(|&p| self.polygon.contains(p))
            && self.tree.pairs(&other.tree, 0.0, &mut |i, j| {
                if cross_properly(self.tree.edges()[i], other.tree.edges()[j]) {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            }) == ControlFlow::Continue(())
    }

    /// The shortest move of `other` that ends the overlap (m): zero if the interiors do not meet
    /// (exact), else to the nearest point of the no-fit polygon's boundary (Cameron and Culley
    /// 1986), right to about 1e-8 of the extents. Holes count as filled.
    pub fn separation(&self, other: &Self) -> Vec2 {
        if !self.overlaps(other) {
            return Vec2::zeros();
        }
        let nfp = no_fit_polygon(&self.polygon.outer, &other.polygon.outer);
        let nearest = nfp.iter().flat_map(Polygon::edges).map(|edge| {
            let way = closest_on_segment(Vec2::zeros(), edge);
            (way.norm(), way)
        });
        let best = nearest.min_by(|a, b| a.0.total_cmp(&b.0));
        best.map_or_else(|| self.push_out(other), |(_, way)| way)
    }

    /// The shortest move along an axis that takes the boxes apart.
    fn push_out(&self, other: &Self) -> Vec2 {
        let (a, b) = (self.bounds(), other.bounds());
        let ways = [
            Vec2::new(a.max.x - b.min.x, 0.0),
            Vec2::new(a.min.x - b.max.x, 0.0),
            Vec2::new(0.0, a.max.y - b.min.y),
            Vec2::new(0.0, a.min.y - b.max.y),
        ];
        let shorter = |p: Vec2, q: Vec2| if q.norm() < p.norm() { q } else { p };
        ways.into_iter().fold(ways[0], shorter)
    }

    /// Length of [`PreparedPolygon::separation`] (m).
    pub fn penetration_depth(&self, other: &Self) -> f64 {
        self.separation(other).norm()
    }
}

/// Whether two segments share a stretch and run the same way. Exact.
fn same_way(a: [Vec2; 2], b: [Vec2; 2]) -> bool {
    if orient2d(a[0], a[1], b[0]) != 0.0 || orient2d(a[0], a[1], b[1]) != 0.0 {
        return false;
    }
    let along = a[1] - a[0];
    let key = |p: Vec2| {
        if along.x.abs() >= along.y.abs() {
            p.x
        } else {
            p.y
        }
    };
    let rising = key(a[0]) < key(a[1]);
    if rising != (key(b[0]) < key(b[1])) {
        return false;
    }
    let range = |s: [Vec2; 2]| {
        if rising {
            (key(s[0]), key(s[1]))
        } else {
            (key(s[1]), key(s[0]))
        }
    };
    let (a, b) = (range(a), range(b));
    a.0.max(b.0) < a.1.min(b.1)
}

/// Whether the interiors of two polygons share a point. Exact for simple outlines.
pub fn interiors_overlap(a: &Polygon, b: &Polygon) -> bool {
    PreparedPolygon::new(a).overlaps(&PreparedPolygon::new(b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{intersection, total_area};
    use proptest::prelude::*;

    fn polygon(points: &[(f64, f64)]) -> Polygon {
        Polygon::new(points.iter().map(|&(x, y)| Vec2::new(x, y)).collect())
    }

    fn square() -> Polygon {
        polygon(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    }

    #[test]
    fn touching_is_not_overlapping() {
        let square = square();
        let moved = |x: f64, y: f64| square.translated(Vec2::new(x, y));
        assert!(interiors_overlap(&square, &square));
        assert!(!interiors_overlap(&square, &moved(1.0, 0.0)));
        assert!(!interiors_overlap(&square, &moved(1.0, 0.5)));
        assert!(!interiors_overlap(&square, &moved(1.0, 1.0)));
        assert!(interiors_overlap(&square, &moved(1.0 - 1e-15, 0.5)));
        assert!(interiors_overlap(&square, &moved(0.5, 0.0)));
        let small = square.mapped(|p| p * 0.5);
        assert!(interiors_overlap(&square, &small));
        assert!(interiors_overlap(
            &square,
            &small.translated(Vec2::new(0.25, 0.25))
        ));
        let diamond = polygon(&[(0.5, 0.0), (1.0, 0.5), (0.5, 1.0), (0.0, 0.5)]);
        assert!(interiors_overlap(&square, &diamond));
    }

    #[test]
    fn a_piece_in_a_hole_or_a_notch_is_free() {
        let mut frame = polygon(&[(-1.0, -1.0), (2.0, -1.0), (2.0, 2.0), (-1.0, 2.0)]);
        frame.holes.push(square().outer);
        assert!(!interiors_overlap(&frame, &square()));
        assert!(interiors_overlap(
            &frame,
            &square().translated(Vec2::new(1e-12, 0.0))
        ));
        let notched = polygon(&[
            (0.0, 0.0),
            (3.0, 0.0),
            (3.0, 2.0),
            (2.0, 2.0),
            (2.0, 1.0),
            (1.0, 1.0),
            (1.0, 2.0),
            (0.0, 2.0),
        ]);
        let key = square().translated(Vec2::new(1.0, 1.0));
        let (notched, key) = (PreparedPolygon::new(&notched), PreparedPolygon::new(&key));
        assert!(!notched.overlaps(&key));
        assert_eq!(notched.distance(&key), 0.0);
        assert_eq!(notched.penetration_depth(&key), 0.0);
    }

    #[test]
    fn depth_of_a_corner_pushed_into_a_corner() {
        let p = |s: f64| {
            let wall = polygon(&[
                (-9.0, -9.0),
                (9.0, -9.0),
                (9.0, 0.0),
                (0.0, 0.0),
                (0.0, 9.0),
                (-9.0, 9.0),
            ]);
            let square = square().translated(Vec2::new(-s, -s));
            PreparedPolygon::new(&wall).separation(&PreparedPolygon::new(&square))
        };
        assert!(
            (p(1e-3) - Vec2::new(1e-3, 1e-3)).norm() < 1e-7,
            "{}",
            p(1e-3)
        );
        assert!((p(1e-6).norm() - 1e-6 * 2f64.sqrt()).abs() < 5e-8);
    }

    #[test]
    fn distances() {
        let (a, b) = (square(), square().translated(Vec2::new(4.0, 5.0)));
        let (a, b) = (PreparedPolygon::new(&a), PreparedPolygon::new(&b));
        assert_eq!(a.distance(&b), 5.0);
        let inner = PreparedPolygon::new(&square().mapped(|p| p * 0.5 + Vec2::new(0.2, 0.2)));
        assert_eq!(a.distance(&inner), 0.0);
        assert!(a.covers(&inner) && !inner.covers(&a) && a.covers(&a));
    }

    fn grid_polygon() -> impl Strategy<Value = Polygon> {
        prop::collection::vec((0i32..7, 0i32..7), 3..8)
            .prop_map(|points| {
                let points = points
                    .iter()
                    .map(|&(x, y)| Vec2::new(f64::from(x), f64::from(y)));
                Polygon::new(points.collect())
            })
            .prop_filter("simple", |p| p.is_simple() && p.area() > 0.0)
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            cases: 400,
            max_local_rejects: 1_000_000,
            ..ProptestConfig::default()
        })]
        // On a small grid nearly every pair touches somewhere, and overlaps are never thin.
        #[test]
        fn overlap_agrees_with_the_area_of_the_intersection(
            a in grid_polygon(), b in grid_polygon(), x in -6i32..6, y in -6i32..6
        ) {
            let b = b.translated(Vec2::new(f64::from(x), f64::from(y)));
            let area = total_area(&intersection(&a, &b));
            prop_assert_eq!(interiors_overlap(&a, &b), area > 1e-6, "area {}", area);
            prop_assert_eq!(interiors_overlap(&b, &a), area > 1e-6);
            let (a, b) = (PreparedPolygon::new(&a), PreparedPolygon::new(&b));
            let way = a.separation(&b);
            let after = PreparedPolygon::new(&b.polygon().translated(way * (1.0 + 1e-6)));
            prop_assert!(total_area(&intersection(a.polygon(), after.polygon())) < 1e-5);
        }
    }
}
