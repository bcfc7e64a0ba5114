//! Holes, slits and tight curves.

use crate::common::{self, line, loop_of, seam_of};
use toile_cut::{Corner, CutError, EdgeIndex, Finding, SeamEdge, SeamLine, cut_line};
use toile_geometry::{Curve, Vec2, ring_area};

fn rectangle(min: [f64; 2], max: [f64; 2]) -> [Vec2; 4] {
    [min, [max[0], min[1]], max, [min[0], max[1]]].map(Vec2::from)
}

fn with_hole(hole: Vec<SeamEdge>) -> SeamLine {
    SeamLine {
        holes: vec![hole],
        ..seam_of(&rectangle([-0.2; 2], [0.2; 2]), &[0.01; 4])
    }
}

fn circle(radius: f64, width: f64, bulge: f64) -> Vec<SeamEdge> {
    let ends = [Vec2::new(radius, 0.0), Vec2::new(-radius, 0.0)];
    (0..2)
        .map(|k| SeamEdge {
            limit: toile_cut::MITRE_LIMIT,
            curve: Curve::Arc {
                start: ends[k],
                end: ends[1 - k],
                bulge,
            },
            width,
            corner: Corner::Mitre,
        })
        .collect()
}

#[test]
fn a_holes_allowance_goes_into_it() {
    for turned in [false, true] {
        let mut hole = loop_of(
            &rectangle([-0.05, -0.03], [0.05, 0.03]),
            &[0.01, 0.02, 0.0, 0.005],
        );
        if turned {
            hole = common::reversed_loop(&hole);
        }
        let cut = cut_line(&with_hole(hole)).unwrap();
        assert_eq!(cut.holes.len(), 1);
        assert!((ring_area(&cut.holes[0].points) + (0.1 - 0.025) * (0.06 - 0.01)).abs() < 1e-9);
        let edges: Vec<usize> = cut.holes[0].origins.iter().map(|o| o.edge.edge).collect();
        assert!(cut.holes[0].origins.iter().all(|o| o.edge.ring == 1));
        assert_eq!(edges.len(), 4);
        // The hole's corners are inner corners of the cloth: its allowances overlap.
        assert!(
            cut.findings.iter().all(|f| matches!(
                f,
                Finding::Swallowed {
                    inner_corner: true,
                    ..
                }
            )),
            "{:?}",
            cut.findings
        );
    }
}

#[test]
fn a_round_hole_shrinks_to_a_smaller_circle() {
    for bulge in [1.0, -1.0] {
        let cut = cut_line(&with_hole(circle(0.02, 0.008, bulge))).unwrap();
        let hole = &cut.holes[0];
        for p in &hole.points {
            assert!((p.norm() - 0.012).abs() < 1e-5);
        }
        assert!(cut.findings.is_empty(), "{:?}", cut.findings);
        let without = cut_line(&with_hole(circle(0.02, 0.0, bulge))).unwrap();
        assert!(
            without.holes[0]
                .points
                .iter()
                .all(|p| (p.norm() - 0.02).abs() < 1e-12)
        );
    }
}

#[test]
fn a_hole_smaller_than_its_allowance_is_shut() {
    let cut = cut_line(&with_hole(circle(0.02, 0.025, 1.0))).unwrap();
    assert!(cut.holes.is_empty());
    assert_eq!(cut.findings, [Finding::HoleShut { hole: 0, parts: 0 }]);
    // An hourglass falls into two.
    let hourglass = [
        [-0.1, -0.05],
        [0.0, -0.008],
        [0.1, -0.05],
        [0.1, 0.05],
        [0.0, 0.008],
        [-0.1, 0.05],
    ];
    let cut = cut_line(&with_hole(loop_of(&hourglass.map(Vec2::from), &[0.01; 6]))).unwrap();
    assert_eq!(cut.holes.len(), 2);
    assert!(
        cut.findings
            .contains(&Finding::HoleShut { hole: 0, parts: 2 })
    );
    assert!(cut.polygon().crossings(9).is_empty());
}

#[test]
fn stray_holes_are_refused() {
    let hole = loop_of(&rectangle([0.3; 2], [0.4; 2]), &[0.0; 4]);
    assert_eq!(cut_line(&with_hole(hole)), Err(CutError::StrayHole(0)));
    let mut two = with_hole(loop_of(&rectangle([-0.1; 2], [0.1; 2]), &[0.01; 4]));
    two.holes
        .push(loop_of(&rectangle([-0.05; 2], [0.05; 2]), &[0.01; 4]));
    assert_eq!(cut_line(&two), Err(CutError::StrayHole(1)));
}

