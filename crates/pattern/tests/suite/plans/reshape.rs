//! Darts pivoted and panels spread: angles conserved, legs trued, openings as asked, all else rigid.

use super::*;
use crate::sample::{
    alter, alter_seam, bend, dart, edge, ends, fold, outline, put_operation, put_point,
    rich_sample, sample,
};
use std::collections::BTreeMap;

/// Length of every named edge of a stage, all its parts together (m).
fn lengths(stage: &Stage) -> BTreeMap<EdgeName, f64> {
    let mut found = BTreeMap::new();
    for edge in stage.lines.iter().flat_map(|line| &line.edges) {
        *found.entry(edge.name).or_insert(0.0) += edge.curve.length();
    }
    found
}

/// Everything that was there is as long as it was, but what is left out.
#[track_caller]
fn untouched(before: &Stage, after: &Stage, but: impl Fn(EdgeName) -> bool) {
    let now = lengths(after);
    for (name, length) in lengths(before) {
        if !but(name) {
            let left = now.get(&name).copied().unwrap_or(0.0);
            assert!(
                (left - length).abs() < 1e-9,
                "{name:?}: {length} became {left}"
            );
        }
    }
}

fn made(by: OperationId, role: Role, index: u16) -> EdgeName {
    Name::Made { by, role, index }
}

fn leg_length(stage: &Stage, by: OperationId, index: u16) -> f64 {
    lengths(stage)[&made(by, Role::Leg, index)]
}

fn found(stage: &Stage, by: OperationId) -> StageDart {
    *stage.darts.iter().find(|dart| dart.by == by).unwrap()
}

/// Angle a dart takes in, about where it pivots.
fn angle(dart: &StageDart) -> f64 {
    let [a, b] = dart.mouth.map(|end| end - dart.pivot);
    a.perp(&b).atan2(a.dot(&b)).abs()
}

fn outline_area(stage: &Stage) -> f64 {
    0.5 * stage
        .outline()
        .iter()
        .map(|e| e.curve.swept_area())
        .sum::<f64>()
}

/// Every edge starts where the one before it ends.
#[track_caller]
fn closed(stage: &Stage) {
    let edges = stage.outline();
    for (k, edge) in edges.iter().enumerate() {
        let before = &edges[(k + edges.len() - 1) % edges.len()];
        assert_eq!(before.curve.end(), edge.curve.start(), "{:?}", edge.name);
    }
}

/// The sample with a bent side, and a dart in its front's top.
fn with_dart() -> (Pattern, OperationId) {
    let mut pattern = sample();
    bend(
        &mut pattern,
        0,
        "right",
        CurveRule::Arc {
            bulge: (-0.1).into(),
        },
    );
    let kind = dart(&pattern, "top", 0.5, 0.04, Apex::Depth(0.2.into()));
    let id = put_operation(&mut pattern, 0, "dart", kind);
    (pattern, id)
}

fn to_edge(pattern: &Pattern, dart: OperationId, name: &str, share: f64) -> plan::PivotWish {
    let line = Name::Drawn(outline(pattern, "front"));
    plan::PivotWish {
        dart,
        mouth: (line, Mark::between(ends(pattern, "front", name), 0.5)),
        share: share.into(),
        back: if share < 1.0 { 0.02 } else { 0.0 }.into(),
        turned: None,
    }
}

fn pivot(pattern: &mut Pattern, wish: plan::PivotWish) -> OperationId {
    let front = pattern.panels[0].id;
    let (edits, id) = plan::pivot_dart(&evaluated(pattern), front, wish).unwrap();
    *pattern = done(pattern, &edits);
    id
}

