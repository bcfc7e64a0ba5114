//! Fragments copied, pasted, duplicated; other patterns inserted.

use super::*;
use crate::sample::{
    alter, dart, edge, ends, formula, formula_in, outline, point, put_operation, put_point,
    put_variable, sample,
};
use std::sync::Arc;
use toile_pattern::plan::{Fragment, NumberAddress, PasteTarget};

/// The sample with a dart, a notch, a variable and formulas that speak of the back.
fn rich() -> Pattern {
    let mut pattern = sample();
    let apex = put_point(&mut pattern, 0, "apex", PointRule::at(0.2, 0.4));
    let kind = dart(&pattern, "top", 0.5, 0.02, Apex::Point(apex));
    put_operation(&mut pattern, 0, "dart", kind);
    let panel = pattern.panels[0].id;
    let wish = (
        outline(&pattern, "front"),
        Mark::between(ends(&pattern, "front", "right"), 0.5),
    );
    let (edits, _) = plan::add_notch(&evaluated(&pattern), panel, wish, NotchKind::V).unwrap();
    pattern = done(&pattern, &edits);
    put_variable(&mut pattern, "reach", formula("bust / 2"));
    let x = PointRule::At {
        x: formula_in(&pattern, "reach - 5cm"),
        y: formula_in(&pattern, "length(back.right) * 0 + y(front.p0)"),
    };
    crate::sample::place(&mut pattern, 0, "p1", x);
    let inside = formula_in(&pattern, "length(front.right) / 60");
    alter(&mut pattern, 0, |panel| panel.allowance = inside);
    pattern
}

/// Copies through JSON, as a clipboard does.
fn copied(pattern: &Pattern, parts: &[PartId]) -> Fragment {
    let fragment = plan::copy(&evaluated(pattern), parts).unwrap();
    let text = serde_json::to_string(&fragment).unwrap();
    assert!(text.starts_with("{\"kind\":\"fragment\""), "{text}");
    let read: Fragment = serde_json::from_str(&text).unwrap();
    assert_eq!(read, fragment);
    read
}

fn panel_points(pattern: &Pattern, panel: PanelId) -> Vec<PointId> {
    plan::points_of(&evaluated(pattern), &[panel.into()])
}

#[test]
fn a_panel_pasted_beside_is_the_same_in_every_size() {
    let pattern = rich();
    let front = pattern.panels[0].id;
    let fragment = copied(&pattern, &[front.into()]);
    assert!(fragment.seams.is_empty() && fragment.variables.is_empty());
    let target = PasteTarget {
        sheet: None,
        offset: [0.6, 0.1],
    };
    let pasted = plan::paste(&evaluated(&pattern), &fragment, target).unwrap();
    let after = done(&pattern, &pasted.edits);
    assert!(pasted.loosened.is_empty(), "all of it is here");
    let copy = after.panel_named("front 2").unwrap();
    let sheet = after.sheet(copy.sheet().unwrap()).unwrap();
    assert_eq!((&*sheet.name, sheet.on_table), ("front 2", [0.6, 0.1]));
    assert_eq!(copy.operations[0].name, "dart");
    let Number::Formula(allowance) = &copy.allowance else {
        panic!("{:?}", copy.allowance);
    };
    let names = Names::new(&after);
    assert_eq!(allowance.text(&names), "length('front 2'.right) / 60");
    for body in bodies() {
        let evaluation = Evaluation::new(&after, &body);
        let old = evaluation.last_stage(after.panel(front).unwrap()).unwrap();
        let new = evaluation.last_stage(copy).unwrap();
        let [old, new] = [old, new].map(|stage| {
            let edges = stage.outline().iter();
            edges.map(|e| (e.curve, e.allowance)).collect::<Vec<_>>()
        });
        assert_eq!(old, new);
        assert_eq!(new.len(), 7, "with its dart");
    }
}

