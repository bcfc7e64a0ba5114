//! Darts, diamonds and folds put on panels, adjusted, reordered and removed.

use super::*;
use crate::sample::{dart, ends, fold, formula, outline, point, put_point, sample};

fn front(pattern: &Pattern) -> PanelId {
    pattern.panel_named("front").unwrap().id
}

fn add(pattern: &mut Pattern, kind: OperationKind) -> OperationId {
    let panel = front(pattern);
    let (edits, id) = plan::add_operation(&evaluated(pattern), panel, kind).unwrap();
    *pattern = done(pattern, &edits);
    id
}

fn names(pattern: &Pattern) -> Vec<&str> {
    pattern.panels[0]
        .operations
        .iter()
        .map(|o| &*o.name)
        .collect()
}

#[test]
fn darts_open_where_they_are_put_in_every_size() {
    let mut pattern = sample();
    let kind = OperationKind::Dart {
        line: Name::Drawn(outline(&pattern, "front")),
        mouth: Mark::between(ends(&pattern, "front", "top"), 0.25),
        intake: formula("bust / 50"),
        apex: Apex::Depth(0.1.into()),
        trued: false,
        keeps_length: false,
        pressed: toile_pattern::Pressed::default(),
    };
    let shallow = add(&mut pattern, kind);
    let apex = put_point(&mut pattern, 0, "apex", PointRule::at(0.1, 0.3));
    let deep = dart(&pattern, "top", 0.75, 0.03, Apex::Point(apex));
    let deep = add(&mut pattern, deep);
    assert_eq!(names(&pattern), ["dart", "dart 2"]);
    for body in bodies() {
        let intake = body.get("bust").unwrap() / 50.0;
        let evaluation = Evaluation::new(&pattern, &body);
        let stage = evaluation.last_stage(&pattern.panels[0]).unwrap();
        let [one, two] = [shallow, deep].map(|id| {
            let found = stage.darts.iter().find(|dart| dart.by == id);
            *found.unwrap()
        });
        // The top runs from right to left.
        same_place(one.mouth[0], v(0.3 + intake / 2.0, 0.6));
        same_place(one.mouth[1], v(0.3 - intake / 2.0, 0.6));
        same_place(one.apex, v(0.3, 0.5));
        same_place(two.mouth[0], v(0.115, 0.6));
        same_place(two.apex, v(0.1, 0.3));
    }
}

#[test]
fn darts_go_before_the_fold_and_diamonds_too() {
    let mut pattern = sample();
    pattern.seams.clear();
    let kind = fold(&pattern, "left");
    let folded = add(&mut pattern, kind);
    let kind = dart(&pattern, "top", 0.5, 0.02, Apex::Depth(0.1.into()));
    let first = add(&mut pattern, kind);
    let a = put_point(&mut pattern, 0, "a", PointRule::at(0.2, 0.2));
    let b = put_point(&mut pattern, 0, "b", PointRule::at(0.2, 0.4));
    let kind = OperationKind::Diamond {
        ends: [a, b],
        widest: 0.5.into(),
        intake: 0.02.into(),
    };
    let second = add(&mut pattern, kind);
    let order: Vec<OperationId> = pattern.panels[0].operations.iter().map(|o| o.id).collect();
    assert_eq!(order, [first, second, folded]);
    assert_eq!(names(&pattern), ["dart", "dart 2", "fold"]);
    for body in bodies() {
        let evaluation = Evaluation::new(&pattern, &body);
        assert!(evaluation.diagnostics().is_empty());
        let stage = evaluation.last_stage(&pattern.panels[0]).unwrap();
        assert_eq!(stage.darts.len(), 4, "both halves have both");
        let mirrored = stage.darts.iter().find(|d| d.by == first && d.half == 1);
        same_place(mirrored.unwrap().apex, v(-0.2, 0.5));
    }
}

