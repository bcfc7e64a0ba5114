//! Edits: absolute, all or nothing, and undone exactly.
#![allow(clippy::unwrap_used)]

mod sample;

use proptest::prelude::*;
use sample::*;
use toile_geometry::Vec2;
use toile_measure::Measurements;
use toile_pattern::*;

/// The pattern with its id counters forgotten: undoing does not turn them back.
fn timeless(pattern: &Pattern) -> Pattern {
    Pattern {
        ids: IdCounters::default(),
        ..pattern.clone()
    }
}

fn in_front(edit: PanelEdit) -> Edit {
    Edit::InPanel { panel: FRONT, edit }
}

fn rich_sample() -> Pattern {
    let mut pattern = sample();
    let top = edge(&pattern, "front", "top").1;
    alter(&mut pattern, 0, |panel| {
        panel.outline[1].curve = EdgeCurve::Arc { bulge: 0.2.into() };
        panel.notches.push(Notch {
            id: NotchId(0),
            name: "notch".into(),
            edge: panel.outline[1].id,
            at: Along::Fraction(0.75.into()),
        });
        panel.darts.push(Dart {
            id: DartId(0),
            name: "dart".into(),
            shape: DartShape::Edge {
                edge: top,
                at: 0.5.into(),
                width: 0.02.into(),
                tip: DartTip::Depth(0.1.into()),
            },
        });
    });
    alter_seam(&mut pattern, 0, |seam| seam.ease = formula("ease"));
    pattern.variables.push(Variable {
        name: "ease".into(),
        number: formula("length(front.right) / 10 + y(front.p2) * 0"),
    });
    pattern.sizes.push(Size {
        name: "M".into(),
        measurements: Measurements::adult(),
    });
    pattern.ids.dart = 1;
    pattern.ids.notch = 1;
    pattern
}

