//! A query to the front: how near features must come to be found, and whether an entry of the front
//! still answers it.

use super::boxes::{BoxTree, Region};
use super::curvature::Clearance;
use super::front_entry::{FrontEntry, Verdict};
use super::moves::Moves;
use super::neighbour_lists::ROUNDING;
use super::reach::Reach;
use super::regions::PruningRule;
use super::surface_view::SurfaceView;
use std::sync::Arc;
use toile_geometry::Vec3;

/// A list is made long enough to hold for this many queries at the present pace.
const QUERIES_PER_LIST: f64 = 8.0;

/// Least and most that features may come nearer before an entry is searched again [m].
const SLACK: [f64; 2] = [1e-3, 2e-3];

/// Leaves whose vertices move against each other by less than the first in a query get a list; an open entry is
/// searched again for one below the second [m]. Apart, so that entries do not change to and fro.
const CALM: [f64; 2] = [2.5e-4, 1e-4];

/// Longest distance of a list, as a share of the shortest edge there: beyond, a list holds most pairs of its
/// leaves and testing their boxes is as fast. Where vertices move by less than `AT_REST` [m] in a query a list
/// may reach as far as `DENSE_AT_REST`: it is long, but holds for very long.
const DENSE: f64 = 0.5;
const DENSE_AT_REST: f64 = 2.0;
const AT_REST: f64 = 2e-5;

/// Lists hold for contacts until vertices move this many times as fast.
const FASTER: f64 = 2.0;

/// Places that differ by rounding alone are no farther from each other [m].
pub const SAME: f64 = 1e-12;

/// How near features must come to be found: everywhere alike, or by the velocities of their region.
#[derive(Clone, Debug, Default)]
pub struct QueryDistance {
    /// At the most [m].
    most: f64,
    pace: Option<Arc<Pace>>,
}

/// The time until the next query, as in [`super::Ahead`].
#[derive(Debug)]
struct Pace {
    /// Bounds of the velocities of every node [m/s].
    velocities: Moves,
    kept: f64,
    least: f64,
    time: f64,
}

impl QueryDistance {
    /// For a reach.
    pub fn new(cloth: &SurfaceView, reach: &Reach) -> Self {
        let pace = reach.ahead.as_ref().map(|ahead| {
            // A prescribed vertex may be led anywhere.
            let velocity = |v: u32| match ahead.pinned[v as usize] {
                true => Vec3::repeat(f64::INFINITY),
                false => ahead.velocities[v as usize],
            };
            Arc::new(Pace {
                velocities: Moves::shifts(cloth, velocity),
                kept: ahead.kept,
                least: ahead.least,
                time: ahead.time,
            })
        });
        Self {
            most: reach.most,
            pace,
        }
    }

    /// No less than [`Reach::of`] of any two features of a region [m], were they `times` as fast.
    pub fn of(&self, region: &Region, times: f64) -> f64 {
        let Some(pace) = &self.pace else {
            return self.most;
        };
        // Of four velocities in a ball none is farther than 3/2 of its radius from their mean.
        let speed = times * 1.5 * pace.velocities.stray(region);
        if !speed.is_finite() {
            return self.most;
        }
        let length = (2.0 * speed * pace.time).max(pace.least);
        (pace.kept + 2.0 * length).min(self.most)
    }
}

/// How vertices moved since the last query.
pub enum MovesSince {
    /// Not at all.
    Still,
    /// Along the trajectories of that query, to their ends.
    AsQueried,
    /// Otherwise.
    Moved(Arc<Moves>),
}

/// A query.
pub struct FrontQuery {
    /// How near features must come on their trajectories to be listed.
    pub near: QueryDistance,
    /// The same in the last query without motion, which contacts make.
    pub contacts: QueryDistance,
    /// What regions that are clear of themselves keep.
    pub clearance: Clearance,
    /// Moves since the last query.
    pub since: MovesSince,
    /// Moves along the trajectories; none where nothing moves.
    pub moves: Option<Arc<Moves>>,
    /// The last moves that are known, to estimate those to come.
    pub last_moves: Option<Arc<Moves>>,
    /// Mean over the vertices of every leaf of the shortest edge there [m].
    pub shortest_edges: Arc<[f64]>,
}

