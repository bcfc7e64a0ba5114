//! Work on domains in parallel: slices are halved recursively down to single domains, which are tasks of the thread
//! pool. The result does not depend on which thread runs a task.

use super::particles::{FilterSlices, FinishSlices, PredictSlices};
use super::region::Region;
use crate::lanes::{LANES, Point};

/// Slices over the slots of some domains, to be divided between tasks.
pub trait Divide: Sized + Send {
    /// Divides after `slots` slots and `domains` domains.
    fn divide(self, slots: usize, domains: usize) -> (Self, Self);
}

/// Runs `work` for every domain with its index and its slices of `all`; `starts` are the first slots of the domains,
/// and the end.
pub fn for_domains<T: Divide>(
    starts: &[usize],
    first: usize,
    all: T,
    work: &(impl Fn(usize, T) + Sync),
) {
    let count = starts.len().saturating_sub(1);
    if count == 0 {
        return;
    }
    if count == 1 {
        return work(first, all);
    }
    let middle = count / 2;
    let (left, right) = all.divide(starts[middle] - starts[0], middle);
    rayon::join(
        || for_domains(&starts[..=middle], first, left, work),
        || for_domains(&starts[middle..], first + middle, right, work),
    );
}

impl Divide for &mut [Point] {
    fn divide(self, slots: usize, _: usize) -> (Self, Self) {
        self.split_at_mut(slots)
    }
}

impl Divide for PredictSlices<'_> {
    fn divide(self, slots: usize, _: usize) -> (Self, Self) {
        let (now, now_) = self.now.split_at_mut(slots);
        let (free, free_) = self.free.split_at_mut(slots);
        let (low, low_) = self.low.split_at_mut(slots);
        let (velocity, velocity_) = self.velocity.split_at_mut(slots);
        (
            Self {
                now,
                free,
                low,
                velocity,
            },
            Self {
                now: now_,
                free: free_,
                low: low_,
                velocity: velocity_,
            },
        )
    }
}

impl Divide for FinishSlices<'_> {
    fn divide(self, slots: usize, _: usize) -> (Self, Self) {
        let all_slots = self.start.len();
        let (start, start_) = self.start.split_at_mut(slots);
        let (ahead, ahead_) = self.ahead.split_at_mut(slots);
        let (now, now_) = self.now.split_at_mut(slots);
        let (free, free_) = self.free.split_at(slots);
        let (velocity, velocity_) = self.velocity.split_at_mut(slots);
        let solids = self.contacts.len() * LANES / all_slots.max(1);
        let (contacts, contacts_) = self.contacts.split_at_mut(slots / LANES * solids);
        (
            Self {
                start,
                ahead,
                now,
                free,
                velocity,
                contacts,
            },
            Self {
                start: start_,
                ahead: ahead_,
                now: now_,
                free: free_,
                velocity: velocity_,
                contacts: contacts_,
            },
        )
    }
}

impl Divide for FilterSlices<'_> {
    fn divide(self, slots: usize, _: usize) -> (Self, Self) {
        let (unfiltered, unfiltered_) = self.unfiltered.split_at_mut(slots);
        let (filtered, filtered_) = self.filtered.split_at_mut(slots);
        (
            Self {
                unfiltered,
                filtered,
            },
            Self {
                unfiltered: unfiltered_,
                filtered: filtered_,
            },
        )
    }
}

/// The regions of some domains or cuts, and their points.
pub struct SweepSlices<'a> {
    /// The regions.
    pub regions: &'a mut [Region],
    /// The points.
    pub now: &'a mut [Point],
    /// Positions of the points at the start of the substep.
    pub start: &'a [Point],
}

impl Divide for SweepSlices<'_> {
    fn divide(self, slots: usize, domains: usize) -> (Self, Self) {
        let (regions, regions_) = self.regions.split_at_mut(domains);
        let (now, now_) = self.now.split_at_mut(slots);
        let (start, start_) = self.start.split_at(slots);
        (
            Self {
                regions,
                now,
                start,
            },
            Self {
                regions: regions_,
                now: now_,
                start: start_,
            },
        )
    }
}

/// The regions of some domains.
pub struct RegionSlices<'a> {
    /// The regions.
    pub regions: &'a mut [Region],
}

impl Divide for RegionSlices<'_> {
    fn divide(self, _: usize, domains: usize) -> (Self, Self) {
        let (regions, regions_) = self.regions.split_at_mut(domains);
        (Self { regions }, Self { regions: regions_ })
    }
}

impl<A: Divide, B: Divide> Divide for (A, B) {
    fn divide(self, slots: usize, domains: usize) -> (Self, Self) {
        let (a, a_) = self.0.divide(slots, domains);
        let (b, b_) = self.1.divide(slots, domains);
        ((a, b), (a_, b_))
    }
}
