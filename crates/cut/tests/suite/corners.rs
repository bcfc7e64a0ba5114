//! Every kind of corner against its closed form, and broken input.

use crate::common::{self, line, meet, seam_of, vertex_near};
use toile_cut::{
    Corner, CutError, EdgeIndex, Finding, MITRE_LIMIT, SeamEdge, SeamLine, SegmentKind, cut_line,
};
use toile_geometry::{Curve, Polygon, Vec2};

const EXACT: f64 = 1e-8;

/// A piece with a corner at the origin that turns left by `degrees` from the direction +x, widths
/// `a` before it and `b` after it; the rest has no allowance.
fn cornered(degrees: f64, kind: Corner, [a, b]: [f64; 2]) -> SeamLine {
    let after = turned(degrees) * 0.3;
    let points = [
        Vec2::new(-0.3, 0.0),
        Vec2::zeros(),
        after,
        Vec2::new(-0.3, 0.35),
    ];
    let mut seam = seam_of(&points, &[a, b, 0.0, 0.0]);
    seam.outline[1].corner = kind;
    seam
}

fn turned(degrees: f64) -> Vec2 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    Vec2::new(cos, sin)
}

/// The lines at the corner of [`cornered`]: a point and a direction each.
struct Lines {
    before: [Vec2; 2],
    after: [Vec2; 2],
    /// Offset lines.
    cut_before: [Vec2; 2],
    cut_after: [Vec2; 2],
    n: Vec2,
    m: Vec2,
}

fn lines(degrees: f64, [a, b]: [f64; 2]) -> Lines {
    let (d, e) = (Vec2::new(1.0, 0.0), turned(degrees));
    let (n, m) = (Vec2::new(0.0, -1.0), Vec2::new(e.y, -e.x));
    Lines {
        before: [Vec2::zeros(), d],
        after: [Vec2::zeros(), e],
        cut_before: [n * a, d],
        cut_after: [m * b, e],
        n,
        m,
    }
}

/// The way of the cut line round the corner, from the first edge's cut line to the second's.
fn check(degrees: f64, kind: Corner, widths: [f64; 2], way: &[Vec2]) {
    let cut = cut_line(&cornered(degrees, kind, widths)).unwrap();
    let points = &cut.outline.points;
    let label = format!("{degrees} {kind:?} {widths:?}: {way:?} in {points:?}");
    let start = vertex_near(points, way[0], EXACT).unwrap_or_else(|| panic!("{label}"));
    for (k, want) in way.iter().enumerate() {
        let at = (start + k) % points.len();
        assert!((points[at] - want).norm() < EXACT, "{k}: {label}");
    }
    let kind_at = |k: usize| cut.outline.origins[(start + k) % points.len()];
    let before = kind_at(points.len() - 1);
    let after = kind_at(way.len() - 1);
    for (origin, edge) in [(before, 0), (after, 1)] {
        assert_eq!(origin.kind, SegmentKind::Edge, "{label}");
        assert_eq!(origin.edge, EdgeIndex { ring: 0, edge }, "{label}");
    }
    for k in 0..way.len() - 1 {
        assert_eq!(kind_at(k).kind, SegmentKind::Corner, "{label}");
        assert_eq!(kind_at(k).edge.edge, 1, "{label}");
    }
    assert!(cut.polygon().is_simple(), "{label}");
}

#[test]
fn a_mitre_is_where_both_cut_lines_meet() {
    for degrees in [20.0, 45.0, 90.0, 120.0] {
        for widths in [[0.01, 0.01], [0.01, 0.0105], [0.0105, 0.01]] {
            let at = lines(degrees, widths);
            check(
                degrees,
                Corner::Mitre,
                widths,
                &[meet(at.cut_before, at.cut_after)],
            );
        }
    }
    // A right angle of any widths.
    check(90.0, Corner::Mitre, [0.01, 0.04], &[Vec2::new(0.04, -0.01)]);
}

#[test]
fn a_cut_line_runs_on_to_the_end_of_a_much_wider_one() {
    let at = lines(30.0, [0.01, 0.04]);
    let u = meet(at.cut_before, [Vec2::zeros(), at.m]);
    check(30.0, Corner::Mitre, [0.01, 0.04], &[u, at.m * 0.04]);
    let at = lines(30.0, [0.04, 0.01]);
    let v = meet(at.cut_after, [Vec2::zeros(), at.n]);
    check(30.0, Corner::Mitre, [0.04, 0.01], &[at.n * 0.04, v]);
}