impl FrontQuery {
    /// Most that a vertex of a region moves on its trajectory against their common rigid motion [m].
    pub fn drift(&self, region: &Region) -> f64 {
        self.moves.as_ref().map_or(0.0, |moves| moves.stray(region))
    }

    /// Adds to an entry the drift since the last query, and sets that of this one.
    pub fn age(&self, entry: &mut FrontEntry) {
        entry.drift += match &self.since {
            MovesSince::Still => 0.0,
            MovesSince::AsQueried => entry.query_drift + SAME,
            MovesSince::Moved(moves) => moves.stray(&entry.region),
        };
        entry.query_drift = self.drift(&entry.region);
    }

    /// Whether an entry answers this query: two vertices that drifted by d came nearer by at most 2 d.
    pub fn is_answered_by(&self, entry: &FrontEntry) -> bool {
        let drift = entry.drift + entry.query_drift;
        let holds = |gap: f64| gap - 2.0 * drift >= self.near.of(&entry.region, 1.0);
        match &entry.verdict {
            Verdict::Clear(level) => drift <= self.clearance.budget(*level),
            Verdict::Separated(gap) => holds(*gap),
            Verdict::Listed(list) => holds(list.gap) && 2.0 * entry.drift < list.crossing_gap,
            Verdict::Open => {
                self.moves.is_none() || entry.query_drift > CALM[1] || self.is_dense(&entry.region)
            }
        }
    }

    /// Whether the features of a region lie too close for a list.
    fn is_dense(&self, region: &Region) -> bool {
        let edge = |first: u32| self.shortest_edges[first as usize];
        let edge = region.nodes().map(|n| edge(n.first)).fold(0.0, f64::max);
        let most = match self.pace(region) <= AT_REST {
            true => DENSE_AT_REST,
            false => DENSE,
        };
        self.list_distances(region)[0] > most * edge
    }

    /// Whether the features of a region get a list.
    pub fn lists(&self, region: &Region) -> bool {
        self.pace(region) <= CALM[0] && !self.is_dense(region)
    }

    /// Drift of a region in a query [m]: in this one or, where nothing moves in it, in the last that moved.
    fn pace(&self, region: &Region) -> f64 {
        match (&self.moves, &self.last_moves) {
            (Some(moves), _) | (None, Some(moves)) => moves.stray(region),
            (None, None) => 0.0,
        }
    }

    /// How near features of a region are to be listed [m], and how near to crossing edges and faces are.
    pub fn list_distances(&self, region: &Region) -> [f64; 2] {
        let drift = self.drift(region);
        let pace = match self.moves.is_some() {
            true => drift,
            false => self.pace(region),
        };
        let slack = (2.0 * QUERIES_PER_LIST * pace).clamp(SLACK[0], SLACK[1]);
        let near = self.near.of(region, 1.0) + 2.0 * drift;
        [near.max(self.contacts.of(region, FASTER)) + slack, slack]
    }
}

/// Prunes regions whose nodes are far apart where the trajectories begin, and those that keep clear of
/// themselves on them; notes an entry for each.
pub struct QueryRule<'a> {
    /// The tree, fitted where the trajectories begin.
    pub tree: &'a BoxTree,
    /// The query.
    pub query: &'a FrontQuery,
}

impl PruningRule for QueryRule<'_> {
    type Notes = Vec<FrontEntry>;

    fn apart(&self, entries: &mut Vec<FrontEntry>, region: &Region) -> bool {
        let Some(distance) = self.tree.distance(region) else {
            return false;
        };
        let apart = distance > self.query.list_distances(region)[0];
        if apart {
            let verdict = Verdict::Separated(distance - ROUNDING);
            entries.push(FrontEntry::new(*region, verdict, self.query.drift(region)));
        }
        apart
    }

    fn level(&self, region: &Region) -> Option<usize> {
        self.query.clearance.level(self.query.drift(region))
    }

    fn clear(&self, entries: &mut Vec<FrontEntry>, region: &Region, level: usize) {
        let verdict = Verdict::Clear(level);
        entries.push(FrontEntry::new(*region, verdict, self.query.drift(region)));
    }
}
