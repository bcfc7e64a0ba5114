//! Markers of all kinds pass the referee; jobs that cannot be done are refused.

use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::atomic::AtomicBool;
use toile_geometry::{Bounds2, Polygon, Vec2};
use toile_nesting::{
    Allowed, Control, Item, ItemProblem, Marker, Mirror, Nap, NestingError, Search, Strip, judge,
    make_marker,
};

fn make(items: &[Item], strip: &Strip, evaluations: u64) -> Result<Marker, NestingError> {
    let mut control = Control {
        progress: &mut |_| {},
        cancel: &AtomicBool::new(false),
    };
    make_marker(items, strip, Search::evaluations(evaluations), &mut control)
}

fn box_of(length: f64, width: f64) -> Polygon {
    Polygon::rectangle(Bounds2 {
        min: Vec2::zeros(),
        max: Vec2::new(length, width),
    })
}

fn polygon(points: &[(f64, f64)]) -> Polygon {
    Polygon::new(points.iter().map(|&(x, y)| Vec2::new(x, y)).collect())
}

/// Front or back of a T-shirt, half a metre wide, grain along its y.
fn bodice(neck: f64) -> Polygon {
    let mut right = vec![(0.26, 0.0), (0.26, 0.44)];
    for k in 0..=20 {
        let angle = FRAC_PI_2 * f64::from(k) / 20.0;
        right.push((0.26 - 0.08 * angle.sin(), 0.44 + 0.22 * (1.0 - angle.cos())));
    }
    for k in 0..=20 {
        let angle = FRAC_PI_2 * f64::from(k) / 20.0;
        right.push((0.09 * angle.cos(), 0.70 - neck * angle.sin()));
    }
    let left = right.iter().rev().skip(1).map(|&(x, y)| (-x, y));
    let all: Vec<(f64, f64)> = right.iter().copied().chain(left).collect();
    polygon(&all)
}

fn sleeve() -> Polygon {
    let mut points = vec![(-0.16, 0.0), (0.16, 0.0), (0.19, 0.14)];
    for k in 1..40 {
        let t = f64::from(k) / 40.0;
        let height = 0.14 + 0.13 * (PI * t).sin().powi(2) + 0.012 * (2.0 * PI * t).sin();
        points.push((0.19 - 0.38 * t, height));
    }
    points.push((-0.19, 0.14));
    polygon(&points)
}

fn shirt(quantity: u32) -> Vec<Item> {
    let piece = |name: &str, outline: Polygon, mirror: Mirror, count: u32| Item {
        grain: FRAC_PI_2,
        quantity: count * quantity,
        allowed: Allowed::two_way().mirrored(mirror),
        ..Item::new(name, outline)
    };
    vec![
        piece("front", bodice(0.1), Mirror::Never, 1),
        piece("back", bodice(0.03), Mirror::Never, 1),
        piece("sleeve", sleeve(), Mirror::Pairs, 2),
        piece("neckband", box_of(0.05, 0.45), Mirror::Never, 1),
    ]
}

fn sound(items: &[Item], strip: &Strip, marker: &Marker) {
    let verdict = judge(items, strip, marker);
    assert!(verdict.is_sound(), "{:?}", verdict.violations);
}

#[test]
fn a_shirt_is_laid_on_its_grain() {
    let strip = Strip {
        selvedge: 0.01,
        end_margin: 0.02,
        gap: 0.003,
        ..Strip::of_width(1.5)
    };
    for quantity in [1, 3] {
        let items = shirt(quantity);
        let marker = make(&items, &strip, 400000).unwrap();
        sound(&items, &strip, &marker);
        assert!(marker.unplaced.is_empty());
        let floor = 0.69;
        assert!(marker.efficiency > floor, "{}", marker.efficiency);
        assert!(marker.utilisation < marker.efficiency);
        let mirrored = marker.placements.iter().filter(|p| p.mirrored).count();
        assert_eq!(mirrored, quantity as usize, "half of the sleeves");
        let nearest = judge(&items, &strip, &marker).nearest;
        assert!(nearest > 0.003 - 1e-9 && nearest < 0.004, "{nearest}");
    }
}

#[test]
fn nap_keeps_every_piece_one_way() {
    let strip = Strip {
        nap: Nap::OneWay,
        ..Strip::of_width(1.4)
    };
    let items = shirt(2);
    let marker = make(&items, &strip, 1).unwrap();
    sound(&items, &strip, &marker);
    assert!(marker.placements.iter().all(|p| p.turn == 0.0));
    let free = Strip {
        nap: Nap::None,
        ..strip.clone()
    };
    let turned = make(&items, &free, 1).unwrap();
    assert!(turned.placements.iter().any(|p| p.turn != 0.0));
}