#[test]
fn a_pivoted_dart_takes_in_the_same_angle_in_two_places() {
    for share in [0.25, 0.5, 0.9] {
        for turned in [Turned::FromDart, Turned::ToDart] {
            let (mut pattern, dart) = with_dart();
            let wish = plan::PivotWish {
                turned: Some(turned),
                ..to_edge(&pattern, dart, "right", share)
            };
            let by = pivot(&mut pattern, wish);
            let evaluation = evaluated(&pattern);
            assert_eq!(evaluation.diagnostics(), []);
            let front = pattern.panels[0].id;
            let before = evaluation.stage(front, Some(dart)).unwrap();
            let after = evaluation.stage(front, Some(by)).unwrap();
            closed(after);
            let whole = angle(&found(before, dart));
            let (old, new) = (found(after, dart), found(after, by));
            assert!((angle(&new) - share * whole).abs() < 1e-12);
            assert!((angle(&old) - (1.0 - share) * whole).abs() < 1e-12);
            for id in [dart, by] {
                let trued = leg_length(after, id, 0) - leg_length(after, id, 1);
                assert!(trued.abs() < 1e-12, "{trued}");
            }
            let legs = [0, 1].map(|leg| made(dart, Role::Leg, leg));
            untouched(before, after, |name| legs.contains(&name));
            assert!((new.apex - new.pivot).norm() - 0.02 < 1e-12);
            // What is not turned stays to the bit.
            let still = match turned {
                Turned::FromDart => edge(&pattern, "front", "top"),
                Turned::ToDart => edge(&pattern, "front", "left"),
            };
            let curve = |stage: &Stage| {
                let mut edges = stage.outline().iter();
                edges.find(|e| e.name == Name::Drawn(still)).unwrap().curve
            };
            assert_eq!(curve(before), curve(after));
        }
    }
}

#[test]
fn a_dart_moved_whole_is_closed_and_its_corners_are_one() {
    let (mut pattern, dart) = with_dart();
    let wish = to_edge(&pattern, dart, "right", 1.0);
    let by = pivot(&mut pattern, wish);
    let front = pattern.panels[0].clone();
    let evaluation = evaluated(&pattern);
    let before = evaluation.stage(front.id, Some(dart)).unwrap();
    let after = evaluation.stage(front.id, Some(by)).unwrap();
    closed(after);
    assert!((outline_area(before) - outline_area(after)).abs() < 1e-12);
    assert_eq!(after.darts.len(), 1);
    let [mouth, whole] = [found(after, by), found(before, dart)];
    assert!((angle(&mouth) - angle(&whole)).abs() < 1e-12);
    // The top is one stretch again, and both ends of the old mouth are places on it.
    let top = Name::Drawn(outline(&pattern, "front"));
    for (index, distance) in [(0, -0.05), (1, 0.05)] {
        let kind = OperationKind::Dart {
            line: top,
            mouth: Mark::Along {
                from: Name::Made {
                    by: dart,
                    role: Role::Mouth,
                    index,
                },
                distance: distance.into(),
            },
            intake: 0.01.into(),
            apex: Apex::Depth(0.05.into()),
            trued: false,
            keeps_length: false,
            pressed: Pressed::default(),
        };
        let found = plan::add_operation(&evaluation, front.id, kind);
        assert!(found.is_ok(), "{found:?}");
    }
    // A seam along the top is as long as without any dart's mouth.
    let (draft, findings) = evaluation.draft();
    assert!(findings.is_empty(), "{findings:?}");
    assert!(check_draft(&draft).is_empty(), "{:?}", check_draft(&draft));
}

#[test]
fn a_part_is_turned_that_has_not_the_fold() {
    let (mut pattern, dart) = with_dart();
    pattern.seams.clear();
    let kind = fold(&pattern, "left");
    put_operation(&mut pattern, 0, "fold", kind);
    // The outline runs from the dart down the left side first.
    let wish = to_edge(&pattern, dart, "bottom", 0.5);
    let by = pivot(&mut pattern, wish);
    let front = pattern.panels[0].clone();
    let own = front.operations.iter().find(|o| o.id == by).unwrap();
    assert!(matches!(
        own.kind,
        OperationKind::Pivot {
            turned: Turned::ToDart,
            ..
        }
    ));
    let place = front.step_of(by).unwrap();
    assert_eq!(place, 2, "before the fold");
    let evaluation = evaluated(&pattern);
    assert_eq!(evaluation.diagnostics(), []);
    assert_eq!(evaluation.last_stage(&front).unwrap().darts.len(), 4);
}

