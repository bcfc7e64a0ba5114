//! The search goes on from any marker, and gives the same bytes on any number of threads.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::atomic::AtomicBool;
use toile_geometry::{Polygon, Vec2};
use toile_nesting::{Allowed, Marker, NestingError};
use toile_nesting::{
    Control, Item, Locked, MatchPoint, Mirror, Nap, Phase, Search, Strip, Stripes, improve_marker,
    judge, make_marker,
};

fn polygon(points: &[(f64, f64)]) -> Polygon {
    Polygon::new(points.iter().map(|&(x, y)| Vec2::new(x, y)).collect())
}

/// A wedge, a hook and a small box: they fit well together only when turned.
fn pieces() -> Vec<Item> {
    let wedge = polygon(&[(0.0, 0.0), (0.5, 0.0), (0.3, 0.4), (0.1, 0.35)]);
    let hook = [
        (0.0, 0.0),
        (0.4, 0.0),
        (0.4, 0.15),
        (0.15, 0.15),
        (0.15, 0.45),
        (0.0, 0.4),
    ];
    let patch = polygon(&[(0.0, 0.0), (0.2, 0.0), (0.2, 0.13), (0.0, 0.13)]);
    let item = |name: &str, outline: Polygon, quantity: u32| Item {
        quantity,
        bundles: (0..quantity).map(|k| k % 2).collect(),
        ..Item::new(name, outline)
    };
    vec![
        item("wedge", wedge, 4),
        Item {
            allowed: Allowed::two_way().mirrored(Mirror::Pairs),
            ..item("hook", polygon(&hook), 4)
        },
        item("patch", patch, 6),
    ]
}

