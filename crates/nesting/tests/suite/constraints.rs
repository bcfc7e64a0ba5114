//! Each rule of the trade: the search keeps it, and the referee catches it when it is broken.

use std::f64::consts::PI;
use std::sync::atomic::AtomicBool;
use toile_geometry::{Bounds2, Polygon, Vec2};
use toile_nesting::{
    Allowed, Control, Flaw, Fold, FoldEdge, Item, ItemProblem, Locked, Marker, MatchPoint, Mirror,
    Nap, NestingError, Phase, Search, Strip, Stripes, Verdict, Violation, judge, make_marker,
};

const EVALUATIONS: u64 = 300_000;

fn try_make(items: &[Item], strip: &Strip) -> Result<Marker, NestingError> {
    let mut control = Control {
        progress: &mut |_| {},
        cancel: &AtomicBool::new(false),
    };
    make_marker(items, strip, Search::evaluations(EVALUATIONS), &mut control)
}

/// A sound marker with everything on it.
fn make(items: &[Item], strip: &Strip) -> Marker {
    let marker = try_make(items, strip).unwrap();
    let verdict = judge(items, strip, &marker);
    assert!(verdict.is_sound(), "{:?}", verdict.violations);
    assert!(marker.unplaced.is_empty(), "{:?}", marker.unplaced);
    marker
}

/// What the referee says when one placement is changed and all lengths are told truly.
fn planted(
    items: &[Item],
    strip: &Strip,
    marker: &Marker,
    change: impl FnOnce(&mut Marker),
) -> Verdict {
    let mut marker = marker.clone();
    change(&mut marker);
    marker.measure(items, strip);
    judge(items, strip, &marker)
}

fn caught(verdict: &Verdict, is_it: impl Fn(&Violation) -> bool) {
    assert!(
        verdict.violations.iter().any(is_it),
        "{:?}",
        verdict.violations
    );
}

fn rectangle(x: f64, y: f64, length: f64, width: f64) -> Polygon {
    Polygon::rectangle(Bounds2 {
        min: Vec2::new(x, y),
        max: Vec2::new(x + length, y + width),
    })
}

/// A piece that is neither symmetrical nor convex.
fn sleeve() -> Polygon {
    let points = [
        (0.0, 0.0),
        (0.5, 0.05),
        (0.55, 0.2),
        (0.48, 0.35),
        (0.3, 0.3),
        (0.02, 0.4),
    ];
    Polygon::new(points.iter().map(|&(x, y)| Vec2::new(x, y)).collect())
}

fn sleeves(quantity: u32) -> Item {
    Item {
        quantity,
        ..Item::new("sleeve", sleeve())
    }
}

#[test]
fn tilt_stays_within_its_tolerance() {
    let mut item = sleeves(5);
    item.allowed.tilt = 3f64.to_radians();
    let items = [item];
    let strip = Strip::of_width(0.9);
    let marker = make(&items, &strip);
    let tilted = |p: &&toile_nesting::Placement| p.turn.sin().abs() > 1e-9;
    assert!(marker.placements.iter().any(|p| tilted(&p)), "tilt is used");
    let verdict = planted(&items, &strip, &marker, |m| {
        m.placements[0].turn = 3.1f64.to_radians();
    });
    caught(&verdict, |v| {
        matches!(v, Violation::Orientation { placement: 0, .. })
    });
}

#[test]
fn one_way_nap_and_pairs_are_kept() {
    let strip = Strip {
        nap: Nap::OneWay,
        ..Strip::of_width(0.9)
    };
    let mut item = sleeves(4);
    item.allowed.mirror = Mirror::Pairs;
    let items = [item];
    let marker = make(&items, &strip);
    assert_eq!(marker.placements.iter().filter(|p| p.mirrored).count(), 2);
    let turned = planted(&items, &strip, &marker, |m| m.placements[1].turn = PI);
    caught(&turned, |v| {
        matches!(v, Violation::Orientation { placement: 1, .. })
    });
    let flipped = planted(&items, &strip, &marker, |m| {
        m.placements[1].mirrored = false
    });
    caught(&flipped, |v| {
        matches!(v, Violation::Orientation { placement: 1, .. })
    });
}

#[test]
fn each_garment_runs_one_way() {
    let strip = Strip {
        nap: Nap::PerBundle,
        ..Strip::of_width(0.9)
    };
    let garment = |name: &str, outline: Polygon| Item {
        quantity: 3,
        bundles: vec![0, 1, 2],
        ..Item::new(name, outline)
    };
    let items = [
        garment("sleeve", sleeve()),
        garment("yoke", rectangle(0.0, 0.0, 0.3, 0.2)),
    ];
    let marker = make(&items, &strip);
    let verdict = planted(&items, &strip, &marker, |m| {
        m.placements[0].turn = if m.placements[0].turn == 0.0 { PI } else { 0.0 };
    });
    caught(&verdict, |v| matches!(v, Violation::Nap { bundle: 0, .. }));
}

