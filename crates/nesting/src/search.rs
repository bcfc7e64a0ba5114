//! The search within its budget: independent searches (islands) run in parallel and sometimes adopt the best
//! layout.
//!
//! # Decided with
//! - [`crate::job::Job`], [`crate::check::check`]: pieces made ready; jobs that are refused;
//! - [`crate::start`], [`crate::layout_marker`]: a first layout, or the given one;
//! - [`crate::explore::Island`]: shorter strips, other layouts, pressing;
//! - [`crate::separate::Separator`], [`crate::refine`], [`crate::slide`]: overlaps parted; exact places;
//!   pieces slid together;
//! - [`crate::search::Budget`], [`crate::search::Meter`], [`crate::side_by_side`]: when it stops; threads;
//! - [`crate::rolls::make_markers_on_rolls`]: several rolls filled one after another;
//! - [`crate::random::SplitMix64`]: numbers that come the same again;
//! - [`crate::referee::judge`]: whether the result can be cut.
//!
//! Where the clock decides, the number of islands follows the machine, and so does the marker.

use crate::check::check;
use crate::error::NestingError;
use crate::explore::Island;
use crate::job::Job;
use crate::layout::Layout;
use crate::layout_marker::{finish, layout_of};
use crate::separate::Limit;
use crate::side_by_side::side_by_side;
use crate::{Item, Marker, PENETRATION_LIMIT, Strip, judge};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Limit at which a search ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Budget {
    /// After this number of evaluations of a pair of pieces: the same job gives the same marker.
    Evaluations(u64),
    /// After this time (s), for interactive use.
    Seconds(f64),
}

/// Parameters of the search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Search {
    /// Limit at which the search ends.
    pub budget: Budget,
    /// Seed of the random numbers; the same seed gives the same marker.
    pub seed: u64,
    /// Number of independent parallel searches. It changes the marker, while the number of processors does
    /// not. 0 means two, or with a time limit one per processor.
    pub islands: usize,
    /// Number of threads; 0 for as many as the machine has. The search uses at most one per island, the
    /// preparation of tables at most as many as the machine has.
    pub threads: usize,
}

impl Default for Search {
    fn default() -> Self {
        Self {
            budget: Budget::Evaluations(10_000_000),
            seed: 1,
            islands: 0,
            threads: 0,
        }
    }
}

impl Search {
    /// The default search with a budget in seconds.
    pub fn seconds(seconds: f64) -> Self {
        Self {
            budget: Budget::Seconds(seconds),
            ..Self::default()
        }
    }

    /// The default search with a budget in evaluations.
    pub fn evaluations(evaluations: u64) -> Self {
        Self {
            budget: Budget::Evaluations(evaluations),
            ..Self::default()
        }
    }
}

/// Progress of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Fraction of the budget used (0 to 1).
    pub done: f64,
    /// Number of evaluations of a pair of pieces.
    pub evaluations: u64,
    /// Length of the best marker so far, end margins included (m); infinite before the first.
    pub length: f64,
    /// The best marker so far; `None` before the first, and on rolls. The same `Arc` as before if its length
    /// did not change.
    pub marker: Option<Arc<Marker>>,
}

/// Receives the progress of a search, and may stop it.
pub struct Control<'a> {
    /// Called about twenty times a second, with unchanged numbers if there is no news.
    pub progress: &'a mut dyn FnMut(Progress),
    /// A flag that any thread may set: the search ends with the best marker so far, or with
    /// [`NestingError::Cancelled`] if there is none yet.
    pub cancel: &'a AtomicBool,
}

/// Largest number of islands.
const MAX_ISLANDS: usize = 64;
/// Largest number of pairs of pieces in all islands together, 24 bytes each: 1 GB.
const PAIRS_HELD: usize = 40_000_000;
/// Number of islands if the result must not depend on the machine, and the smallest number otherwise.
const DEFAULT_ISLANDS: usize = 2;
/// Fraction of the time for computing no-fit polygons in advance; the rest is computed when needed.
const PREPARING: f64 = 0.3;
/// Fraction of the time after which the final polishing ends, too.
const POLISHING: f64 = 1.1;
/// Fraction of the budget for finding new layouts; the rest is for compressing the best one.
const EXPLORING: f64 = 0.8;
/// Evaluations of an island between two exchanges.
const EPOCH: u64 = 3_000_000;
/// Time between two exchanges, with a time limit (s).
const EPOCH_SECONDS: f64 = 0.25;

/// Measures the fraction of the budget used.
struct Meter<'a> {
    search: Search,
    cancel: &'a AtomicBool,
    started: Instant,
}

