//! Edits: absolute, all or nothing; planners; and evaluation kept up to date edit by edit.

use crate::sample::*;
use proptest::prelude::*;
use std::sync::Arc;
use toile_geometry::Vec2;
use toile_measure::Measurements;
use toile_pattern::*;

fn put(entity: Entity) -> Edit {
    Edit::Put(entity)
}

/// One edit of every kind.
fn edits() -> Vec<Edit> {
    let pattern = rich_sample();
    let mut ids = pattern.ids;
    let fabric = pattern.fabrics[0].id;
    let (sheet, pocket) = rectangle(&mut ids, "pocket", fabric, [0.1, 0.1]);
    let head = SheetHead {
        id: sheet.id,
        name: sheet.name.clone(),
        on: None,
        on_table: [0.3, 0.0],
    };
    let mut silk = Fabric::poplin(ids.take());
    silk.name = "silk".into();
    let front = &pattern.panels[0];
    let mut renamed = (**front).clone();
    renamed.name = "forepart".into();
    renamed.grain = formula("45deg");
    let first = &pattern.sheets[0];
    let mut moved = (*first.points[1]).clone();
    moved.rule = PointRule::At {
        x: Number::Adjusted {
            formula: Formula::of_measurements("bust / 2").unwrap(),
            by: -0.05,
        },
        y: Number::PerSize {
            usual: Box::new(0.0.into()),
            sizes: vec![(pattern.sizes[0].id, 0.01)],
        },
    };
    let mut bent = (*first.curves[0]).clone();
    bent.rule = CurveRule::Arc {
        bulge: formula("0.1"),
    };
    let variable = Variable {
        id: pattern.variables[0].id,
        name: "fullness".into(),
        number: formula_in(
            &pattern,
            "distance(front.p0, front.p2) + length(back.top) * 0",
        ),
    };
    let mut seam = (*pattern.seams[0]).clone();
    seam.gathered = true;
    let mut whole = vec![put(Entity::Sheet(head))];
    whole.extend(
        sheet
            .points
            .iter()
            .map(|p| put(Entity::Point(sheet.id, p.clone()))),
    );
    whole.extend(
        sheet
            .curves
            .iter()
            .map(|c| put(Entity::Curve(sheet.id, c.clone()))),
    );
    whole.push(put(Entity::Panel(pocket)));
    let mut all = vec![
        put(Entity::Head(Head {
            name: "other".into(),
            unit: DisplayUnit::Inch,
            base_size: Some(pattern.sizes[0].id),
        })),
        put(Entity::Size(Arc::new(Size {
            id: ids.take(),
            name: "S".into(),
            measurements: Measurements::adult_woman(),
        }))),
        put(Entity::Variable(Arc::new(variable))),
        put(Entity::Fabric(Arc::new(silk))),
        put(Entity::Point(first.id, Arc::new(moved))),
        put(Entity::Curve(first.id, Arc::new(bent))),
        put(Entity::Panel(Arc::new(renamed))),
        put(Entity::Seam(Arc::new(seam))),
        Edit::Remove(pattern.sizes[0].id.into()),
        Edit::Remove(pattern.variables[0].id.into()),
        Edit::Remove(pattern.fabrics[0].id.into()),
        Edit::Remove(pattern.sheets[1].id.into()),
        Edit::Remove(pattern.panels[1].id.into()),
        Edit::Remove(pattern.seams[1].id.into()),
        Edit::Remove(first.points[2].id.into()),
        Edit::Remove(first.curves[3].id.into()),
        Edit::Order {
            part: pattern.panels[1].id.into(),
            at: 0,
        },
        Edit::Order {
            part: first.points[0].id.into(),
            at: 9,
        },
    ];
    let mut without = (**front).clone();
    let dart = without.operations.remove(0);
    all.push(put(Entity::Panel(Arc::new(without.clone()))));
    let mut too_wide = (*dart).clone();
    if let OperationKind::Dart { intake, .. } = &mut too_wide.kind {
        *intake = formula("bust");
    }
    without.operations.push(Arc::new(too_wide));
    all.push(put(Entity::Panel(Arc::new(without))));
    all.extend(renamings(&pattern));
    all.extend(whole);
    all
}

