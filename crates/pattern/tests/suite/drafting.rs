//! From document to draft: formulas, constructions, folds, pairs, darts, spans.

use crate::sample::*;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;
use toile_geometry::{Rigid, Vec2, Vec3};
use toile_measure::Measurements;
use toile_pattern::*;

fn resolved(pattern: &Pattern) -> Draft {
    let (draft, found) = pattern.resolve(&Measurements::adult());
    assert!(found.is_empty(), "{found:?}");
    draft
}

fn loop_area(edges: &[PieceEdge]) -> f64 {
    edges.iter().map(|e| e.curve.swept_area()).sum::<f64>() * 0.5
}

/// Points of a span of a draft, at equal distances.
fn walked(draft: &Draft, span: &DraftSpan, count: usize) -> Vec<Vec2> {
    let piece = &draft.pieces[span.piece];
    let mut edges = piece.outline.iter().chain(piece.holes.iter().flatten());
    let curve = edges.nth(span.edge).unwrap().curve;
    curve.sample(span.from, span.to, count)
}

fn close(a: Vec2, b: (f64, f64)) -> bool {
    (a - Vec2::new(b.0, b.1)).norm() < 1e-9
}

#[test]
fn constructions_put_points_where_geometry_says() {
    let mut pattern = sample();
    let p = [0, 1, 2, 3].map(|k| point(&pattern, "front", &format!("p{k}")));
    let right = pattern.sheets[0].curve_named("right").unwrap().id;
    for (name, place, expected) in [
        (
            "offset",
            PointRule::Offset {
                base: p[1],
                x: 0.1.into(),
                y: formula("-5cm"),
            },
            (0.5, -0.05),
        ),
        (
            "polar",
            PointRule::Polar {
                base: p[0],
                angle: formula("90deg"),
                distance: formula("bust / 4"),
            },
            (0.0, 0.25),
        ),
        (
            "between",
            PointRule::Between {
                base: p[0],
                tip: p[1],
                along: 0.25.into(),
                aside: 0.5.into(),
            },
            (0.1, 0.2),
        ),
        (
            "toward",
            PointRule::Toward {
                base: p[0],
                tip: p[3],
                distance: 0.7.into(),
            },
            (0.0, 0.7),
        ),
        (
            "on edge",
            PointRule::OnCurve {
                curve: right,
                share: 0.5.into(),
            },
            (0.4, 0.3),
        ),
        (
            "crossing",
            PointRule::Crossing {
                first: [p[0], p[2]],
                second: [p[1], p[3]],
            },
            (0.2, 0.3),
        ),
        (
            "mirrored",
            PointRule::Mirrored {
                base: p[0],
                line: [p[1], p[2]],
            },
            (0.8, 0.0),
        ),
        (
            "along curve",
            PointRule::AlongCurve {
                curve: right,
                distance: formula("-10cm"),
            },
            (0.4, 0.5),
        ),
        (
            "foot",
            PointRule::Foot {
                base: p[2],
                line: [p[0], p[1]],
            },
            (0.4, 0.0),
        ),
        (
            "line crossing",
            PointRule::LineCrossing {
                line: [p[0], p[2]],
                curve: right,
                index: 0,
            },
            (0.4, 0.6),
        ),
    ] {
        let id = put_point(&mut pattern, 0, name, place);
        let got = at(&pattern, id);
        assert!(close(got, expected), "{name}: {got:?}");
    }
}

#[test]
fn formulas_follow_the_body_and_the_draft() {
    let mut pattern = sample();
    put_variable(&mut pattern, "width", formula("hips / 4 + 2cm"));
    let width = formula_in(&pattern, "width");
    let height = formula_in(
        &pattern,
        "length(back.right) + distance(back.p0, back.p1) / 4",
    );
    let low = PointRule::At {
        x: width.clone(),
        y: Number::ZERO,
    };
    let high = PointRule::At {
        x: width,
        y: height,
    };
    place(&mut pattern, 0, "p1", low);
    place(&mut pattern, 0, "p2", high);
    for body in [Measurements::adult_woman(), Measurements::adult_man()] {
        let (draft, _) = pattern.resolve(&body);
        let corner = draft.pieces[0].outline[1].curve.end();
        let width = body.get("hips").unwrap() / 4.0 + 0.02;
        assert!(close(corner, (width, 0.7)), "{corner:?}");
    }
}

