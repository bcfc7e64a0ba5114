//! An entry of the front: where a search for near features ended, and how far its vertices have moved
//! since.

use super::boxes::Region;
use super::leaf_aabbs::Hits;
use super::neighbour_lists::NeighbourList;

/// Why a search went no deeper into a region.
#[derive(Clone, Debug)]
pub enum Verdict {
    /// The region's two nodes were this far apart [m].
    Separated(f64),
    /// The region keeps clear of itself, at this level of the curvature's bounds.
    Clear(usize),
    /// Leaves, whose features near each other are listed.
    Listed(NeighbourList),
    /// Leaves that move too fast for a list, or whose features lie too close: their boxes are tested in
    /// every query.
    Open,
}

/// A region with the verdict on it.
#[derive(Clone, Debug)]
pub struct FrontEntry {
    /// The region.
    pub region: Region,
    /// The verdict.
    pub verdict: Verdict,
    /// Most that a vertex of it moved against their common rigid motion since the verdict [m].
    pub drift: f64,
    /// Most that one moves against it on the trajectories of the last query [m].
    pub query_drift: f64,
}

impl FrontEntry {
    /// An entry just made, of vertices that drift so far on the trajectories of the query [m].
    pub fn new(region: Region, verdict: Verdict, query_drift: f64) -> Self {
        Self {
            region,
            verdict,
            drift: 0.0,
            query_drift,
        }
    }

    /// The features that are listed, where there are any.
    pub fn hits(&self) -> Option<&Hits> {
        match &self.verdict {
            Verdict::Listed(list) => list.hits.as_deref(),
            _ => None,
        }
    }
}
