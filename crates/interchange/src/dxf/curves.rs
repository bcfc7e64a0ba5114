//! Curves of drawing programs as points: bulges, arcs, ellipses and B-splines (Piegl and Tiller 1997, chapter 4).
//!
//! Ends of a curve, of its quarter turns and of the spans of a spline are vertices; the points between them lie so
//! near to each other that their chords stay within a tolerance.

use std::f64::consts::{FRAC_PI_2, TAU};
use toile_geometry::{Curve, Vec2};

/// Highest degree of a spline that is read (1).
const MAX_DEGREE: usize = 15;
/// Most halvings of a span between two vertices (1).
const MAX_HALVINGS: u32 = 10;
/// Halvings of a span that are always made, so that no turn of a curve is missed (1).
const MIN_HALVINGS: u32 = 1;

/// A line through points, some of which lie between the vertices of a curve.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct CurvePoints {
    /// The points, vertices among them.
    pub points: Vec<Vec2>,
    /// For each point, whether it lies between two vertices.
    pub between: Vec<bool>,
}

/// A B-spline, rational where it has weights.
#[derive(Clone, Debug, Default)]
pub(super) struct BSpline {
    pub degree: usize,
    pub knots: Vec<f64>,
    pub controls: Vec<Vec2>,
    /// Weights of the controls; empty: all are 1.
    pub weights: Vec<f64>,
}

impl CurvePoints {
    fn vertex(&mut self, at: Vec2) {
        self.points.push(at);
        self.between.push(false);
    }

    /// Adds points between the last vertex and the next, up to a parameter, without the point there.
    fn span(&mut self, at: &impl Fn(f64) -> Vec2, [from, to]: [f64; 2], tolerance: f64) {
        let mut open = vec![(from, to, 0)];
        while let Some((from, to, halvings)) = open.pop() {
            let ends = [at(from), at(to)];
            let chord = ends[1] - ends[0];
            let off = |share: f64| {
                let p = at(from + (to - from) * share) - ends[0];
                match chord.norm() > 0.0 {
                    true => (chord.perp(&p) / chord.norm()).abs(),
                    false => p.norm(),
                }
            };
            let is_flat = || {
                [0.25, 0.5, 0.75]
                    .into_iter()
                    .all(|share| off(share) <= tolerance)
            };
            if halvings >= MAX_HALVINGS || halvings >= MIN_HALVINGS && is_flat() {
                // The stretches lie in order: after the last one comes the next vertex.
                if !open.is_empty() {
                    self.points.push(ends[1]);
                    self.between.push(true);
                }
                continue;
            }
            let middle = 0.5 * (from + to);
            open.extend([(middle, to, halvings + 1), (from, middle, halvings + 1)]);
        }
    }

    /// A curve by a parameter, with vertices at some of its values.
    fn of(at: impl Fn(f64) -> Vec2, vertices: &[f64], tolerance: f64) -> Self {
        let mut curve = Self::default();
        for pair in vertices.windows(2) {
            curve.vertex(at(pair[0]));
            curve.span(&at, [pair[0], pair[1]], tolerance);
        }
        if let Some(&last) = vertices.last() {
            curve.vertex(at(last));
        }
        curve
    }

    /// Part of an ellipse between two values of its parameter (rad); axes are half axes.
    pub fn ellipse(centre: Vec2, axes: [Vec2; 2], [from, to]: [f64; 2], tolerance: f64) -> Self {
        let sweep = to - from;
        let quarters = (sweep.abs() / FRAC_PI_2 - 1e-9).ceil().clamp(1.0, 4.0);
        let vertices: Vec<f64> = (0..=quarters as usize)
            .map(|k| from + sweep * k as f64 / quarters)
            .collect();
        let at = |t: f64| centre + axes[0] * t.cos() + axes[1] * t.sin();
        let mut curve = Self::of(at, &vertices, tolerance);
        // The sine of a full turn is not quite 0.
        if let (true, Some(last)) = (
            sweep.abs() >= TAU - 1e-12,
            curve.points.len().checked_sub(1),
        ) {
            curve.points[last] = curve.points[0];
        }
        curve
    }

    /// A line through vertices, each with the bulge of the way to the next one (the tangent of a quarter of the
    /// angle that it turns by); a closed line has one more way, back to its start, which is not repeated.
    pub fn bulged(vertices: &[(Vec2, f64)], is_closed: bool, tolerance: f64) -> Self {
        let mut curve = Self::default();
        for (k, &(at, bulge)) in vertices.iter().enumerate() {
            curve.vertex(at);
            let is_last = k + 1 == vertices.len();
            if bulge == 0.0 || is_last && !is_closed {
                continue;
            }
            let arc = Curve::Arc {
                start: at,
                end: vertices[(k + 1) % vertices.len()].0,
                bulge,
            };
            let turn = 4.0 * bulge.atan().abs();
            let quarters = (turn / FRAC_PI_2 - 1e-9).ceil().clamp(1.0, 4.0);
            for quarter in 0..quarters as usize {
                let [from, to] = [quarter, quarter + 1].map(|k| k as f64 / quarters);
                if quarter > 0 {
                    curve.vertex(arc.point(from));
                }
                curve.span(&|t| arc.point(t), [from, to], tolerance);
            }
        }
        curve
    }
}

