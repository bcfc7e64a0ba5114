//! Several rolls: what finds no place on one goes to the next, and nothing is lost.

use std::collections::BTreeSet;
use std::sync::atomic::AtomicBool;
use toile_geometry::{Bounds2, Polygon, Vec2};
use toile_nesting::{
    Control, Item, ItemProblem, Locked, Mirror, NestingError, RolledOut, Search, Strip, judge,
    make_markers_on_rolls,
};

fn rectangle(length: f64, width: f64) -> Polygon {
    Polygon::rectangle(Bounds2 {
        min: Vec2::zeros(),
        max: Vec2::new(length, width),
    })
}

fn make(items: &[Item], rolls: &[Strip]) -> Result<RolledOut, NestingError> {
    let mut last = 0.0;
    let mut told = |p: toile_nesting::Progress| {
        assert!((0.0..=1.0 + 1e-9).contains(&p.done), "{}", p.done);
        assert!(p.done >= last, "{} after {last}", p.done);
        last = p.done;
    };
    let mut control = Control {
        progress: &mut told,
        cancel: &AtomicBool::new(false),
    };
    make_markers_on_rolls(items, rolls, Search::evaluations(300_000), &mut control)
}

fn of_length(width: f64, length: f64) -> Strip {
    Strip {
        max_length: Some(length),
        ..Strip::of_width(width)
    }
}

/// Every copy lies on one roll or is listed, every marker is sound, hands are right.
fn whole(items: &[Item], rolls: &[Strip], out: &RolledOut) {
    let mut seen = BTreeSet::new();
    for laid in &out.markers {
        let strip = &rolls[laid.roll];
        let verdict = judge(&laid.items, strip, &laid.marker);
        assert!(verdict.is_sound(), "{:?}", verdict.violations);
        for placement in &laid.marker.placements {
            let (item, copies) = &laid.sources[placement.item];
            let copy = copies[placement.copy as usize];
            if items[*item].allowed.mirror == Mirror::Pairs {
                assert_eq!(placement.mirrored, copy % 2 == 1);
            }
            assert!(seen.insert((*item, copy)), "laid twice");
        }
    }
    for unplaced in &out.unplaced {
        assert!(!unplaced.reason.is_empty());
        assert!(seen.insert((unplaced.item, unplaced.copy)), "also laid");
    }
    let all: usize = items.iter().map(|i| i.quantity as usize).sum();
    assert_eq!(seen.len(), all);
}

#[test]
fn what_a_roll_cannot_hold_goes_to_the_next() {
    let mut sleeve = Item {
        quantity: 6,
        ..Item::new("sleeve", rectangle(0.5, 0.4))
    };
    sleeve.allowed.mirror = Mirror::Pairs;
    sleeve.bundles = vec![0, 0, 1, 1, 2, 2];
    let items = [sleeve];
    let rolls = [
        of_length(0.85, 0.55),
        of_length(0.45, 0.6),
        Strip::of_width(0.85),
    ];
    let out = make(&items, &rolls).unwrap();
    whole(&items, &rolls, &out);
    let counts: Vec<usize> = out
        .markers
        .iter()
        .map(|m| m.marker.placements.len())
        .collect();
    assert_eq!(counts, [2, 1, 3]);
    assert!(out.unplaced.is_empty());
}

#[test]
fn pieces_too_large_for_a_roll_wait_for_one_that_takes_them() {
    let items = [
        Item::new("back", rectangle(0.6, 1.2)),
        Item {
            quantity: 2,
            ..Item::new("pocket", rectangle(0.2, 0.2))
        },
    ];
    let rolls = [of_length(0.9, 1.0), of_length(1.5, 1.0)];
    let out = make(&items, &rolls).unwrap();
    whole(&items, &rolls, &out);
    assert!(out.unplaced.is_empty());
    assert_eq!(out.markers[1].sources, vec![(0, vec![0])]);
    // Nothing takes it: it is named with what every roll lacks.
    let narrow = [of_length(0.9, 1.0), of_length(1.5, 0.5)];
    let out = make(&items, &narrow).unwrap();
    whole(&items, &narrow, &out);
    assert_eq!(out.unplaced.len(), 1);
    let reason = &out.unplaced[0].reason;
    assert!(reason.contains("roll 1: it is 1200 mm across"), "{reason}");
    assert!(reason.contains("roll 2: it is 600 mm long"), "{reason}");
}

