//! Plane curves a pattern edge can be: line, circular arc, quadratic and cubic Bezier.

use crate::Vec2;
use lyon::geom::{CubicBezierSegment, QuadraticBezierSegment, point};

/// A plane curve from a start to an end point, with parameter `t` in 0..=1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Curve {
    /// A straight line.
    Line {
        /// First point (m).
        start: Vec2,
        /// Last point (m).
        end: Vec2,
    },
    /// A circular arc. `bulge` is the tangent of a quarter of the swept angle, positive when
    /// the arc turns counter-clockwise (so it bulges to the right of start to end); 0 is a line,
    /// 1 a half circle.
    Arc {
        /// First point (m).
        start: Vec2,
        /// Last point (m).
        end: Vec2,
        /// Tangent of a quarter of the swept angle.
        bulge: f64,
    },
    /// A quadratic Bezier curve.
    Quadratic {
        /// First point (m).
        start: Vec2,
        /// Control point (m).
        control: Vec2,
        /// Last point (m).
        end: Vec2,
    },
    /// A cubic Bezier curve.
    Cubic {
        /// First point (m).
        start: Vec2,
        /// Control points (m).
        controls: [Vec2; 2],
        /// Last point (m).
        end: Vec2,
    },
}

/// Below this bulge an arc is evaluated as a line: its sagitta is under 1e-12 of its chord.
const FLAT_BULGE: f64 = 1e-12;

/// Nodes and weights of Gauss-Legendre quadrature with 8 points on -1..1 (positive half).
const GAUSS_8: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

/// Pieces a Bezier curve is cut into for quadrature. With 8 nodes each the length of a smooth
/// garment edge is right to 1e-12 of itself, and to 1e-5 across a cusp.
const LENGTH_PIECES: usize = 16;

/// Largest difference between a leg of the control polygon and the mean of the legs, over that mean, at which
/// one piece is enough (1). The error of 8 nodes falls with the 8th power of this ratio, so that it is below
/// the rounding of the length.
const EVEN_LEGS: f64 = 0.02;

impl Curve {
    /// First point (m).
    pub fn start(&self) -> Vec2 {
        match *self {
            Self::Line { start, .. }
            | Self::Arc { start, .. }
            | Self::Quadratic { start, .. }
            | Self::Cubic { start, .. } => start,
        }
    }

    /// Last point (m).
    pub fn end(&self) -> Vec2 {
        match *self {
            Self::Line { end, .. }
            | Self::Arc { end, .. }
            | Self::Quadratic { end, .. }
            | Self::Cubic { end, .. } => end,
        }
    }

    /// Whether every coordinate is finite.
    pub fn is_finite(&self) -> bool {
        self.defining_points()
            .iter()
            .all(|p| p.x.is_finite() && p.y.is_finite())
            && match *self {
                Self::Arc { bulge, .. } => bulge.is_finite(),
                Self::Line { .. } | Self::Quadratic { .. } | Self::Cubic { .. } => true,
            }
    }

    /// Start, control points and end, in order (m).
    pub fn defining_points(&self) -> Vec<Vec2> {
        match *self {
            Self::Line { start, end } | Self::Arc { start, end, .. } => vec![start, end],
            Self::Quadratic {
                start,
                control,
                end,
            } => vec![start, control, end],
            Self::Cubic {
                start,
                controls,
                end,
            } => vec![start, controls[0], controls[1], end],
        }
    }

    /// Centre (m), start angle (rad) and swept angle (rad) of an arc that is not flat.
    fn arc_frame(start: Vec2, end: Vec2, bulge: f64) -> (Vec2, f64, f64) {
        let chord = end - start;
        let left = Vec2::new(-chord.y, chord.x);
        let centre = (start + end) * 0.5 + left * ((1.0 - bulge * bulge) / (4.0 * bulge));
        let from = start - centre;
        (centre, from.y.atan2(from.x), 4.0 * bulge.atan())
    }

    /// Point at parameter `t` (m).
    pub fn point(&self, t: f64) -> Vec2 {
        let u = 1.0 - t;
        match *self {
            Self::Line { start, end } => start * u + end * t,
            Self::Arc { start, end, bulge } => {
                if bulge.abs() < FLAT_BULGE {
                    return start * u + end * t;
                }
                if t == 0.0 {
                    return start;
                }
                if t == 1.0 {
                    return end;
                }
                let (centre, from, sweep) = Self::arc_frame(start, end, bulge);
                let radius = (start - centre).norm();
                let angle = from + sweep * t;
                centre + Vec2::new(angle.cos(), angle.sin()) * radius
            }
            Self::Quadratic {
                start,
                control,
                end,
            } => start * (u * u) + control * (2.0 * u * t) + end * (t * t),
            Self::Cubic {
                start,
                controls,
                end,
            } => {
                start * (u * u * u)
                    + controls[0] * (3.0 * u * u * t)
                    + controls[1] * (3.0 * u * t * t)
                    + end * (t * t * t)
            }
        }
    }

