//! Ellipsoids: which side a point is on, the radial contact point, the closest point.

use crate::Vec3;
use nalgebra::Rotation3;

/// A solid ellipsoid: the points with `|S^-1 R^T (p - c)| <= 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid {
    /// Centre c (m).
    pub centre: Vec3,
    /// Semi-axes, the diagonal of S, all above zero (m).
    pub semi_axes: Vec3,
    /// Rotation R from the ellipsoid's axes to the world's.
    pub rotation: Rotation3<f64>,
}

impl Ellipsoid {
    /// An ellipsoid; nothing unless its numbers are finite and its semi-axes above zero.
    pub fn new(centre: Vec3, semi_axes: Vec3, rotation: Rotation3<f64>) -> Option<Self> {
        let finite = centre.iter().chain(&semi_axes).all(|x| x.is_finite())
            && rotation.matrix().iter().all(|x| x.is_finite());
        (finite && semi_axes.min() > 0.0).then_some(Self {
            centre,
            semi_axes,
            rotation,
        })
    }

    /// The point in the frame where the ellipsoid is the unit sphere: `q = S^-1 R^T (p - c)`.
    pub fn to_unit(&self, point: Vec3) -> Vec3 {
        (self.rotation.inverse() * (point - self.centre)).component_div(&self.semi_axes)
    }

    /// Whether a point lies inside or on the surface: `|q| <= 1`. The sign is exact but for
    /// rounding in q (Rudomin et al. 2002).
    pub fn contains(&self, point: Vec3) -> bool {
        self.to_unit(point).norm_squared() <= 1.0
    }

    /// The surface point on the ray from the centre through the point, `R S q/|q| + c`
    /// (Rudomin et al. 2002). It is the closest point only on a sphere or on an axis; the error
    /// grows with the ratio of the semi-axes. The centre itself gives the end of the shortest
    /// semi-axis.
    pub fn radial_point(&self, point: Vec3) -> Vec3 {
        let unit = self.to_unit(point);
        let direction = unit
            .try_normalize(f64::MIN_POSITIVE)
            .unwrap_or_else(|| Vec3::ith(self.semi_axes.imin(), 1.0));
        self.rotation * direction.component_mul(&self.semi_axes) + self.centre
    }

    /// The closest surface point, to about 1e-12 of the size.
    ///
    /// In the ellipsoid's frame with |y| for the point, the closest point is
    /// `x_i = a_i^2 y_i / (t + a_i^2)` with t the largest root of the secular equation
    /// `sum (a_i y_i / (t + a_i^2))^2 = 1` (Eberly 2013). The left side falls and is convex
    /// right of `-a_min^2`, so Newton's method from the left of the root climbs to it without
    /// overshoot; bisection takes over where rounding stops it. A point whose coordinate along
    /// the shortest axis is zero may lie so deep that there is no such root: then the closest
    /// point leaves that plane.
    pub fn closest_point(&self, point: Vec3) -> Vec3 {
        let local = self.rotation.inverse() * (point - self.centre);
        let scale = self.semi_axes.max();
        let axes = self.semi_axes / scale;
        let y = local.abs() / scale;
        let mut x = closest_in_octant(axes, y);
        for k in 0..3 {
            x[k] = (x[k] * scale).copysign(local[k]);
        }
        self.rotation * x + self.centre
    }

    /// Distance to the surface, negative inside (m).
    pub fn signed_distance(&self, point: Vec3) -> f64 {
        let distance = (self.closest_point(point) - point).norm();
        if self.contains(point) {
            -distance
        } else {
            distance
        }
    }

    /// Outward unit normal at a point of the surface, the direction of `R S^-1 q`.
    pub fn normal_at(&self, surface_point: Vec3) -> Vec3 {
        let q = self.to_unit(surface_point);
        (self.rotation * q.component_div(&self.semi_axes))
            .try_normalize(0.0)
            .unwrap_or_default()
    }
}

