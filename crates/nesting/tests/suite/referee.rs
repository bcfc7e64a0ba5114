//! Planted faults are found, each at its place; sound markers are not accused.

use std::f64::consts::PI;
use toile_geometry::{Bounds2, Polygon, Vec2};
use toile_nesting::{
    Allowed, Item, Marker, Mirror, Nap, Placement, Side, Strip, Unplaced, Verdict, Violation, judge,
};

fn square() -> Item {
    let corner = Vec2::new(0.5, 0.5);
    let outline = Polygon::rectangle(Bounds2 {
        min: Vec2::zeros(),
        max: corner,
    });
    Item {
        quantity: 3,
        allowed: Allowed::one_way(),
        ..Item::new("square", outline)
    }
}

fn strip() -> Strip {
    Strip {
        selvedge: 0.1,
        end_margin: 0.2,
        ..Strip::of_width(1.2)
    }
}

fn placement(copy: u32, x: f64, y: f64) -> Placement {
    Placement {
        item: 0,
        copy,
        turn: 0.0,
        mirrored: false,
        translation: Vec2::new(x, y),
    }
}

/// Two below and above, one beside them: nothing to spare.
fn sound() -> Marker {
    Marker {
        placements: vec![
            placement(0, 0.2, 0.1),
            placement(1, 0.2, 0.6),
            placement(2, 0.7, 0.3),
        ],
        length: 1.4,
        ..Marker::default()
    }
}

fn after(change: impl Fn(&mut Marker)) -> Verdict {
    let mut marker = sound();
    change(&mut marker);
    judge(&[square()], &strip(), &marker)
}

#[test]
fn touching_pieces_at_the_limits_are_sound() {
    let verdict = after(|_| {});
    assert!(verdict.is_sound(), "{verdict:?}");
    assert!((verdict.length - 1.4).abs() < 1e-12);
}

#[test]
fn overlaps_are_measured() {
    let verdict = after(|m| m.placements[1].translation.y = 0.6 - 1e-3);
    let [
        Violation::Overlap {
            pair,
            depth,
            area,
            at,
        },
    ] = verdict.violations[..]
    else {
        panic!("{verdict:?}");
    };
    assert_eq!(pair, [0, 1]);
    assert!((depth - 1e-3).abs() < 1e-7 && (area - 5e-4).abs() < 1e-7);
    assert!((at.y - 0.6).abs() < 2e-3);
    let deep = after(|m| m.placements[1].translation = Vec2::new(0.2, 0.1));
    assert!(
        (deep.deepest - 0.5).abs() < 1e-7,
        "one on top of the other: {}",
        deep.deepest
    );
    let slight = after(|m| m.placements[1].translation.y = 0.6 - 5e-7);
    assert!(slight.is_sound() && slight.deepest > 4e-7 && slight.deepest < 6e-7);
    assert!(!after(|m| m.placements[1].translation.y = 0.6 - 2e-6).is_sound());
}

#[test]
fn pieces_that_stick_out_are_found_on_every_side() {
    for (x, y, side) in [
        (0.19, 0.1, Side::Start),
        (0.2, 0.09, Side::Lower),
        (0.2, 0.61, Side::Upper),
    ] {
        let lone = Marker {
            placements: vec![placement(0, x, y)],
            length: x + 0.7,
            ..Marker::default()
        };
        let item = Item {
            quantity: 1,
            ..square()
        };
        let verdict = judge(&[item], &strip(), &lone);
        let [
            Violation::Outside {
                placement: 0,
                side: found,
                by,
            },
        ] = verdict.violations[..]
        else {
            panic!("{verdict:?}");
        };
        assert_eq!(found, side);
        assert!((by - 0.01).abs() < 1e-9);
    }
    let short = Strip {
        max_length: Some(1.39),
        ..strip()
    };
    let verdict = judge(&[square()], &short, &sound());
    assert!(matches!(
        verdict.violations[..],
        [Violation::Outside {
            placement: 2,
            side: Side::End,
            ..
        }]
    ));
}

