//! Darts trued: edges of several darts, folds, pivots and marks; and the kinks that are told.

use crate::sample::*;
use std::sync::Arc;
use toile_geometry::{Curve, Vec2};
use toile_measure::Measurements;
use toile_pattern::*;

fn trued(mut kind: OperationKind) -> OperationKind {
    if let OperationKind::Dart { trued, .. } = &mut kind {
        *trued = true;
    }
    kind
}

/// A front alone, with darts at shares of its top edge.
fn waist(shares: &[f64], make: impl Fn(OperationKind) -> OperationKind) -> Pattern {
    let mut pattern = sample();
    pattern.seams.clear();
    pattern.panels.truncate(1);
    for (k, share) in shares.iter().enumerate() {
        let kind = dart(&pattern, "top", *share, 0.025, Apex::Depth(0.1.into()));
        put_operation(&mut pattern, 0, &format!("dart {k}"), make(kind));
    }
    pattern
}

fn kinks(pattern: &Pattern) -> Vec<Diagnostic> {
    let found = pattern.check(&Measurements::adult());
    let others = found.iter().filter(|found| found.code != Code::Kink);
    assert_eq!(others.count(), 0, "{found:?}");
    found
}

fn stage(pattern: &Pattern) -> Arc<Stage> {
    let evaluation = Evaluation::new(pattern, &Measurements::adult());
    let panel = evaluation.pattern().panels[0].clone();
    evaluation.last_stage(&panel).unwrap().clone()
}

fn turned(v: Vec2, angle: f64) -> Vec2 {
    let (sin, cos) = angle.sin_cos();
    Vec2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
}

/// The edge beside the darts of an outline once they are closed, as points; the end of one stretch
/// is told twice.
fn closed(stage: &Stage, name: EdgeName) -> Vec<Vec2> {
    let edges = stage.outline();
    let first = edges.iter().position(|edge| edge.name == name).unwrap();
    let mut lay: Box<dyn Fn(Vec2) -> Vec2> = Box::new(|p| p);
    let mut points = Vec::new();
    let mut k = first;
    while k < edges.len() {
        let edge = &edges[k];
        if edge.name == name {
            points.extend((0..=8).map(|j| lay(edge.curve.point(f64::from(j) / 8.0))));
            k += 1;
            continue;
        }
        if edge.name.role() != Some(Role::Leg) {
            break;
        }
        let apex = edge.curve.end();
        let legs = [edge.curve.start() - apex, edges[k + 1].curve.end() - apex];
        assert!((legs[0].norm() - legs[1].norm()).abs() < 1e-12, "{legs:?}");
        let angle = legs[1].perp(&legs[0]).atan2(legs[1].dot(&legs[0]));
        lay = Box::new(move |p| lay(apex + turned(p - apex, angle)));
        k += 2;
    }
    points
}

fn straightness(points: &[Vec2]) -> f64 {
    let (from, to) = (points[0], points[points.len() - 1]);
    let way = (to - from).normalize();
    let away = points.iter().map(|p| way.perp(&(p - from)).abs());
    away.fold(0.0, f64::max)
}

#[test]
fn two_darts_in_a_straight_waist_close_to_one_straight_line() {
    let plain = waist(&[0.3, 0.65], |kind| kind);
    let found = kinks(&plain);
    assert_eq!(found.len(), 2, "{found:?}");
    for kink in &found {
        assert_eq!(kink.severity, Severity::Note);
        assert!(kink.message.contains("top turns by 14.3 degrees"), "{kink}");
        assert!(matches!(kink.place, Place::Operation(..)));
    }
    let pattern = waist(&[0.3, 0.65], trued);
    assert_eq!(kinks(&pattern), []);
    let stage = stage(&pattern);
    let name = Name::Drawn(edge(&pattern, "front", "top"));
    let points = closed(&stage, name);
    assert_eq!(points.len(), 27);
    assert!(straightness(&points) < 1e-12, "{}", straightness(&points));
    let (_, finished) = stage
        .edge_beside(pattern.panels[0].operations[0].id)
        .unwrap();
    let chord = (points[26] - points[0]).norm();
    assert!((finished - chord).abs() < 1e-12);
    let (_, before) = self::stage(&plain)
        .edge_beside(plain.panels[0].operations[0].id)
        .unwrap();
    assert!((before - 0.35).abs() < 1e-12 && finished < before);
    // One by one in the other order it is the same.
    let other = waist(&[0.65, 0.3], trued);
    for (a, b) in closed(&self::stage(&other), name).iter().zip(&points) {
        assert!((a - b).norm() < 1e-12);
    }
}