fn edits() -> Vec<Edit> {
    let mut ids = rich_sample().ids;
    let pocket = rectangle(&mut ids, "pocket", [0.1, 0.1]);
    let mut silk = Fabric::poplin(ids.take_fabric());
    silk.name = "silk".into();
    let seam = Seam::new(
        ids.take_seam(),
        "pocket",
        [
            vec![Span::whole(pocket.id, pocket.outline[0].id)],
            vec![Span::whole(FRONT, EdgeId(0))],
        ],
    );
    vec![
        Edit::SetName("other".into()),
        Edit::SetUnit(DisplayUnit::Inch),
        Edit::SetBaseSize(Some("M".into())),
        Edit::PutSize {
            at: 0,
            size: Size {
                name: "S".into(),
                measurements: Measurements::adult_woman(),
            },
        },
        Edit::RemoveSize("M".into()),
        Edit::SetMeasurement {
            size: "M".into(),
            name: "bust".into(),
            value: Some(1.1),
        },
        Edit::SetMeasurement {
            size: "M".into(),
            name: "bust".into(),
            value: None,
        },
        Edit::PutVariable {
            at: 0,
            variable: Variable {
                name: "length".into(),
                number: formula("60cm"),
            },
        },
        Edit::RemoveVariable("ease".into()),
        Edit::RenameVariable {
            from: "ease".into(),
            to: "fullness".into(),
        },
        Edit::PutFabric {
            at: 0,
            fabric: silk.clone(),
        },
        Edit::PutPanel {
            at: 1,
            panel: Box::new(pocket.clone()),
        },
        Edit::Many(vec![
            Edit::PutFabric {
                at: 9,
                fabric: silk.clone(),
            },
            Edit::PutPanel {
                at: 0,
                panel: Box::new(pocket),
            },
            Edit::PutSeam { at: 0, seam },
            in_front(PanelEdit::SetFabric(silk.id)),
            Edit::RemovePanel(BACK),
        ]),
        Edit::RemovePanel(FRONT),
        Edit::RemoveSeam(SeamId(0)),
        in_front(PanelEdit::Rename("forepart".into())),
        in_front(PanelEdit::RenamePoint {
            point: PointId(2),
            name: "corner".into(),
        }),
        in_front(PanelEdit::RenameEdge {
            edge: EdgeId(1),
            name: "side seam".into(),
        }),
        in_front(PanelEdit::MovePoint {
            point: PointId(1),
            place: PointPlace::at(0.45, -0.02),
        }),
        in_front(PanelEdit::PutPoint {
            at: 0,
            point: Point {
                id: PointId(50),
                name: "mark".into(),
                place: PointPlace::at(0.1, 0.1),
            },
        }),
        in_front(PanelEdit::SetEdgeCurve {
            edge: EdgeId(0),
            curve: EdgeCurve::Quadratic {
                control: PointId(2),
            },
        }),
        in_front(PanelEdit::SetEdgeAllowance {
            edge: EdgeId(0),
            allowance: Some(formula("2cm")),
        }),
        in_front(PanelEdit::SetSeamAllowance(formula("1cm"))),
        in_front(PanelEdit::RemoveDart(DartId(0))),
        in_front(PanelEdit::RemoveNotch(NotchId(0))),
        in_front(PanelEdit::SetGrain(formula("45deg"))),
        in_front(PanelEdit::SetFold(Some(EdgeId(3)))),
        in_front(PanelEdit::SetCut(Cut {
            quantity: 2,
            mirrored: true,
        })),
        in_front(PanelEdit::SetWorn(WornRule::Wrapped {
            part: BodyPart::Trunk,
            facing: Facing::Front,
            level: None,
        })),
        in_front(PanelEdit::JoinEdges {
            point: PointId(3),
            at: 0.4,
        }),
        in_front(PanelEdit::SplitEdge {
            edge: EdgeId(0),
            at: 0.5,
            points: vec![Point {
                id: PointId(60),
                name: "middle".into(),
                place: PointPlace::at(0.2, 0.0),
            }],
            curves: [EdgeCurve::Line, EdgeCurve::Line],
            new_edge: EdgeId(60),
            name: "bottom 2".into(),
        }),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

    #[test]
    fn any_run_of_edits_is_undone_and_redone_exactly(
        choices in prop::collection::vec(0..edits().len(), 1..12),
    ) {
        let all = edits();
        let start = rich_sample();
        let mut pattern = start.clone();
        let mut undo = Vec::new();
        for choice in choices {
            let before = pattern.clone();
            match pattern.apply(all[choice].clone()) {
                Ok(inverse) => undo.push((before, inverse, pattern.clone())),
                Err(error) => {
                    prop_assert_eq!(&pattern, &before, "unchanged on {}", error);
                }
            }
        }
        for (before, inverse, after) in undo.into_iter().rev() {
            let redo = pattern.apply(inverse).unwrap();
            prop_assert_eq!(timeless(&pattern), timeless(&before));
            let mut again = pattern.clone();
            again.apply(redo).unwrap();
            prop_assert_eq!(timeless(&again), timeless(&after));
        }
        prop_assert_eq!(timeless(&pattern), timeless(&start));
    }
}

#[test]
fn every_edit_of_the_list_applies_and_survives_json() {
    for edit in edits() {
        let text = serde_json::to_string(&edit).unwrap();
        assert_eq!(serde_json::from_str::<Edit>(&text).unwrap(), edit);
        let mut pattern = rich_sample();
        let before = pattern.clone();
        pattern.apply(edit.clone()).unwrap();
        assert_ne!(timeless(&pattern), timeless(&before), "{edit:?}");
    }
}

#[test]
fn refused_edits_change_nothing_and_say_why() {
    let point = |place| PanelEdit::MovePoint {
        point: PointId(0),
        place,
    };
    for (edit, says) in [
        (in_front(point(PointPlace::at(f64::NAN, 0.0))), "not finite"),
        (in_front(PanelEdit::Rename("back".into())), "taken"),
        (in_front(PanelEdit::Rename(" ".into())), "cannot be a name"),
        (
            in_front(PanelEdit::Rename("it's".into())),
            "cannot be a name",
        ),
        (in_front(PanelEdit::RemovePoint(PointId(0))), "used by edge"),
        (in_front(PanelEdit::RemovePoint(PointId(99))), "not there"),
        (in_front(PanelEdit::SetFold(Some(EdgeId(99)))), "not there"),
        (in_front(PanelEdit::SetFabric(FabricId(9))), "not there"),
        (Edit::RemovePanel(PanelId(9)), "not there"),
        (Edit::RemoveFabric(FabricId(0)), "used by panel"),
        (Edit::SetBaseSize(Some("XXL".into())), "not there"),
        (
            Edit::Many(vec![
                Edit::SetName("half done".into()),
                Edit::RemoveSeam(SeamId(99)),
            ]),
            "not there",
        ),
        (
            in_front(PanelEdit::JoinEdges {
                point: PointId(1),
                at: 1.5,
            }),
            "choose a place between",
        ),
    ] {
        let mut pattern = rich_sample();
        let error = pattern.apply(edit.clone()).unwrap_err();
        assert!(error.to_string().contains(says), "{edit:?}: {error}");
        assert_eq!(pattern, rich_sample());
    }
    let mut deep = Edit::SetName("deep".into());
    for _ in 0..100 {
        deep = Edit::Many(vec![deep]);
    }
    assert!(rich_sample().apply(deep).is_err());
}

#[test]
fn renaming_keeps_formulas_meaning_the_same() {
    let mut pattern = rich_sample();
    let body = Measurements::adult();
    let before = pattern.check(&body);
    for edit in [
        in_front(PanelEdit::Rename("fore part".into())),
        in_front(PanelEdit::RenameEdge {
            edge: EdgeId(1),
            name: "the side".into(),
        }),
        in_front(PanelEdit::RenamePoint {
            point: PointId(2),
            name: "corner 2".into(),
        }),
        Edit::RenameVariable {
            from: "ease".into(),
            to: "more or less".into(),
        },
    ] {
        pattern.apply(edit).unwrap();
    }
    assert_eq!(pattern.check(&body).len(), before.len());
    let Number::Formula(formula) = &pattern.variables[0].number else {
        panic!("still a formula");
    };
    assert_eq!(
        formula.text(),
        "length('fore part'.'the side') / 10 + y('fore part'.'corner 2') * 0"
    );
}

#[test]
fn splitting_an_edge_keeps_shape_seams_and_notches_in_place() {
    let mut pattern = rich_sample();
    let body = Measurements::adult();
    let right = edge(&pattern, "front", "right");
    let (before, _) = pattern.resolve(&body);
    let edit = pattern.split_edit(&body, right, 0.5).unwrap();
    pattern.apply(edit).unwrap();
    let (after, found) = pattern.resolve(&body);
    assert!(found.is_empty(), "{found:?}");
    let area = |draft: &Draft| -> f64 {
        let edges = draft.pieces[0].outline.iter();
        edges.map(|e| e.curve.swept_area()).sum()
    };
    assert!((area(&before) - area(&after)).abs() < 1e-12);
    let notch = |draft: &Draft| -> Vec2 { draft.pieces[0].notches[0].point };
    assert!((notch(&before) - notch(&after)).norm() < 1e-9);
    let seam = |draft: &Draft| {
        draft
            .seams
            .iter()
            .position(|s| s.name == "one side")
            .unwrap()
    };
    assert_eq!(before.seams[seam(&before)].sides[0].len(), 1);
    assert_eq!(after.seams[seam(&after)].sides[0].len(), 2);
    assert_eq!(pattern.check(&body), rich_sample().check(&body));

    let corner = pattern.panel(FRONT).unwrap().edge(right.1).unwrap().ends[1];
    let edit = pattern.join_edit(&body, (FRONT, corner)).unwrap();
    pattern.apply(edit).unwrap();
    let panel = pattern.panel(FRONT).unwrap();
    assert_eq!(panel.outline.len(), 4);
    assert!(panel.point(corner).is_none());
    let spans = &pattern.seams[0].sides[0];
    assert_eq!(spans.len(), 1, "the two spans are one again");
    assert_eq!(spans[0].edge, right.1);
}

#[test]
fn removing_a_panel_removes_its_seams_and_undo_brings_them_back() {
    let mut pattern = sample();
    let undo = pattern.apply(Edit::RemovePanel(BACK)).unwrap();
    assert!(pattern.seams.is_empty());
    pattern.apply(undo).unwrap();
    assert_eq!(timeless(&pattern), timeless(&sample()));
}

#[test]
fn a_snapshot_shares_what_was_not_edited() {
    let before = sample();
    let mut after = before.clone();
    after
        .apply(in_front(PanelEdit::SetGrain(0.0.into())))
        .unwrap();
    assert!(!std::sync::Arc::ptr_eq(&before.panels[0], &after.panels[0]));
    assert!(std::sync::Arc::ptr_eq(&before.panels[1], &after.panels[1]));
    assert!(std::sync::Arc::ptr_eq(&before.seams[0], &after.seams[0]));
}
