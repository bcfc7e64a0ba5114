//! Markers of a document: made, changed by planners, refused, left waiting.

use crate::sample::*;
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;
use toile_geometry::Vec2;
use toile_measure::Measurements;
use toile_pattern::plan::{self};
use toile_pattern::*;

fn evaluated(pattern: &Pattern) -> Evaluation {
    Evaluation::new(pattern, &Measurements::adult())
}

/// The pattern after edits of a planner.
fn after(pattern: &Pattern, edits: &[Edit]) -> Pattern {
    let mut changed = pattern.clone();
    changed.apply(edits).unwrap();
    changed
}

/// The sample with a marker of its fabric.
fn marked() -> (Pattern, MarkerId) {
    let pattern = sample();
    let fabric = pattern.fabrics[0].id;
    let (edits, id) = plan::add_marker(&evaluated(&pattern), None, fabric).unwrap();
    (after(&pattern, &edits), id)
}

fn piece(pattern: &Pattern, panel: &str) -> OrderedPiece {
    OrderedPiece {
        panel: panel_id(pattern, panel),
        copy: 0,
        size: None,
        garment: 0,
    }
}

fn placed(piece: OrderedPiece, at: [f64; 2]) -> PiecePlacement {
    PiecePlacement {
        piece,
        at,
        turn: 0.0,
        flipped: false,
        locked: false,
        roll: 0,
    }
}

/// The sample with both pieces laid.
fn laid() -> (Pattern, MarkerId, [OrderedPiece; 2]) {
    let (pattern, id) = marked();
    let pieces = ["front", "back"].map(|name| piece(&pattern, name));
    let places = [placed(pieces[0], [0.0, 0.1]), placed(pieces[1], [0.7, 0.1])];
    let edits = plan::place_pieces(&evaluated(&pattern), id, &places).unwrap();
    (after(&pattern, &edits), id, pieces)
}

fn placement(pattern: &Pattern, id: MarkerId, piece: OrderedPiece) -> PiecePlacement {
    *pattern.marker(id).unwrap().placement(piece).unwrap()
}

#[test]
fn a_marker_is_made_for_one_garment_and_renamed() {
    let (pattern, id) = marked();
    let marker = pattern.marker(id).unwrap();
    assert_eq!(marker.name, "marker");
    assert_eq!(marker.quantity(None), 1);
    let ordered: Vec<OrderedPiece> = pattern.ordered_pieces(marker).collect();
    assert_eq!(ordered, ["front", "back"].map(|name| piece(&pattern, name)));
    let fabric = pattern.fabrics[0].id;
    let (edits, second) = plan::add_marker(&evaluated(&pattern), None, fabric).unwrap();
    let pattern = after(&pattern, &edits);
    assert_eq!(pattern.marker(second).unwrap().name, "marker 2");
    let evaluation = evaluated(&pattern);
    let renamed = plan::rename(&evaluation, id.into(), "140 wide").unwrap();
    let renamed = after(&pattern, &renamed);
    assert_eq!(renamed.marker_named("140 wide").unwrap().id, id);
    let taken = plan::rename(&evaluation, id.into(), "marker 2").unwrap_err();
    assert!(taken.to_string().contains("marker \"marker 2\""), "{taken}");
    let taken = plan::add_marker(&evaluation, Some("marker"), fabric).unwrap_err();
    assert!(taken.to_string().contains("is taken"), "{taken}");
    let gone = plan::add_marker(&evaluation, None, FabricId(77)).unwrap_err();
    assert_eq!(gone, EditError::Missing("fabric 77".into()));
    let gone = plan::remove_marker(&evaluation, id).unwrap();
    assert!(after(&pattern, &gone).marker(id).is_none());
    assert!(pattern.users(fabric.into()).contains(&Place::Marker(id)));
    assert_eq!(pattern.describe(&Place::Marker(id)), "marker \"marker\"");
}