#[test]
fn a_sharp_mitre_is_cut_square_to_its_tip() {
    let widths = [0.01, 0.012];
    let at = lines(150.0, widths);
    let tip = meet(at.cut_before, at.cut_after);
    let out = tip.normalize();
    let end = [out * (MITRE_LIMIT * 0.012), Vec2::new(-out.y, out.x)];
    let way = [meet(at.cut_before, end), meet(at.cut_after, end)];
    check(150.0, Corner::Mitre, widths, &way);
    let cut = cut_line(&cornered(150.0, Corner::Mitre, widths)).unwrap();
    let Some(Finding::CutOff {
        corner,
        asked,
        kept,
    }) = cut.findings.first()
    else {
        panic!("{:?}", cut.findings);
    };
    assert_eq!(corner.edge, 1);
    assert!((asked - tip.norm()).abs() < EXACT && (kept - 0.03).abs() < EXACT);
}

#[test]
fn a_corner_reaches_as_far_as_its_limit_asks() {
    let widths = [0.01, 0.012];
    let at = lines(150.0, widths);
    let tip = meet(at.cut_before, at.cut_after);
    let reach = tip.norm() / 0.012;
    for (limit, is_whole) in [
        (1.0, false),
        (reach * 0.99, false),
        (reach * 1.01, true),
        (100.0, true),
    ] {
        let mut seam = cornered(150.0, Corner::Mitre, widths);
        seam.outline[1].limit = limit;
        let cut = cut_line(&seam).unwrap();
        assert_eq!(
            cut.findings.is_empty(),
            is_whole,
            "{limit}: {:?}",
            cut.findings
        );
        let farthest = cut.outline.points.iter().map(|p| p.dot(&tip) / tip.norm());
        let farthest = farthest.fold(f64::NEG_INFINITY, f64::max);
        let asked = tip.norm().min(limit * 0.012);
        assert!(
            (farthest - asked).abs() < EXACT,
            "{limit}: {farthest} for {asked}"
        );
    }
    for limit in [0.5, 101.0, f64::NAN] {
        let mut seam = cornered(150.0, Corner::Mitre, widths);
        seam.outline[1].limit = limit;
        let refused = matches!(cut_line(&seam), Err(CutError::Limit(at)) if at.edge == 1);
        assert!(refused, "{limit}");
    }
}

#[test]
fn a_bevel_goes_straight_across() {
    for degrees in [20.0, 90.0, 150.0] {
        let at = lines(degrees, [0.01, 0.011]);
        check(
            degrees,
            Corner::Bevel,
            [0.01, 0.011],
            &[at.n * 0.01, at.m * 0.011],
        );
    }
}

#[test]
fn a_square_corner_ends_the_allowance_where_the_seam_line_meets_the_other_cut_line() {
    for degrees in [60.0, 80.0, 100.0, 130.0] {
        for widths in [[0.01, 0.01], [0.02, 0.015], [0.02, 0.004], [0.01, 0.025]] {
            let at = lines(degrees, widths);
            let end = meet(at.after, at.cut_before);
            let way = [end, end + at.m * widths[1]];
            check(degrees, Corner::SquareToNext, widths, &way);
            let end = meet(at.before, at.cut_after);
            let way = [end + at.n * widths[0], end];
            check(degrees, Corner::SquareToPrevious, widths, &way);
        }
    }
    // At a right angle there is nothing to tell it from a mitre.
    let cut = |kind| {
        cut_line(&cornered(90.0, kind, [0.01, 0.02]))
            .unwrap()
            .polygon()
            .area()
    };
    assert!((cut(Corner::SquareToNext) - cut(Corner::Mitre)).abs() < 1e-10);
}

#[test]
fn extended_cut_lines_end_on_the_extended_seam_lines() {
    for degrees in [60.0, 80.0, 100.0, 130.0] {
        for widths in [[0.01, 0.01], [0.02, 0.015], [0.01, 0.02]] {
            let at = lines(degrees, widths);
            let way = [meet(at.after, at.cut_before), meet(at.before, at.cut_after)];
            check(degrees, Corner::Extended, widths, &way);
        }
    }
}

