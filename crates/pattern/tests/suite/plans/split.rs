//! Panels split in two: sides that follow their panel in every size, sewn in its place.

use super::*;
use crate::sample::{
    alter, bend, dart, ends, fold, outline, place, point, put_operation, put_point, sample,
};

/// A curve across the k-th panel's sheet, from a share of its left edge to one of its right.
fn across(pattern: &mut Pattern, k: usize, [left, right]: [f64; 2]) -> CurveId {
    let sheet = pattern.sheets[k].clone();
    let on = |name: &str, share: f64| PointRule::OnCurve {
        curve: sheet.curve_named(name).unwrap().id,
        share: share.into(),
    };
    let start = put_point(pattern, k, "cut left", on("left", left));
    let end = put_point(pattern, k, "cut right", on("right", right));
    let shape = plan::CurveShape::Rule(CurveRule::Arc { bulge: 0.1.into() });
    let ends = [start, end];
    let (edits, curve) =
        plan::add_curve(&evaluated(pattern), (sheet.id, None), ends, shape).unwrap();
    *pattern = done(pattern, &edits);
    curve
}

fn split(pattern: &mut Pattern, k: usize, curve: CurveId) -> plan::SplitPanel {
    let panel = pattern.panels[k].clone();
    let wish = plan::SplitWish {
        line: Name::Drawn(panel.outline().unwrap().id),
        curve,
        joined: plan::Joined::Sewn,
    };
    let (edits, found) = plan::split_panel(&evaluated(pattern), panel.id, wish).unwrap();
    *pattern = done(pattern, &edits);
    found
}

fn area_of(stage: &Stage) -> f64 {
    0.5 * stage
        .outline()
        .iter()
        .map(|e| e.curve.swept_area())
        .sum::<f64>()
}

fn length_of(stages: &[&Stage], name: EdgeName) -> f64 {
    let lines = stages.iter().flat_map(|stage| &stage.lines);
    let own = lines
        .flat_map(|line| &line.edges)
        .filter(|e| e.name == name);
    own.map(|edge| edge.curve.length()).sum()
}

fn cut_edge(split: &plan::SplitPanel, index: u16) -> EdgeName {
    Name::Made {
        by: split.operation,
        role: Role::Split,
        index,
    }
}

#[test]
fn both_sides_together_are_the_panel_in_every_size() {
    let mut pattern = sample();
    place(
        &mut pattern,
        0,
        "p1",
        PointRule::At {
            x: crate::sample::formula("bust / 4"),
            y: 0.0.into(),
        },
    );
    bend(
        &mut pattern,
        0,
        "top",
        CurveRule::Arc { bulge: 0.05.into() },
    );
    let curve = across(&mut pattern, 0, [0.4, 0.5]);
    let found = split(&mut pattern, 0, curve);
    let front = pattern.panels[0].clone();
    for body in bodies() {
        let evaluation = Evaluation::new(&pattern, &body);
        assert_eq!(evaluation.diagnostics(), []);
        let whole = evaluation.stage(front.id, None).unwrap();
        let sides = found.sides.map(|id| &**evaluation.stage(id, None).unwrap());
        let sum: f64 = sides.iter().map(|side| area_of(side)).sum();
        assert!((sum - area_of(whole)).abs() < 1e-12, "{sum}");
        for edge in front.edges() {
            let name = Name::Drawn(edge.id);
            let (own, parts) = (length_of(&[whole], name), length_of(&sides, name));
            assert!((own - parts).abs() < 1e-9, "{}: {own} {parts}", edge.name);
        }
        let along = evaluation.curve(curve).unwrap().length();
        for (index, side) in (0..).zip(sides) {
            assert!((length_of(&[side], cut_edge(&found, index)) - along).abs() < 1e-9);
            assert!(area_of(side) > 0.0, "counter-clockwise");
        }
        // Left of a curve from left to right is above it.
        assert!(sides[0].outline().iter().all(|e| e.curve.start().y > 0.25));
        let (draft, findings) = evaluation.draft();
        assert!(findings.is_empty(), "{findings:?}");
        let names: Vec<&str> = draft.pieces.iter().map(|piece| &*piece.name).collect();
        assert_eq!(names, ["back", "front left", "front right"]);
        assert!(draft.pieces.iter().all(|piece| piece.sewn));
        let joined = draft
            .seams
            .iter()
            .find(|seam| seam.name == "front joined")
            .unwrap();
        assert_eq!(joined.sides.clone().map(|side| side.len()), [1, 1]);
        let side = draft
            .seams
            .iter()
            .find(|seam| seam.name == "one side")
            .unwrap();
        assert_eq!(side.sides[0].len(), 2, "a stretch of either side");
    }
    let (draft, _) = evaluated(&pattern).draft();
    let told = check_draft(&draft);
    assert!(told.is_empty(), "{told:?}");
}

