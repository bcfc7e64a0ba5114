//! A query of the front: the distance at which features must be found, and whether an entry of the front still answers
//! it.

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

/// A list is made long enough to hold for this many queries at the present deviation per query.
const QUERIES_PER_LIST: f64 = 8.0;

/// Least and largest slack of a list (m): the length by which its distance exceeds that of the query.
const SLACK: [f64; 2] = [1e-3, 2e-3];

/// Leaves whose deviation per query is at most `CALM[0]` (m) get a list; an open entry is searched again, and may get
/// one, once it is at most `CALM[1]`. The difference keeps entries from changing at every query.
const CALM: [f64; 2] = [2.5e-4, 1e-4];

/// Largest distance of a list, as a share of the shortest edge there. A longer one would list most pairs of its leaves,
/// and testing their boxes is as fast. At deviations per query of at most `AT_REST` (m) a list may be as long as
/// `DENSE_AT_REST` allows, since it then holds for many queries.
const DENSE: f64 = 0.5;
const DENSE_AT_REST: f64 = 2.0;
const AT_REST: f64 = 2e-5;

/// Lists are made for the reach of contacts at this many times the present velocities, so that they hold while vertices
/// speed up.
const SPEED_MARGIN: f64 = 2.0;

/// Positions that differ by no more than this (m) are the same but for rounding.
pub const SAME: f64 = 1e-12;

/// Distance at which features must be found: the same everywhere, or shorter in regions whose velocities differ little.
#[derive(Clone, Debug, Default)]
pub struct QueryDistance {
    /// Largest distance (m).
    max: f64,
    prediction: Option<Arc<Prediction>>,
}

/// Motion expected until the next query, as in [`super::Ahead`].
#[derive(Debug)]
struct Prediction {
    /// Bounds of the velocities below every node (m/s).
    velocities: Moves,
    /// Contact offset (m).
    offset: f64,
    /// Shortest path expected of a feature (m).
    min_path: f64,
    /// Time until the next query (s).
    time: f64,
}

impl QueryDistance {
    /// Distance for a reach.
    pub fn new(cloth: &SurfaceView, reach: &Reach) -> Self {
        let prediction = reach.ahead.as_ref().map(|ahead| {
            // The motion of a prescribed vertex is not known from its velocity.
            let velocity = |v: u32| match ahead.pinned[v as usize] {
                true => Vec3::repeat(f64::INFINITY),
                false => ahead.velocities[v as usize],
            };
            Arc::new(Prediction {
                velocities: Moves::shifts(cloth, velocity),
                offset: ahead.offset,
                min_path: ahead.min_path,
                time: ahead.time,
            })
        });
        Self {
            max: reach.max,
            prediction,
        }
    }

    /// Upper bound of [`Reach::of`] over the pairs of features of a region (m), were all velocities `factor` times as
    /// large.
    pub fn of(&self, region: &Region, factor: f64) -> f64 {
        let Some(prediction) = &self.prediction else {
            return self.max;
        };
        // Of four velocities in a ball none is farther than 3/2 of its radius from their mean.
        let speed = factor * 1.5 * prediction.velocities.deviation(region);
        if !speed.is_finite() {
            return self.max;
        }
        let path = (2.0 * speed * prediction.time).max(prediction.min_path);
        (prediction.offset + 2.0 * path).min(self.max)
    }
}

/// Motion of the vertices since the last query.
pub enum MovesSince {
    /// No motion.
    Still,
    /// Motion to the ends of the last query's trajectories.
    AsQueried,
    /// Any other motion.
    Moved(Arc<Moves>),
}

/// A query of the front.
pub struct FrontQuery {
    /// Distance on the trajectories at which features must be listed.
    pub near: QueryDistance,
    /// The same distance in the last query without motion, which is one for contacts.
    pub contacts: QueryDistance,
    /// Guarantee of regions that pass the curvature test.
    pub clearance: Clearance,
    /// Motion since the last query.
    pub since: MovesSince,
    /// Displacements on the trajectories; none where nothing moves.
    pub moves: Option<Arc<Moves>>,
    /// The latest displacements known, as an estimate of later ones.
    pub last_moves: Option<Arc<Moves>>,
    /// Shortest edge at a vertex, averaged over the vertices of each leaf (m).
    pub shortest_edges: Arc<[f64]>,
}