#[test]
fn boxes_tile_without_waste() {
    // Nine thirds of the width, exactly: touching pieces everywhere.
    let items = [Item {
        quantity: 9,
        ..Item::new("third", box_of(0.3, 0.5))
    }];
    let strip = Strip::of_width(1.5);
    let marker = make(&items, &strip, 2_000_000).unwrap();
    sound(&items, &strip, &marker);
    assert!(marker.efficiency > 1.0 - 2e-6, "{}", marker.efficiency);
    assert!((marker.length - 0.9).abs() < 2e-6);
}

#[test]
fn interlocking_pieces_are_laid_into_each_other() {
    let ell = polygon(&[
        (0.0, 0.0),
        (0.6, 0.0),
        (0.6, 0.2),
        (0.2, 0.2),
        (0.2, 0.4),
        (0.0, 0.4),
    ]);
    let items = [Item {
        quantity: 2,
        ..Item::new("ell", ell)
    }];
    let strip = Strip::of_width(0.6);
    let marker = make(&items, &strip, 1).unwrap();
    sound(&items, &strip, &marker);
    assert!((marker.length - 0.6).abs() < 2e-6, "{}", marker.length);
}

#[test]
fn a_small_piece_may_lie_in_the_bay_of_a_big_one() {
    let bay = polygon(&[
        (0.0, 0.0),
        (1.0, 0.0),
        (1.0, 1.0),
        (0.0, 1.0),
        (0.0, 0.6),
        (0.8, 0.6),
        (0.8, 0.4),
        (0.0, 0.4),
    ]);
    let mut items = vec![
        Item::new("bay", bay),
        Item::new("tongue", box_of(0.8, 0.199)),
    ];
    items[0].allowed = Allowed::one_way();
    let strip = Strip::of_width(1.0);
    let marker = make(&items, &strip, 1).unwrap();
    sound(&items, &strip, &marker);
    assert!((marker.length - 1.0).abs() < 2e-6, "{}", marker.length);
}

#[test]
fn short_fabric_leaves_pieces_with_a_reason() {
    let strip = Strip {
        max_length: Some(0.75),
        ..Strip::of_width(1.5)
    };
    let items = shirt(2);
    let marker = make(&items, &strip, 1).unwrap();
    sound(&items, &strip, &marker);
    assert!(!marker.unplaced.is_empty() && marker.length <= 0.75);
    assert!(marker.unplaced[0].reason.contains("750 mm"));
}

#[test]
fn the_same_job_gives_the_same_marker_and_more_work_no_worse_one() {
    let strip = Strip::of_width(1.4);
    let items = shirt(2);
    let once = make(&items, &strip, 100000).unwrap();
    assert_eq!(once, make(&items, &strip, 100000).unwrap());
    let first = make(&items, &strip, 1).unwrap();
    assert!(once.length <= first.length);
}

#[test]
fn progress_is_told_and_cancelling_stops() {
    let cancel = AtomicBool::new(false);
    let mut seen: Vec<toile_nesting::Progress> = Vec::new();
    let mut note = |p: toile_nesting::Progress| {
        seen.push(p);
        let better = seen.iter().filter(|p| p.done > 0.0).count() > 2;
        cancel.fetch_or(better, std::sync::atomic::Ordering::Relaxed);
    };
    let mut control = Control {
        progress: &mut note,
        cancel: &cancel,
    };
    let search = Search::default();
    let (items, strip) = (shirt(3), Strip::of_width(1.5));
    let stopped = make_marker(&items, &strip, search, &mut control).unwrap();
    assert!(judge(&items, &strip, &stopped).is_sound());
    let last = seen.last().unwrap();
    assert!(last.done < 1.0, "stopped early");
    assert!(
        (stopped.length - last.length).abs() < 1e-4,
        "the best so far"
    );
    assert!(
        seen.windows(2)
            .all(|w| w[0].done <= w[1].done && w[0].length >= w[1].length)
    );
    let mut at_once = Control {
        progress: &mut |_| {},
        cancel: &AtomicBool::new(true),
    };
    let nothing = make_marker(&items, &strip, search, &mut at_once);
    assert_eq!(nothing, Err(NestingError::Cancelled));
}