#[test]
fn full_rolls_leave_the_rest_with_a_reason_each() {
    let items = [Item {
        quantity: 5,
        ..Item::new("box", rectangle(0.4, 0.4))
    }];
    let rolls = [of_length(0.9, 0.4), of_length(0.5, 0.45)];
    let out = make(&items, &rolls).unwrap();
    whole(&items, &rolls, &out);
    assert_eq!(out.unplaced.len(), 2);
    assert!(out.unplaced[0].reason.contains("roll 2: no room"));
}

#[test]
fn locked_copies_lie_on_the_first_roll() {
    let mut item = Item {
        quantity: 3,
        ..Item::new("box", rectangle(0.4, 0.4))
    };
    item.locked = vec![Locked {
        copy: 2,
        turn: 0.0,
        mirrored: false,
        translation: Vec2::new(0.1, 0.2),
    }];
    let items = [item];
    let rolls = [of_length(0.7, 0.6), Strip::of_width(0.9)];
    let out = make(&items, &rolls).unwrap();
    whole(&items, &rolls, &out);
    assert_eq!(out.markers[0].marker.placements.len(), 1);
    assert_eq!(out.markers[0].marker.placements[0].copy, 2);
    assert_eq!(out.markers[1].sources, vec![(0, vec![0, 1])]);
}

#[test]
fn damaged_pieces_and_rolls_are_refused() {
    let flat = Item::new("flat", rectangle(0.0, 0.4));
    let none = Item {
        quantity: 0,
        ..Item::new("none", rectangle(0.3, 0.4))
    };
    let items = [Item::new("box", rectangle(0.3, 0.3)), none, flat];
    match make(&items, &[Strip::of_width(0.2), Strip::of_width(1.0)]) {
        Err(NestingError::Refused(list)) => {
            let found: Vec<_> = list.iter().map(|r| (r.item, &r.problem)).collect();
            assert_eq!(
                found,
                [(1, &ItemProblem::NoCopies), (2, &ItemProblem::Empty)]
            );
        }
        other => panic!("{other:?}"),
    }
    assert!(matches!(make(&items, &[]), Err(NestingError::Strip(_))));
    assert!(matches!(
        make(&[], &[Strip::of_width(1.0)]),
        Err(NestingError::NoItems)
    ));
    let bad = Strip::of_width(f64::NAN);
    assert!(matches!(make(&items, &[bad]), Err(NestingError::Strip(_))));
}

#[test]
fn refused_locks_are_named_by_the_copies_of_the_job() {
    let mut sleeve = Item {
        quantity: 4,
        ..Item::new("sleeve", rectangle(0.4, 0.3))
    };
    sleeve.allowed.mirror = Mirror::Pairs;
    let rolls = [of_length(0.7, 2.0), Strip::of_width(0.9)];
    let lock = |copy: u32, x: f64| Locked {
        copy,
        turn: 0.0,
        mirrored: copy % 2 == 1,
        translation: Vec2::new(x, 0.35),
    };
    let refused = |locked: Vec<Locked>| {
        let items = [Item {
            locked,
            ..sleeve.clone()
        }];
        match make(&items, &rolls) {
            Err(NestingError::Refused(list)) => list[0].problem.clone(),
            other => panic!("{other:?}"),
        }
    };
    // Copies 1 and 3 are the first and the second of those that lie face down.
    match refused(vec![lock(1, 0.5), lock(3, 0.6)]) {
        ItemProblem::LockedBadly { copy, why } => {
            assert_eq!(copy, 3);
            assert!(why.contains("\"sleeve\" 1 and \"sleeve\" 3"), "{why}");
        }
        other => panic!("{other:?}"),
    }
    // What does not exist is not passed over.
    assert_eq!(refused(vec![lock(9, 0.5)]), ItemProblem::Locked(9));
}
