//! Cubic Bezier curves through points within a tolerance (Schneider 1990), smooth where they join.

use toile_geometry::Vec2;

/// A cubic Bezier curve by its four points (m).
pub type Cubic = [Vec2; 4];

/// Rounds in which the parameters of the points are moved to the nearest of the curve.
const ROUNDS: usize = 8;

/// Curves from the first to the last point, all points within a tolerance (m). A point alone gives none.
pub fn fit(points: &[Vec2], tolerance: f64) -> Vec<Cubic> {
    let mut cubics = Vec::new();
    if points.len() >= 2 {
        let ends = [end_tangent(points, false), end_tangent(points, true)];
        fit_between(points, ends, tolerance, &mut cubics);
    }
    cubics
}

fn fit_between(points: &[Vec2], tangents: [Vec2; 2], tolerance: f64, cubics: &mut Vec<Cubic>) {
    let last = points.len() - 1;
    let chord = points[last] - points[0];
    let straight = [
        points[0],
        points[0] + chord / 3.0,
        points[last] - chord / 3.0,
        points[last],
    ];
    let parameters = by_chords(points);
    if last == 1 || farthest(points, &parameters, &straight).0 <= 0.5 * tolerance && last < 3 {
        cubics.push(straight);
        return;
    }
    let mut parameters = parameters;
    let mut cubic = straight;
    let mut worst = (f64::INFINITY, last / 2);
    for _ in 0..ROUNDS {
        cubic = fitted(points, &parameters, tangents);
        worst = farthest(points, &parameters, &cubic);
        if worst.0 <= tolerance {
            cubics.push(cubic);
            return;
        }
        for (parameter, point) in parameters.iter_mut().zip(points) {
            *parameter = nearer(&cubic, *parameter, *point);
        }
    }
    if last == 2 && !worst.0.is_finite() {
        cubics.push(cubic);
        return;
    }
    let middle = worst.1.clamp(1, last - 1);
    let along = (points[middle + 1] - points[middle - 1])
        .try_normalize(0.0)
        .unwrap_or(tangents[0]);
    fit_between(&points[..=middle], [tangents[0], -along], tolerance, cubics);
    fit_between(&points[middle..], [along, tangents[1]], tolerance, cubics);
}

/// The direction inwards at an end, of the parabola through its first three points.
fn end_tangent(points: &[Vec2], at_end: bool) -> Vec2 {
    let get = |k: usize| match at_end {
        true => points[points.len() - 1 - k],
        false => points[k],
    };
    let first = get(1) - get(0);
    let direction = if points.len() > 2 {
        let second = get(2) - get(0);
        let (a, b) = (first.norm(), first.norm() + (get(2) - get(1)).norm());
        first * (b / a) - second * (a / b)
    } else {
        first
    };
    direction.try_normalize(0.0).unwrap_or(first)
}

/// Shares of the way along the chords at which the points lie.
fn by_chords(points: &[Vec2]) -> Vec<f64> {
    let mut along = vec![0.0];
    for pair in points.windows(2) {
        along.push(along[along.len() - 1] + (pair[1] - pair[0]).norm());
    }
    let whole = along[along.len() - 1].max(f64::MIN_POSITIVE);
    along.iter().map(|at| at / whole).collect()
}