#[test]
fn pivots_that_cannot_be_done_are_refused() {
    let (pattern, dart) = with_dart();
    let front = pattern.panels[0].id;
    let wish = |change: &dyn Fn(&mut plan::PivotWish)| {
        let mut wish = to_edge(&pattern, dart, "right", 0.5);
        change(&mut wish);
        refusal(plan::pivot_dart(&evaluated(&pattern), front, wish))
    };
    let line = Name::Drawn(outline(&pattern, "front"));
    let at_mouth = Mark::Corner(Name::Made {
        by: dart,
        role: Role::Mouth,
        index: 0,
    });
    for (told, says) in [
        (
            wish(&|w| w.back = 0.0.into()),
            "both darts end in one point",
        ),
        (wish(&|w| w.back = 1.0.into()), "less than a leg is long"),
        (wish(&|w| w.share = 1.5.into()), "from 0 to 1"),
        (
            wish(&|w| w.mouth = (line, at_mouth.clone())),
            "lies on a dart",
        ),
        (wish(&|w| w.dart = OperationId(9999)), "was never given"),
        (
            wish(&|w| w.dart = OperationId(pattern.panels[0].id.0)),
            "is of another kind",
        ),
        (
            wish(&|w| w.mouth.0 = Name::Drawn(outline(&pattern, "back"))),
            "its line is not there",
        ),
    ] {
        assert!(told.contains(says), "{told}");
    }
}

#[test]
fn a_pivot_waits_for_its_dart() {
    let (mut pattern, dart) = with_dart();
    let wish = to_edge(&pattern, dart, "right", 0.5);
    let by = pivot(&mut pattern, wish);
    let front = pattern.panels[0].id;
    let edits = plan::remove_operation(&evaluated(&pattern), (front, dart)).unwrap();
    let without = done(&pattern, &edits);
    let findings = evaluated(&without).diagnostics();
    assert_eq!(findings.len(), 1, "{findings:?}");
    assert_eq!(findings[0].place, Place::Operation(front, by));
    assert!(
        findings[0]
            .message
            .contains("its dart is not there any more"),
        "{findings:?}"
    );
    // A dart that cannot be made is told at the dart alone.
    alter(&mut pattern, 0, |panel| {
        let operation = std::sync::Arc::make_mut(&mut panel.operations[0]);
        if let OperationKind::Dart { intake, .. } = &mut operation.kind {
            *intake = 0.9.into();
        }
    });
    let findings = evaluated(&pattern).diagnostics();
    assert_eq!(findings.len(), 1, "{findings:?}");
    assert_eq!(findings[0].place, Place::Operation(front, dart));
}

fn spread(pattern: &mut Pattern, wish: plan::SpreadWish) -> OperationId {
    let front = pattern.panels[0].id;
    let (edits, id) = plan::spread_panel(&evaluated(pattern), front, wish).unwrap();
    *pattern = done(pattern, &edits);
    id
}

fn flare(pattern: &Pattern, count: u16, openings: [f64; 2]) -> plan::SpreadWish {
    let edges = ["bottom", "top"].map(|name| edge(pattern, "front", name));
    let front = pattern.panels[0].id;
    let (line, cuts) = plan::even_cuts(&evaluated(pattern), front, edges, count).unwrap();
    plan::SpreadWish {
        line,
        cuts: cuts
            .into_iter()
            .map(|cut| (cut, openings.map(Number::from)))
            .collect(),
        held: None,
        bridge: Bridge::Straight,
    }
}

#[test]
fn a_panel_opens_along_cuts_as_asked_and_is_rigid_between() {
    for (count, openings) in [
        (1, [0.05, 0.0]),
        (3, [0.04, 0.0]),
        (3, [0.03, 0.03]),
        (5, [0.01, 0.03]),
        (2, [0.0, 0.05]),
        (4, [0.0, 0.0]),
    ] {
        for held in ["bottom", "top", "right"] {
            let mut pattern = sample();
            bend(
                &mut pattern,
                0,
                "bottom",
                CurveRule::Arc { bulge: 0.1.into() },
            );
            let wish = plan::SpreadWish {
                held: Some(Mark::between(ends(&pattern, "front", held), 0.6)),
                ..flare(&pattern, count, openings)
            };
            let by = spread(&mut pattern, wish);
            let front = pattern.panels[0].id;
            let evaluation = evaluated(&pattern);
            let faults = evaluation.diagnostics();
            assert_eq!(faults, []);
            let before = evaluation.stage(front, None).unwrap();
            let after = evaluation.stage(front, Some(by)).unwrap();
            closed(after);
            untouched(before, after, |_| false);
            let now = lengths(after);
            for cut in 0..count {
                for (end, asked) in (0..).zip(openings) {
                    let name = made(by, Role::Opening, 2 * cut + end);
                    let opening = now.get(&name).copied().unwrap_or(0.0);
                    assert!((opening - asked).abs() < 1e-12, "{opening} for {asked}");
                }
            }
            // Trapezoids are added, one a cut.
            let length = |k: u16| {
                let share = f64::from(k) / f64::from(count + 1);
                let path = evaluation.edge(edge(&pattern, "front", "bottom")).unwrap();
                let start = path.point(path.at_length(path.length() * share).unwrap());
                (Vec2::new(0.4 * share, 0.6) - start).norm()
            };
            let added: f64 = (1..=count)
                .map(|k| {
                    let [a, b] = openings;
                    0.5 * (a + b) * (length(k).powi(2) - 0.25 * (a - b).powi(2)).sqrt()
                })
                .sum();
            let area = outline_area(after) - outline_area(before);
            assert!((area - added).abs() < 1e-9, "{area} for {added}");
        }
    }
}

