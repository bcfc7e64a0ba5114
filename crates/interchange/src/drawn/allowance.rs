//! Seam allowances, from the distance of the cut line to the line that is sewn.

use toile_geometry::{Polygon, Vec2, closest_on_segment};

/// Largest difference between distances along an edge that count as one width (m).
const EVEN: f64 = 1e-4;
/// Shares of the length of an edge at which its distance to the cut line is taken: away from its corners, at
/// which the cut line turns.
const SHARES: [f64; 7] = [0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8];
/// Share of the length of an edge to both sides of a place that tells its direction there.
const NEAR: f64 = 0.01;

/// Width of the allowance along an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Width {
    /// It is even (m).
    Even(f64),
    /// It differs along the edge: its mean, and the difference of its largest and smallest (m).
    Uneven {
        /// The mean.
        mean: f64,
        /// The difference.
        spread: f64,
    },
}

/// Width of the allowance along an edge of the sew line, given by the vertices of both lines. Both lines run
/// counter-clockwise. Where a wide allowance ends in a slope, its foot is nearer to a short edge than the line beside
/// it, which then tells the width.
pub(crate) fn width(edge: &[Vec2], cut_line: &[Vec2]) -> Width {
    let nearest = of_distances(SHARES.map(|share| distance(point_at(edge, share), cut_line)));
    let is_even = |width: &Width| matches!(width, Width::Even(_));
    let beside = || {
        let ways = SHARES.map(|share| distance_beside(edge, share, cut_line));
        let all = ways.iter().all(Option::is_some);
        let found = all.then(|| of_distances(ways.map(Option::unwrap_or_default)));
        found.filter(is_even)
    };
    match is_even(&nearest) {
        true => nearest,
        false => beside().unwrap_or(nearest),
    }
}

/// The distance from a place on an edge, square to it and to its right, to a closed line; `None` if it is not met.
fn distance_beside(edge: &[Vec2], share: f64, ring: &[Vec2]) -> Option<f64> {
    let at = point_at(edge, share);
    let [from, to] = [share - NEAR, share + NEAR].map(|share| point_at(edge, share));
    let along = (to - from).normalize();
    let out = Vec2::new(along.y, -along.x);
    let next = ring.iter().cycle().skip(1);
    let ways = ring.iter().zip(next).filter_map(|(&a, &b)| {
        let [a, b] = [a - at, b - at];
        let [before, after] = [along.dot(&a), along.dot(&b)];
        let share = before / (before - after);
        let way = out.dot(&(a + (b - a) * share));
        (before * after <= 0.0 && way > 0.0).then_some(way)
    });
    let nearest = ways.fold(f64::INFINITY, f64::min);
    nearest.is_finite().then_some(nearest)
}

fn of_distances(distances: [f64; SHARES.len()]) -> Width {
    let [low, high] = distances
        .iter()
        .fold([f64::INFINITY, 0.0f64], |[low, high], &d| {
            [low.min(d), high.max(d)]
        });
    let mean = distances.iter().sum::<f64>() / distances.len() as f64;
    match high - low <= EVEN {
        true => Width::Even(mean),
        false => Width::Uneven {
            mean,
            spread: high - low,
        },
    }
}

/// The point at a share of the length of a line.
pub(crate) fn point_at(line: &[Vec2], share: f64) -> Vec2 {
    let lengths = line.windows(2).map(|pair| (pair[1] - pair[0]).norm());
    let mut left = share * lengths.clone().sum::<f64>();
    for (pair, length) in line.windows(2).zip(lengths) {
        if left <= length {
            let part = if length > 0.0 { left / length } else { 0.0 };
            return pair[0] + (pair[1] - pair[0]) * part;
        }
        left -= length;
    }
    line.last().copied().unwrap_or_default()
}

/// Distance of a point to a closed line (m).
pub(crate) fn distance(p: Vec2, ring: &[Vec2]) -> f64 {
    nearest(p, ring).map_or(f64::INFINITY, |found| found.distance)
}

/// The place of a closed line that is nearest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Nearest {
    /// Index of the vertex that the chord with the place starts at.
    pub chord: usize,
    /// Share of the chord before the place.
    pub share: f64,
    /// Distance of the point (m).
    pub distance: f64,
}

/// The nearest place of a closed line; `None` if it has no vertices.
pub(crate) fn nearest(p: Vec2, ring: &[Vec2]) -> Option<Nearest> {
    let next = ring.iter().cycle().skip(1);
    let places = ring.iter().zip(next).enumerate().map(|(chord, (&a, &b))| {
        let place = closest_on_segment(p, [a, b]);
        let length = (b - a).norm();
        Nearest {
            chord,
            share: if length > 0.0 {
                (place - a).norm() / length
            } else {
                0.0
            },
            distance: (place - p).norm(),
        }
    });
    places.min_by(|a, b| a.distance.total_cmp(&b.distance))
}

/// Whether one closed line lies evenly within another: every vertex has a distance of at most `most` (m) to it,
/// and lies inside.
pub(crate) fn is_evenly_inside(inner: &[Vec2], outer: &[Vec2], most: f64) -> bool {
    let around = Polygon::new(outer.to_vec());
    inner.len() > 2
        && inner
            .iter()
            .all(|&p| around.contains(p) && distance(p, outer) <= most)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(low: f64, high: f64) -> Vec<Vec2> {
        [[low, low], [high, low], [high, high], [low, high]]
            .map(Vec2::from)
            .to_vec()
    }

    #[test]
    fn an_even_allowance_is_told_from_an_uneven_one() {
        let edge = [Vec2::new(0.0, 0.0), Vec2::new(0.3, 0.0)];
        let Width::Even(width) = width(&edge, &square(-0.01, 0.31)) else {
            panic!("even");
        };
        assert!((width - 0.01).abs() < 1e-12);
        let slanted = [[-0.01, -0.01], [0.31, -0.02], [0.31, 0.31], [-0.01, 0.31]].map(Vec2::from);
        assert!(
            matches!(super::width(&edge, &slanted), Width::Uneven { mean, spread } if (mean - 0.015).abs() < 1e-4 && spread > 1e-3)
        );
    }

    #[test]
    fn a_wide_allowance_of_a_short_edge_that_ends_in_slopes_is_even() {
        // A hem of 30 mm between sides of 10 mm; no slope is parallel to the edge.
        let edge = [Vec2::new(0.0, 0.0), Vec2::new(0.06, 0.0)];
        let hem = [
            [-0.01, 0.0],
            [0.0, -0.03],
            [0.06, -0.03],
            [0.07, 0.0],
            [0.07, 0.3],
            [-0.01, 0.3],
        ];
        let Width::Even(found) = width(&edge, &hem.map(Vec2::from)) else {
            panic!("even");
        };
        assert!((found - 0.03).abs() < 1e-12);
    }

    #[test]
    fn a_line_evenly_inside_is_known() {
        let outer = square(0.0, 1.0);
        assert!(is_evenly_inside(&square(0.01, 0.99), &outer, 0.02));
        assert!(!is_evenly_inside(&square(0.2, 0.4), &outer, 0.02));
        assert!(!is_evenly_inside(&square(-0.01, 1.01), &outer, 0.02));
        assert!(!is_evenly_inside(&[], &outer, 0.02));
    }

    #[test]
    fn the_nearest_place_has_its_chord_and_share() {
        let found = nearest(Vec2::new(0.25, -0.5), &square(0.0, 1.0)).unwrap();
        assert_eq!((found.chord, found.share, found.distance), (0, 0.25, 0.5));
        assert_eq!(nearest(Vec2::zeros(), &[]), None);
    }
}