/// A slit 0.1 deep in the top of a square, `gap` wide.
fn slit(gap: f64, width: f64) -> SeamLine {
    let half = gap / 2.0;
    let points = [
        [-0.2, -0.2],
        [0.2, -0.2],
        [0.2, 0.2],
        [half, 0.2],
        [half, 0.1],
        [-half, 0.1],
        [-half, 0.2],
        [-0.2, 0.2],
    ];
    seam_of(&points.map(Vec2::from), &[width; 8])
}

#[test]
fn a_narrow_slit_grows_shut_and_a_wide_one_does_not() {
    let shut = |cut: &toile_cut::CutLine| -> Vec<Finding> {
        let found = cut
            .findings
            .iter()
            .filter(|f| matches!(f, Finding::SlitShut { .. }));
        found.cloned().collect()
    };
    let cut = cut_line(&slit(0.015, 0.01)).unwrap();
    assert!((cut.polygon().area() - 0.42 * 0.42).abs() < 1e-8);
    let [
        Finding::SlitShut {
            edges,
            mouth,
            depth,
            length,
        },
    ] = shut(&cut)[..]
    else {
        panic!("{:?}", cut.findings);
    };
    assert_eq!(edges.map(|e| e.edge), [3, 5]);
    assert!((mouth - Vec2::new(0.0, 0.2)).norm() < 1e-6);
    assert!((depth - 0.11).abs() < 1e-6, "{depth}");
    assert!((length - 0.215).abs() < 1e-6, "{length}");
    let cut = cut_line(&slit(0.03, 0.01)).unwrap();
    assert!(shut(&cut).is_empty());
    assert!((cut.polygon().area() - (0.42 * 0.42 - 0.01 * 0.1)).abs() < 1e-8);
}

#[test]
fn a_bay_with_a_narrow_mouth_leaves_a_hole() {
    let keyhole = [
        [-0.2, -0.2],
        [0.2, -0.2],
        [0.2, 0.2],
        [0.006, 0.2],
        [0.006, 0.15],
        [0.05, 0.15],
        [0.05, 0.05],
        [-0.05, 0.05],
        [-0.05, 0.15],
        [-0.006, 0.15],
        [-0.006, 0.2],
        [-0.2, 0.2],
    ];
    let cut = cut_line(&seam_of(&keyhole.map(Vec2::from), &[0.01; 12])).unwrap();
    assert_eq!(cut.holes.len(), 1);
    let area = 0.08 * 0.08;
    assert!((ring_area(&cut.holes[0].points) + area).abs() < 1e-8);
    let bay = cut.findings.iter().find_map(|f| match f {
        Finding::BayShut { hole, area } => Some((*hole, *area)),
        _ => None,
    });
    let (hole, found) = bay.unwrap();
    assert!(hole == 0 && (found - area).abs() < 1e-8);
    assert!(cut.polygon().crossings(9).is_empty());
}

/// A neckline tighter than its allowance: the middle of it has no cut line of its own.
#[test]
fn a_curve_tighter_than_its_allowance_is_swallowed() {
    let (radius, width) = (0.02, 0.03);
    let mut seam = seam_of(&rectangle([-0.2; 2], [0.2; 2]), &[0.0; 4]);
    // In the top edge, walked to the left: down, round and up.
    let p = |x: f64, y: f64| Vec2::new(x, y);
    let edge = |curve: Curve, width: f64| SeamEdge {
        limit: toile_cut::MITRE_LIMIT,
        curve,
        width,
        corner: Corner::Mitre,
    };
    seam.outline[2] = edge(line(p(0.2, 0.2), p(radius, 0.2)), 0.0);
    let round = Curve::Arc {
        start: p(radius, 0.2),
        end: p(-radius, 0.2),
        bulge: -1.0,
    };
    seam.outline.insert(3, edge(round, width));
    seam.outline
        .insert(4, edge(line(p(-radius, 0.2), p(-0.2, 0.2)), 0.0));
    let cut = cut_line(&seam).unwrap();
    assert!(cut.polygon().is_simple());
    // All normals pass the centre: every point of the cut line is 10 mm beyond it or swallowed.
    let swallowed: f64 = cut
        .findings
        .iter()
        .filter_map(|f| match f {
            Finding::Swallowed { edge, span, .. } if *edge == EdgeIndex { ring: 0, edge: 3 } => {
                Some(span[1] - span[0])
            }
            _ => None,
        })
        .sum();
    assert!(swallowed > 0.0, "{:?}", cut.findings);
    // The ends of chords as tight as that are turned by half of what the chords turn: 0.3 mm.
    for q in &cut.outline.points {
        let d = (q - p(0.0, 0.2)).norm();
        assert!(
            q.y <= 0.2 + 1e-9 || (d - (width - radius)).abs() < 2e-5,
            "{q:?}"
        );
    }
}