#[test]
fn operations_are_adjusted_reordered_and_removed() {
    let mut pattern = sample();
    let untouched = pattern.clone();
    let kind = dart(&pattern, "top", 0.25, 0.02, Apex::Depth(0.1.into()));
    let one = add(&mut pattern, kind);
    let kind = dart(&pattern, "top", 0.75, 0.02, Apex::Depth(0.1.into()));
    let two = add(&mut pattern, kind);
    let panel = front(&pattern);
    let wider = dart(&pattern, "right", 0.5, 0.05, Apex::Depth(0.07.into()));
    let edits = plan::set_operation(&evaluated(&pattern), (panel, one), wider).unwrap();
    let pattern = done(&pattern, &edits);
    assert_eq!(names(&pattern), ["dart", "dart 2"]);
    for body in bodies() {
        let evaluation = Evaluation::new(&pattern, &body);
        let stage = evaluation.last_stage(&pattern.panels[0]).unwrap();
        let found = stage.darts.iter().find(|dart| dart.by == one).unwrap();
        same_place(found.apex, v(0.33, 0.3));
    }
    let edits = plan::move_operation(&evaluated(&pattern), (panel, one), 9).unwrap();
    let pattern = done(&pattern, &edits);
    assert_eq!(names(&pattern), ["dart 2", "dart"]);
    let edits = plan::remove_operation(&evaluated(&pattern), (panel, one)).unwrap();
    let pattern = done(&pattern, &edits);
    assert_eq!(names(&pattern), ["dart 2"]);
    let edits = plan::remove_operation(&evaluated(&pattern), (panel, two)).unwrap();
    assert!(done(&pattern, &edits).says_the_same(&untouched));
}

#[test]
fn operations_that_cannot_be_done_are_refused() {
    let mut pattern = sample();
    let kind = dart(&pattern, "top", 0.5, 0.1, Apex::Depth(0.1.into()));
    let first = add(&mut pattern, kind);
    let panel = front(&pattern);
    let foreign = point(&pattern, "back", "p0");
    let own = point(&pattern, "front", "p0");
    let with = |name, share, intake| dart(&pattern, name, share, intake, Apex::Depth(0.1.into()));
    let on_line = |line: LineName| OperationKind::Fold {
        line,
        ends: ends(&pattern, "front", "left").map(Mark::corner),
    };
    let diamond = |ends| OperationKind::Diamond {
        ends,
        widest: 0.5.into(),
        intake: 0.02.into(),
    };
    let evaluation = evaluated(&pattern);
    for (kind, says) in [
        (
            with("right", 0.5, 0.7),
            "does not fit on its edge: give it a width of 0 or more",
        ),
        (with("right", 0.5, -0.01), "does not fit on its edge"),
        (with("right", 1.5, 0.01), "does not fit on its edge"),
        (with("top", 0.6, 0.05), "two darts of one edge overlap"),
        (
            dart(&pattern, "top", 0.1, 0.01, Apex::Point(foreign)),
            "point \"p0\" is on sheet \"back\"",
        ),
        (
            diamond([own, own]),
            "is narrower than nothing or has no length",
        ),
        (
            diamond([own, foreign]),
            "which panel \"front\" is not traced from",
        ),
        (
            on_line(Name::Drawn(outline(&pattern, "back"))),
            "its line is not there",
        ),
        (
            dart(&pattern, "right", 0.5, f64::NAN, Apex::Depth(0.1.into())),
            "not finite",
        ),
    ] {
        let told = refusal(plan::add_operation(&evaluation, panel, kind.clone()));
        assert!(told.contains(says), "{told}");
        let set = plan::set_operation(&evaluation, (panel, OperationId(9999)), kind);
        assert!(refusal(set).contains("operation 9999 of panel \"front\" is not there"));
    }
    let told = refusal(plan::set_operation(
        &evaluation,
        (panel, first),
        with("right", 0.5, 0.7),
    ));
    assert!(told.contains("does not fit on its edge"), "{told}");
    let kind = fold(&pattern, "left");
    assert!(plan::add_operation(&evaluation, PanelId(9999), kind).is_err());
    let mut curved = pattern.clone();
    crate::sample::bend(&mut curved, 0, "left", CurveRule::Arc { bulge: 0.1.into() });
    let kind = fold(&curved, "left");
    let told = refusal(plan::add_operation(&evaluated(&curved), panel, kind));
    assert!(told.contains("not a straight edge"), "{told}");
    // A fold before the dart on its own edge leaves that dart no place.
    let kind = fold(&pattern, "top");
    let told = refusal(plan::add_operation(&evaluated(&pattern), panel, kind));
    assert!(told.contains("not a straight edge"), "{told}");
}
