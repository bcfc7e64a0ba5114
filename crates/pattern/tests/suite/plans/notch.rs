//! Notches, one and in rows, and marks nearest to places.

use super::*;
use crate::sample::{bend, edge, ends, formula, outline, sample};
use toile_pattern::plan::NotchRow;

fn bowed() -> (Pattern, PanelId, LineId) {
    let mut pattern = sample();
    bend(
        &mut pattern,
        0,
        "right",
        CurveRule::Arc { bulge: 0.2.into() },
    );
    let (panel, line) = (pattern.panels[0].id, outline(&pattern, "front"));
    (pattern, panel, line)
}

#[test]
fn notches_lie_where_their_marks_are() {
    let (mut pattern, panel, line) = bowed();
    let right = ends(&pattern, "front", "right");
    let marks = [
        Mark::between(right, 0.5),
        Mark::Along {
            from: Name::Drawn(right[1]),
            distance: formula("bust / 20"),
        },
        Mark::corner(right[0]),
    ];
    let mut made = Vec::new();
    for mark in marks {
        let wish = (line, mark);
        let (edits, id) = plan::add_notch(&evaluated(&pattern), panel, wish, NotchKind::V).unwrap();
        pattern = done(&pattern, &edits);
        made.push(id);
    }
    let names: Vec<&str> = pattern.panels[0].notches.iter().map(|n| &*n.name).collect();
    assert_eq!(names, ["notch", "notch 2", "notch 3"]);
    let side = edge(&pattern, "front", "right");
    for body in bodies() {
        let evaluation = Evaluation::new(&pattern, &body);
        let path = evaluation.edge(side).unwrap();
        let middle = path.at_length(path.length() / 2.0).unwrap();
        let stage = evaluation.stage(panel, None).unwrap();
        let at = |id: NotchId| stage.notches.iter().find(|n| n.id == id).unwrap().point;
        same_place(at(made[0]), path.point(middle));
        same_place(at(made[1]), v(0.4 - body.get("bust").unwrap() / 20.0, 0.6));
        same_place(at(made[2]), v(0.4, 0.0));
    }
}

#[test]
fn rows_are_spaced_evenly() {
    let (pattern, panel, line) = bowed();
    let row = NotchRow {
        line,
        ends: ends(&pattern, "front", "right").map(Name::Drawn),
        count: 3,
    };
    let (edits, made) =
        plan::add_notches(&evaluated(&pattern), panel, row, NotchKind::Slit).unwrap();
    let after = done(&pattern, &edits);
    let side = edge(&pattern, "front", "right");
    for body in bodies() {
        let evaluation = Evaluation::new(&after, &body);
        let path = evaluation.edge(side).unwrap();
        let stage = evaluation.stage(panel, None).unwrap();
        for (k, id) in made.iter().enumerate() {
            let along = path.length() * (k + 1) as f64 / 4.0;
            let found = stage.notches.iter().find(|n| n.id == *id).unwrap();
            same_place(found.point, path.point(path.at_length(along).unwrap()));
        }
    }
    for count in [0, 101] {
        let row = NotchRow { count, ..row };
        let found = plan::add_notches(&evaluated(&pattern), panel, row, NotchKind::Slit);
        assert!(refusal(found).contains("ask for 1 to 100"));
    }
}