#[test]
fn on_a_fold_the_waist_meets_it_square() {
    let mut pattern = waist(&[0.3, 0.65], trued);
    let kind = fold(&pattern, "left");
    put_operation(&mut pattern, 0, "fold", kind);
    assert_eq!(kinks(&pattern), []);
    let stage = stage(&pattern);
    let name = Name::Drawn(edge(&pattern, "front", "top"));
    let own: Vec<Curve> = stage
        .outline()
        .iter()
        .filter(|edge| edge.name == name && edge.half == 0)
        .map(|edge| edge.curve)
        .collect();
    let last = own[own.len() - 1];
    assert_eq!(last.end(), Vec2::new(0.0, 0.6));
    assert!(last.derivative(1.0).normalize().y.abs() < 1e-12);
    // It bows smoothly towards the side: the turns of all of it are the darts' angles.
    let first = own[0].derivative(0.0).normalize();
    assert!(first.y.abs() > 0.1, "{first}");
    // A neighbour that goes on straight keeps its direction too.
    let mut pattern = waist(&[0.3, 0.65], trued);
    place(&mut pattern, 0, "p3", PointRule::at(0.2, 0.6));
    let waist = self::stage(&pattern);
    assert!(waist.darts.iter().all(|dart| dart.trued));
}

#[test]
fn sewn_at_both_sides_the_waist_runs_on_across_seams_and_darts() {
    let mut pattern = waist(&[0.3, 0.65], trued);
    let alone = stage(&pattern);
    let sewn = sample();
    pattern.panels.push(sewn.panels[1].clone());
    let mut evaluation = Evaluation::new(&pattern, &Measurements::adult());
    pattern.seams.clone_from(&sewn.seams);
    assert_eq!(kinks(&pattern), []);
    // What is sewn after the darts is taken over by an evaluation that goes on.
    evaluation.update(&pattern, &Measurements::adult());
    let now = evaluation.last_stage(&pattern.panels[0]).unwrap();
    assert!(!now.is_same(&alone) && now.is_same(&stage(&pattern)));
    let name = Name::Drawn(edge(&pattern, "front", "top"));
    let own = now.outline().iter().filter(|edge| edge.name == name);
    let curves: Vec<Curve> = own.map(|edge| edge.curve).collect();
    let ways = [curves[0].derivative(0.0), curves[2].derivative(1.0)];
    assert!(ways.iter().all(|way| way.y.abs() < 1e-12), "{ways:?}");
    let points = closed(now, name);
    assert!(straightness(&points) > 0.005);
}

#[test]
fn marks_notches_and_measures_follow_the_trued_edge() {
    let mut pattern = waist(&[0.3, 0.65], trued);
    let notch = Notch {
        id: pattern.ids.take(),
        name: "n".into(),
        line: outline(&pattern, "front"),
        at: Mark::between(ends(&pattern, "front", "top"), 0.5),
        kind: NotchKind::Slit,
    };
    alter(&mut pattern, 0, |panel| panel.notches.push(notch));
    let finished = formula_in(&pattern, "finished(front.top)");
    let id = put_variable(&mut pattern, "waist", finished);
    let drawn = formula_in(&pattern, "length(front.top)");
    put_variable(&mut pattern, "drawn", drawn);
    let evaluation = Evaluation::new(&pattern, &Measurements::adult());
    let stage = stage(&pattern);
    let name = Name::Drawn(edge(&pattern, "front", "top"));
    let (_, length) = stage
        .edge_beside(pattern.panels[0].operations[0].id)
        .unwrap();
    let value = evaluation.number(&formula_in(&pattern, "waist"), Want::Length);
    assert!((value.unwrap() - length).abs() < 1e-12, "{id}");
    let notch = stage.notches[0];
    let on = stage.outline().iter().filter(|edge| edge.name == name);
    let away = on.map(|edge| {
        let path = toile_geometry::Path::new(vec![edge.curve]);
        (path.point(path.nearest(notch.point).unwrap()) - notch.point).norm()
    });
    assert!(away.fold(f64::INFINITY, f64::min) < 1e-9);
    assert!(notch.inward.y < -0.9);
}