/// Closest point of an ellipsoid with its axes along the coordinates to a point whose coordinates
/// are not negative. Lengths are over the longest semi-axis.
fn closest_in_octant(a: Vec3, y: Vec3) -> Vec3 {
    let squares = a.component_mul(&a);
    let shortest = a.imin();
    let pole = -squares[shortest];
    // The equation without the axes on which the point has no coordinate.
    let terms = |t: f64| -> [f64; 2] {
        let (mut value, mut slope) = (-1.0, 0.0);
        for k in 0..3 {
            if y[k] > 0.0 {
                let ratio = a[k] * y[k] / (t + squares[k]);
                value += ratio * ratio;
                slope -= 2.0 * ratio * ratio / (t + squares[k]);
            }
        }
        [value, slope]
    };
    let deep = y[shortest] <= 0.0;
    if deep {
        // With t at the pole the other coordinates are fixed; what is left of the unit goes to
        // the shortest axis.
        let mut x = Vec3::zeros();
        let mut used = 0.0;
        let mut enough = true;
        for k in 0..3 {
            let denominator = squares[k] + pole;
            if k != shortest && y[k] > 0.0 {
                if denominator > 0.0 {
                    x[k] = squares[k] * y[k] / denominator;
                    used += (x[k] / a[k]).powi(2);
                } else {
                    enough = false;
                }
            }
        }
        if enough && used < 1.0 {
            x[shortest] = a[shortest] * (1.0 - used).sqrt();
            return x;
        }
    }
    // The root lies between the pole shifted by one term alone and by all terms together.
    let mut low = (0..3)
        .filter(|&k| y[k] > 0.0)
        .map(|k| a[k] * y[k] - squares[k])
        .fold(pole, f64::max);
    let mut high = a.component_mul(&y).norm() + pole;
    let mut t = low;
    for _ in 0..200 {
        let [value, slope] = terms(t);
        if value >= 0.0 {
            low = t;
        } else {
            high = t;
        }
        let newton = t - value / slope;
        let next = if newton > low && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
        if next == t || (high - low) <= f64::EPSILON * high.abs().max(low.abs()) {
            break;
        }
        t = next;
    }
    let mut x = Vec3::zeros();
    for k in 0..3 {
        if y[k] > 0.0 {
            x[k] = squares[k] * y[k] / (t + squares[k]);
        }
    }
    // On the surface to the last bit but one: the direction is right, the length is rounded.
    let length = x.component_div(&a).norm();
    if length > 0.0 { x / length } else { x }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn brute(e: &Ellipsoid, p: Vec3) -> f64 {
        let at = |u: f64, v: f64| {
            let d = Vec3::new(v.cos() * u.cos(), v.cos() * u.sin(), v.sin());
            e.rotation * d.component_mul(&e.semi_axes) + e.centre
        };
        let (mut best, mut place, mut span) = (f64::INFINITY, (0.0, 0.0), std::f64::consts::PI);
        for level in 0..9 {
            let (u0, v0) = place;
            let n = if level == 0 { 60 } else { 12 };
            for i in -n..=n {
                for j in -n..=n {
                    let u = u0 + span * f64::from(i) / f64::from(n);
                    let v = v0 + 0.5 * span * f64::from(j) / f64::from(n);
                    let d = (at(u, v) - p).norm();
                    if d < best {
                        (best, place) = (d, (u, v));
                    }
                }
            }
            span *= if level == 0 { 0.05 } else { 0.25 };
        }
        best
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn closest_point_equals_brute_force(
            axes in (0.02..1.0f64, 0.02..1.0f64, 0.02..1.0f64),
            p in (-1.5..1.5f64, -1.5..1.5f64, -1.5..1.5f64),
            turn in (-3.0..3.0f64, -3.0..3.0f64, -3.0..3.0f64),
        ) {
            let e = Ellipsoid::new(
                Vec3::new(0.1, -0.2, 0.3),
                Vec3::new(axes.0, axes.1, axes.2),
                Rotation3::new(Vec3::new(turn.0, turn.1, turn.2)),
            ).unwrap();
            let p = Vec3::new(p.0, p.1, p.2);
            let got = e.closest_point(p);
            prop_assert!((e.to_unit(got).norm() - 1.0).abs() < 1e-12);
            let distance = (got - p).norm();
            let expected = brute(&e, p);
            prop_assert!(distance <= expected + 1e-9, "{} {}", distance, expected);
            prop_assert!(expected - distance < 1e-4);
            prop_assert!((e.radial_point(p) - p).norm() >= distance - 1e-12);
            prop_assert_eq!(e.contains(p), e.signed_distance(p) <= 0.0);
        }
    }

    #[test]
    fn points_on_axes_and_the_centre() {
        let e = Ellipsoid::new(
            Vec3::zeros(),
            Vec3::new(3.0, 2.0, 1.0),
            Rotation3::identity(),
        )
        .unwrap();
        assert!((e.signed_distance(Vec3::zeros()) + 1.0).abs() < 1e-14);
        assert!((e.signed_distance(Vec3::new(0.0, 0.0, 5.0)) - 4.0).abs() < 1e-14);
        assert!((e.signed_distance(Vec3::new(4.0, 0.0, 0.0)) - 1.0).abs() < 1e-14);
        // Inside on the long axis, deeper than the focus: the closest point leaves the axis.
        let deep = Vec3::new(1.0, 0.0, 0.0);
        let on = e.closest_point(deep);
        assert!(on.z.abs() > 0.5 && (e.to_unit(on).norm() - 1.0).abs() < 1e-14);
        assert!(((on - deep).norm() - brute(&e, deep)).abs() < 1e-6);
        let normal = e.normal_at(on);
        assert!((normal.cross(&(on - deep).normalize())).norm() < 1e-12);
        let sphere =
            Ellipsoid::new(Vec3::zeros(), Vec3::repeat(2.0), Rotation3::identity()).unwrap();
        assert!((sphere.signed_distance(Vec3::zeros()) + 2.0).abs() < 1e-14);
        assert!((sphere.signed_distance(Vec3::new(1.0, 0.0, 0.0)) + 1.0).abs() < 1e-14);
    }

    #[test]
    fn radial_error_is_bounded_by_the_axis_ratio() {
        // Worst excess of the radial distance over the true one, outside, for a long spheroid.
        for (ratio, bound) in [(1.0, 1e-9), (2.0, 0.3), (5.0, 0.95)] {
            let e = Ellipsoid::new(
                Vec3::zeros(),
                Vec3::new(ratio, 1.0, 1.0),
                Rotation3::identity(),
            )
            .unwrap();
            let mut worst: f64 = 0.0;
            for k in 1..400 {
                let angle = std::f64::consts::FRAC_PI_2 * f64::from(k) / 400.0;
                let p = Vec3::new(angle.cos() * ratio, angle.sin(), 0.0) * 1.05;
                let exact = e.signed_distance(p);
                worst = worst.max(1.0 - exact / (e.radial_point(p) - p).norm());
            }
            assert!(worst <= bound, "ratio {ratio}: {worst}");
        }
    }

    #[test]
    fn bad_ellipsoids_are_refused() {
        let make =
            |a: f64| Ellipsoid::new(Vec3::zeros(), Vec3::new(1.0, a, 1.0), Rotation3::identity());
        assert!(make(0.0).is_none() && make(-1.0).is_none() && make(f64::NAN).is_none());
        assert!(make(f64::INFINITY).is_none() && make(1e-3).is_some());
    }
}