    /// Derivative by the parameter at `t` (m).
    pub fn derivative(&self, t: f64) -> Vec2 {
        let u = 1.0 - t;
        match *self {
            Self::Line { start, end } => end - start,
            Self::Arc { start, end, bulge } => {
                if bulge.abs() < FLAT_BULGE {
                    return end - start;
                }
                let (centre, _, sweep) = Self::arc_frame(start, end, bulge);
                let radial = self.point(t) - centre;
                Vec2::new(-radial.y, radial.x) * sweep
            }
            Self::Quadratic {
                start,
                control,
                end,
            } => ((control - start) * u + (end - control) * t) * 2.0,
            Self::Cubic {
                start,
                controls,
                end,
            } => {
                ((controls[0] - start) * (u * u)
                    + (controls[1] - controls[0]) * (2.0 * u * t)
                    + (end - controls[1]) * (t * t))
                    * 3.0
            }
        }
    }

    /// Arc length (m): exact for lines and arcs, by quadrature for Bezier curves.
    pub fn length(&self) -> f64 {
        self.length_until(1.0)
    }

    /// Arc length from the start to parameter `t` (m).
    pub fn length_until(&self, t: f64) -> f64 {
        match *self {
            Self::Line { start, end } => (end - start).norm() * t,
            Self::Arc { start, end, bulge } => {
                if bulge.abs() < FLAT_BULGE {
                    return (end - start).norm() * t;
                }
                let (centre, _, sweep) = Self::arc_frame(start, end, bulge);
                (start - centre).norm() * sweep.abs() * t
            }
            Self::Quadratic { .. } | Self::Cubic { .. } => {
                let count = self.length_pieces();
                let at = |k: usize| t * k as f64 / count as f64;
                (0..count).map(|k| self.quadrature(at(k), at(k + 1))).sum()
            }
        }
    }

    /// Pieces that a Bezier curve is cut into for quadrature: one if it is nearly straight and its speed in the
    /// parameter nearly constant, as between the vertices of a digitised outline.
    fn length_pieces(&self) -> usize {
        let is_even = |legs: &[Vec2]| {
            let mean = legs.iter().sum::<Vec2>() / legs.len() as f64;
            let most = EVEN_LEGS * mean.norm();
            legs.iter().all(|leg| (leg - mean).norm() <= most)
        };
        let is_even = match *self {
            Self::Line { .. } | Self::Arc { .. } => true,
            Self::Quadratic {
                start,
                control,
                end,
            } => is_even(&[control - start, end - control]),
            Self::Cubic {
                start,
                controls: [a, b],
                end,
            } => is_even(&[a - start, b - a, end - b]),
        };
        if is_even { 1 } else { LENGTH_PIECES }
    }

    fn quadrature(&self, from: f64, to: f64) -> f64 {
        let (middle, half) = ((from + to) * 0.5, (to - from) * 0.5);
        GAUSS_8
            .iter()
            .map(|&(node, weight)| {
                let speed = |t: f64| self.derivative(t).norm();
                weight * (speed(middle - half * node) + speed(middle + half * node))
            })
            .sum::<f64>()
            * half
    }

    /// Parameter at which the arc length from the start reaches `length` (m), clamped to 0..=1.
    ///
    /// Safeguarded Newton on the quadrature: right to 1e-12 of the curve's length.
    pub fn parameter_at_length(&self, length: f64) -> f64 {
        let total = self.length();
        if length <= 0.0 || total <= 0.0 {
            return 0.0;
        }
        if length >= total {
            return 1.0;
        }
        let (mut low, mut high) = (0.0, 1.0);
        let mut t = length / total;
        for _ in 0..60 {
            let excess = self.length_until(t) - length;
            if excess.abs() <= 1e-13 * total {
                break;
            }
            if excess > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let speed = self.derivative(t).norm();
            let newton = t - excess / speed;
            t = if speed > 0.0 && newton > low && newton < high {
                newton
            } else {
                0.5 * (low + high)
            };
        }
        t
    }