#[test]
fn a_fabric_that_a_rule_of_a_marker_names_is_not_removed() {
    let (pattern, id) = marked();
    let mut changed = pattern.clone();
    let mut lining = (*changed.fabrics[0]).clone();
    lining.id = changed.ids.take();
    lining.name = "lining".into();
    let lining_id = lining.id;
    changed.fabrics.push(Arc::new(lining));
    assert!(plan::remove_fabric(&evaluated(&changed), lining_id).is_ok());
    let marker = changed.markers.iter_mut().find(|marker| marker.id == id);
    let rule = PieceRule {
        fabric: Some(lining_id),
        ..PieceRule::default()
    };
    Arc::make_mut(marker.unwrap()).rules.push(rule);
    let refused = plan::remove_fabric(&evaluated(&changed), lining_id).unwrap_err();
    assert!(
        refused.to_string().contains("marker \"marker\""),
        "{refused}"
    );
}

#[test]
fn order_and_fabric_are_set_or_refused() {
    let (pattern, id) = marked();
    let evaluation = evaluated(&pattern);
    let order = |quantity| {
        vec![OrderedSize {
            size: None,
            quantity,
        }]
    };
    let edits = plan::set_marker_order(&evaluation, id, order(3)).unwrap();
    let more = after(&pattern, &edits);
    let marker = more.marker(id).unwrap();
    assert_eq!(more.ordered_pieces(marker).count(), 6);
    let twice = [order(1), order(2)].concat();
    for (wrong, what) in [
        (order(0), "no garment"),
        (twice, "twice"),
        (order(2001), "2000"),
    ] {
        let error = plan::set_marker_order(&evaluation, id, wrong).unwrap_err();
        assert!(error.to_string().contains(what), "{error}");
    }
    let usual = pattern.marker(id).unwrap().cloth.clone();
    let cloth = ClothSettings {
        spread: Some(Spread::FaceToFace),
        plies: Some(4),
        width: Some(1.4),
        ..usual.clone()
    };
    let edits = plan::set_marker_cloth(&evaluation, id, cloth.clone()).unwrap();
    assert_eq!(after(&pattern, &edits).marker(id).unwrap().cloth, cloth);
    let flaw = Flaw {
        at: [0.0; 2],
        size: [-1.0, 0.1],
        clearance: 0.0,
    };
    for (wrong, what) in [
        (
            ClothSettings {
                plies: Some(3),
                ..cloth.clone()
            },
            "3 plies",
        ),
        (
            ClothSettings {
                gap: Some(-0.1),
                ..usual.clone()
            },
            "the gap is -0.1",
        ),
        (
            ClothSettings {
                width: Some(f64::NAN),
                ..usual.clone()
            },
            "the width",
        ),
        (
            ClothSettings {
                flaws: Some(vec![flaw]),
                ..usual.clone()
            },
            "flaw",
        ),
    ] {
        let error = plan::set_marker_cloth(&evaluation, id, wrong.clone()).unwrap_err();
        assert!(error.to_string().contains(what), "{error}");
        // Edits that no planner made are refused as well.
        let marker = Marker {
            cloth: wrong,
            ..(**pattern.marker(id).unwrap()).clone()
        };
        let put = Edit::Put(Entity::Marker(Arc::new(marker)));
        assert_eq!(pattern.clone().apply(&[put]).unwrap_err(), error);
    }
}

#[test]
fn a_rule_takes_over_what_changed_in_another_and_keeps_the_rest() {
    for RuleFlag { label, of, usual } in RULE_FLAGS {
        let mut own = LayingRule {
            gap: Some(0.004),
            turns: Some(vec![Turn(0.0)]),
            ..LayingRule::default()
        };
        let kept = own.clone();
        let before = LayingRule {
            turns: Some(vec![Turn(PI)]),
            ..LayingRule::default()
        };
        let mut now = before.clone();
        own.take_changes(&before, &now);
        assert_eq!(own, kept, "{label}");
        *of(&mut now) = Some(!usual(false));
        own.take_changes(&before, &now);
        assert_eq!(*of(&mut own), Some(!usual(false)), "{label}");
        *of(&mut own) = None;
        assert_eq!(own, kept, "{label}: it is a flag of its own");
    }
    let of_all = LayingRule {
        gap: Some(0.01),
        on_print: Some(false),
        ..LayingRule::default()
    };
    let own = LayingRule {
        gap: Some(0.0),
        ..LayingRule::default()
    };
    let whole = own.over(&of_all);
    assert_eq!((whole.gap, whole.on_print), (Some(0.0), Some(false)));
}

