//! Cubics through dense points by least squares (Schneider 1990): with given directions at the ends, or free. After two
//! rounds distances square to the cubic alone are made small, which ends soon (Wang, Pottmann and Liu 2006).

use toile_geometry::{Curve, Vec2};

/// Rounds in which the parameters of the points are moved to their nearest places.
const ROUNDS: usize = 24;
/// Rounds in which whole distances count, not those square to the cubic alone.
const FIRST_ROUNDS: usize = 2;
/// Distance of the points from the cubic that is good enough (m).
const ENOUGH: f64 = 4e-6;
/// Share of the best distance that a round must come below for another to follow (1).
const BETTER: f64 = 0.95;
/// Least and greatest handle, as shares of the length of the curve (1).
const HANDLES: [f64; 2] = [0.02, 1.5];
/// Fewest points of a fit whose directions are free.
const MIN_FREE: usize = 5;

/// A cubic with its greatest distance from the points that it was fitted to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fit {
    /// The handle after the start and the one before the end.
    pub handles: [Vec2; 2],
    /// Greatest distance of a point from the cubic, in the unit of the points.
    pub off: f64,
}

/// The cubic from the first to the last of some points that comes nearest to all of them, with unit vectors along it
/// at both ends.
pub(crate) fn along(points: &[Vec2], directions: [Vec2; 2]) -> Fit {
    fitted(points, |shares, last| {
        with_directions((points, directions), shares, last)
    })
}

/// The cubic from the first to the last of some points that comes nearest to all of them; `None` for few points.
pub(crate) fn free(points: &[Vec2]) -> Option<Fit> {
    let is_enough = points.len() >= MIN_FREE;
    is_enough.then(|| fitted(points, |shares, _| without_directions(points, shares)))
}

/// The best of some rounds; `handles` finds them for the parameters of the points and, after the first rounds, the cubic
/// of the last round.
fn fitted(points: &[Vec2], handles: impl Fn(&[f64], Option<&Curve>) -> [Vec2; 2]) -> Fit {
    let mut shares = by_length(points);
    let mut best: Option<Fit> = None;
    let mut last: Option<Curve> = None;
    for round in 0..ROUNDS {
        let handles = handles(&shares, last.as_ref().filter(|_| round >= FIRST_ROUNDS));
        let curve = curve(points, handles);
        // The parameters are moved first, so that distances are those to the nearest places.
        for (p, t) in points.iter().zip(&mut shares) {
            *t = moved(&curve, *p, moved(&curve, *p, *t));
        }
        let places = points.iter().zip(&shares);
        let off = places.map(|(p, &t)| (curve.point(t) - p).norm());
        let off = off.fold(0.0, f64::max);
        let is_better = best.is_none_or(|best| off < BETTER * best.off);
        if best.is_none_or(|best| off < best.off) {
            best = Some(Fit { handles, off });
        }
        if off <= ENOUGH || round > 2 * FIRST_ROUNDS && !is_better {
            break;
        }
        last = Some(curve);
    }
    best.unwrap_or(Fit {
        handles: chord_handles(points),
        off: 0.0,
    })
}

fn curve(points: &[Vec2], controls: [Vec2; 2]) -> Curve {
    Curve::Cubic {
        start: points[0],
        controls,
        end: points[points.len() - 1],
    }
}

/// Handles of a straight line.
pub(crate) fn chord_handles(points: &[Vec2]) -> [Vec2; 2] {
    let (start, end) = (points[0], points[points.len() - 1]);
    let third = (end - start) / 3.0;
    [start + third, end - third]
}

fn by_length(points: &[Vec2]) -> Vec<f64> {
    let mut lengths = vec![0.0];
    for pair in points.windows(2) {
        lengths.push(lengths[lengths.len() - 1] + (pair[1] - pair[0]).norm());
    }
    let whole = lengths[lengths.len() - 1].max(f64::MIN_POSITIVE);
    lengths.iter().map(|length| length / whole).collect()
}

/// One step of Newton's towards the place of a curve that is nearest to a point.
fn moved(curve: &Curve, p: Vec2, t: f64) -> f64 {
    const STEP: f64 = 1e-4;
    if t <= 0.0 || t >= 1.0 {
        return t;
    }
    let off = curve.point(t) - p;
    let speed = curve.derivative(t);
    let change = (curve.derivative((t + STEP).min(1.0)) - speed) / STEP;
    let slope = speed.norm_squared() + off.dot(&change);
    match slope > 0.0 {
        true => (t - off.dot(&speed) / slope).clamp(0.0, 1.0),
        false => t,
    }
}

