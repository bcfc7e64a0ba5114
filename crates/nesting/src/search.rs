//! A marker within a budget: islands search side by side, now and then the best layout is shared.

use crate::check::{NestingError, check};
use crate::explore::Island;
use crate::job::Job;
use crate::layout::Layout;
use crate::separate::Limit;
use crate::{Item, Marker, Placement, Strip, Unplaced, judge};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// When a search ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Budget {
    /// After so many evaluations of a pair of pieces: the same job gives the same marker.
    Evaluations(u64),
    /// After so many seconds \[s\]: for a person who waits.
    Seconds(f64),
}

/// How hard to search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Search {
    /// When it ends.
    pub budget: Budget,
    /// Start of the sequences of chance; the same seed gives the same marker.
    pub seed: u64,
    /// Searches side by side; their number changes the marker, the number of processors does not.
    pub islands: usize,
}

impl Default for Search {
    fn default() -> Self {
        Self {
            budget: Budget::Evaluations(10_000_000),
            seed: 1,
            islands: 2,
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

/// How far a search has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Part of the budget used, 0..=1.
    pub done: f64,
    /// Pairs of pieces evaluated.
    pub evaluations: u64,
    /// Length of the best so far, end margins included \[m\].
    pub length: f64,
}

/// How the outside follows and stops a search.
pub struct Control<'a> {
    /// Told now and then.
    pub progress: &'a mut dyn FnMut(Progress),
    /// Set from anywhere to stop: the search ends with [`NestingError::Cancelled`].
    pub cancel: &'a AtomicBool,
}

/// Part of the budget spent on new layouts; the rest presses the best one.
const EXPLORING: f64 = 0.8;
/// Evaluations of an island between two exchanges.
const EPOCH: u64 = 3_000_000;

/// What was used and what is at hand.
struct Meter<'a> {
    search: Search,
    cancel: &'a AtomicBool,
    started: Instant,
}

impl Meter<'_> {
    /// Part of the budget used.
    fn done(&self, queries: u64) -> f64 {
        match self.search.budget {
            Budget::Evaluations(all) => queries as f64 / all.max(1) as f64,
            Budget::Seconds(all) => self.started.elapsed().as_secs_f64() / all.max(1e-3),
        }
    }

    /// Whether the clock says that a part of the budget is used up.
    fn stops(&self, part: f64) -> bool {
        self.cancel.load(Ordering::Relaxed)
            || match self.search.budget {
                Budget::Evaluations(_) => false,
                Budget::Seconds(all) => {
                    self.started.elapsed() > Duration::from_secs_f64((all * part).clamp(0.0, 1e9))
                }
            }
    }

    /// Evaluations of one island when a part of the budget is used up.
    fn share(&self, part: f64) -> u64 {
        match self.search.budget {
            Budget::Evaluations(all) => {
                (all as f64 * part / self.search.islands.max(1) as f64) as u64
            }
            Budget::Seconds(_) => u64::MAX,
        }
    }
}

/// Lays all pieces on the strip in little length.
///
/// With a budget in evaluations the same input gives the same marker. Refuses a job that cannot be
/// done, naming every piece and the remedy. Copies that find no place on a strip of limited length
/// are listed in the marker. Every marker has passed the referee on the original outlines.
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
    check(items, strip)?;
    let meter = Meter {
        search,
        cancel: control.cancel,
        started: Instant::now(),
    };
    let copies: Vec<(usize, u32)> = (0..items.len())
        .flat_map(|k| (0..items[k].quantity).map(move |copy| (k, copy)))
        .collect();
    let job = Job::new(items, strip, &copies);
    job.prepare(threads(), &|| control.cancel.load(Ordering::Relaxed));
    let best = hunt(&job, &meter, control)?;
    let marker = finish(&job, &best);
    match judge(items, strip, &marker).violations.first() {
        None => Ok(marker),
        Some(violation) => Err(NestingError::Unsound(format!("{violation:?}"))),
    }
}

fn threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

