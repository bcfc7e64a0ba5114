//! Darts: folded by computation, the layers lie flush.

use crate::common::{loop_of, reversed, seam_of, vertex_near};
use toile_cut::{
    CapFault, CutError, CutLine, Dart, EdgeIndex, Finding, SeamLine, SegmentKind, cut_line,
};
use toile_geometry::{Curve, Vec2, closest_on_segment};

/// 0.01 mm.
const FLUSH: f64 = 1e-5;

/// A waist with a dart: from the left the waist, both legs, the waist again, then sides and hem.
/// The waist slopes by `slope` at both sides of the mouth.
fn waist(intake: f64, slope: f64, widths: [f64; 2], pressed: usize) -> SeamLine {
    let half = intake / 2.0;
    let points = [
        Vec2::new(-0.12, slope * (0.12 - half)),
        Vec2::new(-half, 0.0),
        Vec2::new(0.0, 0.1),
        Vec2::new(half, 0.0),
        Vec2::new(0.12, slope * (0.12 - half)),
        Vec2::new(0.12, 0.3),
        Vec2::new(-0.12, 0.3),
    ];
    let [before, after] = widths;
    let mut seam = seam_of(&points, &[before, 0.0, 0.0, after, 0.0, 0.0, 0.0]);
    seam.darts.push(Dart {
        legs: [1, 2],
        pressed,
    });
    seam
}

fn mirrored(p: Vec2, [on, to]: [Vec2; 2]) -> Vec2 {
    let along = (to - on).normalize();
    let d = p - on;
    on + along * (2.0 * d.dot(&along)) - d
}

fn distance(p: Vec2, segments: &[[Vec2; 2]]) -> f64 {
    let all = segments
        .iter()
        .map(|&s| (p - closest_on_segment(p, s)).norm());
    all.fold(f64::INFINITY, f64::min)
}

fn segments(cut: &CutLine, kind: SegmentKind, edge: usize) -> Vec<[Vec2; 2]> {
    let points = &cut.outline.points;
    (0..points.len())
        .filter(|&k| {
            let origin = cut.outline.origins[k];
            origin.kind == kind && origin.edge == EdgeIndex { ring: 0, edge }
        })
        .map(|k| [points[k], points[(k + 1) % points.len()]])
        .collect()
}

/// Folds the cloth inside the dart and measures how far its cut edges are from the neighbour's.
fn check_flush(seam: &SeamLine, [before, after]: [usize; 2]) -> CutLine {
    let cut = cut_line(seam).unwrap();
    assert!(cut.polygon().is_simple());
    let dart = seam.darts[0];
    let curve = |edge: usize| seam.outline[edge].curve;
    let apex = curve(dart.legs[0]).end();
    let mouths = [curve(dart.legs[0]).start(), curve(dart.legs[1]).end()];
    let middle = (mouths[0] + mouths[1]) * 0.5;
    let near = dart.legs[dart.pressed];
    let far = dart.legs[1 - dart.pressed];
    let leg = [mouths[dart.pressed], apex];
    let neighbour = segments(&cut, SegmentKind::Edge, [before, after][dart.pressed]);
    let (one, two) = (
        segments(&cut, SegmentKind::DartCap, near),
        segments(&cut, SegmentKind::DartCap, far),
    );
    assert!(!one.is_empty() && !two.is_empty(), "{cut:?}");
    for [p, q] in one.into_iter().chain(two) {
        for k in 0..=10 {
            let at = p + (q - p) * (f64::from(k) / 10.0);
            // The half beyond the fold line is folded twice.
            let beyond = (at - middle).dot(&(mouths[1 - dart.pressed] - middle)) > 0.0;
            let once = if beyond {
                mirrored(at, [middle, apex])
            } else {
                at
            };
            let folded = mirrored(once, leg);
            assert!(distance(folded, &neighbour) < FLUSH, "{at:?} on {folded:?}");
        }
    }
    cut
}