#[test]
fn pieces_on_a_fold_lie_on_it() {
    let half = Item {
        quantity: 2,
        fold_edge: Some(FoldEdge::Lower),
        ..Item::new("front", rectangle(0.0, 0.0, 0.6, 0.25))
    };
    let items = [half, sleeves(4)];
    let folded = Strip {
        fold: Fold::Lower,
        selvedge: 0.02,
        ..Strip::of_width(0.75)
    };
    let marker = make(&items, &folded);
    let verdict = planted(&items, &folded, &marker, |m| {
        m.placements[0].translation.y += 0.01
    });
    caught(
        &verdict,
        |v| matches!(v, Violation::OffFold { placement: 0, by } if (by - 0.01).abs() < 1e-9),
    );
    // A tube takes one on either fold.
    let tube = Strip {
        fold: Fold::Both,
        ..folded.clone()
    };
    let marker = make(&items, &tube);
    let front = |m: &Marker, k: usize| m.placements[k].pose(&items[0]).lay(&items[0].outline);
    for k in 0..2 {
        let bounds = front(&marker, k).bounds();
        assert!(bounds.min.y.abs() < 1e-9 || (bounds.max.y - 0.75).abs() < 1e-9);
    }
    match try_make(&items, &Strip::of_width(0.75)) {
        Err(NestingError::Refused(list)) => assert_eq!(list[0].problem, ItemProblem::NoFold),
        other => panic!("{other:?}"),
    }
}

#[test]
fn gaps_and_margins_are_kept_all_round() {
    let mut wide = sleeves(3);
    wide.gap = 0.02;
    let items = [
        wide,
        Item {
            quantity: 3,
            ..Item::new("box", rectangle(0.0, 0.0, 0.2, 0.2))
        },
    ];
    let strip = Strip {
        gap: 0.004,
        selvedge: 0.015,
        end_margin: 0.03,
        ..Strip::of_width(0.9)
    };
    let marker = make(&items, &strip);
    let nearest = judge(&items, &strip, &marker).nearest;
    assert!((0.004..0.0201).contains(&nearest), "{nearest}");
    let verdict = planted(&items, &strip, &marker, |m| {
        m.placements[0].translation.y = -0.001
    });
    caught(&verdict, |v| {
        matches!(v, Violation::Outside { placement: 0, .. })
    });
}

#[test]
fn match_points_lie_on_the_print() {
    let mut items = [
        sleeves(4),
        Item {
            quantity: 2,
            ..Item::new("box", rectangle(0.0, 0.0, 0.3, 0.22))
        },
    ];
    items[0].match_point = Some(MatchPoint {
        point: Vec2::new(0.1, 0.2),
        phase: Phase::At(Vec2::new(0.01, 0.0)),
    });
    for repeat in [
        Vec2::new(0.08, 0.0),
        Vec2::new(0.0, 0.05),
        Vec2::new(0.08, 0.05),
    ] {
        let strip = Strip {
            stripes: Some(Stripes {
                repeat,
                origin: Vec2::new(0.02, 0.03),
            }),
            selvedge: 0.01,
            ..Strip::of_width(0.9)
        };
        let marker = make(&items, &strip);
        let verdict = planted(&items, &strip, &marker, |m| {
            m.placements[2].translation += Vec2::new(0.004, 0.004);
        });
        caught(&verdict, |v| {
            matches!(v, Violation::OffPrint { placement: 2, .. })
        });
    }
}

#[test]
fn a_matched_set_lies_alike_wherever_that_is() {
    let matched = |name: &str, outline: Polygon, point: Vec2| Item {
        quantity: 2,
        match_point: Some(MatchPoint {
            point,
            phase: Phase::Set(3),
        }),
        ..Item::new(name, outline)
    };
    let items = [
        matched("sleeve", sleeve(), Vec2::new(0.5, 0.05)),
        matched("front", rectangle(0.0, 0.0, 0.5, 0.3), Vec2::new(0.4, 0.3)),
    ];
    let strip = Strip {
        stripes: Some(Stripes {
            repeat: Vec2::new(0.06, 0.0),
            origin: Vec2::zeros(),
        }),
        ..Strip::of_width(0.9)
    };
    let marker = make(&items, &strip);
    let verdict = planted(&items, &strip, &marker, |m| {
        m.placements[3].translation.x += 0.01
    });
    caught(&verdict, |v| {
        matches!(v, Violation::OffPrint { placement: 3, .. })
    });
}