impl FrontQuery {
    /// Deviation of a region's vertices from their common rigid motion on the trajectories (m).
    pub fn deviation(&self, region: &Region) -> f64 {
        (self.moves.as_ref()).map_or(0.0, |moves| moves.deviation(region))
    }

    /// Adds the deviation since the last query to the drift of an entry, and sets that of this query.
    pub fn age(&self, entry: &mut FrontEntry) {
        entry.drift += match &self.since {
            MovesSince::Still => 0.0,
            MovesSince::AsQueried => entry.query_deviation + SAME,
            MovesSince::Moved(moves) => moves.deviation(&entry.region),
        };
        entry.query_deviation = self.deviation(&entry.region);
    }

    /// Whether an entry answers this query: two vertices with drift d have come nearer to each other by at most 2 d.
    pub fn is_answered_by(&self, entry: &FrontEntry) -> bool {
        let drift = entry.drift + entry.query_deviation;
        let holds = |gap: f64| gap - 2.0 * drift >= self.near.of(&entry.region, 1.0);
        match &entry.verdict {
            Verdict::Clear(level) => drift <= self.clearance.max_drift_at(*level),
            Verdict::Separated(gap) => holds(*gap),
            // Crossings are asked for where the trajectories begin.
            Verdict::Listed(list) => holds(list.gap) && 2.0 * entry.drift < list.crossing_gap,
            Verdict::Open => {
                self.moves.is_none()
                    || entry.query_deviation > CALM[1]
                    || self.is_dense(&entry.region)
            }
        }
    }

    /// Whether the features of a region lie too close for a list.
    fn is_dense(&self, region: &Region) -> bool {
        let of_leaf = |leaf: u32| self.shortest_edges[leaf as usize];
        let edges = region.nodes().map(|node| of_leaf(node.first_leaf));
        let edge = edges.fold(0.0, f64::max);
        let limit = match self.deviation_per_query(region) <= AT_REST {
            true => DENSE_AT_REST,
            false => DENSE,
        };
        self.list_distances(region)[0] > limit * edge
    }

    /// Whether a region of two leaves, or of one, gets a list.
    pub fn gets_list(&self, region: &Region) -> bool {
        self.deviation_per_query(region) <= CALM[0] && !self.is_dense(region)
    }

    /// Deviation of a region in this query or, where nothing moves, in the last motion known (m).
    fn deviation_per_query(&self, region: &Region) -> f64 {
        match (&self.moves, &self.last_moves) {
            (Some(moves), _) | (None, Some(moves)) => moves.deviation(region),
            (None, None) => 0.0,
        }
    }

    /// Distances within which a list of a region must be complete (m): for pairs of a vertex and a face or of two
    /// edges, and for an edge and a face that may cross.
    pub fn list_distances(&self, region: &Region) -> [f64; 2] {
        let deviation = self.deviation(region);
        let per_query = match self.moves.is_some() {
            true => deviation,
            false => self.deviation_per_query(region),
        };
        let slack = (2.0 * QUERIES_PER_LIST * per_query).clamp(SLACK[0], SLACK[1]);
        let near = self.near.of(region, 1.0) + 2.0 * deviation;
        [
            near.max(self.contacts.of(region, SPEED_MARGIN)) + slack,
            slack,
        ]
    }
}

/// Rule of a search for the front: prunes regions whose nodes are far apart where the trajectories begin and regions
/// that pass the curvature test, and notes an entry for each.
pub struct QueryRule<'a> {
    /// The tree, fitted where the trajectories begin.
    pub tree: &'a BoxTree,
    /// The query.
    pub query: &'a FrontQuery,
}

impl PruningRule for QueryRule<'_> {
    type Notes = Vec<FrontEntry>;

    fn is_separated(&self, entries: &mut Vec<FrontEntry>, region: &Region) -> bool {
        let Some(distance) = self.tree.distance(region) else {
            return false;
        };
        let separated = distance > self.query.list_distances(region)[0];
        if separated {
            let verdict = Verdict::Separated(distance - ROUNDING);
            entries.push(FrontEntry::new(
                *region,
                verdict,
                self.query.deviation(region),
            ));
        }
        separated
    }

    fn level(&self, region: &Region) -> Option<usize> {
        self.query.clearance.level(self.query.deviation(region))
    }

    fn note_clear(&self, entries: &mut Vec<FrontEntry>, region: &Region, level: usize) {
        let verdict = Verdict::Clear(level);
        entries.push(FrontEntry::new(
            *region,
            verdict,
            self.query.deviation(region),
        ));
    }
}