#[test]
fn notches_are_changed_moved_and_removed() {
    let (pattern, panel, line) = bowed();
    let top = ends(&pattern, "front", "top");
    let wish = (line, Mark::between(top, 0.5));
    let (edits, id) = plan::add_notch(&evaluated(&pattern), panel, wish, NotchKind::Slit).unwrap();
    let with = done(&pattern, &edits);
    let edits = plan::set_notch_kind(&evaluated(&with), (panel, id), NotchKind::T).unwrap();
    let changed = done(&with, &edits);
    assert_eq!(changed.panels[0].notches[0].kind, NotchKind::T);
    let wish = (line, Mark::between(top, 0.25));
    let edits = plan::move_notch(&evaluated(&changed), (panel, id), wish).unwrap();
    let moved = done(&changed, &edits);
    for body in bodies() {
        let evaluation = Evaluation::new(&moved, &body);
        same_place(
            evaluation.stage(panel, None).unwrap().notches[0].point,
            v(0.3, 0.6),
        );
    }
    let evaluation = evaluated(&moved);
    let edits = plan::remove_notch(&evaluation, (panel, id)).unwrap();
    assert!(done(&moved, &edits).says_the_same(&pattern));
    let back = ends(&pattern, "back", "top");
    for (wish, says) in [
        ((line, Mark::between(top, 1.5)), "lies beyond its edge"),
        (
            (line, Mark::between(back, 0.5)),
            "corner \"p2\" is not there",
        ),
        (
            (LineId(9999), Mark::between(top, 0.5)),
            "line 9999 is not there",
        ),
        ((line, Mark::Notch(NotchId(9999))), "never given"),
    ] {
        let told = refusal(plan::add_notch(
            &evaluation,
            panel,
            wish.clone(),
            NotchKind::V,
        ));
        assert!(told.contains(says), "{told}");
        let told = refusal(plan::move_notch(&evaluation, (panel, id), wish));
        assert!(told.contains(says), "{told}");
    }
    let itself = (line, Mark::Notch(id));
    let told = refusal(plan::move_notch(&evaluation, (panel, id), itself));
    assert!(told.contains("where it lies itself"), "{told}");
    let nothing = (panel, NotchId(9999));
    assert!(plan::remove_notch(&evaluation, nothing).is_err());
    assert!(plan::set_notch_kind(&evaluation, nothing, NotchKind::V).is_err());
}

#[test]
fn places_lead_to_the_nearest_mark() {
    let (pattern, panel, line) = bowed();
    let evaluation = evaluated(&pattern);
    let top = ends(&pattern, "front", "top");
    let found = plan::nearest_mark(&evaluation, panel, v(0.3, 0.7)).unwrap();
    assert_eq!(
        (found.line, found.edge),
        (line, Name::Drawn(edge(&pattern, "front", "top")))
    );
    let Mark::Between { ends, share } = &found.mark else {
        panic!("{found:?}");
    };
    assert_eq!(*ends, top.map(Name::Drawn));
    assert!((share.value().unwrap() - 0.25).abs() < 1e-9);
    same_place(found.at, v(0.3, 0.6));
    let found = plan::nearest_mark(&evaluation, panel, v(-0.1, -0.2)).unwrap();
    assert_eq!(
        found.mark,
        Mark::corner(crate::sample::point(&pattern, "front", "p0"))
    );
    assert!(plan::nearest_mark(&evaluation, PanelId(9999), v(0.0, 0.0)).is_err());
    assert!(plan::nearest_mark(&evaluation, panel, v(f64::NAN, 0.0)).is_err());
}

#[test]
fn a_distance_along_a_finished_edge_passes_over_a_dart() {
    let (mut pattern, panel, line) = bowed();
    let top = edge(&pattern, "front", "top");
    let kind = crate::sample::dart(&pattern, "top", 0.5, 0.02, Apex::Depth(0.1.into()));
    crate::sample::put_operation(&mut pattern, 0, "dart", kind);
    let evaluation = evaluated(&pattern);
    let drawn = evaluation.edge(top).unwrap().length();
    let finished = plan::finished_edge(&evaluation, panel, top).unwrap();
    assert_eq!(finished.line, line);
    assert!((finished.length - drawn + 0.02).abs() < 1e-12);
    // Before the mouth a distance is as it is drawn, and stays as it is typed.
    let mark =
        |end: usize, distance: &Number| plan::mark_along(&evaluation, &finished, (end, distance));
    let typed = formula("5cm + 2cm");
    let along = |end: usize, distance: Number| Mark::Along {
        from: finished.ends[end],
        distance,
    };
    assert_eq!(mark(0, &typed), Ok(along(0, typed.clone())));
    let back = formula("-(5cm + 2cm)");
    assert_eq!(mark(1, &back), Ok(along(1, back.clone())));
    // Beyond it the intake is added; a formula stays a formula.
    let far = formula("30cm");
    let Ok(Mark::Along { distance, .. }) = mark(0, &far) else {
        panic!("{:?}", mark(0, &far));
    };
    let Number::Adjusted { by, .. } = distance else {
        panic!("{distance:?}");
    };
    assert!((by - 0.02).abs() < 1e-9, "{by}");
    for beyond in [-0.01, drawn, f64::NAN] {
        assert!(mark(0, &beyond.into()).is_err(), "{beyond}");
    }
    assert!(plan::finished_edge(&evaluation, panel, EdgeId(9999)).is_err());
}
