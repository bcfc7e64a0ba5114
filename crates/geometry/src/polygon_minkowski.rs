//! Minkowski sums of polygons by their convolution.
//!
//! The convolution of two outlines (Guibas, Ramshaw and Stolfi 1983) is the set of closed curves
//! traced by `a + b` where the outlines have the same direction. Around a point `p` it winds once
//! for every part of the overlap of `A` and `p - B`, so the points it winds round are the
//! Minkowski sum. It has far fewer edges than the sum of all pairs of convex parts.

use crate::polygon::{ring_area, without_repeats};
use crate::{Polygon, Vec2, orient2d, wound_region};
use std::collections::BTreeMap;

/// A node of the convolution: a point of the first ring plus a point of the second.
type Node = (usize, usize);

/// The points `a + b` for `a` inside one outer ring and `b` inside the other. Holes of the
/// operands are taken as filled. Right to the rounding of [`wound_region`]. Empty if a ring has
/// no area.
pub fn minkowski_sum(a: &[Vec2], b: &[Vec2]) -> Vec<Polygon> {
    let (a, b) = (counter_clockwise(a), counter_clockwise(b));
    if a.len() < 3 || b.len() < 3 {
        return Vec::new();
    }
    let loops: Vec<Vec<Vec2>> = convolution(&a, &b)
        .into_iter()
        .map(|cycle| cycle.into_iter().map(|(i, j)| a[i] + b[j]).collect())
        .collect();
    let mut region = wound_region(&loops);
    // Two filled outlines have one sum; anything else is rounding.
    region.sort_by(|p, q| q.area().total_cmp(&p.area()));
    region.truncate(1);
    region
}

/// Positions at which a ring, moved by them, overlaps another that stays: `fixed + (-moving)`.
pub fn no_fit_polygon(fixed: &[Vec2], moving: &[Vec2]) -> Vec<Polygon> {
    let turned: Vec<Vec2> = moving.iter().map(|p| -p).collect();
    minkowski_sum(fixed, &turned)
}

fn counter_clockwise(ring: &[Vec2]) -> Vec<Vec2> {
    let mut ring = without_folds(without_repeats(ring));
    let area = ring_area(&ring);
    if !area.is_finite() || area == 0.0 {
        return Vec::new();
    }
    if area < 0.0 {
        ring.reverse();
    }
    ring
}

/// Removes points at which the outline runs straight on or turns straight back.
fn without_folds(mut ring: Vec<Vec2>) -> Vec<Vec2> {
    loop {
        let n = ring.len();
        let straight =
            |k: usize| orient2d(ring[(k + n - 1) % n], ring[k], ring[(k + 1) % n]) == 0.0;
        let Some(k) = (0..n).find(|&k| straight(k)) else {
            return ring;
        };
        ring.remove(k);
        ring = without_repeats(&ring);
        if ring.len() < 3 {
            return Vec::new();
        }
    }
}

/// Directions of the edges; their cross products order them without contradiction.
fn directions(ring: &[Vec2]) -> Vec<Vec2> {
    let n = ring.len();
    (0..n).map(|k| ring[(k + 1) % n] - ring[k]).collect()
}

fn cross_sign(a: Vec2, b: Vec2) -> f64 {
    orient2d(Vec2::zeros(), a, b)
}

/// Whether a direction lies in the turn (less than half a circle, counter-clockwise) between two
/// others. `first` and `last` say whether the ends belong to it.
fn in_turn(direction: Vec2, turn: [Vec2; 2], [first, last]: [bool; 2]) -> bool {
    let (after, before) = (
        cross_sign(turn[0], direction),
        cross_sign(direction, turn[1]),
    );
    if after == 0.0 && direction.dot(&turn[0]) > 0.0 {
        return first;
    }
    if before == 0.0 && direction.dot(&turn[1]) > 0.0 {
        return last;
    }
    after > 0.0 && before > 0.0
}

/// How often, and which way, an edge of one ring is swept at a corner of the other: +1, -1 or 0.
/// Equal directions are told apart as if the first ring's were turned by a trifle
/// counter-clockwise; `ends` are the ends that a counter-clockwise turn then holds.
fn sweep(direction: Vec2, corner: [Vec2; 2], ends: [bool; 2]) -> i8 {
    let turn = cross_sign(corner[0], corner[1]);
    if turn > 0.0 {
        i8::from(in_turn(direction, corner, ends))
    } else if turn < 0.0 {
        let back = [corner[1], corner[0]];
        -i8::from(in_turn(direction, back, ends))
    } else {
        0
    }
}

