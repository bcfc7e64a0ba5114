//! Pair queries of the search, public for benchmarks and for tests against exact results.

use crate::check::check;
use crate::error::NestingError;
use crate::job::Job;
use crate::pair::PairQuery;
use crate::random::SplitMix64;
use crate::{Item, Strip};
use toile_geometry::{PreparedPolygon, Vec2};

/// Number of poses in which a pair is queried before the next pair.
const POSES: usize = 16;

/// Distance from a position at which fitting is tested (m), and number of directions.
const PINPOINT: f64 = 1e-7;
const SIDES: usize = 128;

/// One pair of shapes in a pose.
#[derive(Clone, Copy, Debug)]
struct PosedPair<'a> {
    fixed: usize,
    moving: usize,
    /// Offset of the moving shape from the fixed one (m).
    apart: Vec2,
    pair: PairQuery<'a>,
}

/// Queries of random pairs of pieces, each in several random poses with overlapping boxes, as a move of the
/// search queries one pair at many positions.
///
/// A query is one signed penetration depth: the distance that the pair must move until it just touches,
/// positive for an overlap. The search uses no other kind of query; [`PairQueries::exact`] computes the same
/// number by polygon operations.
pub struct PairQueries<'a> {
    job: &'a Job<'a>,
    posed: Vec<PosedPair<'a>>,
}

/// Runs `work` with `count` random queries of the pieces of a job.
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
    let job = Job::new(items, strip, &copies, &|| false)?;
    let mut sequence = SplitMix64(seed);
    let shapes = job.shapes.len();
    let mut posed = Vec::with_capacity(count);
    let (mut fixed, mut moving) = (0, 0);
    for number in 0..count {
        if number % POSES == 0 {
            (fixed, moving) = (sequence.below(shapes), sequence.below(shapes));
        }
        let (a, b) = (job.shapes[fixed].size, job.shapes[moving].size);
        let chance = Vec2::new(sequence.unit(), sequence.unit());
        let apart = (a + b).component_mul(&chance) - b;
        posed.extend(job.pair(fixed, moving).map(|pair| PosedPair {
            fixed,
            moving,
            apart,
            pair,
        }));
    }
    Ok(work(&PairQueries { job: &job, posed }))
}

impl PairQueries<'_> {
    /// Number of queries.
    pub fn count(&self) -> usize {
        self.posed.len()
    }

    /// Runs all queries in order; returns the sum of the depths (m).
    pub fn sum(&self) -> f64 {
        let depth = |ask: &PosedPair<'_>| {
            ask.pair
                .probe(ask.apart)
                .map_or(0.0, |(probe, _)| probe.depth)
        };
        self.posed.iter().map(depth).sum()
    }

    /// The depth of one query (m); `None` if the pair is farther apart than the search window.
    pub fn depth(&self, number: usize) -> Option<f64> {
        let ask = self.posed.get(number)?;
        ask.pair.probe(ask.apart).map(|(probe, _)| probe.depth)
    }

    /// The exact depth (m) of the simplified outlines. They have fewer points than the original ones and are
    /// larger by at most [`PairQueries::growth`].
    pub fn exact(&self, number: usize) -> Option<f64> {
        let [fixed, moving] = self.pair(number)?;
        Some(match fixed.overlaps(&moving) {
            true => fixed.penetration_depth(&moving),
            false => -fixed.distance(&moving),
        })
    }

    /// Whether the exact depth ends at a pinpoint: a position at which the pair fits only in theory, since it
    /// overlaps at a tenth of a micrometre from there in all 128 directions. The search does not use such
    /// positions.
    pub fn ends_at_a_pinpoint(&self, number: usize) -> bool {
        let Some([fixed, moving]) = self.pair(number) else {
            return false;
        };
        let way = fixed.separation(&moving);
        let beside = |k: usize| {
            let angle = std::f64::consts::TAU * k as f64 / SIDES as f64;
            let there = way + Vec2::new(angle.cos(), angle.sin()) * PINPOINT;
            PreparedPolygon::new(&moving.polygon().translated(there))
        };
        way != Vec2::zeros() && (0..SIDES).all(|k| fixed.overlaps(&beside(k)))
    }

    /// The outlines of a pair in its pose.
    fn pair(&self, number: usize) -> Option<[PreparedPolygon; 2]> {
        let ask = self.posed.get(number)?;
        let moving = self.job.taken(ask.moving).translated(ask.apart);
        let fixed = PreparedPolygon::new(&self.job.taken(ask.fixed));
        Some([fixed, PreparedPolygon::new(&moving)])
    }

    /// Largest growth of simplified outlines for a pair (m).
    pub fn growth(&self) -> f64 {
        self.job.growth()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_geometry::Polygon;

    #[test]
    fn queries_are_exact() {
        let ring = |n: usize, scale: f64| {
            let point = |k: usize| {
                let angle = std::f64::consts::TAU * k as f64 / n as f64;
                let radius = scale * (1.0 + 0.4 * (3.0 * angle).sin());
                Vec2::new(radius * angle.cos(), radius * angle.sin())
            };
            Polygon::new((0..n).map(point).collect())
        };
        let items = [
            Item::new("lobed", ring(60, 0.2)),
            Item::new("small", ring(9, 0.1)),
        ];
        let worst = with_pair_queries(&items, &Strip::of_width(1.2), (600, 3), |queries| {
            assert_eq!(queries.count(), 600);
            let both = |k: usize| Some((queries.depth(k)?, queries.exact(k)?));
            let found: Vec<(f64, f64)> = (0..600).filter_map(both).collect();
            assert!(found.len() > 400 && found.iter().any(|f| f.0 > 0.05));
            let sum: f64 = (0..600).filter_map(|k| queries.depth(k)).sum();
            assert!((sum - queries.sum()).abs() < 1e-9);
            assert!(queries.growth() < 2e-4);
            let off = found.iter().map(|(depth, exact)| (depth - exact).abs());
            off.fold(0.0, f64::max)
        });
        assert!(worst.unwrap() < 1e-7);
        let nothing = with_pair_queries(&[], &Strip::of_width(1.2), (1, 1), |_| ());
        assert_eq!(nothing, Err(NestingError::NoItems));
    }
}
