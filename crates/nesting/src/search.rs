//! Several orders are tried within a budget of positions weighed, not of time; the best one is kept.

use crate::check::{NestingError, check};
use crate::fit::Fit;
use crate::order::{CRITERIA, Copy, Sequence, ordered, shuffled};
use crate::place::{Layout, Preference, lay};
use crate::{Item, Marker, Strip, Unplaced};
use std::sync::atomic::AtomicBool;

/// How hard to search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Search {
    /// Positions of pieces weighed before the search ends; at least a few whole markers are laid.
    /// The default takes about a second. Ten times as many shorten the marker by a percent or so.
    pub positions: u64,
    /// Start of the sequence that shuffles orders; the same seed gives the same marker.
    pub seed: u64,
}

impl Default for Search {
    fn default() -> Self {
        Self {
            positions: 10_000_000,
            seed: 1,
        }
    }
}

/// How far a search has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Part of the budget used, 0..=1.
    pub done: f64,
    /// Markers laid.
    pub markers: u64,
    /// Length of the best so far, end margins included \[m\].
    pub length: f64,
}

/// How the outside follows and stops a search.
pub struct Control<'a> {
    /// Told after every few markers.
    pub progress: &'a mut dyn FnMut(Progress),
    /// Set from anywhere to stop: the search ends with [`NestingError::Cancelled`].
    pub cancel: &'a AtomicBool,
}

/// Lays all pieces on the strip in little length.
///
/// Deterministic: the same input gives the same marker. Refuses a job that cannot be done, naming
/// every piece and the remedy. Copies that find no place on a strip of limited length are listed
/// in the marker.
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
/// let marker = make_marker(&items, &strip, Search::default(), &mut control)?;
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
    let fit = Fit::new(items, strip);
    let mut best: Option<Trial> = None;
    let mut sequence = Sequence(search.seed);
    let (mut positions, mut markers) = (0, 0);
    loop {
        let batch: Vec<Plan> = (markers..markers + BATCH)
            .map(|number| plan(items, number, best.as_ref(), &mut sequence))
            .collect();
        let trials = lay_batch((items, strip, &fit), batch, control.cancel);
        for trial in trials {
            let trial = trial.ok_or(NestingError::Cancelled)?;
            positions += trial.layout.positions;
            if best.as_ref().is_none_or(|known| trial.score < known.score) {
                best = Some(trial);
            }
        }
        markers += BATCH;
        let Some(known) = &best else {
            return Err(NestingError::NoItems);
        };
        let most = STARTS + MARKERS_PER_COPY * known.plan.order.len() as u64;
        let done = (positions as f64 / search.positions.max(1) as f64)
            .max(markers as f64 / most as f64)
            .min(1.0);
        (control.progress)(Progress {
            done,
            markers,
            length: known.layout.reach + strip.end_margin,
        });
        if done >= 1.0 {
            break;
        }
    }
    let best = best.ok_or(NestingError::NoItems)?;
    Ok(finish(items, strip, best.layout))
}

/// Markers laid between two looks at the best: they may be laid at the same time, and their number
/// is fixed so that the number of threads does not matter.
const BATCH: u64 = 4;
/// Orders that are always tried first, budget permitting.
const STARTS: u64 = 2 * CRITERIA.len() as u64;
/// Shuffles after which a small job is taken to be settled, per copy.
const MARKERS_PER_COPY: u64 = 60;

/// A marker to lay.
struct Plan {
    order: Vec<Copy>,
    preference: Preference,
}

/// A marker laid.
struct Trial {
    score: (f64, f64, f64),
    layout: Layout,
    plan: Plan,
}

/// First the orders by size, then shuffles of the best.
fn plan(items: &[Item], number: u64, best: Option<&Trial>, sequence: &mut Sequence) -> Plan {
    match best {
        Some(best) if number >= STARTS => Plan {
            order: shuffled(&best.plan.order, sequence),
            preference: best.plan.preference,
        },
        _ => Plan {
            order: ordered(items, CRITERIA[(number / 2) as usize % CRITERIA.len()]),
            preference: [Preference::ShortestReach, Preference::EarliestStart]
                [(number % 2) as usize],
        },
    }
}

/// Lays all plans, on as many threads as there are; results in the order of the plans.
fn lay_batch(
    job: (&[Item], &Strip, &Fit),
    plans: Vec<Plan>,
    cancel: &AtomicBool,
) -> Vec<Option<Trial>> {
    let one = |plan: Plan| {
        let layout = lay(job, &plan.order, plan.preference, cancel)?;
        Some(Trial {
            score: score(job.0, &layout),
            layout,
            plan,
        })
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let share = plans.len().div_ceil(threads.max(1)).max(1);
    let mut shares: Vec<Vec<Plan>> = Vec::new();
    for plan in plans {
        match shares.last_mut() {
            Some(last) if last.len() < share => last.push(plan),
            _ => shares.push(vec![plan]),
        }
    }
    std::thread::scope(|scope| {
        let mine = shares.pop().unwrap_or_default();
        let others: Vec<_> = shares
            .into_iter()
            .map(|share| scope.spawn(|| share.into_iter().map(one).collect::<Vec<_>>()))
            .collect();
        let last: Vec<Option<Trial>> = mine.into_iter().map(one).collect();
        let mut all = Vec::new();
        for other in others {
            match other.join() {
                Ok(trials) => all.extend(trials),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        all.extend(last);
        all
    })
}

/// Less is better: area left over \[m2\], then length \[m\], then the sum of all right ends \[m\].
fn score(items: &[Item], layout: &Layout) -> (f64, f64, f64) {
    let area = |&(item, _): &Copy| items[item].outline.area();
    let left_over = layout.left_over.iter().map(area).sum();
    (left_over, layout.reach, layout.spread)
}

fn finish(items: &[Item], strip: &Strip, mut layout: Layout) -> Marker {
    layout.placements.sort_by_key(|p| (p.item, p.copy));
    layout.left_over.sort_unstable();
    let area: f64 = layout
        .placements
        .iter()
        .map(|p| items[p.item].outline.area())
        .sum();
    let length = layout.reach + strip.end_margin;
    let share = |of: f64| {
        if of > 0.0 {
            area / (strip.width * of)
        } else {
            0.0
        }
    };
    let reason = format!(
        "no room is left on {:.0} mm of fabric; take more fabric or lay it on another marker",
        strip.max_length.unwrap_or(length) * 1e3
    );
    Marker {
        efficiency: share(layout.reach - strip.end_margin),
        utilisation: share(length),
        length,
        unplaced: layout
            .left_over
            .iter()
            .map(|&(item, copy)| Unplaced {
                item,
                copy,
                reason: reason.clone(),
            })
            .collect(),
        placements: layout.placements,
    }
}