impl Meter<'_> {
    /// Fraction of the budget used.
    fn done(&self, queries: u64) -> f64 {
        match self.search.budget {
            Budget::Evaluations(all) => queries as f64 / all.max(1) as f64,
            Budget::Seconds(all) => self.started.elapsed().as_secs_f64() / all.max(1e-3),
        }
    }

    /// Whether the search was cancelled or a fraction of the time limit has passed.
    fn stops(&self, part: f64) -> bool {
        self.cancel.load(Ordering::Relaxed)
            || match self.search.budget {
                Budget::Evaluations(_) => false,
                Budget::Seconds(all) => {
                    self.started.elapsed() > Duration::from_secs_f64((all * part).clamp(0.0, 1e9))
                }
            }
    }

    /// Time of the next exchange, with a time limit.
    fn end_of_epoch(&self) -> Option<Instant> {
        match self.search.budget {
            Budget::Evaluations(_) => None,
            Budget::Seconds(all) => {
                let seconds = (all / 40.0).clamp(1e-3, EPOCH_SECONDS);
                Some(Instant::now() + Duration::from_secs_f64(seconds))
            }
        }
    }

    /// Number of evaluations of one island for a fraction of the budget.
    fn share(&self, part: f64) -> u64 {
        match self.search.budget {
            Budget::Evaluations(all) => {
                (all as f64 * part / self.search.islands.max(1) as f64) as u64
            }
            Budget::Seconds(_) => u64::MAX,
        }
    }
}

/// Lays all pieces on the strip in the shortest length.
///
/// With a budget in evaluations, the same input gives the same marker. Refuses a job that cannot be done,
/// naming every faulty piece and the remedy. Copies that do not fit on a strip of limited length are listed
/// in the marker. Every marker has passed the referee on the original outlines.
///
/// ```
/// use std::sync::atomic::AtomicBool;
/// use toile_geometry::{Bounds2, Polygon, Vec2};
/// use toile_nesting::{Control, Item, Search, Strip, judge, make_marker};
///
/// let corner = Vec2::new(0.6, 0.5);
/// let piece = Polygon::rectangle(Bounds2 { min: Vec2::zeros(), max: corner });
/// let items = [Item { quantity: 3, ..Item::new("pocket", piece) }];
/// let strip = Strip::of_width(1.5);
/// let mut control = Control { progress: &mut |_| {}, cancel: &AtomicBool::new(false) };
/// let marker = make_marker(&items, &strip, Search::evaluations(100_000), &mut control)?;
/// assert!((marker.length - 0.6).abs() < 1e-6);
/// assert!(judge(&items, &strip, &marker).is_sound());
/// # Ok::<(), toile_nesting::NestingError>(())
/// ```
pub fn make_marker(
    items: &[Item],
    strip: &Strip,
    search: Search,
    control: &mut Control<'_>,
) -> Result<Marker, NestingError> {
    run(items, strip, None, (search, control))
}

/// Continues from a marker: a finished one, one stopped early, or one changed by hand.
///
/// Pieces of the start may overlap, lie outside the strip, have an orientation that is not allowed, or be
/// missing: they are separated, moved back, rotated to the nearest allowed orientation, and laid. Locked
/// copies have their locked positions. If the start is valid, the marker is at most as long. Otherwise like
/// [`make_marker`].
pub fn improve_marker(
    items: &[Item],
    strip: &Strip,
    start: &Marker,
    search: Search,
    control: &mut Control<'_>,
) -> Result<Marker, NestingError> {
    run(items, strip, Some(start), (search, control))
}

