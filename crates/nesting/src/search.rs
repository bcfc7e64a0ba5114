//! Several orders are tried within a budget of markers, not of time; the best one is kept.

use crate::check::{NestingError, check};
use crate::fit::Fit;
use crate::order::{CRITERIA, Copy, Sequence, ordered, shuffled};
use crate::place::{Layout, Preference, lay};
use crate::{Item, Marker, Strip, Unplaced};
use std::sync::atomic::AtomicBool;

/// How hard to search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Search {
    /// Number of markers laid, at least one is. More take proportionally longer and are seldom
    /// longer in fabric.
    pub markers: u32,
    /// Start of the sequence that shuffles orders; the same seed gives the same marker.
    pub seed: u64,
}

impl Default for Search {
    fn default() -> Self {
        Self {
            markers: 40,
            seed: 1,
        }
    }
}

/// How far a search has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Markers laid.
    pub done: u32,
    /// Markers to lay.
    pub total: u32,
    /// Length of the best so far, end margins included [m].
    pub length: f64,
}

/// How the outside follows and stops a search.
pub struct Control<'a> {
    /// Told after every marker.
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
    let job = (items, strip, &fit);
    let total = search.markers.max(1);
    let mut best: Option<Trial> = None;
    let mut sequence = Sequence(search.seed);
    for done in 0..total {
        let (order, preference) = match (starting_order(items, done), &best) {
            (Some(start), _) => start,
            (None, Some(best)) => (shuffled(&best.order, &mut sequence), best.preference),
            (None, None) => (ordered(items, CRITERIA[0]), Preference::ShortestReach),
        };
        let layout = lay(job, &order, preference, control.cancel).ok_or(NestingError::Cancelled)?;
        let trial = Trial {
            score: score(items, &layout),
            layout,
            order,
            preference,
        };
        if best.as_ref().is_none_or(|known| trial.score < known.score) {
            best = Some(trial);
        }
        let length = best
            .as_ref()
            .map_or(0.0, |b| b.layout.reach + strip.end_margin);
        (control.progress)(Progress {
            done: done + 1,
            total,
            length,
        });
    }
    let best = best.ok_or(NestingError::NoItems)?;
    Ok(finish(items, strip, best.layout))
}

struct Trial {
    score: (f64, f64),
    layout: Layout,
    order: Vec<Copy>,
    preference: Preference,
}

/// The orders that are always tried first.
fn starting_order(items: &[Item], number: u32) -> Option<(Vec<Copy>, Preference)> {
    let number = number as usize;
    let criterion = *CRITERIA.get(number / 2)?;
    let preference = [Preference::ShortestReach, Preference::EarliestStart][number % 2];
    Some((ordered(items, criterion), preference))
}

/// Less is better: area left over [m2], then length [m].
fn score(items: &[Item], layout: &Layout) -> (f64, f64) {
    let area = |&(item, _): &Copy| items[item].outline.area();
    (layout.left_over.iter().map(area).sum(), layout.reach)
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