#[test]
fn a_folded_dart_lies_flush() {
    for intake in [0.01, 0.02, 0.04] {
        for slope in [0.0, -0.1, 0.15] {
            for pressed in [0, 1] {
                let seam = waist(intake, slope, [0.012; 2], pressed);
                let cut = check_flush(&seam, [0, 3]);
                assert!(
                    !cut.findings
                        .iter()
                        .any(|f| matches!(f, Finding::StraightCap { .. }))
                );
                check_flush(&reversed(&seam), [3, 6]);
            }
        }
    }
    check_flush(&waist(0.03, 0.0, [0.01, 0.02], 0), [0, 3]);
    check_flush(&waist(0.03, 0.0, [0.02, 0.01], 0), [0, 3]);
    check_flush(&waist(0.03, 0.0, [0.0, 0.01], 0), [0, 3]);
}

#[test]
fn a_dart_in_a_curved_waist_lies_flush() {
    let mut seam = waist(0.03, 0.0, [0.01; 2], 0);
    for edge in [0, 3] {
        let (start, end) = (
            seam.outline[edge].curve.start(),
            seam.outline[edge].curve.end(),
        );
        seam.outline[edge].curve = Curve::Arc {
            start,
            end,
            bulge: 0.1,
        };
    }
    check_flush(&seam, [0, 3]);
    seam.darts[0].pressed = 1;
    check_flush(&seam, [0, 3]);
}

/// The tip of the cap in closed form: a straight waist, allowance a, legs that lean by t from the
/// fold line. Mirrored in the leg the cut line falls by 2 t from the mouth.
#[test]
fn the_tip_of_a_cap_is_where_the_mirrored_cut_line_meets_the_fold_line() {
    let (half, depth, width) = (0.015, 0.1, 0.01);
    let cut = cut_line(&waist(2.0 * half, 0.0, [width; 2], 0)).unwrap();
    let lean = f64::atan2(half, depth);
    // The mirrored seam line starts at (-half, 0); its cut line is `width` farther out.
    let tip = Vec2::new(0.0, -half * (2.0 * lean).tan() - width / (2.0 * lean).cos());
    assert!(
        vertex_near(&cut.outline.points, tip, 1e-8).is_some(),
        "{tip:?} {cut:?}"
    );
}

#[test]
fn a_dart_that_cannot_be_folded_is_cut_straight_across() {
    // Its neighbour is shorter than half the mouth.
    let mut seam = waist(0.2, 0.0, [0.01; 2], 0);
    let cut = cut_line(&seam).unwrap();
    let straight = |cut: &CutLine| {
        cut.findings.iter().find_map(|f| match f {
            Finding::StraightCap { dart: 0, fault } => Some(*fault),
            _ => None,
        })
    };
    assert_eq!(
        straight(&cut),
        Some(CapFault::TooShort),
        "{:?}",
        cut.findings
    );
    assert!(
        (cut.polygon().area() - 0.24 * 0.31).abs() < 1e-9,
        "{}",
        cut.polygon().area()
    );
    // Its neighbour is another dart's leg.
    let points = [
        [-0.12, 0.0],
        [-0.02, 0.0],
        [-0.01, 0.1],
        [0.0, 0.0],
        [0.01, 0.1],
        [0.02, 0.0],
        [0.12, 0.0],
        [0.12, 0.3],
        [-0.12, 0.3],
    ];
    seam = seam_of(&points.map(Vec2::from), &[0.01; 9]);
    seam.darts = vec![
        Dart {
            legs: [1, 2],
            pressed: 1,
        },
        Dart {
            legs: [3, 4],
            pressed: 1,
        },
    ];
    let cut = cut_line(&seam).unwrap();
    assert_eq!(straight(&cut), Some(CapFault::NoNeighbour));
    assert!(cut.polygon().is_simple());
}

#[test]
fn legs_that_are_no_dart_are_refused() {
    let sound = waist(0.03, 0.0, [0.01; 2], 0);
    let dart = |legs: [usize; 2], pressed: usize| Dart { legs, pressed };
    for wrong in [
        vec![dart([1, 3], 0)],
        vec![dart([2, 1], 0)],
        vec![dart([1, 2], 2)],
        vec![dart([9, 10], 0)],
        vec![dart([4, 5], 0)],
        vec![dart([1, 2], 0), dart([1, 2], 1)],
    ] {
        let last = wrong.len() - 1;
        let seam = SeamLine {
            darts: wrong,
            ..sound.clone()
        };
        assert_eq!(cut_line(&seam), Err(CutError::Dart(last)));
    }
    assert_eq!(loop_of(&[], &[]).len(), 0);
}
