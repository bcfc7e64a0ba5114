//! The search's own queries of pairs, open to be timed and held against exact ones.

use crate::check::{NestingError, check};
use crate::job::Job;
use crate::pair::PairQuery;
use crate::sequence::Sequence;
use crate::{Item, Strip};
use toile_geometry::{PreparedPolygon, Vec2};

/// One pair of shapes in a pose.
#[derive(Clone, Copy, Debug)]
struct Ask<'a> {
    fixed: usize,
    moving: usize,
    /// How far the moving shape lies from the fixed one \[m\].
    apart: Vec2,
    pair: PairQuery<'a>,
}

/// Queries of random pairs of pieces in random poses in which their boxes meet.
///
/// A query is one signed penetration depth: how far a pair must move to touch, positive if it
/// overlaps. The search makes nothing else; [`PairQueries::exact`] finds the same number by
/// polygon operations on the original outlines.
pub struct PairQueries<'a> {
    job: &'a Job<'a>,
    asks: Vec<Ask<'a>>,
}

/// Runs `work` with so many random queries of the pieces of a job.
///
/// # Errors
/// The job cannot be done, as in [`crate::make_marker`].
pub fn with_pair_queries<R>(
    items: &[Item],
    strip: &Strip,
    (count, seed): (usize, u64),
    work: impl FnOnce(&PairQueries<'_>) -> R,
) -> Result<R, NestingError> {
    check(items, strip)?;
    let copies: Vec<(usize, u32)> = (0..items.len()).map(|item| (item, 0)).collect();
    let job = Job::new(items, strip, &copies);
    let mut sequence = Sequence(seed);
    let shapes = job.shapes.len();
    let mut asks = Vec::with_capacity(count);
    for _ in 0..count {
        let (fixed, moving) = (sequence.below(shapes), sequence.below(shapes));
        let (a, b) = (job.shapes[fixed].size, job.shapes[moving].size);
        let chance = Vec2::new(sequence.unit(), sequence.unit());
        let apart = (a + b).component_mul(&chance) - b;
        asks.extend(job.pair(fixed, moving).map(|pair| Ask {
            fixed,
            moving,
            apart,
            pair,
        }));
    }
    Ok(work(&PairQueries { job: &job, asks }))
}

impl PairQueries<'_> {
    /// How many there are.
    pub fn count(&self) -> usize {
        self.asks.len()
    }

    /// Makes all queries, in order; the sum of the depths \[m\].
    pub fn sum(&self) -> f64 {
        let depth = |ask: &Ask<'_>| {
            ask.pair
                .probe(ask.apart)
                .map_or(0.0, |(probe, _)| probe.depth)
        };
        self.asks.iter().map(depth).sum()
    }

    /// The depth of one of them \[m\]; nothing if the pair lies farther apart than the search
    /// looks.
    pub fn depth(&self, number: usize) -> Option<f64> {
        let ask = self.asks.get(number)?;
        ask.pair.probe(ask.apart).map(|(probe, _)| probe.depth)
    }

    /// The exact depth \[m\] on the original outlines.
    pub fn exact(&self, number: usize) -> Option<f64> {
        let ask = self.asks.get(number)?;
        let outline = |shape: usize| {
            let shape = &self.job.shapes[shape];
            self.job
                .items
                .get(shape.kind)
                .map(|item| shape.outline(item))
        };
        let fixed = PreparedPolygon::new(&outline(ask.fixed)?);
        let moving = PreparedPolygon::new(&outline(ask.moving)?.translated(ask.apart));
        Some(match fixed.overlaps(&moving) {
            true => fixed.penetration_depth(&moving),
            false => -fixed.distance(&moving),
        })
    }

    /// How much the search takes outlines larger than they are, at most, for a pair \[m\].
    pub fn growth(&self) -> f64 {
        self.job.growth()
    }
}
