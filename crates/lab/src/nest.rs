//! The marker benchmark: pieces of three shirts of different sizes, drawn by formulas.

use crate::LabError;
use crate::clock::Clock;
use crate::timed::Timed;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::atomic::AtomicBool;
use toile_geometry::{Polygon, Vec2};
use toile_nesting::{
    Allowed, Control, Item, Mirror, Progress, Search, Strip, judge, make_marker, with_pair_queries,
};
use toile_session::cpu_seconds;

/// Evaluations given to each island.
const EVALUATIONS: u64 = 20_000_000;
/// Random pairs queried, how often each, and how many of them are held against the exact answer.
const PAIRS: usize = 100_000;
const PASSES: u32 = 50;
const CHECKED: usize = 2_000;
/// What rounding of the polygons may come to (m).
const ROUNDING: f64 = 1e-6;
/// Points along a curve.
const POINTS: u32 = 16;

/// Front or back of a shirt, grain along its y, with a neck of a depth (m).
fn bodice(neck: f64, scale: f64) -> Polygon {
    let mut right = vec![(0.26, 0.0), (0.26, 0.44)];
    let angles = || (0..=POINTS).map(|k| FRAC_PI_2 * f64::from(k) / f64::from(POINTS));
    right.extend(angles().map(|a| (0.26 - 0.08 * a.sin(), 0.44 + 0.22 * (1.0 - a.cos()))));
    right.extend(angles().map(|a| (0.09 * a.cos(), 0.70 - neck * a.sin())));
    let left = right.iter().rev().skip(1).map(|&(x, y)| (-x, y));
    let all: Vec<Vec2> = right
        .iter()
        .copied()
        .chain(left)
        .map(|(x, y)| Vec2::new(x, y) * scale)
        .collect();
    Polygon::new(all)
}

fn sleeve(scale: f64) -> Polygon {
    let mut points = vec![
        Vec2::new(-0.16, 0.0),
        Vec2::new(0.16, 0.0),
        Vec2::new(0.19, 0.14),
    ];
    for k in 1..2 * POINTS {
        let t = f64::from(k) / f64::from(2 * POINTS);
        let wave = 0.13 * (PI * t).sin().powi(2) + 0.012 * (2.0 * PI * t).sin();
        points.push(Vec2::new(0.19 - 0.38 * t, 0.14 + wave));
    }
    points.push(Vec2::new(-0.19, 0.14));
    points.iter_mut().for_each(|p| *p *= scale);
    Polygon::new(points)
}

fn shirts() -> Vec<Item> {
    let piece = |name: &str, outline: Polygon, quantity: u32, mirror: Mirror| Item {
        grain: FRAC_PI_2,
        quantity,
        allowed: Allowed::two_way().mirrored(mirror),
        ..Item::new(name, outline)
    };
    [0.93, 1.0, 1.07]
        .into_iter()
        .flat_map(|scale| {
            [
                piece("front", bodice(0.1, scale), 2, Mirror::Never),
                piece("back", bodice(0.03, scale), 2, Mirror::Never),
                piece("sleeve", sleeve(scale), 4, Mirror::Pairs),
            ]
        })
        .collect()
}

fn fabric() -> Strip {
    Strip {
        gap: 0.002,
        selvedge: 0.01,
        ..Strip::of_width(1.5)
    }
}

