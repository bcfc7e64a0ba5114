//! From document to draft: formulas, constructions, folds, pairs, darts, spans.
#![allow(clippy::unwrap_used)]

mod sample;

use sample::*;
use std::f64::consts::{FRAC_PI_2, PI};
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
    let id = |k: u32| PointId(k);
    for (name, place, expected) in [
        (
            "offset",
            PointPlace::Offset {
                base: id(1),
                x: 0.1.into(),
                y: formula("-5cm"),
            },
            (0.5, -0.05),
        ),
        (
            "polar",
            PointPlace::Polar {
                base: id(0),
                angle: formula("90deg"),
                distance: formula("bust / 4"),
            },
            (0.0, 0.25),
        ),
        (
            "between",
            PointPlace::Between {
                base: id(0),
                tip: id(1),
                along: 0.25.into(),
                aside: 0.5.into(),
            },
            (0.1, 0.2),
        ),
        (
            "toward",
            PointPlace::Toward {
                base: id(0),
                tip: id(3),
                distance: 0.7.into(),
            },
            (0.0, 0.7),
        ),
        (
            "on edge",
            PointPlace::OnEdge {
                edge: EdgeId(1),
                at: 0.5.into(),
            },
            (0.4, 0.3),
        ),
        (
            "crossing",
            PointPlace::Crossing {
                first: [id(0), id(2)],
                second: [id(1), id(3)],
            },
            (0.2, 0.3),
        ),
        (
            "mirrored",
            PointPlace::Mirrored {
                base: id(0),
                line: [id(1), id(2)],
            },
            (0.8, 0.0),
        ),
    ] {
        let id = put_point(&mut pattern, 0, name, place);
        let places = pattern.point_places(&Measurements::adult());
        let got = places[&(FRONT, id)];
        assert!(close(got, expected), "{name}: {got:?}");
    }
}

#[test]
fn formulas_follow_the_body_and_the_draft() {
    let mut pattern = sample();
    pattern.variables.push(Variable {
        name: "width".into(),
        number: formula("hips / 4 + 2cm"),
    });
    alter(&mut pattern, 0, |panel| {
        panel.points[1].place = PointPlace::At {
            x: formula("width"),
            y: Number::ZERO,
        };
        panel.points[2].place = PointPlace::At {
            x: formula("width"),
            y: formula("length(back.right) + distance(back.p0, back.p1) / 4"),
        };
    });
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
    let left = edge(&pattern, "front", "left").1;
    alter(&mut pattern, 0, |panel| {
        panel.fold = Some(left);
        panel.outline[1].curve = EdgeCurve::Arc { bulge: 0.2.into() };
        panel.notches.push(Notch {
            id: NotchId(0),
            name: "notch".into(),
            edge: panel.outline[2].id,
            at: Along::Fraction(0.25.into()),
        });
    });
    alter_seam(&mut pattern, 0, |seam| {
        let half = seam.sides[0][0].clone();
        seam.sides[0] = vec![Span {
            reflected: true,
            ..half
        }];
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
    alter_seam(&mut pattern, 0, |seam| seam.sides[0][0].copy = 1);
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
    let top = edge(&pattern, "front", "top").1;
    for (id, at) in [(0, 0.25), (1, 0.75)] {
        let dart = Dart {
            id: DartId(id),
            name: format!("dart {id}"),
            shape: DartShape::Edge {
                edge: top,
                at: at.into(),
                width: 0.04.into(),
                tip: DartTip::Depth(0.1.into()),
            },
        };
        alter(&mut pattern, 0, |panel| panel.darts.push(dart));
    }
    let sides = [
        vec![span(&pattern, "front", "top").reversed()],
        vec![span(&pattern, "back", "top")],
    ];
    let mut seam = Seam::new(SeamId(9), "top", sides);
    seam.ease = formula("8cm");
    pattern.seams.push(std::sync::Arc::new(seam));
    assert!(pattern.check(&Measurements::adult()).is_empty());
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
    let low = put_point(&mut pattern, 0, "low", PointPlace::at(0.2, 0.2));
    let high = put_point(&mut pattern, 0, "high", PointPlace::at(0.2, 0.4));
    alter(&mut pattern, 0, |panel| {
        panel.darts.push(Dart {
            id: DartId(0),
            name: "waist".into(),
            shape: DartShape::Diamond {
                ends: [low, high],
                at: 0.4.into(),
                width: 0.03.into(),
            },
        });
    });
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