#[test]
fn seams_and_finished_lengths_go_across_openings() {
    let mut pattern = sample();
    let number = crate::sample::formula_in(&pattern, "finished(front.bottom)");
    let variable = crate::sample::put_variable(&mut pattern, "hem", number);
    let hem = Seam::new(
        pattern.ids.take(),
        "hem",
        [
            vec![crate::sample::span(&pattern, "front", "bottom")],
            vec![crate::sample::span(&pattern, "back", "bottom").reversed()],
        ],
    );
    pattern.seams.push(std::sync::Arc::new(hem));
    alter_seam(&mut pattern, 2, |seam| seam.gathered = true);
    let wish = flare(&pattern, 3, [0.04, 0.0]);
    spread(&mut pattern, wish);
    let evaluation = evaluated(&pattern);
    let hem = evaluation.variable(variable).unwrap().0;
    assert!((hem - 0.52).abs() < 1e-12, "{hem}");
    let (draft, findings) = evaluation.draft();
    assert!(findings.is_empty(), "{findings:?}");
    let seam = draft.seams.iter().find(|seam| seam.name == "hem").unwrap();
    assert_eq!(seam.sides[0].len(), 7, "four stretches and three openings");
}

#[test]
fn notches_lines_and_darts_move_with_their_part() {
    let mut pattern = rich_sample();
    let points = [(0.05, 0.1), (0.35, 0.1)]
        .map(|(x, y)| put_point(&mut pattern, 0, &format!("q{x}"), PointRule::at(x, y)));
    crate::sample::put_line(&mut pattern, 0, ("across", LineKind::Internal), &points);
    let mut wish = flare(&pattern, 1, [0.06, 0.06]);
    wish.held = Some(Mark::corner(ends(&pattern, "front", "left")[1]));
    wish.cuts[0].0 = [("bottom", 0.3), ("top", 0.7)]
        .map(|(name, share)| Mark::between(ends(&pattern, "front", name), share));
    let by = spread(&mut pattern, wish);
    let evaluation = evaluated(&pattern);
    let front = pattern.panels[0].clone();
    let before = evaluation
        .stage(front.id, Some(front.operations[0].id))
        .unwrap();
    let after = evaluation.stage(front.id, Some(by)).unwrap();
    // All that is right of the cut is 6 cm further right: the side's notch too.
    let moved = |stage: &Stage| {
        stage
            .notches
            .iter()
            .find(|n| n.id == front.notches[0].id)
            .unwrap()
            .point
    };
    same_place(moved(after), moved(before) + v(0.06, 0.0));
    let across: Vec<_> = after
        .lines
        .iter()
        .filter(|l| l.kind == LineKind::Internal)
        .collect();
    assert_eq!(across.len(), 2, "cut where the cut crosses it");
    same_place(across[0].edges[0].curve.end(), v(0.12, 0.1));
    same_place(across[1].edges[0].curve.start(), v(0.18, 0.1));
    same_place(across[1].edges[0].curve.end(), v(0.41, 0.1));
}

