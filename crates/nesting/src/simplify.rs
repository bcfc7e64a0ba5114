//! Simplifies an outline to fewer points, never inside it.

use toile_geometry::{Polygon, Vec2, orient2d, point_segment_distance};

/// A ring with fewer points that contains the old one and grows by at most about `tolerance` (m) (after de
/// Berg, van Kreveld and Schirra 1998: only moves that add area).
///
/// There are two moves: a concave corner is cut off by its chord; an edge between two convex corners is
/// replaced by the intersection of its neighbours. A vertex carries the distance moved so far. Returns the
/// ring itself if the result would touch itself. Rings run counter-clockwise.
pub(crate) fn simplify_outward(ring: &[Vec2], tolerance: f64) -> Vec<Vec2> {
    let mut points: Vec<(Vec2, f64)> = ring.iter().map(|&p| (p, 0.0)).collect();
    while points.len() > 3 {
        let moves =
            (0..points.len()).flat_map(|k| [cut_hollow(&points, k), close_edge(&points, k)]);
        let allowed = moves.flatten().filter(|m| m.cost <= tolerance);
        let Some(best) = allowed.min_by(|a, b| a.cost.total_cmp(&b.cost)) else {
            break;
        };
        best.apply(&mut points);
    }
    let simple: Vec<Vec2> = points.into_iter().map(|(p, _)| p).collect();
    if simple.len() < ring.len() && Polygon::new(simple.clone()).is_simple() {
        simple
    } else {
        ring.to_vec()
    }
}

struct Move {
    cost: f64,
    at: usize,
    /// The point that replaces this vertex and the next; `None` if the vertex is removed.
    joint: Option<Vec2>,
}

impl Move {
    fn apply(self, points: &mut Vec<(Vec2, f64)>) {
        let n = points.len();
        let raise = |points: &mut Vec<(Vec2, f64)>, k: usize| {
            points[k].1 = points[k].1.max(self.cost);
        };
        match self.joint {
            None => {
                raise(points, (self.at + n - 1) % n);
                raise(points, (self.at + 1) % n);
                points.remove(self.at);
            }
            Some(joint) => {
                points[self.at] = (joint, self.cost);
                points.remove((self.at + 1) % n);
            }
        }
    }
}

/// Cuts off vertex `k` if the outline turns right or runs straight there.
fn cut_hollow(points: &[(Vec2, f64)], k: usize) -> Option<Move> {
    let n = points.len();
    let ((a, _), (b, moved), (c, _)) = (points[(k + n - 1) % n], points[k], points[(k + 1) % n]);
    (orient2d(a, b, c) <= 0.0).then(|| Move {
        cost: moved + point_segment_distance(b, [a, c]),
        at: k,
        joint: None,
    })
}

/// Replaces the edge from `k` if the outline turns left at both ends.
fn close_edge(points: &[(Vec2, f64)], k: usize) -> Option<Move> {
    let n = points.len();
    let at = |step: usize| points[(k + n - 1 + step) % n];
    let ((a, _), (b, moved_b), (c, moved_c), (d, _)) = (at(0), at(1), at(2), at(3));
    if orient2d(a, b, c) <= 0.0 || orient2d(b, c, d) <= 0.0 {
        return None;
    }
    let (u, v) = (b - a, d - c);
    let cross = u.perp(&v);
    // Neighbours that diverge or are nearly parallel do not meet nearby.
    if cross <= 1e-9 * u.norm() * v.norm() {
        return None;
    }
    let joint = b + u * ((c - b).perp(&v) / cross);
    let cost = point_segment_distance(joint, [b, c]) + moved_b.max(moved_c);
    // Rounding may put the joint slightly inside: the old edge must be on its left.
    let outside = orient2d(a, joint, b) >= 0.0 || point_segment_distance(b, [a, joint]) < 1e-12;
    (cost.is_finite() && outside).then_some(Move {
        cost,
        at: k,
        joint: Some(joint),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use toile_geometry::{difference, total_area};

    proptest! {
        #[test]
        fn the_old_region_is_covered_and_growth_is_small(
            waves in prop::collection::vec(0.5..1.0f64, 5..12), count in 20usize..200
        ) {
            let ring: Vec<Vec2> = (0..count)
                .map(|k| {
                    let angle = std::f64::consts::TAU * k as f64 / count as f64;
                    let place = angle / std::f64::consts::TAU * waves.len() as f64;
                    let (low, rest) = (place.floor() as usize % waves.len(), place.fract());
                    let smooth = rest * rest * (3.0 - 2.0 * rest);
                    let radius = waves[low] * (1.0 - smooth) + waves[(low + 1) % waves.len()] * smooth;
                    Vec2::new(angle.cos(), angle.sin()) * radius
                })
                .collect();
            let tolerance = 2e-3;
            let simple = simplify_outward(&ring, tolerance);
            let (old, new) = (Polygon::new(ring), Polygon::new(simple));
            prop_assert!(new.outer.len() <= old.outer.len());
            prop_assert!(total_area(&difference(&old, &new)) < 1e-7);
            for &p in &new.outer {
                let away = old
                    .edges()
                    .map(|e| point_segment_distance(p, e))
                    .fold(f64::INFINITY, f64::min);
                prop_assert!(away <= tolerance * 1.01, "{away}");
            }
        }
    }

    #[test]
    fn a_circle_loses_half_of_its_points() {
        let ring: Vec<Vec2> = (0..300)
            .map(|k| {
                let angle = std::f64::consts::TAU * f64::from(k) / 300.0;
                Vec2::new(angle.cos(), angle.sin()) * 0.2
            })
            .collect();
        let simple = simplify_outward(&ring, 2e-4);
        assert!(simple.len() < 150, "{}", simple.len());
    }
}
