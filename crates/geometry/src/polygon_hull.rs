//! Convex hulls with exact orientation.

use crate::{Vec2, orient2d};

/// The corners of the convex hull, counter-clockwise from the leftmost (then lowest) point
/// (Andrew 1979, monotone chain). Exact: no corner is lost or added by rounding; collinear points
/// are left out. Points that are not finite are ignored. Fewer than three corners mean that the
/// points are collinear.
pub fn convex_hull(points: &[Vec2]) -> Vec<Vec2> {
    let mut sorted: Vec<Vec2> = points
        .iter()
        .copied()
        .filter(|p| p.x.is_finite() && p.y.is_finite())
        .map(|p| p + Vec2::zeros())
        .collect();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let mut hull = half_hull(sorted.iter().copied());
    let upper = half_hull(sorted.iter().rev().copied());
    hull.pop();
    hull.extend(&upper[..upper.len() - 1]);
    hull
}

/// One half of a convex hull (Andrew 1979): of points sorted by x, then y, the lower half; of points
/// sorted the other way the upper half, walked the other way. Exact as [`convex_hull`].
pub fn half_hull(points: impl Iterator<Item = Vec2>) -> Vec<Vec2> {
    let mut chain: Vec<Vec2> = Vec::new();
    for p in points {
        while chain.len() > 1 && orient2d(chain[chain.len() - 2], chain[chain.len() - 1], p) <= 0.0
        {
            chain.pop();
        }
        chain.push(p);
    }
    chain
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Polygon;
    use proptest::prelude::*;

    #[test]
    fn hulls_of_few_collinear_and_repeated_points() {
        let p = |x: f64, y: f64| Vec2::new(x, y);
        assert!(convex_hull(&[]).is_empty());
        assert_eq!(convex_hull(&[p(1.0, 2.0); 5]), vec![p(1.0, 2.0)]);
        let line: Vec<Vec2> = (0..9)
            .map(|k| p(f64::from(k), 2.0 * f64::from(k)))
            .collect();
        assert_eq!(convex_hull(&line), vec![p(0.0, 0.0), p(8.0, 16.0)]);
        assert!(convex_hull(&[p(f64::NAN, 0.0)]).is_empty());
        let square = [
            p(0.0, 0.0),
            p(1.0, 0.0),
            p(1.0, 1.0),
            p(0.0, 1.0),
            p(0.5, 0.0),
        ];
        assert_eq!(convex_hull(&square).len(), 4);
    }

    proptest! {
        #[test]
        fn hulls_are_convex_and_hold_every_point(
            points in prop::collection::vec((-8i32..8, -8i32..8), 3..60)
        ) {
            let points: Vec<Vec2> = points
                .iter()
                .map(|&(x, y)| Vec2::new(f64::from(x) * 0.1, f64::from(y) * 0.1))
                .collect();
            let hull = convex_hull(&points);
            for q in &hull {
                prop_assert!(points.contains(q));
            }
            if hull.len() > 2 {
                let hull = Polygon::new(hull);
                prop_assert!(hull.is_convex());
                for &p in &points {
                    prop_assert!(hull.contains(p));
                }
                let twice = convex_hull(&hull.outer);
                prop_assert_eq!(twice, hull.outer);
            }
        }
    }
}