    /// `count + 1` points at equal arc lengths between two arc-length fractions, ends included
    /// exactly (m). `from` may be larger than `to`: the points then run backwards.
    pub fn sample(&self, from: f64, to: f64, count: usize) -> Vec<Vec2> {
        let total = self.length();
        (0..=count)
            .map(|k| {
                let fraction = from + (to - from) * k as f64 / count.max(1) as f64;
                if fraction <= 0.0 {
                    self.start()
                } else if fraction >= 1.0 {
                    self.end()
                } else {
                    self.point(self.parameter_at_length(fraction * total))
                }
            })
            .collect()
    }

    /// The piece between two parameters; `from > to` gives it reversed. Exact.
    pub fn between(&self, from: f64, to: f64) -> Self {
        let (start, end) = (self.point(from), self.point(to));
        match *self {
            Self::Line { .. } => Self::Line { start, end },
            Self::Arc { bulge, .. } => Self::Arc {
                start,
                end,
                bulge: (bulge.atan() * (to - from)).tan(),
            },
            Self::Quadratic { .. } => Self::Quadratic {
                start,
                control: start + self.derivative(from) * ((to - from) / 2.0),
                end,
            },
            Self::Cubic { .. } => {
                let third = (to - from) / 3.0;
                Self::Cubic {
                    start,
                    controls: [
                        start + self.derivative(from) * third,
                        end - self.derivative(to) * third,
                    ],
                    end,
                }
            }
        }
    }

    /// The same curve walked from end to start.
    pub fn reversed(&self) -> Self {
        match *self {
            Self::Line { start, end } => Self::Line {
                start: end,
                end: start,
            },
            Self::Arc { start, end, bulge } => Self::Arc {
                start: end,
                end: start,
                bulge: -bulge,
            },
            Self::Quadratic {
                start,
                control,
                end,
            } => Self::Quadratic {
                start: end,
                control,
                end: start,
            },
            Self::Cubic {
                start,
                controls,
                end,
            } => Self::Cubic {
                start: end,
                controls: [controls[1], controls[0]],
                end: start,
            },
        }
    }

    /// The curve with every defining point moved by a similarity; `flips` says whether the map
    /// turns left into right (a reflection), which turns arcs the other way.
    fn mapped(&self, map: impl Fn(Vec2) -> Vec2, orientation: f64) -> Self {
        match *self {
            Self::Line { start, end } => Self::Line {
                start: map(start),
                end: map(end),
            },
            Self::Arc { start, end, bulge } => Self::Arc {
                start: map(start),
                end: map(end),
                bulge: bulge * orientation,
            },
            Self::Quadratic {
                start,
                control,
                end,
            } => Self::Quadratic {
                start: map(start),
                control: map(control),
                end: map(end),
            },
            Self::Cubic {
                start,
                controls,
                end,
            } => Self::Cubic {
                start: map(start),
                controls: controls.map(&map),
                end: map(end),
            },
        }
    }

    /// The curve moved by `offset` (m).
    pub fn translated(&self, offset: Vec2) -> Self {
        self.mapped(|p| p + offset, 1.0)
    }

    /// The curve turned about the origin by `angle` (rad), counter-clockwise.
    pub fn rotated(&self, angle: f64) -> Self {
        let rotation = nalgebra::Rotation2::new(angle);
        self.mapped(|p| rotation * p, 1.0)
    }

    /// The curve scaled about the origin by a positive factor.
    pub fn scaled(&self, factor: f64) -> Self {
        self.mapped(|p| p * factor, 1.0)
    }

    /// The curve reflected in the line through `on_line` along `direction` (not zero).
    pub fn reflected(&self, on_line: Vec2, direction: Vec2) -> Self {
        let unit = direction.normalize();
        self.mapped(
            |p| {
                let d = p - on_line;
                on_line + unit * (2.0 * d.dot(&unit)) - d
            },
            -1.0,
        )
    }