fn run(
    items: &[Item],
    strip: &Strip,
    start: Option<&Marker>,
    (search, control): (Search, &mut Control<'_>),
) -> Result<Marker, NestingError> {
    check(items, strip)?;
    let count: usize = items.iter().map(|item| item.quantity as usize).sum();
    let search = checked(search, count + strip.flaws.len())?;
    let meter = Meter {
        search,
        cancel: control.cancel,
        started: Instant::now(),
    };
    let copies: Vec<(usize, u32)> = (0..items.len())
        .flat_map(|k| (0..items[k].quantity).map(move |copy| (k, copy)))
        .collect();
    let found = search_for((items, strip, &copies), start, (&meter, control));
    let marker = match (found, start) {
        (Ok(marker), _) => marker,
        // Stopped before a layout was found: a valid start is better than none.
        (Err(NestingError::Cancelled), Some(start)) if judge(items, strip, start).is_sound() => {
            return Ok(start.clone());
        }
        (Err(error), _) => return Err(error),
    };
    let verdict = judge(items, strip, &marker);
    let gains = |s: &&Marker| verdict.is_sound() && is_ahead(&marker, s);
    if let Some(start) = start.filter(|s| !gains(s))
        && judge(items, strip, start).is_sound()
    {
        return Ok(start.clone());
    }
    match verdict.violations.first() {
        None => Ok(marker),
        Some(violation) => {
            let name = |k: usize| {
                let placement = &marker.placements[k];
                format!("\"{}\" {}", items[placement.item].name, placement.copy)
            };
            Err(NestingError::Unsound(violation.in_words(&name)))
        }
    }
}

/// Prepares the tables and searches.
fn search_for(
    (items, strip, copies): (&[Item], &Strip, &[(usize, u32)]),
    start: Option<&Marker>,
    (meter, control): (&Meter<'_>, &mut Control<'_>),
) -> Result<Marker, NestingError> {
    let stop = || meter.cancel.load(Ordering::Relaxed);
    let job = Job::new(items, strip, copies, &stop)?;
    let mut told = || (control.progress)(BEGUN);
    let threads = threads(meter.search);
    job.prepare(threads, &|| meter.stops(PREPARING), &mut told);
    let layout = start.map(|marker| layout_of(&job, marker));
    let best = run_islands(&job, layout.as_ref(), meter, control)?;
    Ok(finish(&job, &best))
}

/// Progress before the first layout.
const BEGUN: Progress = Progress {
    done: 0.0,
    evaluations: 0,
    length: f64::INFINITY,
    marker: None,
};

/// Checks the parameters for a number of pieces and flaws, and sets the number of islands.
fn checked(mut search: Search, count: usize) -> Result<Search, NestingError> {
    let refuse = |what: String| Err(NestingError::Search(what));
    if let Budget::Seconds(seconds) = search.budget
        && (seconds.is_nan() || seconds < 0.0)
    {
        return refuse(format!("the time is {seconds} s; give 0 or more"));
    }
    let most = (PAIRS_HELD / count.pow(2).max(1)).clamp(1, MAX_ISLANDS);
    if search.islands > most {
        return refuse(format!(
            "{} islands are too many for {count} pieces and flaws; give {most} at most",
            search.islands
        ));
    }
    if search.islands == 0 {
        search.islands = match search.budget {
            Budget::Evaluations(_) => DEFAULT_ISLANDS,
            Budget::Seconds(_) => processors().max(DEFAULT_ISLANDS),
        };
        search.islands = search.islands.min(most);
    }
    Ok(search)
}

/// Threads that run at once: as the variable of rayon says, which holds for all work of a process, else one a
/// processor.
fn processors() -> usize {
    let said = std::env::var("RAYON_NUM_THREADS").ok();
    let said = said.and_then(|text| text.parse().ok());
    said.filter(|&count| count > 0)
        .unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from))
}

/// Whether a marker has more pieces laid than another, or as many on clearly less fabric.
fn is_ahead(marker: &Marker, other: &Marker) -> bool {
    let (left, other_left) = (marker.unplaced.len(), other.unplaced.len());
    let shorter = marker.length < other.length - PENETRATION_LIMIT;
    left < other_left || (left == other_left && shorter)
}

fn threads(search: Search) -> usize {
    match search.threads {
        0 => processors(),
        threads => threads.min(processors().max(search.islands)),
    }
}

/// The islands of a search, each with its own seed.
fn islands<'a>(job: &'a Job<'a>, search: Search) -> Vec<Island<'a>> {
    let seed = search.seed.wrapping_mul(0x1000_0000_01b3);
    let count = search.islands.max(1) as u64;
    (0..count)
        .map(|k| Island::new(job, seed.wrapping_add(k)))
        .collect()
}

