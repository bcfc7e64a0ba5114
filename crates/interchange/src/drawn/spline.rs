//! Cubic splines through the vertices of a curve, by chord length, with parabolas at the ends (Farin 2002, chapter 9).
//! A natural spline has no curvature at its ends: its tangent there, on which the corner of an allowance depends, would be
//! off by a quarter of the turn between two vertices.

use toile_geometry::Vec2;

/// Directions of a curve at its start and at its end, of length 1, where they are known.
pub(crate) type Tangents = [Option<Vec2>; 2];

/// Derivatives at points by the arc length of the chords (1), of the cubic spline through them. Two
/// points give the direction of their chord.
pub(crate) fn slopes_of(points: &[Vec2]) -> Vec<Vec2> {
    slopes_between(points, Tangents::default())
}

/// As [`slopes_of`], with the known tangents of the ends.
fn slopes_between(points: &[Vec2], ends: Tangents) -> Vec<Vec2> {
    let n = points.len();
    let chords: Vec<Vec2> = points.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if n <= 2 {
        let chord = chords.first().copied().unwrap_or_default();
        let chord = chord / chord.norm().max(f64::MIN_POSITIVE);
        return (0..n).map(|k| ends[k].unwrap_or(chord)).collect();
    }
    let h: Vec<f64> = chords
        .iter()
        .map(|chord| chord.norm().max(f64::MIN_POSITIVE))
        .collect();
    // Rows of a tridiagonal system for the derivatives: the curve is a parabola between the last two points.
    let mut diagonal = vec![2.0; n];
    (diagonal[0], diagonal[n - 1]) = (1.0, 1.0);
    let (mut lower, mut upper) = (vec![0.0; n], vec![0.0; n]);
    let mut right = vec![Vec2::zeros(); n];
    upper[0] = 1.0;
    right[0] = chords[0] * (2.0 / h[0]);
    for k in 1..n - 1 {
        let weight = h[k] / (h[k - 1] + h[k]);
        lower[k] = weight;
        upper[k] = 1.0 - weight;
        right[k] =
            (chords[k - 1] * (weight / h[k - 1]) + chords[k] * ((1.0 - weight) / h[k])) * 3.0;
    }
    lower[n - 1] = 1.0;
    right[n - 1] = chords[n - 2] * (2.0 / h[n - 2]);
    if let Some(tangent) = ends[0] {
        (upper[0], right[0]) = (0.0, tangent);
    }
    if let Some(tangent) = ends[1] {
        (lower[n - 1], right[n - 1]) = (0.0, tangent);
    }
    for k in 1..n {
        let factor = lower[k] / diagonal[k - 1];
        diagonal[k] -= factor * upper[k - 1];
        let before = right[k - 1];
        right[k] -= before * factor;
    }
    for k in (0..n).rev() {
        let after = match k + 1 < n {
            true => right[k + 1] * upper[k],
            false => Vec2::zeros(),
        };
        right[k] = (right[k] - after) / diagonal[k];
    }
    right
}

/// Handles of the cubics between points, with the known tangents of the ends: of each cubic the handle after its start
/// and that before its end. A spline that turns back against one of its chords overshoots; its handles are then those
/// of straight chords, and the flag is `true`.
pub(crate) fn handles(points: &[Vec2], ends: Tangents) -> (Vec<[Vec2; 2]>, bool) {
    let slopes = slopes_between(points, ends);
    let pairs = || points.windows(2).zip(slopes.windows(2));
    let overshoots = pairs().any(|(ends, slopes)| {
        let chord = ends[1] - ends[0];
        slopes.iter().any(|slope| slope.dot(&chord) <= 0.0)
    });
    let of = |(ends, slopes): (&[Vec2], &[Vec2])| {
        let chord = ends[1] - ends[0];
        let third = chord.norm() / 3.0;
        match overshoots {
            true => [ends[0] + chord / 3.0, ends[1] - chord / 3.0],
            false => [ends[0] + slopes[0] * third, ends[1] - slopes[1] * third],
        }
    };
    (pairs().map(of).collect(), overshoots)
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_geometry::Curve;

    #[test]
    fn a_straight_row_stays_straight() {
        let points: Vec<Vec2> = [0.0, 0.3, 1.0, 1.4].map(|x| Vec2::new(x, 2.0 * x)).to_vec();
        let direction = Vec2::new(1.0, 2.0).normalize();
        for slope in slopes_of(&points) {
            assert!((slope - direction).norm() < 1e-12);
        }
    }

    #[test]
    fn a_spline_is_nearer_to_an_arc_than_its_chords_by_far() {
        let arc = |t: f64| Vec2::new(t.cos(), t.sin());
        let points: Vec<Vec2> = (0..=6).map(|k| arc(0.25 * f64::from(k))).collect();
        let (handles, overshoots) = handles(&points, Tangents::default());
        assert!(!overshoots);
        let error = |k: usize| {
            let curve = Curve::Cubic {
                start: points[k],
                controls: handles[k],
                end: points[k + 1],
            };
            let off = (1..8).map(|t| (curve.point(f64::from(t) / 8.0).norm() - 1.0).abs());
            off.fold(0.0, f64::max)
        };
        // Chords are off by 1 - cos(0.125) = 7.8e-3.
        let all = (0..6).map(error).fold(0.0, f64::max);
        assert!(all < 2e-4, "{all}");
        // The tangent at the start goes straight up.
        let start = handles[0][0] - points[0];
        assert!((start.x / start.y).abs() < 2e-3, "{start:?}");
    }

    #[test]
    fn handles_of_a_spline_that_turns_back_are_those_of_chords() {
        let points = [[0.0, 0.0], [1.0, 0.0], [0.4, 0.0], [1.5, 0.0]].map(Vec2::from);
        let (handles, overshoots) = handles(&points, Tangents::default());
        assert!(overshoots);
        assert!((handles[0][0] - Vec2::new(1.0 / 3.0, 0.0)).norm() < 1e-12);
    }

    #[test]
    fn few_points_are_no_fault() {
        assert!(slopes_of(&[]).is_empty());
        assert_eq!(slopes_of(&[Vec2::zeros()]), [Vec2::zeros()]);
        assert!(handles(&[Vec2::zeros()], Tangents::default()).0.is_empty());
        let twice = [Vec2::zeros(), Vec2::zeros()];
        assert!(
            handles(&twice, Tangents::default()).0[0]
                .iter()
                .all(|p| p.norm() == 0.0)
        );
    }
}
