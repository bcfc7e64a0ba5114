//! Counts over the looks of a run.

use super::impact_resolution::ImpactStats;
use serde::{Deserialize, Serialize};

/// What was found and done so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tally {
    /// Looks.
    pub looks: usize,
    /// Edges that crossed a face: at the first look, most at one look, at the last look.
    pub crossings: [usize; 3],
    /// Vertices of outer layers on the wrong side of inner ones, in the same three counts.
    pub astray: [usize; 3],
    /// Impulses that kept features from passing through each other between looks.
    pub impulses: usize,
    /// Moves of vertices in rigid zones, where impulses did not settle.
    pub zoned: usize,
    /// Moves of vertices that were cut because zones were not enough.
    pub cut: usize,
}

impl Tally {
    /// Counts a look that found so many crossings and layer violations.
    pub(super) fn count_look(&mut self, crossings: usize, violations: usize) {
        let counts = [
            (&mut self.crossings, crossings),
            (&mut self.astray, violations),
        ];
        for (counts, now) in counts {
            if self.looks == 0 {
                counts[0] = now;
            }
            counts[1] = counts[1].max(now);
            counts[2] = now;
        }
        self.looks += 1;
    }

    /// Counts what a motion was corrected by.
    pub fn count_impacts(&mut self, impacts: ImpactStats) {
        self.impulses += impacts.impulses;
        self.zoned += impacts.zoned;
        self.cut += impacts.cut;
    }

    /// With another's counts after these.
    #[must_use]
    pub fn then(self, next: Self) -> Self {
        if self.looks == 0 || next.looks == 0 {
            return if self.looks == 0 { next } else { self };
        }
        let both = |[first, most, _]: [usize; 3], [_, next, last]: [usize; 3]| {
            [first, most.max(next), last]
        };
        Self {
            looks: self.looks + next.looks,
            crossings: both(self.crossings, next.crossings),
            astray: both(self.astray, next.astray),
            impulses: self.impulses + next.impulses,
            zoned: self.zoned + next.zoned,
            cut: self.cut + next.cut,
        }
    }
}