/// Parts called otherwise: by free names, by names that others have, and by names that formulas
/// asked for in vain.
fn renamings(pattern: &Pattern) -> Vec<Edit> {
    let mut all = Vec::new();
    for name in ["late", "ease", "bust", "p2"] {
        for variable in &pattern.variables {
            let (id, number) = (variable.id, variable.number.clone());
            let name = name.to_owned();
            all.push(put(Entity::Variable(Arc::new(Variable {
                id,
                name,
                number,
            }))));
        }
        let sheet = &pattern.sheets[0];
        let mut point = (*sheet.points[1]).clone();
        point.name = name.into();
        all.push(put(Entity::Point(sheet.id, Arc::new(point))));
    }
    for name in ["right", "late edge", "back"] {
        let sheet = &pattern.sheets[0];
        let mut curve = (*sheet.curves[2]).clone();
        curve.name = name.into();
        all.push(put(Entity::Curve(sheet.id, Arc::new(curve))));
        let mut seam = (*pattern.seams[1]).clone();
        seam.name = name.into();
        all.push(put(Entity::Seam(Arc::new(seam))));
        all.push(put(Entity::Sheet(SheetHead {
            id: sheet.id,
            name: name.into(),
            on: None,
            on_table: [0.0; 2],
        })));
        let mut panel = (*pattern.panels[1]).clone();
        panel.name = name.into();
        panel.lines[0].edges[1].name = "late edge".into();
        all.push(put(Entity::Panel(Arc::new(panel))));
        let mut fabric = (*pattern.fabrics[0]).clone();
        fabric.name = name.into();
        all.push(put(Entity::Fabric(Arc::new(fabric))));
    }
    all
}

/// Whether an evaluation that was kept up to date equals a fresh one to the bit.
fn equals_fresh(kept: &Evaluation) -> Result<(), TestCaseError> {
    let fresh = Evaluation::new(kept.pattern(), kept.wearer());
    let bits = |evaluation: &Evaluation| -> Vec<u64> {
        let points = evaluation.points();
        points
            .values()
            .flat_map(|p| [p.x.to_bits(), p.y.to_bits()])
            .collect()
    };
    prop_assert_eq!(bits(kept), bits(&fresh));
    for panel in &kept.pattern().panels {
        let stages = [kept.last_stage(panel), fresh.last_stage(panel)];
        match stages {
            [Some(a), Some(b)] => prop_assert!(a.is_same(b), "panel {:?}", panel.name),
            [a, b] => prop_assert_eq!(a.is_some(), b.is_some(), "panel {:?}", panel.name),
        }
    }
    for variable in &kept.pattern().variables {
        let value = |evaluation: &Evaluation| {
            let found = evaluation.variable(variable.id);
            found.map(|(value, power)| (value.to_bits(), power))
        };
        prop_assert_eq!(value(kept), value(&fresh), "variable {:?}", variable.name);
    }
    prop_assert_eq!(kept.diagnostics(), fresh.diagnostics());
    prop_assert_eq!(kept.check(), fresh.check());
    prop_assert_eq!(kept.names(), fresh.names());
    Ok(())
}

/// Wearers: of the size's own table, of a body that lacks a measurement, of none.
fn wearers(pattern: &Pattern) -> Vec<Wearer> {
    let mut partial = Measurements::new();
    let asked = toile_measure::Origin::Asked;
    for (name, value) in [("bust", 0.9), ("ears", 0.07)] {
        partial.set(name, value, asked).unwrap();
    }
    let mut all = vec![(&Measurements::adult()).into(), (&partial).into()];
    all.extend(pattern.sizes.iter().map(Wearer::from));
    all
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

    #[test]
    fn any_run_of_edits_evaluates_as_if_afresh(
        choices in prop::collection::vec((0..edits().len(), 0_usize..6), 1..20),
    ) {
        let all = edits();
        let mut pattern = rich_sample();
        let wearers = wearers(&pattern);
        let mut snapshots = vec![pattern.clone()];
        let mut evaluation = Evaluation::new(&pattern, &wearers[0]);
        for (choice, wearer) in choices {
            let before = pattern.clone();
            // Half of the time the wearer stays.
            let wearer = wearers.get(wearer).unwrap_or(evaluation.wearer()).clone();
            match pattern.apply(&[all[choice].clone()]) {
                Ok(()) => {
                    evaluation.update(&pattern, wearer);
                    equals_fresh(&evaluation)?;
                    snapshots.push(pattern.clone());
                }
                Err(error) => prop_assert_eq!(&pattern, &before, "unchanged on {}", error),
            }
        }
        // Undoing is going back to a snapshot.
        for snapshot in snapshots.iter().rev() {
            let wearer = evaluation.wearer().clone();
            evaluation.update(snapshot, wearer);
            equals_fresh(&evaluation)?;
        }
    }
}