#[test]
fn spreads_that_cannot_be_done_are_refused() {
    let pattern = sample();
    let front = pattern.panels[0].id;
    let wish = |change: &dyn Fn(&mut plan::SpreadWish)| {
        let mut wish = flare(&pattern, 2, [0.05, 0.0]);
        change(&mut wish);
        refusal(plan::spread_panel(&evaluated(&pattern), front, wish))
    };
    let swap = |w: &mut plan::SpreadWish| {
        let other = w.cuts[1].0[1].clone();
        w.cuts[1].0[1] = std::mem::replace(&mut w.cuts[0].0[1], other);
    };
    for (told, says) in [
        (wish(&|w| w.cuts.clear()), "there is no cut"),
        (
            wish(&|w| w.cuts[0].1[0] = (-0.01).into()),
            "cut 0 opens by less than nothing",
        ),
        (
            wish(&|w| w.cuts[1].1[0] = 1.3.into()),
            "differ by more than twice its length",
        ),
        (wish(&swap), "cuts 0 and 1 cross"),
        (
            wish(&|w| w.cuts[1].0 = w.cuts[0].0.clone()),
            "cuts 0 and 1 cross or lie on each other",
        ),
        (
            wish(&|w| w.cuts[1].0[0] = w.cuts[0].0[0].clone()),
            "cuts 0 and 1 open at one place",
        ),
        (
            wish(&|w| w.cuts[0].0[1] = w.cuts[0].0[0].clone()),
            "cut 0: the cut has no length",
        ),
        (
            wish(&|w| w.cuts[0].0[1] = Mark::corner(ends(&pattern, "front", "bottom")[1])),
            "cut 0: the cut leaves the panel",
        ),
        (
            wish(&|w| w.line = Name::Drawn(outline(&pattern, "back"))),
            "spread it along its outline",
        ),
    ] {
        assert!(told.contains(says), "{told} should say {says}");
    }
    let edges = ["bottom", "bottom"].map(|name| edge(&pattern, "front", name));
    let told = refusal(plan::even_cuts(&evaluated(&pattern), front, edges, 2));
    assert!(told.contains("not two of one line"), "{told}");
}

#[test]
fn a_smooth_bridge_goes_on_from_both_sides() {
    let mut pattern = sample();
    let wish = plan::SpreadWish {
        bridge: Bridge::Smooth,
        ..flare(&pattern, 1, [0.05, 0.0])
    };
    let by = spread(&mut pattern, wish);
    let evaluation = evaluated(&pattern);
    let stage = evaluation.last_stage(&pattern.panels[0]).unwrap();
    let edges = stage.outline();
    let k = edges
        .iter()
        .position(|e| e.name == made(by, Role::Opening, 0))
        .unwrap();
    let along = |edge: &StageEdge, t: f64| edge.curve.derivative(t).normalize();
    assert!((along(&edges[k - 1], 1.0) - along(&edges[k], 0.0)).norm() < 1e-12);
    assert!((along(&edges[k], 1.0) - along(&edges[k + 1], 0.0)).norm() < 1e-12);
}

#[test]
fn numbers_of_pivots_and_spreads_are_shown_and_set() {
    let (mut pattern, dart) = with_dart();
    let wish = to_edge(&pattern, dart, "right", 0.5);
    let pivoted = pivot(&mut pattern, wish);
    let entries = plan::numbers_of(&evaluated(&pattern), pivoted.into());
    let labels: Vec<&str> = entries.iter().map(|entry| entry.label).collect();
    assert_eq!(labels, ["part of the edge", "part moved", "set back"]);
    let edits = plan::set_number(&evaluated(&pattern), &entries[1].place, 0.25.into()).unwrap();
    let pattern = done(&pattern, &edits);
    let evaluation = evaluated(&pattern);
    let front = pattern.panels[0].id;
    let stage = |after| evaluation.stage(front, Some(after)).unwrap();
    let (whole, new) = (found(stage(dart), dart), found(stage(pivoted), pivoted));
    assert!((angle(&new) - 0.25 * angle(&whole)).abs() < 1e-12);

    let mut pattern = sample();
    let wish = flare(&pattern, 2, [0.04, 0.0]);
    let by = spread(&mut pattern, wish);
    let entries = plan::numbers_of(&evaluated(&pattern), by.into());
    let labels: Vec<&str> = entries.iter().map(|entry| entry.label).collect();
    let cut = ["cut from", "cut to", "opening at start", "opening at end"];
    assert_eq!(labels, [cut, cut].concat());
    let edits = plan::set_number(&evaluated(&pattern), &entries[6].place, 0.07.into()).unwrap();
    let pattern = done(&pattern, &edits);
    let evaluation = evaluated(&pattern);
    let now = lengths(evaluation.last_stage(&pattern.panels[0]).unwrap());
    assert!((now[&made(by, Role::Opening, 2)] - 0.07).abs() < 1e-12);
    assert!((now[&made(by, Role::Opening, 0)] - 0.04).abs() < 1e-12);
}