#[test]
fn gaps_are_measured() {
    let items = [Item {
        gap: 0.02,
        ..square()
    }];
    let verdict = judge(&items, &strip(), &sound());
    assert_eq!(verdict.violations.len(), 3, "{verdict:?}");
    let roomy = |gap: f64| {
        let mut marker = sound();
        marker.placements[2].translation.x = 0.7 + gap;
        marker.length += gap;
        let pair = Marker {
            placements: vec![marker.placements[0], marker.placements[2]],
            ..marker
        };
        let items = [Item {
            quantity: 3,
            gap: 0.02,
            ..square()
        }];
        let verdict = judge(&items, &strip(), &pair);
        verdict
            .violations
            .iter()
            .filter(|v| matches!(v, Violation::Gap { .. }))
            .count()
    };
    assert_eq!((roomy(0.019), roomy(0.02), roomy(0.0199999)), (1, 0, 0));
}

#[test]
fn orientations_are_held_to_the_rules() {
    let faulty = |change: &dyn Fn(&mut Placement), item: Item, nap: Nap| {
        let mut marker = sound();
        marker
            .placements
            .iter_mut()
            .for_each(|p| p.translation += Vec2::new(0.5, 0.5));
        change(&mut marker.placements[1]);
        let strip = Strip { nap, ..strip() };
        let verdict = judge(&[item], &strip, &marker);
        verdict
            .violations
            .iter()
            .filter(|v| matches!(v, Violation::Orientation { placement: 1, .. }))
            .count()
    };
    let turn = |p: &mut Placement| p.turn = PI;
    let flip = |p: &mut Placement| p.mirrored = true;
    let tilt = |p: &mut Placement| p.turn = 0.01;
    let whole = |p: &mut Placement| p.turn = 2.0 * PI;
    let two_way = || Item {
        allowed: Allowed::two_way(),
        ..square()
    };
    let pairs = || Item {
        allowed: Allowed::one_way().mirrored(Mirror::Pairs),
        ..square()
    };
    assert_eq!(faulty(&turn, square(), Nap::None), 1);
    assert_eq!(faulty(&turn, two_way(), Nap::None), 0);
    assert_eq!(faulty(&turn, two_way(), Nap::OneWay), 1);
    assert_eq!(faulty(&tilt, two_way(), Nap::None), 1);
    assert_eq!(faulty(&whole, square(), Nap::OneWay), 0);
    assert_eq!(faulty(&flip, square(), Nap::None), 1);
    assert_eq!(faulty(&flip, pairs(), Nap::None), 0);
    assert_eq!(
        faulty(&|_| {}, pairs(), Nap::None),
        1,
        "copy 1 is the mirrored one"
    );
}

#[test]
fn copies_are_counted() {
    let copies = |change: &dyn Fn(&mut Marker)| after(change).violations;
    let missing = copies(&|m| {
        m.placements.pop();
        m.length = 0.9;
    });
    assert_eq!(
        missing,
        [Violation::Copy {
            item: 0,
            copy: 2,
            count: 0
        }]
    );
    let listed = copies(&|m| {
        m.placements.pop();
        m.length = 0.9;
        m.unplaced.push(Unplaced {
            item: 0,
            copy: 2,
            reason: "no room".into(),
        });
    });
    assert_eq!(listed, []);
    let twice = copies(&|m| m.placements[2].copy = 1);
    assert_eq!(twice.len(), 2);
    let unknown = copies(&|m| {
        m.placements.push(Placement {
            item: 7,
            ..m.placements[0]
        })
    });
    assert!(unknown.contains(&Violation::Nonsense { placement: 3 }));
    let nowhere = copies(&|m| m.placements[2].translation.x = f64::NAN);
    assert!(nowhere.contains(&Violation::Nonsense { placement: 2 }));
}

#[test]
fn a_false_length_is_found() {
    assert!(matches!(
        after(|m| m.length = 1.3).violations[..],
        [Violation::Length { stated, .. }] if stated == 1.3
    ));
    assert!(!after(|m| m.length = f64::NAN).is_sound());
}