fn hunt(
    job: &Job<'_>,
    meter: &Meter<'_>,
    control: &mut Control<'_>,
) -> Result<Layout, NestingError> {
    let count = meter.search.islands.max(1) as u64;
    let seeds = (0..count).map(|k| {
        meter
            .search
            .seed
            .wrapping_mul(0x1000_0000_01b3)
            .wrapping_add(k)
    });
    let mut islands: Vec<Island<'_>> = seeds.map(|seed| Island::new(job, seed)).collect();
    each(&mut islands, &|island| {
        island.start(&Limit {
            queries: u64::MAX,
            stop: &|| meter.cancel.load(Ordering::Relaxed),
        });
    });
    let epoch = EPOCH.min(meter.share(1.0) / 16 + 1);
    for (part, press) in [(EXPLORING, false), (1.0, true)] {
        loop {
            if meter.cancel.load(Ordering::Relaxed) {
                return Err(NestingError::Cancelled);
            }
            share(&mut islands);
            tell(&islands, meter, control);
            let queries = |island: &Island<'_>| island.queries();
            let most = islands.iter().map(queries).max().unwrap_or(0);
            if meter.stops(part) || most >= meter.share(part) {
                break;
            }
            each(&mut islands, &|island| {
                let limit = Limit {
                    queries: (island.queries() + epoch).min(meter.share(part)),
                    stop: &|| meter.stops(part),
                };
                if press {
                    let done = |queries: u64| {
                        (meter.done(queries * count) - EXPLORING) / (1.0 - EXPLORING)
                    };
                    island.press(&limit, &done);
                } else {
                    island.explore(&limit);
                }
            });
            let now = islands.iter().map(queries).max().unwrap_or(0);
            if now == most {
                // Nothing is left to try.
                break;
            }
        }
    }
    let mut best = best_of(&islands)
        .map(|k| islands.swap_remove(k))
        .ok_or(NestingError::NoItems)?;
    best.polish();
    best.best.ok_or(NestingError::Cancelled)
}

/// Works on all islands, on as many threads as there are.
fn each<'a>(islands: &mut [Island<'a>], work: &(dyn Fn(&mut Island<'a>) + Sync)) {
    let share = islands.len().div_ceil(threads());
    std::thread::scope(|scope| {
        let mut chunks = islands.chunks_mut(share);
        let own = chunks.next();
        for chunk in chunks {
            scope.spawn(move || chunk.iter_mut().for_each(work));
        }
        own.into_iter().flatten().for_each(work);
    });
}

/// The best layout goes to islands that are clearly behind.
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

/// The island with the best layout, the first of equal ones.
fn best_of(islands: &[Island<'_>]) -> Option<usize> {
    let order = |a: (f64, f64), b: (f64, f64)| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1));
    (0..islands.len()).min_by(|&a, &b| order(islands[a].score(), islands[b].score()))
}

fn tell(islands: &[Island<'_>], meter: &Meter<'_>, control: &mut Control<'_>) {
    let evaluations: u64 = islands.iter().map(Island::queries).sum();
    let length = best_of(islands).map_or(f64::INFINITY, |k| islands[k].score().1);
    let margin = islands
        .first()
        .map_or(0.0, |i| 2.0 * i.separator.job.strip.end_margin);
    (control.progress)(Progress {
        done: meter.done(evaluations).min(1.0),
        evaluations,
        length: length + margin,
    });
}

fn finish(job: &Job<'_>, layout: &Layout) -> Marker {
    let strip = job.strip;
    let (mut placements, mut unplaced) = (Vec::new(), Vec::new());
    let reason = match strip.max_length {
        Some(length) => format!(
            "no room is left on {:.0} mm of fabric; take more fabric or lay it on another marker",
            length * 1e3
        ),
        None => "no place was found between defects, locked pieces and stripes; free some of them"
            .to_owned(),
    };
    for (k, piece) in job.pieces.iter().enumerate() {
        let Some(item) = piece.item else {
            continue;
        };
        if !layout.present[k] {
            unplaced.push(Unplaced {
                item,
                copy: piece.copy,
                reason: reason.clone(),
            });
            continue;
        }
        let shape = &job.shapes[layout.shape[k]];
        placements.push(Placement {
            item,
            copy: piece.copy,
            turn: shape.turn,
            mirrored: shape.mirrored,
            translation: layout.at[k] - shape.offset + job.corner(),
        });
    }
    let mut marker = Marker {
        placements,
        unplaced,
        ..Marker::default()
    };
    marker.measure(job.items, strip);
    marker
}
