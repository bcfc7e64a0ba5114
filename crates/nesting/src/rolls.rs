//! Several rolls of given width and length, filled one after the other.

use crate::check::{check_locks, check_numbered};
use crate::error::{NestingError, Refusal};
use crate::{
    Budget, Control, Item, ItemProblem, Marker, Mirror, Progress, Search, Strip, Unplaced,
    make_marker,
};

/// The marker on one roll.
#[derive(Clone, Debug, PartialEq)]
pub struct RollMarker {
    /// Index of the roll.
    pub roll: usize,
    /// Items of the job with the copies that were left for this roll; the marker numbers these copies from 0.
    pub items: Vec<Item>,
    /// For each of these items, its index in the job and the numbers of its copies there.
    pub sources: Vec<(usize, Vec<u32>)>,
    /// The marker. Copies that it lists as unplaced were passed on to the next roll.
    pub marker: Marker,
}

/// Markers on several rolls.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RolledOut {
    /// One marker for each roll with pieces, in the order of the rolls.
    pub markers: Vec<RollMarker>,
    /// Copies that lie on no roll, by item and copy, with the reason for each roll.
    pub unplaced: Vec<Unplaced>,
}

/// Lays all pieces on rolls of fabric, which are filled in the given order; pieces that do not fit on one go
/// to the next. A roll of unlimited length takes all remaining pieces in the shortest length. Locked copies
/// lie on the first roll.
///
/// The budget is divided in proportion to the area that each roll can take. Every marker has passed the
/// referee.
///
/// # Errors
/// There is no roll or no piece, a roll is invalid, a piece is damaged, or the search is stopped. A piece
/// that is only too large for a roll is not an error: it is listed as unplaced.
pub fn make_markers_on_rolls(
    items: &[Item],
    rolls: &[Strip],
    search: Search,
    control: &mut Control<'_>,
) -> Result<RolledOut, NestingError> {
    if rolls.is_empty() {
        return Err(NestingError::Strip(
            "no roll is given; give at least one with its width".to_owned(),
        ));
    }
    if items.is_empty() {
        return Err(NestingError::NoItems);
    }
    check_all_locks(items)?;
    let mut left: Vec<Remainder> = (0..items.len())
        .map(|item| Remainder {
            copies: (0..items[item].quantity).collect(),
            reasons: Vec::new(),
        })
        .collect();
    let mut out = RolledOut::default();
    let shares = shares(items, rolls);
    let mut done = 0.0;
    for (roll, strip) in rolls.iter().enumerate() {
        let RollJob { laid, sources } = RollJob::new(items, &mut left, (roll, strip))?;
        if !laid.is_empty() && shares[roll] > 0.0 {
            let mut told = |progress: Progress| {
                (control.progress)(Progress {
                    done: done + progress.done * shares[roll],
                    marker: None,
                    ..progress
                });
            };
            let mut control = Control {
                progress: &mut told,
                cancel: control.cancel,
            };
            let made = make_marker(&laid, strip, part(search, shares[roll]), &mut control);
            if made == Err(NestingError::Cancelled) && !out.markers.is_empty() {
                // Stopped after some rolls: the remaining pieces are reported as not laid.
                for source in &sources {
                    left[source.0].reasons = vec!["the search was stopped; go on".to_owned()];
                }
                break;
            }
            let marker = made?;
            note_result(&marker, &sources, &mut left, (roll, rolls.len()));
            if !marker.placements.is_empty() {
                out.markers.push(RollMarker {
                    roll,
                    items: laid,
                    sources,
                    marker,
                });
            }
        }
        done += shares[roll];
    }
    for (item, remainder) in left.iter().enumerate() {
        out.unplaced
            .extend(remainder.copies.iter().map(|&copy| Unplaced {
                item,
                copy,
                reason: remainder.reasons.join("; "),
            }));
    }
    Ok(out)
}

/// Copies of an item that are not laid yet, with the reasons of the rolls so far.
struct Remainder {
    copies: Vec<u32>,
    reasons: Vec<String>,
}

/// Fraction of the search budget for each roll: in proportion to the area that it takes of the remaining
/// pieces.
fn shares(items: &[Item], rolls: &[Strip]) -> Vec<f64> {
    let area = |item: &Item| item.outline.area() * f64::from(item.quantity);
    let mut left: f64 = items.iter().map(area).sum();
    let taken: Vec<f64> = rolls
        .iter()
        .map(|strip| {
            let room = strip
                .max_length
                .map_or(f64::INFINITY, |l| (l * strip.usable_width()).max(0.0));
            let taken = room.min(left);
            left -= taken;
            taken.max(0.0)
        })
        .collect();
    let last = taken.iter().rposition(|&t| t > 0.0);
    let most = taken.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    // A roll after the last one that the area requires takes pieces that did not fit on the others.
    let late = last.map_or(0, |l| rolls.len() - 1 - l) as f64;
    let spare = if late > 0.0 { 0.2 } else { 0.0 };
    let share = |(k, t): (usize, &f64)| match last {
        Some(last) if k > last => spare / late,
        _ => (1.0 - spare) * t / most,
    };
    taken.iter().enumerate().map(share).collect()
}