/// Starts all islands, then lets them search with exchanges until the budget is used; returns the best
/// layout.
fn run_islands(
    job: &Job<'_>,
    start: Option<&Layout>,
    meter: &Meter<'_>,
    control: &mut Control<'_>,
) -> Result<Layout, NestingError> {
    let mut islands = islands(job, meter.search);
    let threads = threads(meter.search);
    tracing::info!(
        items = job.items.len(),
        islands = islands.len(),
        threads,
        "search begins"
    );
    let mut told = || (control.progress)(BEGUN);
    let begin = |island: &mut Island<'_>| {
        let limit = Limit {
            queries: u64::MAX,
            stop: &|| meter.cancel.load(Ordering::Relaxed),
        };
        match start {
            Some(layout) => island.start_from(layout, &limit),
            None => island.start(&limit),
        }
    };
    each(&mut islands, threads, (&begin, &mut told));
    share(&mut islands);
    let mut last = report_progress(&islands, BEGUN, meter, control);
    for (part, press) in [(EXPLORING, false), (1.0, true)] {
        let phase = if press { "compression" } else { "exploration" };
        tracing::info!(phase, length = last.length, "phase of the search");
        loop {
            let most = islands.iter().map(Island::queries).max().unwrap_or(0);
            if meter.stops(part) || most >= meter.share(part) {
                break;
            }
            let mut again = || (control.progress)(last.clone());
            epoch(&mut islands, meter, (part, press), &mut again);
            share(&mut islands);
            last = report_progress(&islands, last, meter, control);
            let (evaluations, length) = (last.evaluations, last.length);
            tracing::debug!(phase, evaluations, length, "islands exchanged");
            let now = islands.iter().map(Island::queries).max().unwrap_or(0);
            if now == most {
                // No island made another query.
                break;
            }
        }
    }
    let best = best_of(&islands).map(|k| islands.swap_remove(k));
    let mut best = best.ok_or(NestingError::Cancelled)?;
    tracing::info!(
        phase = "polishing",
        length = last.length,
        "phase of the search"
    );
    best.polish(&Limit {
        queries: u64::MAX,
        stop: &|| meter.stops(POLISHING),
    });
    best.best.ok_or(NestingError::Cancelled)
}

/// Lets every island search until the next exchange.
fn epoch(
    islands: &mut [Island<'_>],
    meter: &Meter<'_>,
    (part, press): (f64, bool),
    told: &mut dyn FnMut(),
) {
    let count = islands.len() as u64;
    let queries = EPOCH.min(meter.share(1.0) / 16 + 1);
    let ends = meter.end_of_epoch();
    let work = |island: &mut Island<'_>| {
        let limit = Limit {
            queries: match ends {
                Some(_) => u64::MAX,
                None => (island.queries() + queries).min(meter.share(part)),
            },
            stop: &|| meter.stops(part) || ends.is_some_and(|end| Instant::now() >= end),
        };
        if press {
            let done = |queries: u64| (meter.done(queries * count) - EXPLORING) / (1.0 - EXPLORING);
            island.press(&limit, &done);
        } else {
            island.explore(&limit);
        }
    };
    each(islands, threads(meter.search), (&work, told));
}

/// A function that works on one island.
type Work<'w, 'a> = &'w (dyn Fn(&mut Island<'a>) + Sync);

/// Runs `work` on all islands with a number of threads.
fn each<'a>(
    islands: &mut [Island<'a>],
    threads: usize,
    (work, told): (Work<'_, 'a>, &mut dyn FnMut()),
) {
    let share = islands.len().div_ceil(threads.max(1)).max(1);
    let chunks = islands.chunks_mut(share).collect();
    let chunk = |chunk: &mut [Island<'a>]| chunk.iter_mut().for_each(work);
    side_by_side(chunks, &chunk, told);
}

/// Copies the best layout to islands with worse ones.
fn share(islands: &mut [Island<'_>]) {
    let Some(first) = best_of(islands) else {
        return;
    };
    let (score, best) = (islands[first].score(), islands[first].best.clone());
    for island in islands.iter_mut().filter(|i| i.score() > score) {
        if let Some(best) = &best {
            island.adopt(best);
        }
    }
}

/// The island with the best layout, the first of equals.
fn best_of(islands: &[Island<'_>]) -> Option<usize> {
    let order = |a: (f64, f64), b: (f64, f64)| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1));
    (0..islands.len()).min_by(|&a, &b| order(islands[a].score(), islands[b].score()))
}

/// Reports the progress of all islands and returns it; reuses the marker of `last` if the length is the same.
fn report_progress(
    islands: &[Island<'_>],
    last: Progress,
    meter: &Meter<'_>,
    control: &mut Control<'_>,
) -> Progress {
    let evaluations: u64 = islands.iter().map(Island::queries).sum();
    let best = best_of(islands).and_then(|k| islands[k].best.as_ref().map(|best| (k, best)));
    let Some((k, best)) = best else {
        let progress = Progress {
            done: meter.done(evaluations).min(1.0),
            evaluations,
            ..BEGUN
        };
        (control.progress)(progress.clone());
        return progress;
    };
    let job = islands[k].separator.job;
    let length = best.length + 2.0 * job.strip.end_margin;
    let laid = last
        .marker
        .filter(|_| last.length.to_bits() == length.to_bits())
        .filter(|marker| {
            marker.placements.len() == best.present.iter().filter(|&&laid| laid).count()
        });
    let progress = Progress {
        done: meter.done(evaluations).min(1.0),
        evaluations,
        length,
        marker: Some(laid.unwrap_or_else(|| Arc::new(finish(job, best)))),
    };
    (control.progress)(progress.clone());
    progress
}