/// A hem turned up along its seam line: the end of its allowance lies on the other cut line.
#[test]
fn a_hem_turned_up_lies_flush() {
    for degrees in [60.0, 80.0, 100.0, 130.0] {
        let widths = [0.03, 0.012];
        let at = lines(degrees, widths);
        let fold = meet(at.before, at.cut_after);
        // Where the other cut line is as far inside as the hem is wide, mirrored in the hem.
        let inside = meet([-at.n * widths[0], at.before[1]], at.cut_after);
        let turned_up = Vec2::new(inside.x, -inside.y);
        check(
            degrees,
            Corner::MirroredInPrevious,
            widths,
            &[turned_up, fold],
        );
        let widths = [0.012, 0.03];
        let at = lines(degrees, widths);
        let fold = meet(at.after, at.cut_before);
        let inside = meet([-at.m * widths[1], at.after[1]], at.cut_before);
        let along = at.after[1];
        let turned_up = along * (2.0 * inside.dot(&along)) - inside;
        check(degrees, Corner::MirroredInNext, widths, &[fold, turned_up]);
    }
}

#[test]
fn a_tapered_hem_is_narrower_at_its_ends_and_says_so() {
    let cut = cut_line(&cornered(120.0, Corner::MirroredInPrevious, [0.04, 0.01])).unwrap();
    let [Finding::Narrow { edge, span, least }] = cut.findings[..] else {
        panic!("{:?}", cut.findings);
    };
    assert_eq!(edge, EdgeIndex { ring: 0, edge: 0 });
    // Its end lies on x sin 60 - y cos 60 = 0.01 (turned by 120 degrees, mirrored).
    let (sin, cos) = 120f64.to_radians().sin_cos();
    let end = (0.01 + 0.04 * cos) / sin;
    assert!((span[0] - (0.3 + end)).abs() < EXACT && (span[1] - 0.3).abs() < EXACT);
    assert!((least - 0.01 / -cos).abs() < EXACT, "{least}");
}

#[test]
fn blunt_corners_of_kinds_that_would_reach_far_are_mitred() {
    for kind in [
        Corner::SquareToNext,
        Corner::SquareToPrevious,
        Corner::Extended,
        Corner::MirroredInPrevious,
        Corner::MirroredInNext,
    ] {
        let at = lines(15.0, [0.01; 2]);
        check(15.0, kind, [0.01; 2], &[meet(at.cut_before, at.cut_after)]);
        let cut = cut_line(&cornered(15.0, kind, [0.01; 2])).unwrap();
        let found = &cut.findings[..];
        assert!(
            matches!(found, [Finding::Mitred { asked, .. }] if *asked > 0.025),
            "{found:?}"
        );
    }
}

#[test]
fn inner_corners_meet_whatever_their_kind() {
    let hook = [
        Vec2::new(0.0, 0.0),
        Vec2::new(0.3, 0.0),
        Vec2::new(0.3, 0.3),
        Vec2::new(0.2, 0.3),
        Vec2::new(0.2, 0.1),
        Vec2::new(0.0, 0.1),
    ];
    for kind in common::KINDS {
        let mut seam = seam_of(&hook, &[0.01; 6]);
        seam.outline[4].corner = kind;
        let cut = cut_line(&seam).unwrap();
        assert!((cut.polygon().area() - (0.32 * 0.12 + 0.12 * 0.2)).abs() < 1e-9);
        assert!(vertex_near(&cut.outline.points, Vec2::new(0.19, 0.11), EXACT).is_some());
        let inner = |f: &&Finding| {
            matches!(f, Finding::Swallowed { inner_corner: true, span, .. }
            if (span[1] - span[0] - 0.01).abs() < 1e-7)
        };
        assert_eq!(
            cut.findings.iter().filter(inner).count(),
            2,
            "{:?}",
            cut.findings
        );
        assert_eq!(cut.findings.len(), 2);
    }
}

#[test]
fn without_widths_the_seam_line_is_cut_to_the_bit() {
    let mut seam = cornered(70.0, Corner::Mitre, [0.0; 2]);
    seam.outline[1].curve = Curve::Arc {
        start: seam.outline[1].curve.start(),
        end: seam.outline[1].curve.end(),
        bulge: 0.3,
    };
    let cut = cut_line(&seam).unwrap();
    let flat: Vec<Vec2> = seam
        .outline
        .iter()
        .flat_map(|e| {
            let mut points = e.curve.flatten(toile_cut::FLATNESS);
            points.pop();
            points
        })
        .collect();
    assert_eq!(cut.outline.points, flat);
    assert!(cut.findings.is_empty());
    // Nor does it move beside an edge that has one.
    seam.outline[3].width = 0.013;
    let cut = cut_line(&seam).unwrap();
    for p in &flat[1..flat.len() - 1] {
        assert!(cut.outline.points.contains(p), "{p:?}");
    }
}

