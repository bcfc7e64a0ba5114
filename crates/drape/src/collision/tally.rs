//! Counts of detections, crossings and impact corrections over a run.

use super::impact_resolution::ImpactStats;
use serde::{Deserialize, Serialize};

/// Counts over a run so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tally {
    /// Detections.
    pub looks: usize,
    /// Pairs of an edge and a face that cross: in the first detection, in the detection with most, in the last.
    pub crossings: [usize; 3],
    /// Vertices of outer layers on the wrong side of inner ones, in the same three counts.
    pub astray: [usize; 3],
    /// Impulses applied to collisions between detections.
    pub impulses: usize,
    /// Displacements of vertices replaced by those of a rigid impact zone, where impulses were not enough.
    pub zoned: usize,
    /// Displacements of vertices truncated, where zones were not enough.
    pub cut: usize,
}

impl Tally {
    /// Adds a detection with its crossings and layer violations.
    pub(super) fn count_detection(&mut self, crossings: usize, violations: usize) {
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

    /// Adds the corrections of a motion.
    pub fn count_impacts(&mut self, impacts: ImpactStats) {
        self.impulses += impacts.impulses;
        self.zoned += impacts.zoned;
        self.cut += impacts.cut;
    }

    /// The counts of this run and of a later one together.
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