#[test]
fn a_folded_panel_is_unfolded() {
    let mut pattern = sample();
    let kind = fold(&pattern, "left");
    put_operation(&mut pattern, 0, "fold", kind);
    bend(
        &mut pattern,
        0,
        "right",
        CurveRule::Arc { bulge: 0.2.into() },
    );
    let notch = Notch {
        id: pattern.ids.take(),
        name: "notch".into(),
        line: outline(&pattern, "front"),
        at: Mark::between(ends(&pattern, "front", "top"), 0.25),
        kind: NotchKind::Slit,
    };
    alter(&mut pattern, 0, |panel| panel.notches.push(notch));
    alter_seam(&mut pattern, 0, |seam| {
        let half = seam.sides[0][0].clone();
        seam.sides[0] = vec![Span { half: 1, ..half }];
    });
    pattern.seams.remove(1);
    let draft = resolved(&pattern);
    let piece = &draft.pieces[0];
    assert_eq!(piece.outline.len(), 6);
    for (k, edge) in piece.outline.iter().enumerate() {
        let next = &piece.outline[(k + 1) % 6];
        assert_eq!(edge.curve.end(), next.curve.start(), "closed to the bit");
    }
    let half: f64 = 0.4 * 0.6;
    let arc = 0.5 * {
        let chord: f64 = 0.6;
        let sweep = 4.0 * 0.2_f64.atan();
        let radius = chord / (2.0 * (sweep / 2.0).sin());
        radius * radius * (sweep - sweep.sin())
    };
    assert!((loop_area(&piece.outline) - 2.0 * (half + arc)).abs() < 1e-12);
    let notches: Vec<_> = piece.notches.iter().map(|n| (n.point, n.inward)).collect();
    assert!(close(notches[0].0, (0.3, 0.6)) && close(notches[1].0, (-0.3, 0.6)));
    assert!(close(notches[0].1, (0.0, -1.0)) && close(notches[1].1, (0.0, -1.0)));
    let line = walked(&draft, &draft.seams[0].sides[0][0], 4);
    assert!(close(line[0], (-0.4, 0.0)) && close(line[4], (-0.4, 0.6)));
}

#[test]
fn a_mirrored_pair_has_a_left_and_a_right() {
    let mut pattern = sample();
    alter(&mut pattern, 0, |panel| {
        panel.cut = Cut {
            quantity: 2,
            mirrored: true,
        };
        panel.grain = formula("60deg");
        panel.worn = WornRule::Wrapped {
            part: BodyPart::LeftArm,
            facing: Facing::Around,
            level: None,
        };
    });
    alter_seam(&mut pattern, 0, |seam| {
        seam.sides[0][0].copy = 1;
        seam.right_sides_together = false;
    });
    let draft = resolved(&pattern);
    let [left, right] = [&draft.pieces[0], &draft.pieces[1]];
    assert_eq!((&*left.name, &*right.name), ("front", "front mirrored"));
    assert!(loop_area(&left.outline) > 0.0, "both run counter-clockwise");
    assert!((loop_area(&left.outline) - loop_area(&right.outline)).abs() < 1e-12);
    assert!((left.grain - PI / 3.0).abs() < 1e-12);
    assert!((right.grain - 2.0 * PI / 3.0).abs() < 1e-12);
    let part = |piece: &Piece| match piece.worn {
        Worn::Wrapped { part, .. } => part,
        _ => panic!("wrapped"),
    };
    assert_eq!(part(left), BodyPart::LeftArm);
    assert_eq!(part(right), BodyPart::RightArm);
    let line = walked(&draft, &draft.seams[0].sides[0][0], 3);
    assert!(close(line[0], (-0.4, 0.0)) && close(line[3], (-0.4, 0.6)));
}

#[test]
fn a_placed_pair_stands_at_mirror_places() {
    let turn = nalgebra::UnitQuaternion::from_euler_angles(0.3, -0.7, 1.1);
    let q = turn.coords;
    let mut pattern = sample();
    alter(&mut pattern, 0, |panel| {
        panel.cut = Cut {
            quantity: 2,
            mirrored: true,
        };
        panel.worn = WornRule::Placed {
            translation: [0.1, 1.2, 0.3],
            rotation: [q.x, q.y, q.z, q.w],
        };
    });
    let (draft, _) = pattern.resolve(&Measurements::adult());
    let place = |k: usize| match draft.pieces[k].worn {
        Worn::Placed(rigid) => rigid,
        _ => panic!("placed"),
    };
    let at = |rigid: Rigid, x: f64, y: f64| (rigid * nalgebra::Point3::new(x, y, 0.0)).coords;
    for (x, y) in [(0.0, 0.0), (0.4, 0.0), (0.2, 0.6)] {
        let left: Vec3 = at(place(0), x, y);
        let right: Vec3 = at(place(1), -x, y);
        assert!((left - Vec3::new(-right.x, right.y, right.z)).norm() < 1e-12);
    }
}