fn weights(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

fn at(cubic: &Cubic, t: f64) -> Vec2 {
    let w = weights(t);
    cubic[0] * w[0] + cubic[1] * w[1] + cubic[2] * w[2] + cubic[3] * w[3]
}

/// The curve of least squares with given directions at its ends.
fn fitted(points: &[Vec2], parameters: &[f64], tangents: [Vec2; 2]) -> Cubic {
    let (first, last) = (points[0], points[points.len() - 1]);
    let (mut c00, mut c01, mut c11, mut x0, mut x1) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (&t, point) in parameters.iter().zip(points) {
        let w = weights(t);
        let (a, b) = (tangents[0] * w[1], tangents[1] * w[2]);
        let off = point - first * (w[0] + w[1]) - last * (w[2] + w[3]);
        c00 += a.dot(&a);
        c01 += a.dot(&b);
        c11 += b.dot(&b);
        x0 += a.dot(&off);
        x1 += b.dot(&off);
    }
    let determinant = c00 * c11 - c01 * c01;
    let third = (last - first).norm() / 3.0;
    let whole: f64 = points.windows(2).map(|p| (p[1] - p[0]).norm()).sum();
    // Handles longer than the way itself would lead the curve there and back between its points.
    let sound = |length: &f64| *length > 0.05 * third && *length < whole;
    let length = |x: f64| Some(x / determinant).filter(sound).unwrap_or(third);
    let (one, two) = (length(x0 * c11 - x1 * c01), length(c00 * x1 - c01 * x0));
    [
        first,
        first + tangents[0] * one,
        last + tangents[1] * two,
        last,
    ]
}

/// The largest distance of a point from its place on the curve (m), and its index.
fn farthest(points: &[Vec2], parameters: &[f64], cubic: &Cubic) -> (f64, usize) {
    (parameters.iter().zip(points).enumerate())
        .map(|(k, (&t, point))| ((at(cubic, t) - point).norm(), k))
        .fold(
            (0.0, 0),
            |most, one| if one.0 > most.0 { one } else { most },
        )
}

/// One step of Newton's method to the nearest place of the curve.
fn nearer(cubic: &Cubic, t: f64, point: Vec2) -> f64 {
    let s = 1.0 - t;
    let [a, b, c] = [0, 1, 2].map(|k| (cubic[k + 1] - cubic[k]) * 3.0);
    let first = a * (s * s) + b * (2.0 * s * t) + c * (t * t);
    let second = ((b - a) * s + (c - b) * t) * 2.0;
    let off = at(cubic, t) - point;
    let slope = first.norm_squared() + off.dot(&second);
    if slope > 0.0 {
        (t - off.dot(&first) / slope).clamp(0.0, 1.0)
    } else {
        t
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arc_is_followed_and_a_line_stays_one() {
        let arc: Vec<Vec2> = (0..=60)
            .map(|k| {
                let (sine, cosine) = (3.0 * f64::from(k) / 60.0).sin_cos();
                Vec2::new(cosine, sine) * 0.3
            })
            .collect();
        let cubics = fit(&arc, 1e-4);
        assert!(cubics.len() <= 4, "{}", cubics.len());
        for cubic in &cubics {
            for k in 0..=20 {
                let off = (at(cubic, f64::from(k) / 20.0).norm() - 0.3).abs();
                assert!(off < 1.5e-4, "{off}");
            }
        }
        for pair in cubics.windows(2) {
            assert_eq!(pair[0][3], pair[1][0]);
            let (a, b) = (pair[0][3] - pair[0][2], pair[1][1] - pair[1][0]);
            assert!(a.perp(&b).abs() < 1e-9 * a.norm().max(b.norm()));
        }
        // One point between ends says little of the curve: its handles are no longer than the way.
        for turn in [-0.1, 0.1] {
            let way = Vec2::new(0.014, -0.0027);
            let off = Vec2::new(0.0002, 0.001);
            let few = [Vec2::zeros(), 0.6 * way + off, way];
            let tangents = [way.normalize(), -(way + turn * off).normalize()];
            let cubic = fitted(&few, &[0.0, 0.6, 1.0], tangents);
            let handles = [cubic[1] - cubic[0], cubic[3] - cubic[2]];
            let whole = (few[1] - few[0]).norm() + (few[2] - few[1]).norm();
            assert!(handles.iter().all(|handle| handle.norm() < whole), "{turn}");
        }
        let line: Vec<Vec2> = (0..9).map(|k| Vec2::new(f64::from(k), 2.0)).collect();
        assert_eq!(fit(&line, 1e-4).len(), 1);
        assert!(fit(&line[..1], 1e-4).is_empty());
    }
}