#[test]
fn a_trued_dart_that_is_pivoted_leaves_two() {
    let mut pattern = waist(&[0.45], trued);
    let line = Name::Drawn(outline(&pattern, "front"));
    let kind = OperationKind::Pivot {
        dart: pattern.panels[0].operations[0].id,
        line,
        mouth: Mark::between(ends(&pattern, "front", "right"), 0.6),
        share: 0.5.into(),
        back: 0.03.into(),
        turned: Turned::default(),
        pressed: Pressed::default(),
    };
    put_operation(&mut pattern, 0, "pivot", kind);
    // The side of the back was not turned with it.
    let found = pattern.check(&Measurements::adult());
    let kinks = found
        .iter()
        .filter(|f| matches!(f.place, Place::Operation(..)));
    assert_eq!(kinks.count(), 0, "{found:?}");
    let stage = stage(&pattern);
    for name in ["top", "right"] {
        closed(&stage, Name::Drawn(edge(&pattern, "front", name)));
    }
}

/// Darts that keep the finished length.
fn kept(mut kind: OperationKind) -> OperationKind {
    if let OperationKind::Dart {
        trued,
        keeps_length,
        ..
    } = &mut kind
    {
        (*trued, *keeps_length) = (true, true);
    }
    kind
}

fn finished(pattern: &Pattern) -> Vec<plan::FinishedLength> {
    let evaluation = Evaluation::new(pattern, &Measurements::adult());
    let panel = &pattern.panels[0];
    let steps = panel.operations.iter();
    steps
        .filter_map(|step| plan::finished_length(&evaluation, panel.id, step.id))
        .collect()
}

#[test]
fn a_dart_that_keeps_the_finished_length_gives_it_back_at_its_mouth() {
    // Closed, the trued top is the chord over the angle that the legs leave of it: 40 cm with a dart of
    // 2.5 by 10 cm in its middle.
    let (reach, turn) = (0.2_f64.hypot(0.1), (0.2_f64 / 0.1).atan());
    let chord = |half: f64| 2.0 * reach * (turn - half).sin();
    let trued = waist(&[0.5], trued);
    let [own] = finished(&trued)[..] else {
        panic!("one dart");
    };
    assert!((own.length - chord((0.0125_f64 / 0.1).atan())).abs() < 1e-12);
    assert!(
        (own.untrued - 0.375).abs() < 1e-12 && own.length < 0.3745,
        "{own:?}"
    );
    let pattern = waist(&[0.5], kept);
    assert_eq!(kinks(&pattern), []);
    let [own] = finished(&pattern)[..] else {
        panic!("one dart");
    };
    assert!((own.length - 0.375).abs() < 1e-11, "{own:?}");
    let half = turn - (0.375 / (2.0 * reach)).asin();
    let dart = &stage(&pattern).darts[0];
    let legs = dart.mouth.map(|end| end - dart.apex);
    let angle = legs[0].perp(&legs[1]).abs().atan2(legs[0].dot(&legs[1]));
    assert!((angle - 2.0 * half).abs() < 1e-9, "{angle}");
    assert!((legs[0].norm() - legs[1].norm()).abs() < 1e-12);
    // Each of two, on a straight edge, a bowed one, one that goes on in a fold.
    let mut bowed = waist(&[0.3, 0.65], kept);
    bend(&mut bowed, 0, "top", CurveRule::Arc { bulge: 0.1.into() });
    let plain = waist(&[], kept);
    let drawn = |pattern: &Pattern| {
        let evaluation = Evaluation::new(pattern, &Measurements::adult());
        evaluation
            .edge(edge(pattern, "front", "top"))
            .unwrap()
            .length()
    };
    assert!((drawn(&plain) - 0.4).abs() < 1e-12 && drawn(&bowed) > 0.4);
    let mut folded = waist(&[0.3, 0.65], kept);
    let kind = fold(&folded, "left");
    put_operation(&mut folded, 0, "fold", kind);
    for pattern in [waist(&[0.3, 0.65], kept), bowed, folded] {
        let own = finished(&pattern);
        assert_eq!(own.len(), 2);
        for own in own {
            let wanted = drawn(&pattern) - 2.0 * 0.025;
            assert!((own.length - wanted).abs() < 1e-10, "{own:?} {wanted}");
        }
        let found = pattern.check(&Measurements::adult());
        let on_step = |f: &&Diagnostic| matches!(f.place, Place::Operation(..));
        assert_eq!(found.iter().filter(on_step).count(), 0, "{found:?}");
    }
}