/// The convolution as closed cycles of nodes.
fn convolution(a: &[Vec2], b: &[Vec2]) -> Vec<Vec<Node>> {
    let (along_a, along_b) = (directions(a), directions(b));
    let (n, m) = (a.len(), b.len());
    let mut outgoing: BTreeMap<Node, Vec<Node>> = BTreeMap::new();
    let mut add = |from: Node, to: Node, sign: i8| match sign {
        1 => outgoing.entry(from).or_default().push(to),
        -1 => outgoing.entry(to).or_default().push(from),
        _ => {}
    };
    for i in 0..n {
        let corner_a = [along_a[(i + n - 1) % n], along_a[i]];
        for j in 0..m {
            let corner_b = [along_b[(j + m - 1) % m], along_b[j]];
            let sign = sweep(along_a[i], corner_b, [true, false]);
            add((i, j), ((i + 1) % n, j), sign);
            let sign = sweep(along_b[j], corner_a, [false, true]);
            add((i, j), (i, (j + 1) % m), sign);
        }
    }
    trace(outgoing)
}

/// Splits balanced directed edges into closed cycles.
fn trace(mut outgoing: BTreeMap<Node, Vec<Node>>) -> Vec<Vec<Node>> {
    let mut cycles = Vec::new();
    while let Some((&start, _)) = outgoing.iter().next() {
        let mut cycle = Vec::new();
        let mut at = start;
        while let Some(ways) = outgoing.get_mut(&at) {
            cycle.push(at);
            let next = ways.pop();
            if ways.is_empty() {
                outgoing.remove(&at);
            }
            match next {
                Some(next) => at = next,
                None => break,
            }
        }
        cycles.push(cycle);
    }
    cycles
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Bounds2, convex_hull, total_area};
    use proptest::prelude::*;

    fn star(radii: &[f64], turn: f64) -> Vec<Vec2> {
        let n = radii.len() as f64;
        let point = |(k, &r): (usize, &f64)| {
            let angle = turn + std::f64::consts::TAU * k as f64 / n;
            Vec2::new(r * angle.cos(), r * angle.sin())
        };
        radii.iter().enumerate().map(point).collect()
    }

    #[test]
    fn two_squares_make_a_square() {
        let square = Polygon::rectangle(Bounds2 {
            min: Vec2::zeros(),
            max: Vec2::new(1.0, 1.0),
        });
        let sum = minkowski_sum(&square.outer, &square.outer);
        assert_eq!(sum.len(), 1);
        assert!((sum[0].area() - 4.0).abs() < 1e-8);
        assert!(minkowski_sum(&square.outer, &[]).is_empty());
    }

    #[test]
    fn a_key_fits_its_lock() {
        // A square room with a door narrower than the key leaves a hole in the no-fit polygon.
        let p = |x: f64, y: f64| Vec2::new(x, y);
        let room = [
            p(0.0, 0.0),
            p(3.0, 0.0),
            p(3.0, 3.0),
            p(1.6, 3.0),
            p(1.6, 2.5),
            p(2.5, 2.5),
            p(2.5, 0.5),
            p(0.5, 0.5),
            p(0.5, 2.5),
            p(1.4, 2.5),
            p(1.4, 3.0),
            p(0.0, 3.0),
        ];
        let key = [p(0.0, 0.0), p(0.5, 0.0), p(0.5, 0.5), p(0.0, 0.5)];
        let nfp = no_fit_polygon(&room, &key);
        assert_eq!(nfp.len(), 1);
        assert_eq!(nfp[0].holes.len(), 1);
        let free = Polygon::new(nfp[0].holes[0].clone());
        assert!((free.area() - 1.5 * 1.5).abs() < 1e-7, "{}", free.area());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn sums_hold_all_pairs_and_keep_within_the_hull(
            a in prop::collection::vec(0.2..1.0f64, 3..12),
            b in prop::collection::vec(0.2..1.0f64, 3..12),
            turn in 0.0..6.0f64,
        ) {
            let (a, b) = (star(&a, 0.0), star(&b, turn));
            let sum = minkowski_sum(&a, &b);
            prop_assert_eq!(sum.len(), 1);
            let all: Vec<Vec2> = a.iter().flat_map(|p| b.iter().map(move |q| p + q)).collect();
            for &p in &all {
                let inside = sum[0].contains(p)
                    || sum[0].edges().any(|e| crate::point_segment_distance(p, e) < 1e-7);
                prop_assert!(inside, "{p}");
            }
            let hull = Polygon::new(convex_hull(&all));
            prop_assert!(sum[0].area() <= hull.area() + 1e-7);
        }

        #[test]
        fn a_point_is_in_the_no_fit_polygon_where_the_rings_overlap(
            a in prop::collection::vec(0.2..1.0f64, 3..9),
            b in prop::collection::vec(0.2..1.0f64, 3..9),
            x in -2.0..2.0f64,
            y in -2.0..2.0f64,
        ) {
            let (a, b) = (star(&a, 0.1), star(&b, 0.7));
            let by = Vec2::new(x, y);
            let nfp = no_fit_polygon(&a, &b);
            let (a, b) = (Polygon::new(a), Polygon::new(b).translated(by));
            let overlap = total_area(&crate::intersection(&a, &b));
            if overlap > 1e-6 {
                prop_assert!(nfp[0].contains(by));
            }
            if overlap == 0.0 {
                let near = nfp[0].edges().any(|e| crate::point_segment_distance(by, e) < 1e-6);
                prop_assert!(near || !nfp[0].contains(by));
            }
        }
    }
}
