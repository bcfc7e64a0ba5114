//! Cuts one garment-like outline many times: `time` it and divide. Says nothing.

use toile_cut::{Corner, Dart, SeamEdge, SeamLine, cut_line};
use toile_geometry::{Curve, Vec2};

/// A bodice front: neckline, shoulder, armhole, side, a waist with a dart.
fn bodice() -> SeamLine {
    let p = |x: f64, y: f64| Vec2::new(x, y);
    let line = |start: Vec2, end: Vec2| Curve::Line { start, end };
    let cubic = |start, controls, end| Curve::Cubic {
        start,
        controls,
        end,
    };
    let curves = [
        cubic(
            p(0.0, 0.0),
            [p(0.03, 0.0), p(0.07, -0.002)],
            p(0.09, -0.004),
        ),
        line(p(0.09, -0.004), p(0.105, 0.11)),
        line(p(0.105, 0.11), p(0.12, -0.004)),
        cubic(
            p(0.12, -0.004),
            [p(0.16, -0.006), p(0.2, 0.0)],
            p(0.24, 0.01),
        ),
        cubic(p(0.24, 0.01), [p(0.25, 0.08), p(0.25, 0.14)], p(0.26, 0.22)),
        cubic(p(0.26, 0.22), [p(0.19, 0.24), p(0.18, 0.33)], p(0.2, 0.42)),
        line(p(0.2, 0.42), p(0.08, 0.46)),
        cubic(p(0.08, 0.46), [p(0.07, 0.4), p(0.05, 0.38)], p(0.0, 0.37)),
        line(p(0.0, 0.37), p(0.0, 0.0)),
    ];
    let kinds = [
        Corner::Mitre,
        Corner::Mitre,
        Corner::Mitre,
        Corner::Mitre,
        Corner::MirroredInPrevious,
        Corner::SquareToPrevious,
        Corner::Extended,
        Corner::MirroredInPrevious,
        Corner::Bevel,
    ];
    let edge = |(curve, corner): (Curve, Corner)| SeamEdge {
        limit: toile_cut::MITRE_LIMIT,
        curve,
        width: 0.01,
        corner,
    };
    SeamLine {
        outline: curves.into_iter().zip(kinds).map(edge).collect(),
        holes: Vec::new(),
        darts: vec![Dart {
            legs: [1, 2],
            pressed: 0,
        }],
    }
}

fn main() {
    let seam = bodice();
    for _ in 0..1000 {
        let cut = cut_line(&seam);
        assert!(cut.is_ok_and(|cut| cut.outline.points.len() > 200));
    }
}