#[test]
fn collinear_edges_of_two_widths_meet_in_a_step() {
    let points = [
        Vec2::new(0.0, 0.0),
        Vec2::new(0.2, 0.0),
        Vec2::new(0.4, 0.0),
        Vec2::new(0.4, 0.3),
        Vec2::new(0.0, 0.3),
    ];
    let cut = cut_line(&seam_of(&points, &[0.01, 0.02, 0.0, 0.0, 0.0])).unwrap();
    assert!((cut.polygon().area() - (0.12 + 0.002 + 0.004)).abs() < 1e-9);
    let step = vertex_near(&cut.outline.points, Vec2::new(0.2, -0.01), 1e-12).unwrap();
    assert_eq!(cut.outline.origins[step].kind, SegmentKind::Corner);
    // Of one width: two segments, each with its edge.
    let cut = cut_line(&seam_of(&points, &[0.02, 0.02, 0.0, 0.0, 0.0])).unwrap();
    let between = vertex_near(&cut.outline.points, Vec2::new(0.2, -0.02), 1e-12).unwrap();
    assert_eq!(cut.outline.origins[between].edge.edge, 1);
    assert_eq!(cut.outline.origins[between - 1].edge.edge, 0);
}

#[test]
fn broken_input_is_refused_by_cause() {
    assert_eq!(cut_line(&SeamLine::default()), Err(CutError::NoArea(0)));
    let sound = || cornered(90.0, Corner::Mitre, [0.01; 2]);
    let with = |change: &dyn Fn(&mut Vec<SeamEdge>)| {
        let mut seam = sound();
        change(&mut seam.outline);
        cut_line(&seam).unwrap_err()
    };
    let edge = |edge| EdgeIndex { ring: 0, edge };
    for width in [-1e-9, f64::NAN, f64::INFINITY] {
        assert_eq!(with(&|e| e[2].width = width), CutError::Width(edge(2)));
    }
    let nan = Vec2::new(f64::NAN, 0.0);
    assert_eq!(
        with(&|e| e[0].curve = line(nan, nan)),
        CutError::NotFinite(edge(0))
    );
    assert!(matches!(
        with(&|e| e[1].curve = line(Vec2::zeros(), Vec2::new(0.5, 0.5))),
        CutError::Open(found, _) if found == edge(1)
    ));
    assert!(matches!(
        with(&|e| {
            e.remove(3);
        }),
        CutError::Open(..)
    ));
    let bow = [[0.0, 0.0], [0.2, 0.2], [0.2, 0.0], [0.0, 0.1]].map(Vec2::from);
    let found = cut_line(&seam_of(&bow, &[0.01; 4])).unwrap_err();
    assert!(matches!(found, CutError::Crossing(..)), "{found:?}");
    let flat = [[0.0, 0.0], [0.2, 0.2], [0.1, 0.1]].map(Vec2::from);
    assert_eq!(
        cut_line(&seam_of(&flat, &[0.01; 3])),
        Err(CutError::NoArea(0))
    );
}

#[test]
fn slivers_and_short_edges_are_cut_like_others() {
    // A spike of 0.1 mm, an edge of 1 nm, and one without length.
    let points = [
        [0.0, 0.0],
        [0.3, 0.0],
        [0.3, 0.0],
        [0.3, 1e-9],
        [0.3, 1e-4],
        [0.0, 1e-4],
    ];
    let seam = seam_of(&points.map(Vec2::from), &[0.01; 6]);
    let cut = cut_line(&seam).unwrap();
    assert!(cut.polygon().is_simple());
    assert!((cut.polygon().area() - 0.32 * 0.0201).abs() < 1e-8);
    let needle = [[0.0, 0.0], [0.3, 0.0], [0.0, 1e-5]].map(Vec2::from);
    let cut = cut_line(&seam_of(&needle, &[0.01; 3])).unwrap();
    assert!(cut.polygon().is_simple());
    assert!(cut.polygon().bounds().max.x < 0.3 + 0.0251);
}

#[test]
fn a_piece_far_from_the_origin_is_cut_alike() {
    let at = |by: Vec2| {
        let mut seam = cornered(110.0, Corner::MirroredInPrevious, [0.03, 0.01]);
        for edge in &mut seam.outline {
            edge.curve = edge.curve.translated(by);
        }
        cut_line(&seam).unwrap().polygon()
    };
    let (near, far): (Polygon, Polygon) = (at(Vec2::zeros()), at(Vec2::new(-512.0, 1024.0)));
    assert_eq!(near.outer.len(), far.outer.len());
    assert!((near.area() - far.area()).abs() < 1e-9);
}