#[test]
fn every_edit_of_the_list_applies_and_survives_json() {
    for edit in edits().into_iter().take(18) {
        let text = serde_json::to_string(&edit).unwrap();
        assert_eq!(serde_json::from_str::<Edit>(&text).unwrap(), edit, "{text}");
        let mut pattern = rich_sample();
        pattern.apply(std::slice::from_ref(&edit)).unwrap();
        assert_ne!(pattern, rich_sample(), "{edit:?}");
    }
    let mut pattern = rich_sample();
    pattern.apply(&edits()[18..]).unwrap();
    assert_eq!(pattern.panels.len(), 3);
}

#[test]
fn refused_edits_change_nothing_and_say_why() {
    let pattern = rich_sample();
    let point = |rule: PointRule| {
        let sheet = &pattern.sheets[0];
        let mut point = (*sheet.points[0]).clone();
        point.rule = rule;
        put(Entity::Point(sheet.id, Arc::new(point)))
    };
    let named = |name: &str| {
        let mut panel = (*pattern.panels[0]).clone();
        panel.name = name.into();
        put(Entity::Panel(Arc::new(panel)))
    };
    let base = |base| PointRule::Offset {
        base,
        x: Number::ZERO,
        y: Number::ZERO,
    };
    let of_another_kind = PointId(pattern.panels[0].id.0);
    for (edit, says) in [
        (point(PointRule::at(f64::NAN, 0.0)), "not finite"),
        (named(" "), "cannot be a name"),
        (named("it's"), "cannot be a name"),
        (point(base(PointId(9999))), "never given"),
        (point(base(of_another_kind)), "another kind"),
        (Edit::Remove(PointId(9999).into()), "not there"),
        (
            Edit::Remove(pattern.panels[0].lines[0].id.into()),
            "put its panel",
        ),
    ] {
        let mut changed = pattern.clone();
        let harmless = Edit::Remove(pattern.seams[0].id.into());
        let error = changed.apply(&[harmless, edit.clone()]).unwrap_err();
        assert!(error.to_string().contains(says), "{edit:?}: {error}");
        assert_eq!(changed, pattern);
    }
}

#[test]
fn renaming_touches_no_formula() {
    let mut pattern = rich_sample();
    let before = pattern.variables[0].clone();
    alter(&mut pattern, 0, |panel| {
        panel.name = "fore part".into();
        panel.lines[0].edges[1].name = "the side".into();
    });
    let sheet = Arc::make_mut(&mut pattern.sheets[0]);
    Arc::make_mut(&mut sheet.points[2]).name = "corner 2".into();
    assert_eq!(pattern.variables[0], before);
    let formula = before.number.as_formula().unwrap();
    assert_eq!(
        formula.text(&Names::new(&pattern)),
        "length('fore part'.'the side') / 10 + y('fore part'.'corner 2') * 0"
    );
}

#[test]
fn dividing_an_edge_and_joining_it_again_is_the_same_document() {
    let mut pattern = rich_sample();
    let body = Measurements::adult();
    let panel = panel_id(&pattern, "front");
    let right = edge(&pattern, "front", "right");
    let before = Evaluation::new(&pattern, &body);
    let (edits, corner) = plan::divide_edge(&before, (panel, right), None).unwrap();
    pattern.apply(&edits).unwrap();
    let after = Evaluation::new(&pattern, &body);
    let (old, new) = (before.draft().0, after.draft().0);
    let area = |draft: &Draft| -> f64 {
        let edges = draft.pieces[0].outline.iter();
        edges.map(|e| e.curve.swept_area()).sum()
    };
    assert!((area(&old) - area(&new)).abs() < 1e-12);
    let notch = |draft: &Draft| -> Vec2 { draft.pieces[0].notches[0].point };
    assert!((notch(&old) - notch(&new)).norm() < 1e-9);
    let side = |draft: &Draft| {
        let seam = draft.seams.iter().find(|s| s.name == "one side").unwrap();
        seam.sides[0].len()
    };
    assert_eq!((side(&old), side(&new)), (1, 2));
    assert_eq!(before.check(), after.check());
    let edits = plan::join_edges(&after, (panel, corner)).unwrap();
    pattern.apply(&edits).unwrap();
    assert!(pattern.says_the_same(&rich_sample()));
}