#[test]
fn sides_have_notches_and_operations_of_their_panel_and_their_own() {
    let mut pattern = sample();
    let kind = dart(&pattern, "top", 0.5, 0.03, Apex::Depth(0.1.into()));
    let upper_dart = put_operation(&mut pattern, 0, "dart", kind);
    let line = outline(&pattern, "front");
    let at = Mark::between(ends(&pattern, "front", "right"), 0.1);
    let (edits, low) = plan::add_notch(
        &evaluated(&pattern),
        pattern.panels[0].id,
        (line, at),
        NotchKind::V,
    )
    .unwrap();
    let mut pattern = done(&pattern, &edits);
    let curve = across(&mut pattern, 0, [0.5, 0.5]);
    let found = split(&mut pattern, 0, curve);
    let [upper, lower] = found.sides;
    let corner = |index| Name::Made {
        by: found.operation,
        role: Role::Split,
        index,
    };
    let kind = OperationKind::Dart {
        line: Name::Drawn(line),
        mouth: Mark::Between {
            ends: [corner(1), corner(0)],
            share: 0.5.into(),
        },
        intake: 0.02.into(),
        apex: Apex::Depth(0.08.into()),
        trued: false,
        keeps_length: false,
        pressed: Pressed::default(),
    };
    // Along the lower side the cut runs from its end back to its start.
    let (edits, lower_dart) = plan::add_operation(&evaluated(&pattern), lower, kind).unwrap();
    let pattern = done(&pattern, &edits);
    let own = Notch {
        id: NotchId(pattern.ids.next),
        name: "own".into(),
        line,
        at: Mark::between(ends(&pattern, "front", "left"), 0.9),
        kind: NotchKind::T,
    };
    let mut pattern = pattern;
    let k = pattern
        .panels
        .iter()
        .position(|panel| panel.id == lower)
        .unwrap();
    pattern.ids.reserve(own.id.0);
    alter(&mut pattern, k, |panel| panel.notches.push(own.clone()));
    let evaluation = evaluated(&pattern);
    assert_eq!(evaluation.diagnostics(), []);
    let panels = [upper, lower].map(|id| pattern.panel(id).unwrap());
    let [above, below] = panels.map(|panel| evaluation.last_stage(panel).unwrap());
    let darts = |stage: &Stage| stage.darts.iter().map(|d| d.by).collect::<Vec<_>>();
    assert_eq!(
        (darts(above), darts(below)),
        (vec![upper_dart], vec![lower_dart])
    );
    let notches = |stage: &Stage| stage.notches.iter().map(|n| n.id).collect::<Vec<_>>();
    assert_eq!(
        (notches(above), notches(below)),
        (vec![], vec![low, own.id])
    );
    let placed = below.notches.iter().find(|n| n.id == own.id).unwrap();
    same_place(placed.point, v(0.0, 0.06));
    let (draft, _) = evaluation.draft();
    let sewn = |id| {
        draft
            .seams
            .iter()
            .any(|s| matches!(s.id, SeamOrigin::Dart { dart, .. } if dart == id))
    };
    assert!(sewn(upper_dart) && sewn(lower_dart));
    // A notch of a side on what the other side has is told.
    let left = ends(&pattern, "front", "left");
    alter(&mut pattern, k, |panel| {
        panel.notches[0].at = Mark::between(left, 0.1);
    });
    let told = evaluated(&pattern).diagnostics();
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(
        told[0].message.contains("its place is not there"),
        "{told:?}"
    );
}

