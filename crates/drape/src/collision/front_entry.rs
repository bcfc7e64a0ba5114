//! An entry of the front: a region where the search of the tree ended, why it ended there, and how far the region's
//! vertices have deviated from a common rigid motion since.

use super::boxes::Region;
use super::leaf_aabbs::Hits;
use super::neighbour_lists::NeighbourList;

/// Why the search of the tree went no deeper into a region.
#[derive(Clone, Debug)]
pub enum Verdict {
    /// The boxes of the region's two nodes were this far apart (m).
    Separated(f64),
    /// The region passed the curvature test at this level: it cannot touch itself.
    Clear(usize),
    /// The region is two leaves, or one, and has a neighbour list.
    Listed(NeighbourList),
    /// The region is two leaves, or one, without a list: its vertices move too fast or its features lie too close.
    /// Boxes of its features are tested in every query.
    Open,
}

/// A region with the verdict of the search.
#[derive(Clone, Debug)]
pub struct FrontEntry {
    /// The region.
    pub region: Region,
    /// The verdict.
    pub verdict: Verdict,
    /// Drift: deviation of the region's vertices from their common rigid motion, summed over all motions since the
    /// verdict (m).
    pub drift: f64,
    /// Deviation on the trajectories of the last query, which is not in the drift yet (m).
    pub query_deviation: f64,
}

impl FrontEntry {
    /// A new entry of a region with this deviation on the trajectories of the query (m).
    pub fn new(region: Region, verdict: Verdict, query_deviation: f64) -> Self {
        Self {
            region,
            verdict,
            drift: 0.0,
            query_deviation,
        }
    }

    /// The listed pairs, where there are any.
    pub fn hits(&self) -> Option<&Hits> {
        match &self.verdict {
            Verdict::Listed(list) => list.hits.as_deref(),
            _ => None,
        }
    }
}