impl BSpline {
    /// The points of the spline; `None` if its numbers make none.
    pub fn points(&self, tolerance: f64) -> Option<CurvePoints> {
        let (degree, count) = (self.degree, self.controls.len());
        let is_sound = (1..=MAX_DEGREE).contains(&degree)
            && count > degree
            && self.knots.len() == count + degree + 1
            && self.knots.is_sorted()
            && (self.weights.is_empty() || self.weights.len() == count)
            && self.weights.iter().all(|&weight| weight > 0.0);
        if !is_sound {
            return None;
        }
        let mut vertices = self.knots[degree..=count].to_vec();
        vertices.dedup();
        let curve = CurvePoints::of(|t| self.at(t), &vertices, tolerance);
        (curve.points.len() > 1).then_some(curve)
    }

    /// The point at a parameter (de Boor 1972).
    fn at(&self, t: f64) -> Vec2 {
        let (degree, count) = (self.degree, self.controls.len());
        let span = self.knots[degree + 1..count].partition_point(|&knot| knot <= t) + degree;
        let weight = |k: usize| self.weights.get(k).copied().unwrap_or(1.0);
        let mut rows: Vec<(Vec2, f64)> = (span - degree..=span)
            .map(|k| (self.controls[k] * weight(k), weight(k)))
            .collect();
        for level in 1..=degree {
            for j in (level..=degree).rev() {
                let low = self.knots[span - degree + j];
                let width = self.knots[span + 1 + j - level] - low;
                let share = if width > 0.0 { (t - low) / width } else { 0.0 };
                let (before, own) = (rows[j - 1], rows[j]);
                rows[j] = (
                    before.0 * (1.0 - share) + own.0 * share,
                    before.1 * (1.0 - share) + own.1 * share,
                );
            }
        }
        rows[degree].0 / rows[degree].1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn off(curve: &CurvePoints, radius: f64) -> f64 {
        let middles = curve
            .points
            .windows(2)
            .map(|pair| 0.5 * (pair[0] + pair[1]));
        let all = curve.points.iter().copied().chain(middles);
        all.map(|p| (p.norm() - radius).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn arcs_and_bulges_stay_within_the_tolerance() {
        let axes = [Vec2::new(200.0, 0.0), Vec2::new(0.0, 200.0)];
        let circle = CurvePoints::ellipse(Vec2::zeros(), axes, [0.0, TAU], 0.01);
        assert!(off(&circle, 200.0) <= 0.01, "{}", off(&circle, 200.0));
        assert_eq!(circle.points[0], circle.points[circle.points.len() - 1]);
        assert_eq!(circle.between.iter().filter(|b| !**b).count(), 5);
        // A semicircle from (200, 0) to (-200, 0) above the axis, and straight back.
        let ends = [(Vec2::new(200.0, 0.0), 1.0), (Vec2::new(-200.0, 0.0), 0.0)];
        let half = CurvePoints::bulged(&ends, true, 0.01);
        assert!(off(&half, 200.0) <= 0.01 && half.points.len() > 20);
        assert!(half.points.iter().all(|p| p.y > -1e-9));
        assert_eq!(half.between.iter().filter(|b| !**b).count(), 3);
    }

    #[test]
    fn a_rational_spline_of_degree_two_is_a_circle() {
        // A quarter of a circle (Piegl and Tiller 1997, section 7.3).
        let spline = BSpline {
            degree: 2,
            knots: vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
            controls: [[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
                .map(Vec2::from)
                .to_vec(),
            weights: vec![1.0, 0.5_f64.sqrt(), 1.0],
        };
        let curve = spline.points(1e-5).unwrap();
        assert!(off(&curve, 1.0) <= 1.2e-5 && curve.points.len() > 100);
        // Two cubics that meet at (2, 0.5): by de Boor's rows.
        let controls = [[0.0, 0.0], [1.0, 1.0], [2.0, 0.5], [3.0, 0.0], [4.0, 1.0]];
        let spline = BSpline {
            degree: 3,
            knots: vec![0.0, 0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0, 1.0],
            controls: controls.map(Vec2::from).to_vec(),
            weights: Vec::new(),
        };
        assert!((spline.at(0.5) - Vec2::new(2.0, 0.5)).norm() < 1e-12);
        assert!((spline.at(1.0) - Vec2::new(4.0, 1.0)).norm() < 1e-12);
        let vertices = spline.points(1e-4).unwrap();
        assert_eq!(vertices.between.iter().filter(|b| !**b).count(), 3);
    }

    #[test]
    fn splines_without_sense_are_none() {
        let mut spline = BSpline {
            degree: 2,
            knots: vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
            controls: vec![Vec2::zeros(); 3],
            weights: vec![1.0, 0.0, 1.0],
        };
        assert_eq!(spline.points(0.01), None);
        spline.weights.clear();
        spline.knots.swap(0, 5);
        assert_eq!(spline.points(0.01), None);
        spline.degree = 0;
        assert_eq!(spline.points(0.01), None);
    }
}