/// A corner that is joined away stays a point while anything is placed by it: it waits there.
#[test]
fn a_corner_that_something_is_placed_by_stays_a_point() {
    type Use<'u> = &'u dyn Fn(&mut Pattern, PointId);
    let uses: [Use<'_>; 4] = [
        &|pattern, corner| {
            let kind = dart(pattern, "top", 0.5, 0.02, Apex::Point(corner));
            put_operation(pattern, 0, "to it", kind);
        },
        &|pattern, corner| {
            let kind = OperationKind::Dart {
                line: Name::Drawn(outline(pattern, "front")),
                mouth: Mark::Along {
                    from: Name::Drawn(corner),
                    distance: 0.05.into(),
                },
                intake: 0.01.into(),
                apex: Apex::Depth(0.1.into()),
                trued: false,
                keeps_length: false,
                pressed: toile_pattern::Pressed::default(),
            };
            put_operation(pattern, 0, "beside it", kind);
        },
        &|pattern, corner| {
            let left = ends(pattern, "front", "left");
            let kind = OperationKind::Fold {
                line: Name::Drawn(outline(pattern, "front")),
                ends: [Mark::corner(left[0]), Mark::corner(corner)],
            };
            put_operation(pattern, 0, "from it", kind);
        },
        &|pattern, corner| {
            let inside = put_point(pattern, 0, "inside", PointRule::at(0.2, 0.2));
            put_line(
                pattern,
                0,
                ("pocket", LineKind::Internal),
                &[corner, inside],
            );
        },
    ];
    for (k, make) in uses.into_iter().enumerate() {
        let mut pattern = sample();
        let body = Measurements::adult();
        let panel = panel_id(&pattern, "front");
        let right = edge(&pattern, "front", "right");
        let before = Evaluation::new(&pattern, &body);
        let (edits, corner) = plan::divide_edge(&before, (panel, right), None).unwrap();
        pattern.apply(&edits).unwrap();
        make(&mut pattern, corner);
        let after = Evaluation::new(&pattern, &body);
        let edits = plan::join_edges(&after, (panel, corner)).unwrap();
        pattern.apply(&edits).unwrap();
        assert!(pattern.point(corner).is_some(), "use {k}");
        assert_eq!(pattern.panels[0].lines[0].edges.len(), 4, "use {k}");
    }
}

#[test]
fn a_corner_between_two_curves_becomes_a_straight_line() {
    let mut pattern = sample();
    let panel = panel_id(&pattern, "front");
    let corner = point(&pattern, "front", "p2");
    let evaluation = Evaluation::new(&pattern, &Measurements::adult());
    let edits = plan::remove_point(&evaluation, (panel, corner)).unwrap();
    pattern.apply(&edits).unwrap();
    let (draft, _) = pattern.resolve(&Measurements::adult());
    assert_eq!(draft.pieces[0].outline.len(), 3);
    let swept: f64 = draft.pieces[0]
        .outline
        .iter()
        .map(|e| e.curve.swept_area())
        .sum();
    assert!((swept - 0.24).abs() < 1e-12, "half the rectangle, twice");
}

#[test]
fn free_points_go_where_they_are_moved_and_formulas_stay() {
    let mut pattern = sample();
    let [a, b] = ends(&pattern, "front", "bottom");
    let right = pattern.sheets[0].curves[1].id;
    let free = [
        PointRule::at(0.1, 0.1),
        PointRule::At {
            x: formula("bust / 10"),
            y: formula("2cm"),
        },
        PointRule::Offset {
            base: a,
            x: 0.1.into(),
            y: formula("10cm"),
        },
        PointRule::Polar {
            base: a,
            angle: formula("30deg"),
            distance: 0.05.into(),
        },
        PointRule::Between {
            base: a,
            tip: b,
            along: 0.5.into(),
            aside: formula("1/10"),
        },
    ];
    for (k, rule) in free.into_iter().enumerate() {
        let id = put_point(&mut pattern, 0, &format!("free {k}"), rule);
        for to in [Vec2::new(0.03, -0.004), Vec2::new(0.2, 0.07)] {
            let evaluation = Evaluation::new(&pattern, &Measurements::adult());
            let edits = plan::move_point(&evaluation, id, to).unwrap();
            pattern.apply(&edits).unwrap();
            assert!((at(&pattern, id) - to).norm() < 1e-12, "{k}");
        }
    }
    let on_line = PointRule::Toward {
        base: a,
        tip: b,
        distance: formula("bust / 10"),
    };
    let on_curve = PointRule::OnCurve {
        curve: right,
        share: 0.5.into(),
    };
    for (rule, expected) in [(on_line, (0.3, 0.0)), (on_curve, (0.4, 0.25))] {
        let id = put_point(&mut pattern, 0, "on", rule);
        let evaluation = Evaluation::new(&pattern, &Measurements::adult());
        let edits = plan::move_point(&evaluation, id, Vec2::new(0.3, 0.25)).unwrap();
        pattern.apply(&edits).unwrap();
        let expected = Vec2::new(expected.0, expected.1);
        assert!((at(&pattern, id) - expected).norm() < 1e-9);
    }
    let foot = PointRule::Foot {
        base: a,
        line: [a, b],
    };
    let id = put_point(&mut pattern, 0, "foot", foot);
    let evaluation = Evaluation::new(&pattern, &Measurements::adult());
    assert!(plan::move_point(&evaluation, id, Vec2::zeros()).is_err());
    assert!(plan::move_point(&evaluation, a, Vec2::new(f64::NAN, 0.0)).is_err());
}

