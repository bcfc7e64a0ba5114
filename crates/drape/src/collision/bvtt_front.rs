//! The front of the bounding volume test tree (Ehmann and Lin 2001): the regions at which the search for near features
//! ended, stored from query to query. A search ends at regions whose two nodes are far apart, at regions that pass the
//! curvature test, and at pairs of leaves, most of them with a neighbour list. An entry stays valid until its vertices
//! have deviated too far from a common rigid motion; only then is its region searched again.

use super::boxes::Region;
use super::curvature::Clearance;
use super::front_entry::{FrontEntry, Verdict};
use super::front_query::{FrontQuery, MovesSince, QueryDistance, QueryRule, SAME};
use super::leaf_aabbs::{Hits, LeafAabbs};
use super::moves::Moves;
use super::neighbour_lists::NeighbourList;
use super::reach::Reach;
use super::regions::Regions;
use super::surface_view::SurfaceView;
use super::trajectories::LinearTrajectories;
use pulp::Arch;
use rayon::iter::Either;
use rayon::prelude::*;
use std::sync::Arc;
use toile_geometry::Vec3;

/// The front is rebuilt once it has this share and this many entries more than after the last rebuild:
/// entries split as boxes approach and are never merged back.
const REBUILD_AFTER_GROWTH: (f64, usize) = (0.25, 64);

/// The front is rebuilt after this many queries: it is refined as boxes approach, never coarsened as they part.
const REBUILD_AFTER_QUERIES: usize = 256;

/// The front, and what it was made for.
#[derive(Clone, Debug, Default)]
pub struct BvttFront {
    entries: Vec<FrontEntry>,
    /// Number of entries after the last rebuild, and of queries since.
    rebuilt_with: usize,
    queries: usize,
    /// Clearance of the last query; none where the next one must rebuild the front.
    clearance: Option<Clearance>,
    /// Positions at the start and end of the last query's trajectories (m).
    from: Vec<Vec3>,
    to: Vec<Vec3>,
    /// Distance of the last query without motion, which was one for contacts.
    contacts: QueryDistance,
    /// The last displacements known.
    last_moves: Option<Arc<Moves>>,
    /// Indices of the entries with a list.
    listed: Vec<u32>,
    /// Pairs of leaves without a list, and the distance at which their features must be found (m).
    open: Vec<([u32; 2], f64)>,
    /// Shortest edge at a vertex, averaged over the vertices of each leaf (m).
    shortest_edges: Option<Arc<[f64]>>,
}

impl BvttFront {
    /// Makes the next query rebuild the front.
    pub fn forget(&mut self) {
        self.clearance = None;
    }

    /// Neighbour lists of the entries that have one.
    pub fn lists(&self) -> impl IndexedParallelIterator<Item = Option<&Hits>> {
        let listed = self.listed.par_iter();
        listed.map(|&k| self.entries[k as usize].hits())
    }

    /// Pairs of leaves without a list, and the distance at which their features must be found (m).
    pub fn open(&self) -> &[([u32; 2], f64)] {
        &self.open
    }

    /// Begins a query for features that come within reach on their trajectories: removes the entries that do not
    /// answer it. Returns their regions, which must be searched again, and the query.
    pub fn expired(
        &mut self,
        cloth: &SurfaceView,
        (trajectories, reach): (&LinearTrajectories, &Reach),
        clearance: Clearance,
    ) -> (Vec<Region>, FrontQuery) {
        let (share, least) = REBUILD_AFTER_GROWTH;
        let limit = self.rebuilt_with + least + (share * self.rebuilt_with as f64) as usize;
        let rebuild = self.clearance != Some(clearance)
            || self.from.len() != trajectories.from.len()
            || self.entries.len() > limit
            || self.queries > REBUILD_AFTER_QUERIES;
        self.queries = if rebuild { 0 } else { self.queries + 1 };
        let near = QueryDistance::new(cloth, reach);
        if trajectories.are_still() {
            self.contacts = near.clone();
        }
        let since = match rebuild {
            true => MovesSince::Still,
            false => self.since(cloth, trajectories.from),
        };
        let moves = Moves::of(trajectories, cloth).map(Arc::new);
        if let (Some(moves), _) | (None, MovesSince::Moved(moves)) = (&moves, &since) {
            self.last_moves = Some(moves.clone());
        }
        let shortest_edges = self
            .shortest_edges
            .get_or_insert_with(|| shortest_edges(cloth));
        let query = FrontQuery {
            near,
            contacts: self.contacts.clone(),
            clearance,
            since,
            moves,
            last_moves: self.last_moves.clone(),
            shortest_edges: shortest_edges.clone(),
        };
        self.from.clear();
        self.from.extend_from_slice(trajectories.from);
        self.to.clear();
        self.to.extend_from_slice(trajectories.to);
        self.clearance = Some(clearance);
        if rebuild {
            self.entries.clear();
            self.listed.clear();
            self.rebuilt_with = 0;
            let root = cloth.tree.root().map(Region::Own);
            return (root.into_iter().collect(), query);
        }
        (self.remove_expired(&query), query)
    }

    /// Ages all entries and removes those that do not answer a query; returns their regions.
    fn remove_expired(&mut self, query: &FrontQuery) -> Vec<Region> {
        let age = |entry: &mut FrontEntry| {
            query.age(entry);
            query.is_answered_by(entry)
        };
        let entries = self.entries.par_iter_mut().with_min_len(512);
        let valid: Vec<bool> = entries.map(age).collect();
        let both = self.entries.iter().zip(&valid);
        let expired = both.filter(|(_, valid)| !**valid);
        let expired: Vec<Region> = expired.map(|(entry, _)| entry.region).collect();
        if !expired.is_empty() {
            let mut valid = valid.into_iter();
            self.entries.retain(|_| valid.next() == Some(true));
        }
        expired
    }