#[test]
fn a_dart_whose_point_is_near_its_edge_is_not_trued_and_says_so() {
    // Deep enough it is trued; the nearer its point, the farther would its legs run.
    for (depth, is_trued) in [(0.1, true), (0.08, true), (0.015, false), (0.005, false)] {
        for on_fold in [false, true] {
            let mut pattern = waist(&[], trued);
            let kind = dart(&pattern, "top", 0.5, 0.03, Apex::Depth(depth.into()));
            put_operation(&mut pattern, 0, "dart", trued(kind));
            if on_fold {
                let kind = fold(&pattern, "left");
                put_operation(&mut pattern, 0, "fold", kind);
            }
            let found = pattern.check(&Measurements::adult());
            let told: Vec<&Diagnostic> =
                found.iter().filter(|f| f.code == Code::NotTrued).collect();
            assert_eq!(told.is_empty(), is_trued, "{depth} {on_fold}: {found:?}");
            let stage = stage(&pattern);
            let leg = (stage.darts[0].mouth[0] - stage.darts[0].apex).norm();
            let drawn = 0.015_f64.hypot(depth);
            if !is_trued {
                assert!(told[0].message.contains("so near the edge"), "{}", told[0]);
                assert_eq!(told[0].severity, Severity::Warning);
                assert!((leg - drawn).abs() < 1e-12, "{depth}: {leg}");
            }
            assert!(leg < 2.0 * drawn + 1e-12, "{depth}: {leg} of {drawn}");
        }
    }
}

#[test]
fn a_kink_that_is_meant_is_not_told() {
    let mut pattern = waist(&[0.5], |kind| kind);
    assert_eq!(kinks(&pattern).len(), 1);
    alter(&mut pattern, 0, |panel| {
        Arc::make_mut(&mut panel.operations[0]).meant = true;
    });
    assert_eq!(kinks(&pattern), []);
    // The front's waist falls to the side: the line turns across the seam.
    let mut pattern = sample();
    place(&mut pattern, 0, "p3", PointRule::at(0.0, 0.64));
    place(&mut pattern, 1, "p2", PointRule::at(0.4, 0.64));
    let found = kinks(&pattern);
    assert!(!found.is_empty());
    for kink in &found {
        assert!(matches!(kink.place, Place::SeamEnd(..)), "{kink}");
        assert!(kink.message.contains("degrees"), "{kink}");
    }
    let corners = [(0, "top"), (0, "left"), (1, "top"), (1, "right")];
    for (k, name) in corners {
        alter(&mut pattern, k, |panel| {
            let edges = panel.lines.iter_mut().flat_map(|line| &mut line.edges);
            for edge in edges.filter(|edge| edge.name == name) {
                edge.corner.meant = true;
            }
        });
    }
    assert_eq!(kinks(&pattern), []);
}

#[test]
fn pleats_close_to_the_edge_as_drawn() {
    let mut pattern = sample();
    bend(&mut pattern, 0, "top", CurveRule::Arc { bulge: 0.2.into() });
    let line = Name::Drawn(outline(&pattern, "front"));
    let kind = OperationKind::Pleat {
        line,
        held: Mark::between(ends(&pattern, "front", "right"), 0.5),
        pleats: vec![PleatLine {
            number: 0,
            ends: ["top", "bottom"].map(|name| Mark::between(ends(&pattern, "front", name), 0.4)),
        }],
        depth: 0.02.into(),
        kind: PleatKind::Knife,
        pressed: Side::Left,
        trued: true,
    };
    put_operation(&mut pattern, 0, "pleat", kind);
    let found = pattern.check(&Measurements::adult());
    let on_step = |f: &&Diagnostic| f.code == Code::Kink && matches!(f.place, Place::Operation(..));
    assert_eq!(found.iter().filter(on_step).count(), 0, "{found:?}");
}

#[test]
fn journals_of_earlier_versions_have_the_kind_of_a_corner_alone() {
    let limit = MitreLimit::None;
    let whole = EdgeCorner {
        kind: Corner::Bevel,
        limit,
        meant: true,
    };
    let text = serde_json::to_string(&whole).unwrap();
    for (text, corner) in [
        (&*text, whole),
        ("null", EdgeCorner::default()),
        (
            "\"bevel\"",
            EdgeCorner {
                kind: Corner::Bevel,
                ..EdgeCorner::default()
            },
        ),
    ] {
        assert_eq!(serde_json::from_str::<EdgeCorner>(text).unwrap(), corner);
    }
}