/// Only what depends on a point is computed again when it moves.
#[test]
fn a_moved_point_is_followed_by_its_dependants_alone() {
    let mut pattern = sample();
    let id = point(&pattern, "front", "p1");
    let body = Measurements::adult();
    let mut evaluation = Evaluation::new(&pattern, &body);
    let back = evaluation.last_stage(&pattern.panels[1]).unwrap().clone();
    let edits = plan::move_point(&evaluation, id, Vec2::new(0.41, 0.0)).unwrap();
    pattern.apply(&edits).unwrap();
    let update = evaluation.update(&pattern, &body);
    // The point, two curves, two edges, a stage and both seams.
    assert_eq!(update.computed, 8, "{update:?}");
    assert!(Arc::ptr_eq(
        &back,
        evaluation.last_stage(&pattern.panels[1]).unwrap()
    ));
    assert_eq!(evaluation.update(&pattern, &body).computed, 0);
}

/// A formula that named a stretch of a panel once is not looked at when that panel changes later.
#[test]
fn what_named_a_panel_once_does_not_follow_it_any_more() {
    let mut pattern = sample();
    let body = Measurements::adult();
    let number = formula_in(&pattern, "length(front.right)");
    put_variable(&mut pattern, "side", number);
    let mut kept = Evaluation::new(&pattern, &body);
    let mut plain = (*pattern.variables[0]).clone();
    plain.number = 0.5.into();
    let edit = put(Entity::Variable(Arc::new(plain)));
    pattern.apply(&[edit]).unwrap();
    kept.update(&pattern, &body);
    let mut fresh = Evaluation::new(&pattern, &body);
    alter(&mut pattern, 0, |panel| panel.allowance = 0.02.into());
    let updates = [&mut kept, &mut fresh].map(|e| e.update(&pattern, &body).computed);
    assert_eq!(updates[0], updates[1]);
}

/// A curve and an edge may have the same name; a formula says which it means.
#[test]
fn curves_named_like_edges_are_told_apart() {
    let mut pattern = sample();
    let [_, corner] = ends(&pattern, "front", "right");
    let curve = pattern.sheets[0].curves[1].id;
    let on = PointRule::OnCurve {
        curve,
        share: 0.25.into(),
    };
    let quarter = put_point(&mut pattern, 0, "quarter", on);
    let first = pattern.sheets[0].points[1].id;
    alter(&mut pattern, 0, |panel| {
        panel.lines[0].edges[1].ends = [quarter, corner];
        panel.lines[0].edges[0].ends[1] = first;
    });
    let names = Names::new(&pattern);
    for (text, length) in [
        ("length(front.right)", 0.45),
        (
            "length(curve front.right) + angle(curve 'front'.right) * 0cm",
            0.6,
        ),
        ("length(curve front.bottom)", 0.4),
    ] {
        let formula = Formula::parse(text, &names).unwrap();
        let printed = formula.text(&names);
        assert_eq!(
            Formula::parse(&printed, &names).unwrap(),
            formula,
            "{printed}"
        );
        let id = put_variable(&mut pattern, &format!("v{length}"), formula.into());
        let evaluation = Evaluation::new(&pattern, &Measurements::adult());
        let found = evaluation.variable(id).unwrap().0;
        assert!((found - length).abs() < 1e-9, "{printed} is {found}");
    }
    // A panel called so is no word before another.
    alter(&mut pattern, 1, |panel| panel.name = "curve".into());
    let names = Names::new(&pattern);
    let formula = Formula::parse("length(curve.right)", &names).unwrap();
    assert_eq!(formula.text(&names), "length(curve.right)");
}