#[test]
fn points_and_curves_bring_what_they_are_made_from() {
    let mut pattern = sample();
    let [a, b] = ends(&pattern, "front", "bottom");
    let middle = PointRule::Between {
        base: a,
        tip: b,
        along: 0.5.into(),
        aside: 0.1.into(),
    };
    let m = put_point(&mut pattern, 0, "m", middle);
    let right = pattern.sheets[0].curves[1].id;
    let on = PointRule::OnCurve {
        curve: right,
        share: 0.5.into(),
    };
    let n = put_point(&mut pattern, 0, "n", on);
    let loose = PointRule::Offset {
        base: n,
        x: formula_in(&pattern, "distance(front.m, back.p2)"),
        y: 0.0.into(),
    };
    let o = put_point(&mut pattern, 0, "o", loose);
    let fragment = copied(&pattern, &[o.into()]);
    let names: Vec<&str> = fragment.sheets[0].points.iter().map(|p| &*p.name).collect();
    assert_eq!(names, ["p0", "p1", "p2", "m", "n", "o"]);
    assert_eq!(fragment.sheets[0].curves.len(), 1);
    let sheet = pattern.sheets[0].id;
    let offset = [0.05, -0.02];
    let target = PasteTarget {
        sheet: Some(sheet),
        offset,
    };
    let pasted = plan::paste(&evaluated(&pattern), &fragment, target).unwrap();
    let after = done(&pattern, &pasted.edits);
    let new: Vec<PointId> = pasted
        .parts
        .iter()
        .filter_map(|part| match part {
            PartId::Point(id) => Some(*id),
            _ => None,
        })
        .collect();
    let old = [a, b, point(&pattern, "front", "p2"), m, n];
    for body in bodies() {
        let before = places(&after, &body, &old);
        let found = places(&after, &body, &new);
        for (k, at) in before.iter().enumerate() {
            same_place(found[k], at + v(offset[0], offset[1]));
        }
    }
    assert_eq!(after.sheets.len(), 2);
    assert_eq!(after.point(new[3]).unwrap().1.name, "m 2");
}

#[test]
fn in_another_pattern_references_become_values() {
    let pattern = rich();
    let front = pattern.panels[0].id;
    let fragment = copied(&pattern, &[front.into()]);
    let (other, sheet) = blank();
    let target = PasteTarget {
        sheet: Some(sheet),
        offset: [0.0, 0.0],
    };
    let pasted = plan::paste(&evaluated(&other), &fragment, target).unwrap();
    let after = done(&other, &pasted.edits);
    let p1 = after.sheets[0].point_named("p1").unwrap().id;
    assert_eq!(
        pasted.loosened,
        ["at.x", "at.y"].map(|path| NumberAddress::new(p1, path))
    );
    let bust = Measurements::adult().get("bust").unwrap();
    for body in bodies() {
        same_place(places(&after, &body, &[p1])[0], v(bust / 2.0 - 0.05, 0.0));
        let evaluation = Evaluation::new(&after, &body);
        let errors = evaluation.diagnostics();
        assert!(
            errors.iter().all(|d| d.severity < Severity::Error),
            "{errors:?}"
        );
    }
    assert_eq!(after.fabrics.len(), 1, "its fabric comes along");
    // A pattern of another name with the very same parts is another pattern.
    let mut twin = pattern.clone();
    twin.name = "twin".into();
    let target = PasteTarget::default();
    let pasted = plan::paste(&evaluated(&twin), &fragment, target).unwrap();
    assert_eq!(pasted.loosened.len(), 2);
    // And so is this one when the part is gone or is another.
    let mut gone = pattern.clone();
    gone.apply(&[Edit::Remove(pattern.variables[0].id.into())])
        .unwrap();
    let pasted = plan::paste(&evaluated(&gone), &fragment, target).unwrap();
    assert_eq!(pasted.loosened.len(), 1);
    done(&gone, &pasted.edits);
}