#[test]
fn flaws_are_left_out_but_by_pieces_that_may_hide_them() {
    let mut pocket = Item {
        quantity: 6,
        ..Item::new("pocket", rectangle(0.0, 0.0, 0.2, 0.2))
    };
    pocket.over_flaws = true;
    let items = [sleeves(5), pocket];
    let strip = Strip {
        flaws: vec![
            Flaw {
                outline: rectangle(0.4, 0.4, 0.05, 0.02),
                clearance: 0.005,
            },
            Flaw {
                outline: rectangle(0.1, 0.1, 0.01, 0.01),
                clearance: 0.0,
            },
        ],
        ..Strip::of_width(0.9)
    };
    let marker = make(&items, &strip);
    let verdict = planted(&items, &strip, &marker, |m| {
        m.placements[0].translation = Vec2::new(0.2, 0.2);
        m.placements[0].turn = 0.0;
    });
    caught(
        &verdict,
        |v| matches!(v, Violation::OnFlaw { placement: 0, flaw: 0, area } if *area > 9e-4),
    );
    let verdict = planted(&items, &strip, &marker, |m| {
        m.placements[5].translation = Vec2::new(0.35, 0.35);
    });
    let over = |v: &Violation| matches!(v, Violation::OnFlaw { placement: 5, .. });
    assert!(!verdict.violations.iter().any(over), "a pocket may");
}

#[test]
fn locked_pieces_stay() {
    let mut items = [sleeves(4)];
    items[0].allowed = Allowed::two_way();
    let lock = Locked {
        copy: 2,
        turn: PI,
        mirrored: false,
        translation: Vec2::new(1.0, 0.7),
    };
    items[0].locked = vec![lock];
    let strip = Strip::of_width(0.9);
    let marker = make(&items, &strip);
    assert_eq!(marker.placements[2].translation, lock.translation);
    let verdict = planted(&items, &strip, &marker, |m| {
        m.placements[2].translation.x += 0.001
    });
    caught(&verdict, |v| matches!(v, Violation::Moved { placement: 2 }));
    items[0].locked[0].turn = 1.0;
    match try_make(&items, &strip) {
        Err(NestingError::Refused(list)) => assert_eq!(list[0].problem, ItemProblem::Locked(2)),
        other => panic!("{other:?}"),
    }
}

#[test]
fn overlaps_are_shown_as_what_is_cut_twice() {
    let items = [Item {
        quantity: 2,
        ..Item::new("box", rectangle(0.0, 0.0, 0.2, 0.2))
    }];
    let strip = Strip::of_width(0.9);
    let marker = make(&items, &strip);
    let verdict = planted(&items, &strip, &marker, |m| {
        m.placements[0].turn = 0.0;
        m.placements[0].translation = Vec2::zeros();
        m.placements[1].turn = 0.0;
        m.placements[1].translation = Vec2::new(0.15, 0.1);
    });
    let (pair, shared) = &verdict.overlaps[0];
    assert_eq!(*pair, [0, 1]);
    let area: f64 = shared.iter().map(Polygon::area).sum();
    assert!((area - 0.05 * 0.1).abs() < 1e-8, "{area}");
}

#[test]
fn too_many_points_and_copies_are_refused_by_name() {
    let ring = |count: u32| {
        let point = |k: u32| {
            let angle = std::f64::consts::TAU * f64::from(k) / f64::from(count);
            Vec2::new(angle.cos(), angle.sin()) * 0.2
        };
        Polygon::new((0..count).map(point).collect())
    };
    let cases = [
        (
            Item::new("disc", ring(1_000_000)),
            ItemProblem::TooManyPoints(1_000_000),
        ),
        (
            Item {
                quantity: u32::MAX,
                ..Item::new("disc", ring(20))
            },
            ItemProblem::TooMany(u32::MAX),
        ),
    ];
    for (item, problem) in cases {
        let error = try_make(&[item], &Strip::of_width(1.0)).unwrap_err();
        assert!(error.to_string().contains("piece \"disc\""), "{error}");
        match error {
            NestingError::Refused(list) => assert_eq!(list[0].problem, problem),
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn too_many_pieces_together_are_refused() {
    let item = |name: &str| Item {
        quantity: 1_500,
        ..Item::new(name, rectangle(0.0, 0.0, 0.01, 0.01))
    };
    let error = try_make(&[item("one"), item("two")], &Strip::of_width(1.0)).unwrap_err();
    assert!(error.to_string().contains("3000 pieces"), "{error}");
}

#[test]
fn the_remedy_for_wide_pieces_is_the_width_of_the_open_fabric() {
    let items = [Item::new("yoke", rectangle(0.0, 0.0, 0.3, 0.9))];
    for (fold, open) in [
        (Fold::Open, "940 mm"),
        (Fold::Lower, "1840 mm"),
        (Fold::Both, "1800 mm"),
    ] {
        let strip = Strip {
            fold,
            selvedge: 0.02,
            ..Strip::of_width(0.8)
        };
        let words = try_make(&items, &strip).unwrap_err().to_string();
        assert!(
            words.contains(&format!("at least {open} wide")),
            "{fold:?}: {words}"
        );
    }
}