fn part(search: Search, share: f64) -> Search {
    let budget = match search.budget {
        Budget::Evaluations(all) => Budget::Evaluations((all as f64 * share) as u64),
        Budget::Seconds(all) => Budget::Seconds(all * share),
    };
    Search { budget, ..search }
}

/// Refuses locks of copies that do not exist, since they would lie on no roll.
fn check_all_locks(items: &[Item]) -> Result<(), NestingError> {
    let refusal = |(k, item): (usize, &Item)| {
        // An item without copies is refused for that reason instead.
        let problem = check_locks(item).filter(|_| item.quantity > 0)?;
        Some(Refusal {
            item: k,
            name: item.name.clone(),
            problem,
        })
    };
    let refused: Vec<Refusal> = items.iter().enumerate().filter_map(refusal).collect();
    match refused.is_empty() {
        true => Ok(()),
        false => Err(NestingError::Refused(refused)),
    }
}

/// The items to lay on one roll.
struct RollJob {
    laid: Vec<Item>,
    /// For each item, its index in the job and the numbers of its copies there.
    sources: Vec<(usize, Vec<u32>)>,
}

impl RollJob {
    /// The remaining items without those too large for the roll, whose reason is noted.
    fn new(
        items: &[Item],
        left: &mut [Remainder],
        (roll, strip): (usize, &Strip),
    ) -> Result<Self, NestingError> {
        let mut job = Self {
            laid: Vec::new(),
            sources: Vec::new(),
        };
        for (k, item) in items.iter().enumerate() {
            if item.quantity == 0 {
                // Refused below, with its name.
                job.laid.push(item.clone());
                job.sources.push((k, Vec::new()));
            }
            for copies in groups(item, &left[k].copies) {
                job.laid.push(part_of(item, &copies, roll));
                job.sources.push((k, copies));
            }
        }
        if job.laid.is_empty() {
            return Ok(job);
        }
        let copy_of = |item: usize, copy: u32| {
            let copies = &job.sources[item].1;
            copies.get(copy as usize).copied().unwrap_or(copy)
        };
        let refused = match check_numbered(&job.laid, strip, &copy_of) {
            Ok(()) => return Ok(job),
            Err(NestingError::Refused(refused)) => refused,
            Err(error) => return Err(error),
        };
        let too_large = |refusal: &Refusal| {
            matches!(
                refusal.problem,
                ItemProblem::TooWide { .. } | ItemProblem::TooLong { .. }
            )
        };
        if !refused.iter().all(too_large) {
            let other = refused.into_iter().filter(|r| !too_large(r));
            let named = other.map(|mut r| {
                r.item = job.sources[r.item].0;
                r
            });
            return Err(NestingError::Refused(named.collect()));
        }
        for refusal in refused.iter().rev() {
            let reason = format!("roll {}: {}", roll + 1, refusal.problem);
            let reasons = &mut left[job.sources[refusal.item].0].reasons;
            if !reasons.contains(&reason) {
                reasons.push(reason);
            }
            job.laid.remove(refusal.item);
            job.sources.remove(refusal.item);
        }
        Ok(job)
    }
}

/// Groups of copies with the same orientations: for a pair the even and the odd copies.
fn groups(item: &Item, copies: &[u32]) -> Vec<Vec<u32>> {
    let whole = item.allowed.mirror != Mirror::Pairs;
    let (even, odd): (Vec<u32>, Vec<u32>) = copies.iter().partition(|&&c| whole || c % 2 == 0);
    [even, odd].into_iter().filter(|g| !g.is_empty()).collect()
}

/// An item with only some of its copies.
fn part_of(item: &Item, copies: &[u32], roll: usize) -> Item {
    let mut part = item.clone();
    part.quantity = copies.len() as u32;
    part.bundles = copies.iter().map(|&c| item.bundle(c)).collect();
    if item.allowed.mirror == Mirror::Pairs {
        part.allowed.mirror = match copies[0] % 2 {
            1 => Mirror::Always,
            _ => Mirror::Never,
        };
    }
    let locks = item.locked.iter().filter(|_| roll == 0);
    part.locked = locks
        .filter_map(|lock| {
            let copy = copies.iter().position(|&c| c == lock.copy)? as u32;
            Some(crate::Locked { copy, ..*lock })
        })
        .collect();
    part
}

/// Removes the pieces laid on a roll from the remaining ones, and notes why the others were not placed.
fn note_result(
    marker: &Marker,
    sources: &[(usize, Vec<u32>)],
    left: &mut [Remainder],
    (roll, count): (usize, usize),
) {
    for placement in &marker.placements {
        let (item, copies) = &sources[placement.item];
        let copy = copies[placement.copy as usize];
        left[*item].copies.retain(|&c| c != copy);
    }
    for unplaced in &marker.unplaced {
        let reason = match count {
            1 => unplaced.reason.clone(),
            _ => format!("roll {}: {}", roll + 1, unplaced.reason),
        };
        let reasons = &mut left[sources[unplaced.item].0].reasons;
        if !reasons.contains(&reason) {
            reasons.push(reason);
        }
    }
}
