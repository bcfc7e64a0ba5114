//! Locked copies: what they fix, and what is refused before any search.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::atomic::AtomicBool;
use toile_geometry::{Bounds2, Polygon, Vec2};
use toile_nesting::{
    Allowed, Control, Fold, FoldEdge, Item, Locked, Marker, MatchPoint, Mirror, Nap, NestingError,
    Phase, Search, Strip, Stripes, Violation, judge, make_marker,
};

fn try_make(items: &[Item], strip: &Strip, seed: u64) -> Result<Marker, NestingError> {
    let mut control = Control {
        progress: &mut |_| {},
        cancel: &AtomicBool::new(false),
    };
    let search = Search {
        seed,
        ..Search::evaluations(100_000)
    };
    make_marker(items, strip, search, &mut control)
}

fn make(items: &[Item], strip: &Strip, seed: u64) -> Marker {
    let marker = try_make(items, strip, seed).unwrap();
    let verdict = judge(items, strip, &marker);
    assert!(verdict.is_sound(), "{:?}", verdict.violations);
    assert!(marker.unplaced.is_empty(), "{:?}", marker.unplaced);
    marker
}

/// The refusal, which names the piece and the locked copy.
fn refused(items: &[Item], strip: &Strip) -> String {
    let error = try_make(items, strip, 1).unwrap_err();
    assert!(matches!(error, NestingError::Refused(_)), "{error}");
    let words = error.to_string();
    assert!(words.contains("locked copy"), "{words}");
    words
}

fn rectangle(length: f64, width: f64) -> Polygon {
    Polygon::rectangle(Bounds2 {
        min: Vec2::zeros(),
        max: Vec2::new(length, width),
    })
}

fn wedge() -> Polygon {
    let points = [(0.0, 0.0), (0.5, 0.0), (0.3, 0.4), (0.1, 0.35)];
    Polygon::new(points.iter().map(|&(x, y)| Vec2::new(x, y)).collect())
}

fn locked(copy: u32, turn: f64, x: f64, y: f64) -> Locked {
    Locked {
        copy,
        turn,
        mirrored: false,
        translation: Vec2::new(x, y),
    }
}

#[test]
fn a_lock_off_the_fold_is_refused() {
    let strip = Strip {
        fold: Fold::Lower,
        ..Strip::of_width(0.8)
    };
    let half = |turns: Vec<f64>, lock: Locked| Item {
        fold_edge: Some(FoldEdge::Upper),
        allowed: Allowed::turned(turns).mirrored(Mirror::Free),
        locked: vec![lock],
        ..Item::new("front", rectangle(0.5, 0.3))
    };
    let words = refused(&[half(vec![0.0, PI], locked(0, 0.0, 0.0, 0.0))], &strip);
    assert!(words.contains("fold edge"), "{words}");
    // Its fold edge across the fold.
    let across = half(vec![0.0, PI, FRAC_PI_2], locked(0, FRAC_PI_2, 0.3, 0.0));
    refused(&[across], &strip);
    make(&[half(vec![0.0, PI], locked(0, PI, 0.5, 0.3))], &strip, 1);
}

#[test]
fn locks_that_break_a_rule_are_refused_by_name() {
    let item = |locks: Vec<Locked>| Item {
        quantity: 4,
        locked: locks,
        ..Item::new("wedge", wedge())
    };
    let plain = Strip {
        gap: 0.01,
        selvedge: 0.02,
        ..Strip::of_width(0.9)
    };
    for (locks, nap, what) in [
        (vec![locked(0, PI, 0.6, 0.6)], Nap::OneWay, "nap"),
        (vec![locked(0, 0.0, 0.0, 0.7)], Nap::None, "selvedge"),
        (vec![locked(0, 0.0, -0.1, 0.1)], Nap::None, "at the start"),
        (
            vec![locked(0, 0.0, 0.0, 0.1), locked(1, 0.0, 0.505, 0.1)],
            Nap::None,
            "apart and need 10.00 mm",
        ),
        (
            vec![locked(0, 0.0, 0.0, 0.1), locked(3, PI, 0.6, 0.6)],
            Nap::PerBundle,
            "opposite ways",
        ),
    ] {
        let strip = Strip {
            nap,
            ..plain.clone()
        };
        let words = refused(&[item(locks)], &strip);
        assert!(
            words.contains(what) && words.contains("\"wedge\""),
            "{what}: {words}"
        );
    }
}

