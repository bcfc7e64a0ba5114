//! Curves against closed forms, fine polylines and their own promises.

use super::*;
use std::f64::consts::PI;

fn samples() -> [Curve; 5] {
    let v = Vec2::new;
    [
        Curve::Line {
            start: v(0.1, 0.2),
            end: v(0.5, -0.3),
        },
        Curve::Arc {
            start: v(0.1, 0.2),
            end: v(0.5, -0.3),
            bulge: 0.7,
        },
        Curve::Arc {
            start: v(0.1, 0.2),
            end: v(0.5, -0.3),
            bulge: -1.9,
        },
        Curve::Quadratic {
            start: v(0.1, 0.2),
            control: v(0.9, 0.8),
            end: v(0.5, -0.3),
        },
        Curve::Cubic {
            start: v(0.1, 0.2),
            controls: [v(0.9, 0.8), v(-0.7, 0.1)],
            end: v(0.5, -0.3),
        },
    ]
}

#[test]
fn half_circle_has_its_length_area_and_side() {
    let arc = Curve::Arc {
        start: Vec2::new(1.0, 0.0),
        end: Vec2::new(-1.0, 0.0),
        bulge: 1.0,
    };
    assert!((arc.length() - PI).abs() < 1e-12);
    assert!((arc.swept_area() - PI).abs() < 1e-12);
    assert!(
        (arc.point(0.5) - Vec2::new(0.0, 1.0)).norm() < 1e-12,
        "counter-clockwise"
    );
}

#[test]
fn length_and_area_agree_with_fine_polylines() {
    for curve in samples() {
        let count = 200_000;
        let points: Vec<_> = (0..=count)
            .map(|k| curve.point(f64::from(k) / f64::from(count)))
            .collect();
        let walked: f64 = points.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
        let swept: f64 = points.windows(2).map(|w| w[0].perp(&w[1])).sum();
        assert!((walked - curve.length()).abs() < 1e-9, "{curve:?}");
        assert!((swept - curve.swept_area()).abs() < 1e-9, "{curve:?}");
    }
}

/// Curves whose legs differ from their mean by just as much as one piece of quadrature is for.
#[test]
fn the_length_of_a_nearly_straight_curve_is_that_of_its_many_parts() {
    let leg = |angle: f64| {
        Vec2::new(1.0, 0.0) + Vec2::new(angle.cos(), angle.sin()) * (0.999 * EVEN_LEGS)
    };
    for k in 0..24 {
        let turn = f64::from(k) * PI / 12.0;
        let third = 2.0 * PI / 3.0;
        let a = leg(turn);
        let b = a + leg(turn + third);
        let curve = Curve::Cubic {
            start: Vec2::zeros(),
            controls: [a, b],
            end: b + leg(turn + 2.0 * third),
        };
        let part = |k: u8| curve.between(f64::from(k) / 64.0, f64::from(k + 1) / 64.0);
        let walked: f64 = (0..64).map(|k| part(k).length()).sum();
        assert!((walked / curve.length() - 1.0).abs() < 1e-14, "{curve:?}");
        let half: f64 = (0..32).map(|k| part(k).length()).sum();
        assert!((half / curve.length_until(0.5) - 1.0).abs() < 1e-14);
    }
}

#[test]
fn pieces_reversals_and_reflections_lie_on_the_curve() {
    for curve in samples() {
        let piece = curve.between(0.8, 0.3);
        for k in 0..=10 {
            let t = f64::from(k) / 10.0;
            assert!((piece.point(t) - curve.point(0.8 - 0.5 * t)).norm() < 1e-12);
            assert!((curve.reversed().point(t) - curve.point(1.0 - t)).norm() < 1e-12);
        }
        let mirror = curve.reflected(Vec2::zeros(), Vec2::y());
        let p = curve.point(0.37);
        assert!((mirror.point(0.37) - Vec2::new(-p.x, p.y)).norm() < 1e-12);
    }
}

#[test]
fn flattening_keeps_its_promise_down_a_ladder() {
    for curve in samples() {
        for tolerance in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5] {
            let points = curve.flatten(tolerance);
            assert_eq!(
                (points[0], points[points.len() - 1]),
                (curve.start(), curve.end())
            );
            for k in 0..=1000 {
                let p = curve.point(f64::from(k) / 1000.0);
                let distance = points
                    .windows(2)
                    .map(|w| {
                        let d = w[1] - w[0];
                        let along = ((p - w[0]).dot(&d) / d.norm_squared()).clamp(0.0, 1.0);
                        (w[0] + d * along - p).norm()
                    })
                    .fold(f64::INFINITY, f64::min);
                assert!(
                    distance <= tolerance * 1.01,
                    "{curve:?} {tolerance} {distance}"
                );
            }
        }
    }
}

#[test]
fn samples_are_equally_spaced_along_the_curve() {
    for curve in samples() {
        let points = curve.sample(0.9, 0.2, 7);
        let step = curve.length() * 0.1;
        for (k, point) in points.iter().enumerate() {
            let t = curve.parameter_at_length(curve.length() * 0.9 - step * k as f64);
            assert!((curve.point(t) - point).norm() < 1e-10);
        }
    }
}