    /// Motion of the vertices, now at `x`, since the last query.
    fn since(&self, cloth: &SurfaceView, x: &[Vec3]) -> MovesSince {
        let are_same = |positions: &[Vec3]| {
            let mut both = x.iter().zip(positions);
            both.all(|(x, y)| (x - y).norm_squared() <= SAME * SAME)
        };
        if self.from == x {
            return MovesSince::Still;
        }
        if are_same(&self.to) {
            return MovesSince::AsQueried;
        }
        let displacement = |v: u32| x[v as usize] - self.from[v as usize];
        MovesSince::Moved(Arc::new(Moves::new(cloth, &self.from, displacement)))
    }

    /// Searches the regions of expired entries, and adds an entry for each region where the search ends. The tree
    /// must be fitted at the start `x` of the trajectories (m). Returns the number of regions opened, and of regions
    /// given the curvature test.
    pub fn search(
        &mut self,
        cloth: &SurfaceView,
        (regions, leaves): (&mut Regions, &mut LeafAabbs),
        x: &[Vec3],
        (expired, query): (&[Region], &FrontQuery),
    ) -> [usize; 2] {
        let tree = cloth.tree;
        let rule = QueryRule { tree, query };
        let found = regions.search(cloth, (x, expired), query.clearance, &rule);
        for mut entries in found.notes {
            self.entries.append(&mut entries);
        }
        let list_or_open = |&pair: &[u32; 2]| {
            let region = tree.region(pair);
            match query.gets_list(&region) {
                true => Either::Left(pair),
                false => {
                    let deviation = query.deviation(&region);
                    Either::Right(FrontEntry::new(region, Verdict::Open, deviation))
                }
            }
        };
        let pairs = found.pairs.par_iter().with_min_len(64);
        let (listed, open): (Vec<[u32; 2]>, Vec<FrontEntry>) = pairs.partition_map(list_or_open);
        self.entries.extend(open);
        leaves.fit_some(
            &LinearTrajectories::still(x),
            cloth.corners(),
            &leaves_of(cloth, listed.iter().copied()),
        );
        let (arch, leaves) = (Arch::new(), &*leaves);
        let list = |hits: &mut Hits, &pair: &[u32; 2]| {
            let region = tree.region(pair);
            let distances = query.list_distances(&region);
            hits.clear();
            leaves.near_within(arch, pair, distances[0], hits);
            leaves.crossing_within(arch, pair, distances[1], hits);
            let list = NeighbourList::of(cloth, x, hits, distances);
            FrontEntry::new(region, Verdict::Listed(list), query.deviation(&region))
        };
        let pairs = listed.par_iter().with_min_len(8);
        let lists = pairs.map_init(Hits::default, list);
        self.entries.par_extend(lists);
        if self.rebuilt_with == 0 {
            self.rebuilt_with = self.entries.len();
        }
        let with_list = (0u32..).zip(&self.entries);
        let with_list = with_list.filter(|(_, entry)| entry.hits().is_some());
        self.listed.clear();
        self.listed.extend(with_list.map(|(k, _)| k));
        [found.opened, found.tested]
    }

    /// Collects the pairs of leaves without a list and fits the boxes of their features to the trajectories. Where
    /// vertices are marked, pairs of leaves without a marked vertex are left out.
    pub fn fit(
        &mut self,
        cloth: &SurfaceView,
        leaves: &mut LeafAabbs,
        (trajectories, query): (&LinearTrajectories, &FrontQuery),
        marks: Option<&[bool]>,
    ) {
        let is_marked = |leaf: u32| {
            let mut vertices = cloth.leaf(leaf as usize).iter();
            marks.is_none_or(|marks| vertices.any(|&v| marks[v as usize]))
        };
        let all = 0..cloth.tree.leaves() as u32;
        let marked: Vec<bool> = match marks {
            None => vec![true; all.len()],
            Some(_) => all.map(is_marked).collect(),
        };
        let open = |entry: &FrontEntry| {
            let mut nodes = entry.region.nodes().map(|node| node.first_leaf);
            let first = nodes.next()?;
            let pair = [first, nodes.next().unwrap_or(first)];
            let is_open = matches!(entry.verdict, Verdict::Open)
                && pair.iter().any(|&leaf| marked[leaf as usize]);
            is_open.then(|| (pair, query.near.of(&entry.region, 1.0)))
        };
        let entries = self.entries.par_iter().with_min_len(512);
        self.open = entries.filter_map(open).collect();
        let pairs = self.open.iter().map(|(pair, _)| *pair);
        let of_pairs = leaves_of(cloth, pairs);
        leaves.fit_some(trajectories, cloth.corners(), &of_pairs);
    }
}

/// The leaves of some pairs, each once, sorted.
fn leaves_of(cloth: &SurfaceView, pairs: impl Iterator<Item = [u32; 2]>) -> Vec<u32> {
    let mut is_in_pair = vec![false; cloth.tree.leaves()];
    (pairs.flatten()).for_each(|leaf| is_in_pair[leaf as usize] = true);
    let leaves = 0..is_in_pair.len() as u32;
    leaves.filter(|&leaf| is_in_pair[leaf as usize]).collect()
}

/// Shortest edge at a vertex, averaged over the vertices of each leaf (m).
fn shortest_edges(cloth: &SurfaceView) -> Arc<[f64]> {
    let of_leaf = |leaf: usize| {
        let vertices = cloth.leaf(leaf);
        let sum: f64 = vertices
            .iter()
            .map(|&v| cloth.shortest_edge[v as usize])
            .sum();
        sum / vertices.len() as f64
    };
    (0..cloth.tree.leaves()).map(of_leaf).collect()
}