#[test]
fn a_side_follows_what_happens_to_its_panel_before() {
    let mut pattern = sample();
    pattern.seams.clear();
    let curve = across(&mut pattern, 0, [0.5, 0.5]);
    let found = split(&mut pattern, 0, curve);
    let mut evaluation = evaluated(&pattern);
    let [upper, _] = found.sides;
    let mut moved = pattern.clone();
    place(&mut moved, 0, "p2", PointRule::at(0.5, 0.7));
    let body = Measurements::adult();
    evaluation.update(&moved, wearer(&moved, &body));
    let has_corner = |evaluation: &Evaluation, at: Vec2| {
        let stage = evaluation.stage(upper, None).unwrap();
        stage
            .outline()
            .iter()
            .any(|e| (e.curve.start() - at).norm() < 1e-12)
    };
    assert!(has_corner(&evaluation, v(0.5, 0.7)));
    // An operation put before the split is in both.
    let kind = dart(&moved, "top", 0.5, 0.02, Apex::Depth(0.1.into()));
    let front = moved.panels[0].id;
    let (edits, id) = plan::add_operation(&evaluation, front, kind).unwrap();
    let with_dart = done(&moved, &edits);
    let edits = plan::move_operation(&evaluated(&with_dart), (front, id), 0).unwrap();
    let with_dart = done(&with_dart, &edits);
    evaluation.update(&with_dart, wearer(&with_dart, &body));
    assert_eq!(evaluation.stage(upper, None).unwrap().darts.len(), 1);
    let fresh = evaluated(&with_dart);
    assert!(
        fresh
            .stage(upper, None)
            .unwrap()
            .is_same(evaluation.stage(upper, None).unwrap())
    );
    // Without the split both sides wait and say so; they are back when it is.
    let edits = plan::remove_operation(&evaluation, (front, found.operation)).unwrap();
    let without = done(&with_dart, &edits);
    evaluation.update(&without, wearer(&without, &body));
    let told = evaluation.diagnostics();
    assert_eq!(told.len(), 2, "both panels, not their seam: {told:?}");
    assert!(
        told.iter()
            .any(|d| d.message.contains("is not split any more")),
        "{told:?}"
    );
    evaluation.update(&with_dart, wearer(&with_dart, &body));
    assert_eq!(evaluation.diagnostics(), []);
    // A split that cannot be done is told once, where it is.
    let mut short = with_dart.clone();
    let end = point(&short, "front", "cut right");
    let sheet = short.sheets[0].clone();
    let found_point = sheet.point(end).unwrap();
    let away = Point {
        rule: PointRule::at(0.2, 0.2),
        ..(**found_point).clone()
    };
    short
        .apply(&[Edit::Put(Entity::Point(
            sheet.id,
            std::sync::Arc::new(away),
        ))])
        .unwrap();
    let told = evaluated(&short).diagnostics();
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(
        told[0].message.contains("meets the outline in one place"),
        "{told:?}"
    );
    assert_eq!(told[0].place, Place::Operation(front, found.operation));
}

#[test]
fn a_folded_panel_is_split_into_folded_ones() {
    let mut pattern = sample();
    pattern.seams.clear();
    let kind = fold(&pattern, "left");
    put_operation(&mut pattern, 0, "fold", kind);
    let curve = across(&mut pattern, 0, [0.5, 0.4]);
    let found = split(&mut pattern, 0, curve);
    let evaluation = evaluated(&pattern);
    assert_eq!(evaluation.diagnostics(), []);
    let whole = area_of(evaluation.last_stage(&pattern.panels[0]).unwrap());
    let sides = found
        .sides
        .map(|id| evaluation.last_stage(pattern.panel(id).unwrap()).unwrap());
    assert!(sides.iter().all(|side| side.folds.len() == 1));
    let sum: f64 = sides.iter().map(|side| area_of(side)).sum();
    assert!((sum - whole).abs() < 1e-12, "{sum} {whole}");
    let (draft, findings) = evaluation.draft();
    assert!(findings.is_empty(), "{findings:?}");
    assert_eq!(draft.seams.len(), 2, "one a half");
    assert_eq!(
        draft
            .pieces
            .iter()
            .filter(|p| p.id.panel != pattern.panels[1].id)
            .count(),
        2
    );
}