#[test]
fn impossible_pieces_are_refused_by_name() {
    let strip = Strip {
        selvedge: 0.02,
        max_length: Some(2.0),
        ..Strip::of_width(1.5)
    };
    let item = |outline: Polygon| Item::new("yoke", outline);
    let bow = polygon(&[(0.0, 0.0), (0.2, 0.2), (0.2, 0.0), (0.0, 0.3)]);
    let nan = polygon(&[(0.0, 0.0), (f64::NAN, 0.2), (0.2, 0.0)]);
    let mut stray = box_of(0.1, 0.1);
    stray
        .holes
        .push(box_of(0.1, 0.1).translated(Vec2::new(1.0, 0.0)).outer);
    let good = || item(box_of(0.1, 0.1));
    type Expected = fn(&ItemProblem) -> bool;
    let cases: Vec<(Item, Expected)> = vec![
        (item(bow), |p| matches!(p, ItemProblem::Crosses(_))),
        (item(nan), |p| matches!(p, ItemProblem::NotFinite(_))),
        (item(Polygon::default()), |p| *p == ItemProblem::Empty),
        (item(stray), |p| *p == ItemProblem::StrayHole(0)),
        (item(box_of(0.2, 1.47)), |p| {
            matches!(p, ItemProblem::TooWide { .. })
        }),
        (item(box_of(2.1, 0.2)), |p| {
            matches!(p, ItemProblem::TooLong { .. })
        }),
        (
            Item {
                quantity: 0,
                ..good()
            },
            |p| *p == ItemProblem::NoCopies,
        ),
        (
            Item {
                gap: -1.0,
                ..good()
            },
            |p| *p == ItemProblem::NegativeGap,
        ),
        (
            Item {
                grain: f64::NAN,
                ..good()
            },
            |p| matches!(p, ItemProblem::NotFinite(_)),
        ),
        (
            Item {
                allowed: Allowed::turned(vec![]),
                ..good()
            },
            |p| *p == ItemProblem::NoOrientation,
        ),
    ];
    for (bad, expected) in cases {
        let items = [good(), bad.clone()];
        match make(&items, &strip, 1) {
            Err(NestingError::Refused(list)) => {
                assert_eq!((list.len(), list[0].item), (1, 1), "{list:?}");
                assert!(expected(&list[0].problem), "{list:?}");
                assert!(list[0].to_string().starts_with("piece \"yoke\": "));
            }
            other => panic!("{bad:?} gave {other:?}"),
        }
    }
}

#[test]
fn a_wide_piece_is_refused_with_the_remedy_and_fits_that_fabric() {
    let items = [Item {
        grain: FRAC_PI_2,
        ..Item::new("circle skirt", box_of(1.6, 0.4))
    }];
    let strip = Strip {
        selvedge: 0.02,
        ..Strip::of_width(1.5)
    };
    let message = make(&items, &strip, 1).unwrap_err().to_string();
    for part in [
        "circle skirt",
        "1600 mm across",
        "1460 mm are usable",
        "at least 1640 mm wide",
    ] {
        assert!(message.contains(part), "{message}");
    }
    let wide = Strip {
        width: 1.64,
        ..strip.clone()
    };
    let marker = make(&items, &wide, 1).unwrap();
    sound(&items, &wide, &marker);
}

#[test]
fn impossible_fabric_and_empty_jobs_are_refused() {
    assert_eq!(
        make(&[], &Strip::of_width(1.5), 1),
        Err(NestingError::NoItems)
    );
    let items = shirt(1);
    for bad in [
        Strip::of_width(f64::NAN),
        Strip::of_width(0.0),
        Strip::of_width(-1.0),
        Strip {
            selvedge: 0.8,
            ..Strip::of_width(1.5)
        },
        Strip {
            gap: -0.1,
            ..Strip::of_width(1.5)
        },
        Strip {
            end_margin: f64::INFINITY,
            ..Strip::of_width(1.5)
        },
    ] {
        assert!(
            matches!(make(&items, &bad, 1), Err(NestingError::Strip(_))),
            "{bad:?}"
        );
    }
    let against = [Item {
        allowed: Allowed::turned(vec![PI]),
        ..items[0].clone()
    }];
    let nap = Strip {
        nap: Nap::OneWay,
        ..Strip::of_width(1.5)
    };
    assert!(
        make(&against, &nap, 1)
            .unwrap_err()
            .to_string()
            .contains("nap")
    );
}

/// Forty different pieces of two hundred to three hundred points, as smooth as drafted curves.
fn many_smooth_pieces() -> Vec<Item> {
    let piece = |k: u32| {
        let count = 200 + (k * 37) % 100;
        let [a, b, c] = [3, 5, 7].map(|m| f64::from((k * m) % 11) / 11.0);
        let point = |n: u32| {
            let angle = std::f64::consts::TAU * f64::from(n) / f64::from(count);
            let waves =
                1.0 + 0.25 * a * (2.0 * angle + 6.0 * b).cos() + 0.2 * c * (3.0 * angle).sin();
            Vec2::new(angle.cos() * (1.0 + a), angle.sin()) * (waves * (0.05 + 0.15 * b))
        };
        Item {
            grain: b,
            ..Item::new(
                format!("piece {k}"),
                Polygon::new((0..count).map(point).collect()),
            )
        }
    };
    (0..40).map(piece).collect()
}