#[test]
fn darts_open_the_outline_and_seams_skip_their_mouths() {
    let mut pattern = sample();
    for share in [0.25, 0.75] {
        let kind = dart(&pattern, "top", share, 0.04, Apex::Depth(0.1.into()));
        put_operation(&mut pattern, 0, &format!("dart at {share}"), kind);
    }
    let sides = [
        vec![span(&pattern, "front", "top").reversed()],
        vec![span(&pattern, "back", "top")],
    ];
    let mut seam = Seam::new(pattern.ids.take(), "top", sides);
    seam.ease = formula("8cm");
    pattern.seams.push(std::sync::Arc::new(seam));
    assert!(faults(&pattern).is_empty());
    let draft = resolved(&pattern);
    let piece = &draft.pieces[0];
    assert_eq!(piece.outline.len(), 4 + 2 * 3);
    assert!((loop_area(&piece.outline) - (0.24 - 2.0 * 0.04 * 0.1 / 2.0)).abs() < 1e-12);
    let darts: Vec<_> = draft
        .seams
        .iter()
        .filter(|s| matches!(s.id, SeamOrigin::Dart { .. }))
        .collect();
    assert_eq!(darts.len(), 2);
    for seam in darts {
        let [a, b] = [0, 1].map(|k| walked(&draft, &seam.sides[k][0], 1));
        assert_eq!(a[1], b[1], "both legs end at the apex");
        assert!(
            (a[0] - b[0]).norm() - 0.04 < 1e-12,
            "and start at the mouth"
        );
    }
    let top = draft.seams.last().unwrap();
    let sewn: Vec<Vec<Vec2>> = top.sides[0].iter().map(|s| walked(&draft, s, 1)).collect();
    assert_eq!(sewn.len(), 3);
    assert!(close(sewn[0][0], (0.0, 0.6)) && close(sewn[0][1], (0.08, 0.6)));
    assert!(close(sewn[1][0], (0.12, 0.6)) && close(sewn[1][1], (0.28, 0.6)));
    assert!(close(sewn[2][0], (0.32, 0.6)) && close(sewn[2][1], (0.4, 0.6)));
}

#[test]
fn a_diamond_dart_is_a_hole_sewn_shut() {
    let mut pattern = sample();
    let low = put_point(&mut pattern, 0, "low", PointRule::at(0.2, 0.2));
    let high = put_point(&mut pattern, 0, "high", PointRule::at(0.2, 0.4));
    let kind = OperationKind::Diamond {
        ends: [low, high],
        widest: 0.4.into(),
        intake: 0.03.into(),
    };
    put_operation(&mut pattern, 0, "waist", kind);
    assert!(pattern.check(&Measurements::adult()).is_empty());
    let draft = resolved(&pattern);
    let piece = &draft.pieces[0];
    assert_eq!(piece.holes.len(), 1);
    assert!((loop_area(&piece.holes[0]) + 0.2 * 0.03 / 2.0).abs() < 1e-12);
    let seam = &draft.seams[0];
    let walk = |side: usize| -> Vec<Vec2> {
        let spans = seam.sides[side].iter();
        spans.flat_map(|s| walked(&draft, s, 1)).collect()
    };
    let (left, right) = (walk(0), walk(1));
    assert!(close(left[0], (0.2, 0.2)) && close(right[0], (0.2, 0.2)));
    assert!(close(left[3], (0.2, 0.4)) && close(right[3], (0.2, 0.4)));
    assert!(close(left[1], (0.185, 0.28)) && close(right[1], (0.215, 0.28)));
}