#[test]
fn a_side_is_split_again() {
    let mut pattern = sample();
    pattern.seams.clear();
    let curve = across(&mut pattern, 0, [0.5, 0.5]);
    let first = split(&mut pattern, 0, curve);
    let sheet = pattern.sheets[0].id;
    let low = dot(&mut pattern, sheet, PointRule::at(0.2, -0.1));
    let high = dot(&mut pattern, sheet, PointRule::at(0.2, 0.29));
    let down = straight(&mut pattern, sheet, [high, low]);
    let k = pattern
        .panels
        .iter()
        .position(|panel| panel.id == first.sides[1])
        .unwrap();
    let wish = plan::SplitWish {
        line: Name::Drawn(outline(&pattern, "front")),
        curve: down,
        joined: plan::Joined::Sewn,
    };
    let (edits, second) =
        plan::split_panel(&evaluated(&pattern), pattern.panels[k].id, wish).unwrap();
    let pattern = done(&pattern, &edits);
    let evaluation = evaluated(&pattern);
    assert_eq!(evaluation.diagnostics(), []);
    let stage = |id: PanelId| evaluation.stage(id, None).unwrap();
    let parts = [first.sides[0], second.sides[0], second.sides[1]].map(|id| area_of(stage(id)));
    assert!(
        (parts.iter().sum::<f64>() - 0.24).abs() < 1e-12,
        "{parts:?}"
    );
    // The first cut's seam has gone over to both parts of the lower side.
    let (draft, findings) = evaluation.draft();
    assert!(findings.is_empty(), "{findings:?}");
    let joined = draft
        .seams
        .iter()
        .find(|seam| seam.name == "front joined")
        .unwrap();
    assert_eq!(joined.sides.clone().map(|side| side.len()), [1, 2]);
}

#[test]
fn splits_that_cannot_be_done_are_refused() {
    let mut pattern = sample();
    let sheet = pattern.sheets[0].id;
    let dots = [
        (-0.1, 0.3),
        (0.2, 0.3),
        (0.5, 0.3),
        (0.1, 0.2),
        (0.3, 0.2),
        (0.2, 0.7),
    ]
    .map(|(x, y)| dot(&mut pattern, sheet, PointRule::at(x, y)));
    let half = straight(&mut pattern, sheet, [dots[0], dots[1]]);
    let inside = straight(&mut pattern, sheet, [dots[3], dots[4]]);
    let whole = straight(&mut pattern, sheet, [dots[0], dots[2]]);
    let foreign = pattern.sheets[1].curves[0].id;
    let front = pattern.panels[0].id;
    let line = Name::Drawn(outline(&pattern, "front"));
    let wish = |curve: CurveId, line: LineName| {
        let joined = plan::Joined::Apart;
        plan::split_panel(
            &evaluated(&pattern),
            front,
            plan::SplitWish {
                line,
                curve,
                joined,
            },
        )
    };
    for (found, says) in [
        (wish(half, line), "meets the outline in one place"),
        (wish(inside, line), "does not meet the outline"),
        (wish(foreign, line), "is on sheet \"back\""),
        (
            wish(whole, Name::Drawn(outline(&pattern, "back"))),
            "its line is not there",
        ),
        (wish(CurveId(9999), line), "was never given"),
    ] {
        let told = refusal(found);
        assert!(told.contains(says), "{told} should say {says}");
    }
    // A curve that reaches beyond the panel is followed within it.
    let (edits, found) = wish(whole, line).unwrap();
    let split = done(&pattern, &edits);
    let evaluation = evaluated(&split);
    let side = evaluation.stage(found.sides[0], None).unwrap();
    assert!((area_of(side) - 0.12).abs() < 1e-12);
    // Sewing the panel itself is told.
    let mut wrong = split.clone();
    crate::sample::alter_seam(&mut wrong, 0, |seam| {
        seam.sides[0] = vec![crate::sample::span(&pattern, "front", "right")];
    });
    let told = evaluated(&wrong).diagnostics();
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(
        told[0]
            .message
            .contains("which is split and not cut itself"),
        "{told:?}"
    );
}