    /// Points along the curve, both ends included, whose chords stay within `tolerance` (m).
    /// The number of points is bounded (1e5), however small the tolerance.
    pub fn flatten(&self, tolerance: f64) -> Vec<Vec2> {
        let tolerance = tolerance.max(self.length() * 1e-10).max(1e-12);
        let lyon = |p: Vec2| point(p.x, p.y);
        let mut points = vec![self.start()];
        match *self {
            Self::Line { .. } => {}
            Self::Arc { start, end, bulge } => {
                if bulge.abs() >= FLAT_BULGE {
                    let (centre, _, sweep) = Self::arc_frame(start, end, bulge);
                    let radius = (start - centre).norm();
                    let step = 2.0 * (1.0 - (tolerance / radius).min(1.0)).acos();
                    let count = (sweep.abs() / step.max(1e-4)).ceil().clamp(1.0, 1e5) as usize;
                    points.extend((1..count).map(|k| self.point(k as f64 / count as f64)));
                }
            }
            Self::Quadratic {
                start,
                control,
                end,
            } => {
                let segment = QuadraticBezierSegment {
                    from: lyon(start),
                    ctrl: lyon(control),
                    to: lyon(end),
                };
                points.extend(segment.flattened(tolerance).map(|p| Vec2::new(p.x, p.y)));
                points.pop();
            }
            Self::Cubic {
                start,
                controls,
                end,
            } => {
                let segment = CubicBezierSegment {
                    from: lyon(start),
                    ctrl1: lyon(controls[0]),
                    ctrl2: lyon(controls[1]),
                    to: lyon(end),
                };
                points.extend(segment.flattened(tolerance).map(|p| Vec2::new(p.x, p.y)));
                points.pop();
            }
        }
        points.push(self.end());
        points
    }

    /// Chords of equal parameter steps that stay within `tolerance` (m) of the curve, 1 to 1e5.
    pub fn chord_count(&self, tolerance: f64) -> usize {
        // The error of a chord is at most the second derivative over 8, times the step squared.
        let bend = match *self {
            Self::Line { .. } => 0.0,
            Self::Arc { start, end, bulge } if bulge.abs() >= FLAT_BULGE => {
                let (centre, _, sweep) = Self::arc_frame(start, end, bulge);
                (start - centre).norm() * sweep * sweep
            }
            Self::Arc { .. } => 0.0,
            Self::Quadratic {
                start,
                control,
                end,
            } => 2.0 * (start - control * 2.0 + end).norm(),
            Self::Cubic {
                start,
                controls: [a, b],
                end,
            } => 6.0 * (start - a * 2.0 + b).norm().max((a - b * 2.0 + end).norm()),
        };
        (bend / (8.0 * tolerance)).sqrt().ceil().clamp(1.0, 1e5) as usize
    }

    /// Parameter in a range at which the curve comes nearest to a point, where it comes nearest
    /// once in the range: by Newton's method, kept inside by halving.
    pub(crate) fn nearest_between(&self, to: Vec2, range: [f64; 2]) -> f64 {
        let slope = |t: f64| (self.point(t) - to).dot(&self.derivative(t));
        let [mut low, mut high] = range;
        if slope(low) >= 0.0 {
            return low;
        }
        if slope(high) <= 0.0 {
            return high;
        }
        let mut t = 0.5 * (low + high);
        for _ in 0..60 {
            let value = slope(t);
            if value > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let step = 1e-6 * (range[1] - range[0]);
            let rise = (slope(t + step) - slope(t - step)) / (2.0 * step);
            let newton = t - value / rise;
            let next = match newton > low && newton < high {
                true => newton,
                false => 0.5 * (low + high),
            };
            if (next - t).abs() < 1e-15 {
                break;
            }
            t = next;
        }
        t
    }

    /// Twice the signed area swept from the origin (m2): summed over a closed outline it is
    /// twice the enclosed area, positive when counter-clockwise. Exact.
    pub fn swept_area(&self) -> f64 {
        let cross = |a: Vec2, b: Vec2| a.perp(&b);
        match *self {
            Self::Line { start, end } => cross(start, end),
            Self::Arc { start, end, bulge } => {
                if bulge.abs() < FLAT_BULGE {
                    return cross(start, end);
                }
                let (centre, _, sweep) = Self::arc_frame(start, end, bulge);
                let radius = (start - centre).norm();
                cross(start, end) + radius * radius * (sweep - sweep.sin())
            }
            Self::Quadratic {
                start,
                control,
                end,
            } => {
                (2.0 * cross(start, control) + cross(start, end) + 2.0 * cross(control, end)) / 3.0
            }
            Self::Cubic {
                start,
                controls: [a, b],
                end,
            } => {
                (6.0 * cross(start, a)
                    + 3.0 * cross(start, b)
                    + cross(start, end)
                    + 3.0 * cross(a, b)
                    + 3.0 * cross(a, end)
                    + 6.0 * cross(b, end))
                    / 10.0
            }
        }
    }
}

#[cfg(test)]
mod tests;
