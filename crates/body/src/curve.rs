//! Smooth monotone interpolation of a value along a coordinate.

/// A piecewise cubic through given points that does not overshoot between them: where the data rise, the
/// curve rises (Fritsch and Carlson 1980; slopes by Fritsch and Butland 1984). Linear beyond the ends.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Monotone {
    points: Vec<[f64; 2]>,
    slopes: Vec<f64>,
    /// Coefficients of each piece in the distance from its first point, constant first.
    pieces: Vec<[f64; 4]>,
}

impl Monotone {
    /// The curve through these points, at least two, in ascending order.
    pub(crate) fn new(points: Vec<[f64; 2]>) -> Self {
        debug_assert!(points.len() > 1 && points.windows(2).all(|w| w[0][0] < w[1][0]));
        let chord: Vec<f64> = points
            .windows(2)
            .map(|w| (w[1][1] - w[0][1]) / (w[1][0] - w[0][0]))
            .collect();
        let last = points.len() - 1;
        let slopes = (0..=last)
            .map(|k| {
                if k == 0 || k == last {
                    return chord[k.saturating_sub(1).min(last - 1)];
                }
                let (left, right) = (chord[k - 1], chord[k]);
                if left * right <= 0.0 {
                    return 0.0;
                }
                let (h, g) = (
                    points[k][0] - points[k - 1][0],
                    points[k + 1][0] - points[k][0],
                );
                3.0 * (h + g) / ((2.0 * g + h) / left + (g + 2.0 * h) / right)
            })
            .collect::<Vec<f64>>();
        let pieces = (0..last)
            .map(|k| {
                let h = points[k + 1][0] - points[k][0];
                let (m0, m1) = (slopes[k], slopes[k + 1]);
                let (second, third) = (3.0 * chord[k] - 2.0 * m0 - m1, m0 + m1 - 2.0 * chord[k]);
                [points[k][1], m0, second / h, third / (h * h)]
            })
            .collect();
        Self {
            points,
            slopes,
            pieces,
        }
    }

    /// Position at which a rising curve has a value, to rounding.
    pub(crate) fn inverse(&self, value: f64) -> f64 {
        let last = self.points.len() - 1;
        for (end, slope) in [(0, self.slopes[0]), (last, self.slopes[last])] {
            let [x, y] = self.points[end];
            let beyond = if end == 0 { value <= y } else { value >= y };
            if beyond {
                return x + (value - y) / slope.max(1e-9);
            }
        }
        let k = self.points.partition_point(|p| p[1] <= value) - 1;
        let (mut low, mut high) = (self.points[k][0], self.points[k + 1][0]);
        let mut x = 0.5 * (low + high);
        for _ in 0..60 {
            let miss = self.at(x) - value;
            if miss < 0.0 {
                low = x;
            } else {
                high = x;
            }
            // Newton's method, kept between the ends.
            let step = 1e-7 * (self.points[k + 1][0] - self.points[k][0]);
            let slope = (self.at(x + step) - self.at(x - step)) / (2.0 * step);
            let next = x - miss / slope;
            let next = if next > low && next < high {
                next
            } else {
                0.5 * (low + high)
            };
            let moved = (next - x).abs();
            x = next;
            if moved < 1e-13 {
                break;
            }
        }
        x
    }

    /// Value at `x`.
    pub(crate) fn at(&self, x: f64) -> f64 {
        let last = self.points.len() - 1;
        if x <= self.points[0][0] {
            return self.points[0][1] + self.slopes[0] * (x - self.points[0][0]);
        }
        if x >= self.points[last][0] {
            return self.points[last][1] + self.slopes[last] * (x - self.points[last][0]);
        }
        // There are only a handful of points: a linear search is faster than bisection.
        let mut k = 0;
        while self.points[k + 1][0] <= x {
            k += 1;
        }
        let [a, b, c, d] = self.pieces[k];
        let t = x - self.points[k][0];
        a + t * (b + t * (c + t * d))
    }
}

/// Cubic step: 0 below 0, 1 above 1, level at both ends.
pub(crate) fn smooth_step(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keeps_the_points_and_never_overshoots() {
        let points = vec![[0.0, 1.0], [0.4, 1.0], [1.0, 3.0], [1.1, 3.2], [2.0, 2.0]];
        let curve = Monotone::new(points.clone());
        for [x, y] in &points {
            assert!((curve.at(*x) - y).abs() < 1e-14);
        }
        for w in points.windows(2) {
            let (low, high) = (w[0][1].min(w[1][1]), w[0][1].max(w[1][1]));
            for k in 0..=50 {
                let x = w[0][0] + (w[1][0] - w[0][0]) * f64::from(k) / 50.0;
                assert!((low - 1e-12..=high + 1e-12).contains(&curve.at(x)), "{x}");
            }
        }
        assert!(
            (curve.at(-1.0) - 1.0).abs() < 1e-14,
            "level beyond a level end"
        );
        let line = Monotone::new(vec![[0.0, 0.0], [1.0, 2.0], [3.0, 6.0]]);
        let rising = Monotone::new(vec![[0.0, 1.0], [0.4, 1.1], [1.0, 3.0], [1.1, 3.2]]);
        for k in -20..=40 {
            let x = 0.05 * f64::from(k);
            assert!((rising.inverse(rising.at(x)) - x).abs() < 1e-9, "{x}");
        }
        assert!((line.at(0.7) - 1.4).abs() < 1e-14 && (line.at(5.0) - 10.0).abs() < 1e-12);
    }
}