#[test]
fn locked_pieces_stay_and_what_is_not_there_is_named() {
    let (pattern, id, [front, back]) = laid();
    let evaluation = evaluated(&pattern);
    let locked = plan::lock_pieces(&evaluation, (id, &[front]), true).unwrap();
    let pattern = after(&pattern, &locked);
    let evaluation = evaluated(&pattern);
    let both = [back, front];
    let aside = [placed(front, [0.1, 0.1])];
    for refused in [
        plan::move_pieces(&evaluation, (id, &both), [0.1, 0.0]),
        plan::turn_pieces(&evaluation, (id, &both), (PI, [0.0; 2])),
        plan::flip_pieces(&evaluation, (id, &both), 0.5),
        plan::take_off_pieces(&evaluation, id, &both),
        plan::place_pieces(&evaluation, id, &aside),
        plan::place_marker(&evaluation, id, aside.to_vec()),
    ] {
        let words = refused.unwrap_err().to_string();
        assert!(
            words.contains("\"front\"") && words.contains("locked"),
            "{words}"
        );
    }
    let open = plan::lock_pieces(&evaluation, (id, &[front]), false).unwrap();
    let open = evaluated(&after(&pattern, &open));
    assert!(plan::move_pieces(&open, (id, &both), [0.1, 0.0]).is_ok());
    let nowhere = plan::move_pieces(&open, (id, &both), [f64::INFINITY, 0.0]).unwrap_err();
    assert!(nowhere.to_string().contains("not finite"), "{nowhere}");
    let off = plan::take_off_pieces(&open, id, &[back]).unwrap();
    let off = evaluated(&after(open.pattern(), &off));
    let missing = plan::flip_pieces(&off, (id, &[back]), 0.5).unwrap_err();
    assert!(
        missing.to_string().contains("piece \"back\" does not lie"),
        "{missing}"
    );
    let twice = [placed(back, [0.0; 2]), placed(back, [1.0; 2])];
    let twice = plan::place_marker(&off, id, twice.to_vec()).unwrap_err();
    assert!(twice.to_string().contains("laid twice"), "{twice}");
}

#[test]
fn lost_parts_leave_their_pieces_waiting_until_they_return() {
    let (pattern, id, [front, back]) = laid();
    let third = OrderedPiece {
        garment: 1,
        ..front
    };
    let more = plan::place_pieces(&evaluated(&pattern), id, &[placed(third, [2.0, 0.1])]).unwrap();
    let pattern = after(&pattern, &more);
    assert!(evaluated(&pattern).diagnostics().is_empty());
    let gone = plan::remove_parts(&evaluated(&pattern), &[front.panel.into()]).unwrap();
    let less = after(&pattern, &gone);
    let found = evaluated(&less).diagnostics();
    let own: Vec<&Diagnostic> = found
        .iter()
        .filter(|d| d.place == Place::Marker(id))
        .collect();
    assert_eq!(own.len(), 1, "{found:?}");
    assert_eq!(
        (own[0].code, own[0].severity),
        (Code::MissingReference, Severity::Warning)
    );
    assert!(
        own[0].message.contains("2 pieces of it wait"),
        "{}",
        own[0].message
    );
    assert_eq!(less.marker(id), pattern.marker(id), "nothing of it is lost");
    // A search meanwhile lays what is there, and does not touch what waits.
    let found = plan::place_marker(&evaluated(&less), id, vec![placed(back, [0.3, 0.2])]).unwrap();
    let searched = after(&less, &found);
    assert_eq!(placement(&searched, id, back).at, [0.3, 0.2]);
    assert_eq!(
        placement(&searched, id, front),
        placement(&pattern, id, front)
    );
    let put = Edit::Put(Entity::Panel(pattern.panel(front.panel).unwrap().clone()));
    let back_again = after(&searched, &[put]);
    let found = evaluated(&back_again).diagnostics();
    assert!(
        found.iter().all(|d| d.place != Place::Marker(id)),
        "{found:?}"
    );
    // The fabric too.
    let fabric = pattern.fabrics[0].id;
    let bare = after(&pattern, &[Edit::Remove(fabric.into())]);
    let found = evaluated(&bare).diagnostics();
    let own = |d: &&Diagnostic| d.place == Place::Marker(id);
    assert_eq!(found.iter().filter(own).count(), 1, "{found:?}");
}