#[test]
fn pieces_that_no_seam_names_are_only_cut() {
    let mut pattern = sample();
    alter(&mut pattern, 1, |panel| panel.cut.quantity = 2);
    let draft = resolved(&pattern);
    let sewn: Vec<bool> = draft.pieces.iter().map(|piece| piece.sewn).collect();
    assert_eq!(sewn, [true, true, false]);
    pattern.panels.remove(1);
    pattern.seams.clear();
    assert!(
        resolved(&pattern).pieces[0].sewn,
        "the only panel is a garment"
    );
}

#[test]
fn grain_defaults_to_upright() {
    assert!(
        resolved(&sample())
            .pieces
            .iter()
            .all(|p| p.grain == FRAC_PI_2)
    );
}

#[test]
fn a_spline_is_drawn_to_a_length() {
    let mut pattern = sample();
    let low = put_point(&mut pattern, 0, "low", PointRule::at(0.5, 0.2));
    let high = put_point(&mut pattern, 0, "high", PointRule::at(0.5, 0.4));
    let spline = |length: Option<Number>| CurveRule::Spline {
        handles: [low, high],
        knots: Vec::new(),
        to_length: length,
    };
    bend(&mut pattern, 0, "right", spline(Some(formula("64.5cm"))));
    let length = right_length(&pattern);
    assert!((length - 0.645).abs() < 1e-12, "{length}");
    bend(&mut pattern, 0, "right", spline(Some(formula("59cm"))));
    let found = pattern.check(&Measurements::adult());
    assert_eq!(found[0].code, Code::OutOfReach, "{found:?}");
}

/// Length of the front's right edge.
fn right_length(pattern: &Pattern) -> f64 {
    let evaluation = Evaluation::new(pattern, &Measurements::adult());
    let edge = edge(pattern, "front", "right");
    evaluation.edge(edge).unwrap().length()
}

#[test]
fn formulas_choose_compare_and_round() {
    for (text, expected) in [
        ("if(bust > 90cm, 2cm, 3cm)", 0.02),
        ("if(not (bust > 90cm) or bust < 1cm, 2cm, 3cm)", 0.03),
        ("if(1 < 2 and 2 <= 2, 4cm, 1cm / 0)", 0.04),
        ("round(12.3cm, 5mm)", 0.125),
        ("1 5/8in", 1.625 * 0.0254),
        ("5/8in", 0.625 * 0.0254),
        ("angle(front.right) / 90deg * 1cm", 0.01),
        ("angle(front.p0, front.p1) * 1cm + 3cm", 0.03),
        ("length(front.p0..front.p2)", 1.0),
        ("length('one side')", 0.6),
        ("finished(front.top)", 0.4),
    ] {
        let mut pattern = sample();
        let number = formula_in(&pattern, text);
        let known = number.as_formula().unwrap().clone();
        put_variable(&mut pattern, "v", number);
        let evaluation = Evaluation::new(&pattern, &Measurements::adult());
        let value = evaluation.variable(pattern.variables[0].id);
        match value {
            Some((value, 1)) if (value - expected).abs() < 1e-12 => {}
            other => panic!("{text}: {other:?} {:?}", evaluation.diagnostics()),
        }
        assert_eq!(known.text(&Names::new(&pattern)), text);
    }
}

/// A size's own value is of the kind the usual one is, and is taken in that size alone.
#[test]
fn a_size_has_a_length_of_its_own() {
    let mut pattern = sample();
    for name in ["S", "M"] {
        let (id, name) = (pattern.ids.take(), name.to_owned());
        let measurements = Measurements::adult();
        pattern.sizes.push(Arc::new(Size {
            id,
            name,
            measurements,
        }));
    }
    let own = |usual| Number::PerSize {
        usual: Box::new(usual),
        sizes: vec![(pattern.sizes[0].id, 0.03)],
    };
    let [length, plain] = [formula("bust / 10"), 2.0.into()].map(own);
    let length = put_variable(&mut pattern, "length", length);
    let plain = put_variable(&mut pattern, "plain", plain);
    let values = |wearer: Wearer| {
        let evaluation = Evaluation::new(&pattern, wearer);
        [length, plain].map(|id| evaluation.variable(id).unwrap())
    };
    let bust = Measurements::adult().get("bust").unwrap();
    assert_eq!(values((&pattern.sizes[0]).into()), [(0.03, 1), (0.03, 0)]);
    // The same measurements are not yet the same size.
    let usual = [(bust / 10.0, 1), (2.0, 0)];
    assert_eq!(values((&pattern.sizes[1]).into()), usual);
    assert_eq!(values((&Measurements::adult()).into()), usual);
}