#[test]
fn what_was_lost_stays_lost() {
    let mut pattern = rich();
    let p2 = point(&pattern, "front", "p2");
    pattern
        .apply(&[
            Edit::Remove(p2.into()),
            Edit::Remove(pattern.panels[1].id.into()),
        ])
        .unwrap();
    let front = pattern.panels[0].id;
    let fragment = copied(&pattern, &[front.into()]);
    for other in [pattern.clone(), blank().0] {
        let target = PasteTarget::default();
        let pasted = plan::paste(&evaluated(&other), &fragment, target).unwrap();
        let after = done(&other, &pasted.edits);
        let copy = after.panels.last().unwrap();
        let corner = copy.lines[0].edges[1].ends[1];
        assert!(after.parts().iter().all(|(id, _)| id.number() != corner.0));
        assert!(
            evaluated(&after).stage(copy.id, None).is_none(),
            "suspended"
        );
    }
}

#[test]
fn sizes_of_their_own_follow_the_names_of_sizes() {
    let (edits, size) =
        plan::add_size(&evaluated(&sample()), Some("M"), Measurements::adult()).unwrap();
    let mut pattern = done(&sample(), &edits);
    let rule = PointRule::At {
        x: Number::PerSize {
            usual: Box::new(0.4.into()),
            sizes: vec![(size, 0.5)],
        },
        y: Number::ZERO,
    };
    crate::sample::place(&mut pattern, 0, "p1", rule);
    let p1 = point(&pattern, "front", "p1");
    let fragment = copied(&pattern, &[p1.into()]);
    let target = PasteTarget::default();
    let (mut other, _) = blank();
    let pasted = plan::paste(&evaluated(&other), &fragment, target).unwrap();
    assert_eq!(pasted.lost_sizes, ["M"]);
    let after = done(&other, &pasted.edits);
    let new = after.sheets[1].points[0].id;
    same_place(
        places(&after, &Measurements::adult(), &[new])[0],
        v(0.4, 0.0),
    );
    let (edits, _) = plan::add_size(&evaluated(&other), Some("M"), Measurements::adult()).unwrap();
    other = done(&other, &edits);
    let pasted = plan::paste(&evaluated(&other), &fragment, target).unwrap();
    assert!(pasted.lost_sizes.is_empty());
    let after = done(&other, &pasted.edits);
    let new = after.sheets[1].points[0].id;
    same_place(
        places(&after, &Measurements::adult(), &[new])[0],
        v(0.5, 0.0),
    );
    same_place(
        places(&after, &Measurements::child(8), &[new])[0],
        v(0.4, 0.0),
    );
}

#[test]
fn duplicates_lie_beside() {
    let pattern = rich();
    let front = pattern.panels[0].id;
    // Seams between panels that are copied are copied with them.
    let parts: Vec<PartId> = vec![front.into(), pattern.panels[1].id.into()];
    let pasted = plan::duplicate(&evaluated(&pattern), &parts).unwrap();
    let after = done(&pattern, &pasted.edits);
    assert_eq!(
        (after.panels.len(), after.sheets.len(), after.seams.len()),
        (4, 4, 4)
    );
    for seam in &after.seams[2..] {
        assert!(seam.spans().all(|span| span.panel != front));
    }
    let right = Evaluation::new(&pattern, &Measurements::adult());
    let wide = right.points().values().map(|p| p.x).fold(0.0, f64::max);
    assert!((after.sheets[2].on_table[0] - wide - 0.05).abs() < 1e-9);
    let curve = pattern.sheets[1].curves[1].id;
    let pasted = plan::duplicate(&evaluated(&pattern), &[curve.into()]).unwrap();
    let after = done(&pattern, &pasted.edits);
    assert_eq!(after.sheets.len(), 2);
    let new = after.sheets[1].points.last().unwrap().id;
    same_place(
        places(&after, &Measurements::adult(), &[new])[0],
        v(0.45, 0.6),
    );
    assert_eq!(panel_points(&after, after.panels[1].id).len(), 4);
}