fn control(cancel: &AtomicBool, work: impl FnOnce(&mut Control<'_>) -> Marked) -> Marker {
    work(&mut Control {
        progress: &mut |_| {},
        cancel,
    })
    .unwrap()
}

type Marked = Result<Marker, NestingError>;

fn make(items: &[Item], strip: &Strip, search: Search) -> Marker {
    control(&AtomicBool::new(false), |control| {
        make_marker(items, strip, search, control)
    })
}

fn improve(items: &[Item], strip: &Strip, start: &Marker, search: Search) -> Marker {
    control(&AtomicBool::new(false), |control| {
        improve_marker(items, strip, start, search, control)
    })
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let (items, strip) = (pieces(), Strip::of_width(1.2));
    let on = |threads: usize| {
        let search = Search {
            threads,
            islands: 3,
            ..Search::evaluations(1_500_000)
        };
        make(&items, &strip, search)
    };
    let one = on(1);
    assert!(judge(&items, &strip, &one).is_sound());
    for threads in 2..5 {
        assert_eq!(one, on(threads), "{threads} threads");
    }
    let other = Search {
        seed: 2,
        islands: 3,
        ..Search::evaluations(1_500_000)
    };
    assert_ne!(
        one.placements,
        make(&items, &strip, other).placements,
        "another seed"
    );
}

#[test]
fn going_on_never_lengthens_and_shortens_a_poor_marker() {
    let (items, strip) = (pieces(), Strip::of_width(1.2));
    // One piece behind the other.
    let mut poor = make(&items, &strip, Search::evaluations(1_000));
    for (k, placement) in poor.placements.iter_mut().enumerate() {
        let bounds = placement
            .pose(&items[placement.item])
            .lay(&items[placement.item].outline);
        let corner = Vec2::new(0.6 * k as f64, 0.0);
        placement.translation += corner - bounds.bounds().min;
    }
    poor.measure(&items, &strip);
    assert!(judge(&items, &strip, &poor).is_sound());
    let mut lengths = vec![poor.length];
    let mut marker = poor;
    for seed in 1..4 {
        let search = Search {
            seed,
            ..Search::evaluations(500_000)
        };
        marker = improve(&items, &strip, &marker, search);
        assert!(judge(&items, &strip, &marker).is_sound());
        lengths.push(marker.length);
    }
    assert!(lengths.windows(2).all(|w| w[1] <= w[0]), "{lengths:?}");
    assert!(lengths[3] < 0.5 * lengths[0], "{lengths:?}");
}

#[test]
fn nothing_to_do_leaves_a_sound_marker_as_it_is() {
    let (items, strip) = (pieces(), Strip::of_width(1.2));
    let marker = make(&items, &strip, Search::evaluations(300_000));
    let same = improve(&items, &strip, &marker, Search::evaluations(0));
    assert_eq!(same, marker);
}

#[test]
fn a_sound_marker_gone_on_from_is_kept_when_the_search_is_stopped_at_once() {
    let (items, strip) = (pieces(), Strip::of_width(1.2));
    let marker = make(&items, &strip, Search::evaluations(300_000));
    let stopped = |start: &Marker| {
        let mut control = Control {
            progress: &mut |_| {},
            cancel: &AtomicBool::new(true),
        };
        let search = Search::evaluations(1_000_000);
        improve_marker(&items, &strip, start, search, &mut control)
    };
    assert_eq!(stopped(&marker), Ok(marker.clone()));
    let mut broken = marker.clone();
    broken.placements[0].translation = marker.placements[1].translation;
    assert_eq!(stopped(&broken), Err(NestingError::Cancelled));
}

/// What a user may have done to a marker by hand.
#[test]
fn broken_markers_are_mended() {
    let items = pieces();
    let strip = Strip {
        nap: Nap::PerBundle,
        gap: 0.004,
        ..Strip::of_width(1.2)
    };
    let sound = make(&items, &strip, Search::evaluations(100_000));
    let changed = |change: &dyn Fn(&mut Marker)| {
        let mut marker = sound.clone();
        change(&mut marker);
        marker
    };
    let cases = [
        (
            "piled up",
            changed(&|m| {
                m.placements
                    .iter_mut()
                    .for_each(|p| p.translation = Vec2::zeros())
            }),
        ),
        (
            "far away",
            changed(&|m| m.placements[3].translation.x = 1e9),
        ),
        (
            "nowhere",
            changed(&|m| m.placements[0].translation.y = f64::NAN),
        ),
        ("turned", changed(&|m| m.placements[1].turn += FRAC_PI_2)),
        ("one turned round", changed(&|m| m.placements[2].turn += PI)),
        (
            "turned over",
            changed(&|m| m.placements[5].mirrored = !m.placements[5].mirrored),
        ),
        ("missing", changed(&|m| drop(m.placements.drain(4..9)))),
        ("unknown", changed(&|m| m.placements[0].item = 77)),
        (
            "twice",
            changed(&|m| {
                let p = m.placements[0];
                m.placements.push(p);
            }),
        ),
        ("empty", Marker::default()),
    ];
    for (what, marker) in cases {
        let mended = improve(&items, &strip, &marker, Search::evaluations(50_000));
        let verdict = judge(&items, &strip, &mended);
        assert!(verdict.is_sound(), "{what}: {:?}", verdict.violations);
        assert_eq!(mended.placements.len(), 14, "{what}");
    }
}

#[test]
fn locks_and_print_hold_when_going_on() {
    let mut items = pieces();
    for item in &mut items[..2] {
        item.match_point = Some(MatchPoint {
            point: Vec2::new(0.0, 0.1),
            phase: Phase::Set(7),
        });
    }
    let strip = Strip {
        stripes: Some(Stripes {
            repeat: Vec2::new(0.05, 0.0),
            origin: Vec2::new(0.01, 0.0),
        }),
        ..Strip::of_width(1.2)
    };
    let marker = make(&items, &strip, Search::evaluations(100_000));
    let laid = marker.placements[9];
    assert_eq!(items[laid.item].name, "patch");
    items[laid.item].locked.push(Locked {
        copy: laid.copy,
        turn: laid.turn,
        mirrored: laid.mirrored,
        translation: laid.translation,
    });
    let more = improve(&items, &strip, &marker, Search::evaluations(200_000));
    assert!(judge(&items, &strip, &more).is_sound());
    assert!(more.length <= marker.length);
    assert!(more.placements.contains(&laid), "it stays");
}

#[test]
fn searches_that_make_no_sense_are_refused() {
    let (items, strip) = (pieces(), Strip::of_width(1.2));
    for search in [
        Search::seconds(f64::NAN),
        Search::seconds(-1.0),
        Search {
            islands: 1_000_000,
            ..Search::evaluations(1_000)
        },
    ] {
        let mut control = Control {
            progress: &mut |_| {},
            cancel: &AtomicBool::new(false),
        };
        let error = make_marker(&items, &strip, search, &mut control).unwrap_err();
        assert!(error.to_string().starts_with("search: "), "{error}");
    }
}

#[test]
fn a_search_stopped_before_a_marker_is_there_says_so() {
    let (items, strip) = (pieces(), Strip::of_width(1.2));
    let short = Strip {
        max_length: Some(0.6),
        ..strip.clone()
    };
    for strip in [strip, short] {
        let mut control = Control {
            progress: &mut |_| {},
            cancel: &AtomicBool::new(true),
        };
        let made = make_marker(&items, &strip, Search::seconds(5.0), &mut control);
        assert_eq!(made, Err(NestingError::Cancelled));
    }
}

#[test]
fn many_tilts_are_thinned_so_that_the_clock_is_kept() {
    let item = |k: u32| {
        let bulge = 0.003 * f64::from(k);
        let outline = polygon(&[(0.0, 0.0), (0.3, bulge), (0.25, 0.2), (0.05, 0.2 + bulge)]);
        let mut item = Item::new(format!("piece {k}"), outline);
        item.allowed.tilt = 0.03;
        item
    };
    let items: Vec<Item> = (0..40).map(item).collect();
    let started = std::time::Instant::now();
    let marker = make(&items, &Strip::of_width(1.5), Search::seconds(1.0));
    assert_eq!(marker.placements.len(), 40);
    assert!(
        started.elapsed().as_secs_f64() < 5.0,
        "{:?}",
        started.elapsed()
    );
}