fn weights(t: f64) -> [f64; 4] {
    let u = 1.0 - t;
    [u * u * u, 3.0 * u * u * t, 3.0 * u * t * t, t * t * t]
}

fn with_directions(
    (points, directions): (&[Vec2], [Vec2; 2]),
    shares: &[f64],
    last: Option<&Curve>,
) -> [Vec2; 2] {
    let (start, end) = (points[0], points[points.len() - 1]);
    let (mut aa, mut ab, mut bb, mut ra, mut rb) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (p, &t) in points.iter().zip(shares) {
        let [w0, w1, w2, w3] = weights(t);
        let (a, b) = (directions[0] * w1, directions[1] * -w2);
        let rest = p - start * (w0 + w1) - end * (w2 + w3);
        match last.and_then(|curve| curve.derivative(t).try_normalize(0.0)) {
            Some(along) => {
                let [a, b, rest] = [a, b, rest].map(|v| along.perp(&v));
                aa += a * a;
                ab += a * b;
                bb += b * b;
                ra += a * rest;
                rb += b * rest;
            }
            None => {
                aa += a.dot(&a);
                ab += a.dot(&b);
                bb += b.dot(&b);
                ra += a.dot(&rest);
                rb += b.dot(&rest);
            }
        }
    }
    let length: f64 = points
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).norm())
        .sum();
    let determinant = aa * bb - ab * ab;
    let both = [
        (ra * bb - rb * ab) / determinant,
        (rb * aa - ra * ab) / determinant,
    ];
    let is_sound = both.iter().all(|handle| {
        handle.is_finite() && (HANDLES[0] * length..=HANDLES[1] * length).contains(handle)
    });
    let [a, b] = if is_sound { both } else { [length / 3.0; 2] };
    [start + directions[0] * a, end - directions[1] * b]
}

fn without_directions(points: &[Vec2], shares: &[f64]) -> [Vec2; 2] {
    let (start, end) = (points[0], points[points.len() - 1]);
    let (mut aa, mut ab, mut bb) = (0.0, 0.0, 0.0);
    let (mut ra, mut rb) = (Vec2::zeros(), Vec2::zeros());
    for (p, &t) in points.iter().zip(shares) {
        let [w0, w1, w2, w3] = weights(t);
        let rest = p - start * w0 - end * w3;
        aa += w1 * w1;
        ab += w1 * w2;
        bb += w2 * w2;
        ra += rest * w1;
        rb += rest * w2;
    }
    let determinant = aa * bb - ab * ab;
    let both = [
        (ra * bb - rb * ab) / determinant,
        (rb * aa - ra * ab) / determinant,
    ];
    match both.iter().all(|p| p.x.is_finite() && p.y.is_finite()) {
        true => both,
        false => chord_handles(points),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUBIC: Curve = Curve::Cubic {
        start: Vec2::new(0.0, 0.0),
        controls: [Vec2::new(0.1, 0.15), Vec2::new(0.3, 0.2)],
        end: Vec2::new(0.4, 0.0),
    };

    fn sampled(count: usize) -> Vec<Vec2> {
        CUBIC.sample(0.0, 1.0, count)
    }

    #[test]
    fn a_cubic_is_found_again_from_points_of_it() {
        let directions = [0.0, 1.0].map(|t| CUBIC.derivative(t).normalize());
        let fit = along(&sampled(30), directions);
        assert!(fit.off < 1e-5, "{}", fit.off);
        assert!(
            (fit.handles[0] - Vec2::new(0.1, 0.15)).norm() < 2e-3,
            "{}",
            fit.handles[0]
        );
        let fit = free(&sampled(30)).unwrap();
        assert!(fit.off < 2e-4, "{}", fit.off);
        assert_eq!(free(&sampled(3)), None);
    }

    #[test]
    fn points_of_one_place_make_no_panic() {
        let points = [Vec2::new(0.1, 0.1); 6];
        let fit = along(&points, [Vec2::zeros(); 2]);
        assert!(fit.off == 0.0 && fit.handles[0].x.is_finite());
        assert!(free(&points).unwrap().handles[0].x.is_finite());
        // Two points have their chord.
        assert_eq!(chord_handles(&points[..2]), [points[0]; 2]);
    }
}