#[test]
fn locks_that_touch_do_not_crowd_out_the_rest() {
    let items = [Item {
        quantity: 6,
        locked: vec![locked(0, 0.0, 0.0, 0.0), locked(1, 0.0, 0.3, 0.0)],
        ..Item::new("box", rectangle(0.3, 0.2))
    }];
    let marker = make(&items, &Strip::of_width(0.65), 1);
    assert!(marker.length < 0.65, "{}", marker.length);
}

#[test]
fn a_locked_member_fixes_where_its_set_lies() {
    let matched = |name: &str, outline: Polygon| Item {
        quantity: 2,
        match_point: Some(MatchPoint {
            point: Vec2::new(0.1, 0.1),
            phase: Phase::Set(3),
        }),
        ..Item::new(name, outline)
    };
    let strip = Strip {
        stripes: Some(Stripes {
            repeat: Vec2::new(0.07, 0.05),
            origin: Vec2::new(0.01, 0.0),
        }),
        ..Strip::of_width(0.9)
    };
    for seed in 1..4 {
        let mut items = [
            matched("wedge", wedge()),
            matched("box", rectangle(0.5, 0.3)),
        ];
        items[0].locked = vec![locked(1, 0.0, 0.2345, 0.123)];
        make(&items, &strip, seed);
        // Two that disagree cannot be.
        items[1].locked = vec![locked(0, 0.0, 0.9, 0.1)];
        let words = refused(&items, &strip);
        assert!(words.contains("beside the print"), "{words}");
    }
}

#[test]
fn the_same_turn_said_otherwise_is_the_same() {
    let items = [Item {
        quantity: 3,
        locked: vec![locked(0, -PI, 0.6, 0.5)],
        ..Item::new("wedge", wedge())
    }];
    make(&items, &Strip::of_width(0.9), 1);
}

#[test]
fn a_locked_piece_fixes_which_way_its_garment_runs() {
    let strip = Strip {
        nap: Nap::PerBundle,
        ..Strip::of_width(0.9)
    };
    let mut items = [
        Item {
            quantity: 2,
            bundles: vec![0, 1],
            ..Item::new("wedge", wedge())
        },
        Item {
            quantity: 4,
            bundles: vec![0, 0, 1, 1],
            ..Item::new("box", rectangle(0.3, 0.2))
        },
    ];
    items[0].locked = vec![locked(0, PI, 0.6, 0.5)];
    let marker = make(&items, &strip, 1);
    let first = |p: &&toile_nesting::Placement| items[p.item].bundle(p.copy) == 0;
    assert!(
        marker
            .placements
            .iter()
            .filter(first)
            .all(|p| p.turn.cos() < 0.0)
    );
    // The referee counts the locked one too.
    let mut turned = marker.clone();
    let other = turned.placements.iter_mut().find(|p| p.item == 1).unwrap();
    let centre = other
        .pose(&items[1])
        .lay(&items[1].outline)
        .bounds()
        .centre();
    other.turn = 0.0;
    other.translation = centre - Vec2::new(0.15, 0.1);
    let verdict = judge(&items, &strip, &turned);
    let nap = |v: &Violation| matches!(v, Violation::Nap { bundle: 0, .. });
    assert!(
        verdict.violations.iter().any(nap),
        "{:?}",
        verdict.violations
    );
    // A piece of its garment that may lie forward only.
    items[1].allowed = Allowed::one_way();
    let words = refused(&items, &strip);
    assert!(words.contains("\"box\" of its garment"), "{words}");
}

#[test]
fn quarter_turns_run_no_way_on_a_nap() {
    let strip = Strip {
        nap: Nap::PerBundle,
        ..Strip::of_width(0.9)
    };
    let items = [Item {
        allowed: Allowed::turned(vec![0.0, FRAC_PI_2]),
        ..Item::new("wedge", wedge())
    }];
    let mut marker = make(&items, &strip, 1);
    marker.placements[0].turn = FRAC_PI_2;
    marker.placements[0].translation = Vec2::new(0.4, 0.0);
    marker.measure(&items, &strip);
    let found = judge(&items, &strip, &marker).violations;
    assert!(
        matches!(found[..], [Violation::Orientation { .. }]),
        "{found:?}"
    );
}
