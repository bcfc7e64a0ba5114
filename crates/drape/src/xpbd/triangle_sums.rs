//! Sums over triangles at their vertices, in parallel over the partitions and in their order, so that they do not depend
//! on the number of threads.

use super::domains::for_domains;
use super::region::{Region, Regions};
use crate::lanes::Point;

/// The partitions of the vertices as ranges of slots.
#[derive(Clone, Copy)]
pub struct Ranges<'a> {
    /// First slots of the domains, and the end.
    pub domains: &'a [usize],
    /// First slots of the ranges about cuts, and the end.
    pub cuts: &'a [usize],
}

impl Ranges<'_> {
    /// Sets `sums` to what `add` adds for every region; `add` has the region, its first slot, and the sums from there on.
    pub fn sum(
        self,
        regions: &Regions,
        sums: &mut [Point],
        add: impl Fn(&Region, usize, &mut [Point]) + Sync,
    ) {
        for_domains(self.domains, 0, &mut *sums, &|d, own: &mut [Point]| {
            own.fill([0.0; 4]);
            add(&regions.domains[d], self.domains[d], own);
        });
        if let (Some(&from), Some(&to)) = (self.cuts.first(), self.cuts.last()) {
            for_domains(
                self.cuts,
                0,
                &mut sums[from..to],
                &|d, own: &mut [Point]| {
                    add(&regions.cuts[d], self.cuts[d], own);
                },
            );
        }
        add(&regions.global, 0, sums);
    }
}
