//! Counts over the contact detections of a run.

use super::impact_resolution::ImpactStats;
use serde::{Deserialize, Serialize};

/// Counts so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tally {
    /// Detections.
    pub looks: usize,
    /// Pairs of an edge and a face that cross: in the first detection, the most in one detection, in the last.
    pub crossings: [usize; 3],
    /// Vertices of outer layers on the wrong side of inner ones, in the same three counts.
    pub astray: [usize; 3],
    /// Impulses that resolved collisions between detections.
    pub impulses: usize,
    /// Moves of vertices in rigid impact zones, where impulses did not resolve the collisions.
    pub zoned: usize,
    /// Moves of vertices that were truncated, where zones did not resolve the collisions.
    pub cut: usize,
}

impl Tally {
    /// Counts a detection with its crossings and layer violations.
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

    /// Counts the corrections of a motion.
    pub fn count_impacts(&mut self, impacts: ImpactStats) {
        self.impulses += impacts.impulses;
        self.zoned += impacts.zoned;
        self.cut += impacts.cut;
    }

    /// These counts, followed by those of a later run.
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
