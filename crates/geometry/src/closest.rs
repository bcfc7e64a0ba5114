//! Closest points of two segments, and of a point and a triangle, in whatever shape they are:
//! parallel, needle-thin, shrunk to a point.

use crate::{Vec3, closest_point_on_triangle};

/// Parameter in 0..=1 of the point of a segment closest to `point`; 0 where the segment is a point.
fn along(segment: [Vec3; 2], point: Vec3) -> f64 {
    let direction = segment[1] - segment[0];
    let length2 = direction.norm_squared();
    if length2 > 0.0 {
        ((point - segment[0]).dot(&direction) / length2).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

fn on(segment: [Vec3; 2], s: f64) -> Vec3 {
    segment[0] + (segment[1] - segment[0]) * s
}

/// Square of the sine of the angle between two segments below which they count as parallel: the
/// crossing of their lines is then known too badly to be trusted alone.
const PARALLEL: f64 = 1e-6;

/// Share of the squared lengths of a triangle's sides below which it counts as a needle.
const NEEDLE: f64 = 1e-6;

/// Parameters in 0..=1 of the closest points of two segments (Ericson, Real-Time Collision
/// Detection, 2005, section 5.1.9). Where they are parallel the best of the four ends is taken too,
/// the earliest of equals.
pub fn closest_on_segments(a: [Vec3; 2], b: [Vec3; 2]) -> [f64; 2] {
    let (u, v, w) = (a[1] - a[0], b[1] - b[0], a[0] - b[0]);
    let (uu, vv, uv) = (u.norm_squared(), v.norm_squared(), u.dot(&v));
    let (uw, vw) = (u.dot(&w), v.dot(&w));
    let sine2 = uu * vv - uv * uv;
    let mut best = [0.0; 2];
    if sine2 > 0.0 {
        let s = ((uv * vw - uw * vv) / sine2).clamp(0.0, 1.0);
        let t = (uv * s + vw) / vv;
        best = if t < 0.0 {
            [(-uw / uu).clamp(0.0, 1.0), 0.0]
        } else if t > 1.0 {
            [((uv - uw) / uu).clamp(0.0, 1.0), 1.0]
        } else {
            [s, t]
        };
    }
    if sine2 > PARALLEL * uu * vv {
        return best;
    }
    let distance2 = |[s, t]: [f64; 2]| (on(a, s) - on(b, t)).norm_squared();
    let ends = [
        [0.0, along(b, a[0])],
        [1.0, along(b, a[1])],
        [along(a, b[0]), 0.0],
        [along(a, b[1]), 1.0],
    ];
    for other in ends {
        if distance2(other) < distance2(best) || distance2(best).is_nan() {
            best = other;
        }
    }
    best
}

/// Barycentric weights of the point of a triangle closest to `point`. Needles are measured along
/// their sides too, so that a triangle without area is its longest side.
pub fn closest_on_face(point: Vec3, corners: [Vec3; 3]) -> [f64; 3] {
    let [a, b, c] = corners;
    let (u, v) = (b - a, c - a);
    let (weights, _) = closest_point_on_triangle(point, corners);
    let sides = u.norm_squared().max(v.norm_squared());
    if u.cross(&v).norm_squared() > NEEDLE * sides * sides {
        return weights;
    }
    let place = |w: [f64; 3]| a * w[0] + b * w[1] + c * w[2];
    let mut best = weights;
    for k in 0..3 {
        let next = (k + 1) % 3;
        let s = along([corners[k], corners[next]], point);
        let mut other = [0.0; 3];
        other[k] = 1.0 - s;
        other[next] = s;
        let (new, old) = ((place(other) - point).norm(), (place(best) - point).norm());
        let valid = best.iter().all(|w| (0.0..=1.0).contains(w));
        if new < old || !valid || !old.is_finite() {
            best = other;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector(scale: f64) -> impl Strategy<Value = Vec3> {
        [-1.0..1.0f64, -1.0..1.0, -1.0..1.0].prop_map(move |[x, y, z]| Vec3::new(x, y, z) * scale)
    }

    /// Least value of a convex function on 0..=1, by golden section.
    fn least(f: impl Fn(f64) -> f64) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..80 {
            let (p, q) = (low + (high - low) * 0.382, low + (high - low) * 0.618);
            if f(p) <= f(q) {
                high = q;
            } else {
                low = p;
            }
        }
        f(0.5 * (low + high)).min(f(0.0)).min(f(1.0))
    }

    proptest! {
        #[test]
        fn segments_are_measured_to_rounding(
            a in vector(1.0), u in vector(1.0), b in vector(1.0), v in vector(1.0),
            nearly in prop::sample::select(vec![1.0, 1e-3, 1e-6, 1e-9, 0.0]),
        ) {
            let (a, b) = ([a, a + u], [b, b + u + (v - u) * nearly]);
            let [s, t] = closest_on_segments(a, b);
            let got = (on(a, s) - on(b, t)).norm();
            let expected = least(|s| (on(b, along(b, on(a, s))) - on(a, s)).norm());
            prop_assert!((0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t));
            prop_assert!((got - expected).abs() < 1e-12, "{got} {expected}");
        }

        #[test]
        fn faces_are_measured_to_rounding(
            p in vector(2.0), a in vector(1.0), b in vector(1.0), c in vector(1.0),
            thin in prop::sample::select(vec![1.0, 1e-3, 1e-6, 1e-9, 1e-13, 0.0]),
        ) {
            let c = a + (b - a) * 0.4 + (c - a) * thin;
            let w = closest_on_face(p, [a, b, c]);
            let got = (a * w[0] + b * w[1] + c * w[2] - p).norm();
            let expected = least(|s| {
                let far = on([b, c], s);
                (on([a, far], along([a, far], p)) - p).norm()
            });
            prop_assert!(w.iter().all(|w| (-1e-15..=1.0 + 1e-15).contains(w)), "{w:?}");
            prop_assert!((got - expected).abs() < 1e-12, "{got} {expected}");
        }
    }

    #[test]
    fn points_in_place_of_segments_and_faces() {
        let p = Vec3::new(1.0, 2.0, 3.0);
        assert_eq!(closest_on_segments([p, p], [p, p]), [0.0, 0.0]);
        let w = closest_on_face(Vec3::zeros(), [p, p, p]);
        assert!((w.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        assert!(w.iter().all(|w| w.is_finite()));
    }
}