#[test]
fn a_whole_pattern_is_inserted() {
    let block = rich();
    let mut pattern = sample();
    put_variable(&mut pattern, "reach", formula("waist / 2"));
    let body = Measurements::adult();
    let other = Evaluation::new(&block, &body);
    let pasted = plan::insert_pattern(&evaluated(&pattern), &other, [1.0, 0.0]).unwrap();
    assert!(pasted.loosened.is_empty());
    let after = done(&pattern, &pasted.edits);
    assert_eq!(
        (after.panels.len(), after.seams.len(), after.fabrics.len()),
        (4, 4, 1)
    );
    assert_eq!(after.variables[1].name, "reach 2");
    assert_eq!(after.sheets[2].on_table, [1.0, 0.0]);
    for body in bodies() {
        let [old, new] = [&block, &after].map(|pattern| {
            let evaluation = Evaluation::new(pattern, &body);
            let panel = &pattern.panels[pattern.panels.len() - 2];
            evaluation
                .last_stage(panel)
                .unwrap()
                .outline()
                .iter()
                .map(|e| e.curve)
                .collect::<Vec<_>>()
        });
        assert_eq!(old, new);
    }
    // A variable that says the same is the same.
    let mut pattern = sample();
    put_variable(&mut pattern, "reach", formula("bust / 2"));
    let pasted = plan::insert_pattern(&evaluated(&pattern), &other, [0.0, 0.0]).unwrap();
    assert_eq!(done(&pattern, &pasted.edits).variables.len(), 1);
    let empty = evaluated(&Pattern::new("empty"));
    assert!(
        refusal(plan::insert_pattern(
            &evaluated(&pattern),
            &empty,
            [0.0, 0.0]
        ))
        .contains("nothing to copy")
    );
}

#[test]
fn what_cannot_be_copied_or_pasted_is_refused() {
    let pattern = rich();
    let evaluation = evaluated(&pattern);
    let notch = pattern.panels[0].notches[0].id;
    for (parts, says) in [
        (vec![], "nothing to copy"),
        (
            vec![notch.into()],
            "is not copied by itself: copy its panel",
        ),
        (vec![PointId(9999).into()], "point 9999 is not there"),
    ] {
        let told = refusal(plan::copy(&evaluation, &parts));
        assert!(told.contains(says), "{told}");
    }
    let side: PartId = edge(&pattern, "front", "right").into();
    let fragment = copied(&pattern, &[side]);
    assert_eq!(fragment.sheets[0].curves.len(), 1);
    for (target, says) in [
        (
            PasteTarget {
                sheet: Some(SheetId(9999)),
                offset: [0.0, 0.0],
            },
            "sheet 9999 is not there",
        ),
        (
            PasteTarget {
                sheet: None,
                offset: [f64::NAN, 0.0],
            },
            "not finite",
        ),
    ] {
        let told = refusal(plan::paste(&evaluation, &fragment, target));
        assert!(told.contains(says), "{told}");
    }
    // Data that no pattern takes is refused, not taken half.
    let mut broken = fragment.clone();
    let sheet = Arc::make_mut(&mut broken.sheets[0]);
    Arc::make_mut(&mut sheet.points[0]).rule = PointRule::at(f64::NAN, 0.0);
    let target = PasteTarget::default();
    assert!(refusal(plan::paste(&evaluation, &broken, target)).contains("not finite"));
    let mut double = fragment.clone();
    double.sheets.push(double.sheets[0].clone());
    let told = refusal(plan::paste(&evaluation, &double, target));
    assert!(
        told.contains("two parts of the fragment have the id"),
        "{told}"
    );
    let text = serde_json::to_string(&fragment)
        .unwrap()
        .replace("\"fragment\"", "\"block\"");
    assert!(serde_json::from_str::<Fragment>(&text).is_err());
}