#[test]
fn forty_different_smooth_pieces_are_laid_soundly() {
    let items = many_smooth_pieces();
    let strip = Strip {
        gap: 0.003,
        ..Strip::of_width(1.5)
    };
    let marker = make(&items, &strip, 1).unwrap();
    sound(&items, &strip, &marker);
    assert!(marker.efficiency > 0.7, "{}", marker.efficiency);
}

#[test]
fn outlines_that_touch_themselves_are_laid() {
    // A ring closed at one point, and a dart whose legs meet at the edge.
    let pinched = polygon(&[
        (0.0, 0.0),
        (0.4, 0.0),
        (0.4, 0.4),
        (0.2, 0.4),
        (0.3, 0.2),
        (0.1, 0.2),
        (0.2, 0.4),
        (0.0, 0.4),
    ]);
    let dart = polygon(&[
        (0.0, 0.0),
        (0.2, 0.0),
        (0.2, 0.2),
        (0.201, 0.0),
        (0.4, 0.0),
        (0.4, 0.3),
        (0.0, 0.3),
    ]);
    let items = [pinched, dart].map(|p| Item {
        quantity: 3,
        ..Item::new("odd", p)
    });
    for gap in [0.0, 0.004] {
        let strip = Strip {
            gap,
            ..Strip::of_width(0.9)
        };
        let marker = make(&items, &strip, 1).unwrap();
        sound(&items, &strip, &marker);
        assert!(marker.unplaced.is_empty());
    }
}

fn star() -> impl Strategy<Value = Polygon> {
    (prop::collection::vec(0.05..0.3f64, 3..30), -1e3..1e3f64).prop_map(|(radii, shift)| {
        let n = radii.len() as f64;
        let point = |(k, r): (usize, &f64)| {
            let angle = std::f64::consts::TAU * k as f64 / n;
            Vec2::new(angle.cos() * r + shift, angle.sin() * r)
        };
        Polygon::new(radii.iter().enumerate().map(point).collect())
    })
}

fn any_item() -> impl Strategy<Value = Item> {
    let mirror = prop_oneof![Just(Mirror::Never), Just(Mirror::Pairs), Just(Mirror::Free)];
    let turns = prop_oneof![
        Just(vec![0.0]),
        Just(vec![0.0, PI]),
        Just(vec![0.0, FRAC_PI_2, PI, -FRAC_PI_2]),
        Just(vec![0.0, 0.03, PI, PI - 0.03]),
    ];
    let gap = prop_oneof![Just(0.0), Just(0.01)];
    (star(), -7.0..7.0f64, 1u32..5, turns, mirror, gap).prop_map(
        |(outline, grain, quantity, turns, mirror, gap)| Item {
            grain,
            quantity,
            allowed: Allowed::turned(turns).mirrored(mirror),
            gap,
            ..Item::new("star", outline)
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn every_marker_passes_the_referee(
        items in prop::collection::vec(any_item(), 1..6),
        width in 0.65..1.6f64,
        margins in (0.0..0.02f64, 0.0..0.02f64),
        gap in prop_oneof![Just(0.0), 0.0..0.02f64],
        length in prop_oneof![Just(None), (0.8..2.0f64).prop_map(Some)],
        nap in prop_oneof![Just(Nap::None), Just(Nap::OneWay), Just(Nap::PerBundle)],
    ) {
        let strip = Strip {
            selvedge: margins.0, end_margin: margins.1, gap, max_length: length, nap,
            ..Strip::of_width(width)
        };
        match make(&items, &strip, 1) {
            Ok(marker) => {
                let verdict = judge(&items, &strip, &marker);
                prop_assert!(verdict.is_sound(), "{:?}", verdict.violations);
                let all: u32 = items.iter().map(|i| i.quantity).sum();
                prop_assert_eq!(marker.placements.len() + marker.unplaced.len(), all as usize);
                prop_assert!(length.is_some() || marker.unplaced.is_empty());
                prop_assert!(marker.efficiency > 0.0 && marker.efficiency <= 1.0 + 1e-6);
            }
            Err(error) => prop_assert!(matches!(error, NestingError::Refused(_)), "{error}"),
        }
    }
}