#[test]
fn what_never_was_is_refused() {
    let (pattern, id, [front, _]) = laid();
    let marker = (**pattern.marker(id).unwrap()).clone();
    let panel = |panel: PanelId| {
        let mut wrong = marker.clone();
        wrong.placements[0].piece = OrderedPiece { panel, ..front };
        Edit::Put(Entity::Marker(Arc::new(wrong)))
    };
    let never = pattern.clone().apply(&[panel(PanelId(9_999))]).unwrap_err();
    assert!(never.to_string().contains("never given"), "{never}");
    let kind = PanelId(pattern.sheets[0].id.0);
    let kind = pattern.clone().apply(&[panel(kind)]).unwrap_err();
    assert!(kind.to_string().contains("another kind"), "{kind}");
}

/// Where a point of a piece with its grain along +x lies.
fn lies(laid: &PiecePlacement, p: Vec2) -> Vec2 {
    let p = if laid.flipped {
        Vec2::new(p.x, -p.y)
    } else {
        p
    };
    let (sin, cos) = laid.turn.sin_cos();
    Vec2::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y) + Vec2::from(laid.at)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(200) })]

    /// Every point of a piece moves as the planner says.
    #[test]
    fn pieces_move_as_rigid_bodies(
        (turn, flipped) in (-3.0..3.0f64, any::<bool>()),
        (x, y) in (-1.0..1.0f64, -1.0..1.0f64),
        (angle, line) in (prop::sample::select(vec![0.1, FRAC_PI_2, PI, -PI, 5.0]), -1.0..1.0f64),
    ) {
        let (pattern, id, [front, _]) = laid();
        let start = PiecePlacement { turn, flipped, ..placed(front, [x, y]) };
        let edits = plan::place_pieces(&evaluated(&pattern), id, &[start]).unwrap();
        let pattern = after(&pattern, &edits);
        let evaluation = evaluated(&pattern);
        let which = (id, &[front][..]);
        let planned = |edits: Result<Vec<Edit>, EditError>| {
            placement(&after(&pattern, &edits.unwrap()), id, front)
        };
        let moved = planned(plan::move_pieces(&evaluation, which, [0.2, -0.3]));
        let turned = planned(plan::turn_pieces(&evaluation, which, (angle, [0.5, line])));
        let flipped = planned(plan::flip_pieces(&evaluation, which, line));
        for p in [Vec2::new(0.0, 0.0), Vec2::new(0.4, 0.1), Vec2::new(-0.2, 0.7)] {
            let from = lies(&start, p);
            prop_assert!((lies(&moved, p) - from - Vec2::new(0.2, -0.3)).norm() < 1e-12);
            let arm = from - Vec2::new(0.5, line);
            let (sin, cos) = angle.sin_cos();
            let arm = Vec2::new(cos * arm.x - sin * arm.y, sin * arm.x + cos * arm.y);
            prop_assert!((lies(&turned, p) - Vec2::new(0.5, line) - arm).norm() < 1e-12);
            let over = Vec2::new(from.x, 2.0 * line - from.y);
            prop_assert!((lies(&flipped, p) - over).norm() < 1e-12);
        }
        prop_assert!(turned.turn > -PI - 1e-12 && turned.turn <= PI);
    }
}