/// Signed penetration queries of pairs of the shirts' pieces in random poses: how many a second on
/// each thread, and how far they lie from exact ones.
pub(crate) fn queries(threads: usize, result: &mut Timed) -> Result<(), LabError> {
    let items = shirts();
    result.vertices = items.iter().map(|item| item.outline.outer.len()).sum();
    let worked = with_pair_queries(&items, &fabric(), (PAIRS, 1), |queries| {
        let warm = queries.sum();
        let (clock, before) = (Clock::start(), cpu_seconds());
        let pass = || {
            (0..PASSES)
                .map(|_| std::hint::black_box(queries).sum())
                .sum()
        };
        let sums: Vec<f64> = std::thread::scope(|scope| {
            let others: Vec<_> = (1..threads).map(|_| scope.spawn(pass)).collect();
            let own: f64 = pass();
            let others = others.into_iter().filter_map(|o| o.join().ok());
            std::iter::once(own).chain(others).collect()
        });
        result.wall_s = clock.wall();
        let same = |sum: &f64| (sum - warm * f64::from(PASSES)).abs() <= 1e-9 * sum.abs();
        if sums.len() != threads || !sums.iter().all(same) {
            result.failure = Some("the sums of the threads differ".to_owned());
        }
        let cpu = cpu_seconds().zip(before).map(|(now, before)| now - before);
        result.cpu_s = cpu;
        let off = |k: usize| Some((k, (queries.depth(k)? - queries.exact(k)?).abs()));
        let errors: Vec<(usize, f64)> = (0..CHECKED).filter_map(off).collect();
        let checked = errors.len();
        let pinpoint =
            |&(k, error): &(usize, f64)| error > ROUNDING && queries.ends_at_a_pinpoint(k);
        let errors: Vec<f64> = (errors.iter().filter(|found| !pinpoint(found)))
            .map(|&(_, error)| error)
            .collect();
        let made = queries.count() as f64 * f64::from(PASSES);
        let mut note = |name: &str, value: f64| result.counted.insert(name.to_owned(), value);
        note("queries_a_second_and_thread", made / result.wall_s);
        if let Some(cpu) = cpu.filter(|cpu| *cpu > 0.0) {
            note("queries_a_cpu_second", made * threads as f64 / cpu);
        }
        note("checked", checked as f64);
        note("pinpoints", (checked - errors.len()) as f64);
        note("error_max_m", errors.iter().copied().fold(0.0, f64::max));
        note(
            "error_mean_m",
            errors.iter().sum::<f64>() / errors.len().max(1) as f64,
        );
        note("outline_growth_allowed_m", queries.growth());
    });
    if let Err(error) = worked {
        result.failure = Some(error.to_string());
    }
    Ok(())
}

/// Lays the shirts with an island a thread.
pub(crate) fn nest(threads: usize, result: &mut Timed) -> Result<(), LabError> {
    let items = shirts();
    let strip = fabric();
    let search = Search {
        islands: threads,
        threads,
        ..Search::evaluations(EVALUATIONS * threads as u64)
    };
    let (clock, before) = (Clock::start(), cpu_seconds());
    let (mut first, mut evaluations) = (None, 0);
    let mut follow = |progress: Progress| {
        first.get_or_insert_with(|| clock.wall());
        evaluations = progress.evaluations;
    };
    let mut control = Control {
        progress: &mut follow,
        cancel: &AtomicBool::new(false),
    };
    let made = make_marker(&items, &strip, search, &mut control);
    result.wall_s = clock.wall();
    // Of the whole process: the islands' threads have ended, and the finer clock counts live ones.
    result.cpu_s = cpu_seconds().zip(before).map(|(now, before)| now - before);
    result.vertices = items.iter().map(|item| item.outline.outer.len()).sum();
    let mut note = |name: &str, value: f64| result.counted.insert(name.to_owned(), value);
    note("first_marker_s", first.unwrap_or(f64::NAN));
    note("evaluations", evaluations as f64);
    match made {
        Ok(marker) => {
            note("efficiency", marker.efficiency);
            note("length_m", marker.length);
            if !judge(&items, &strip, &marker).is_sound() {
                result.failure = Some("the marker is not sound".to_owned());
            }
        }
        Err(error) => result.failure = Some(error.to_string()),
    }
    if let Some(cpu) = result.cpu_s.filter(|cpu| *cpu > 0.0) {
        let rate = evaluations as f64 / cpu;
        result
            .counted
            .insert("evaluations_a_cpu_second".to_owned(), rate);
    }
    Ok(())
}
