//! The front of the bounding volume test tree (Ehmann and Lin 2001): where a search for near features
//! ended, kept from query to query. It ends between regions far apart, at regions that cannot touch
//! themselves, and at pairs of leaves with lists of the features near each other. An entry holds until its
//! vertices have moved too far against each other, however far they go together; only then is its region
//! searched again.

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

/// The front of a search.
#[derive(Clone, Debug, Default)]
pub struct BvttFront {
    entries: Vec<FrontEntry>,
    /// Entries after the last rebuild, and queries since.
    rebuilt_with: usize,
    queries: usize,
    /// The clearance of the last query; none where the next one is to rebuild the front.
    clearance: Option<Clearance>,
    /// Where the trajectories of the last query began and ended [m].
    from: Vec<Vec3>,
    to: Vec<Vec3>,
    contacts: QueryDistance,
    last_moves: Option<Arc<Moves>>,
    /// Entries with a list.
    listed: Vec<u32>,
    /// Pairs of leaves without, and how near features of them must come to be found [m].
    open: Vec<([u32; 2], f64)>,
    shortest_edges: Option<Arc<[f64]>>,
}

impl BvttFront {
    /// Has the next query rebuild the front.
    pub fn forget(&mut self) {
        self.clearance = None;
    }

    /// Lists of features that may come near each other.
    pub fn lists(&self) -> impl IndexedParallelIterator<Item = Option<&Hits>> {
        let listed = self.listed.par_iter();
        listed.map(|&k| self.entries[k as usize].hits())
    }

    /// Pairs of leaves whose features are not listed, and how near features of them must come to be found [m].
    pub fn open(&self) -> &[([u32; 2], f64)] {
        &self.open
    }

    /// Removes the entries that do not answer a query for features that come within reach on their trajectories;
    /// returns the regions to be searched for it, and the query.
    pub fn expired(
        &mut self,
        cloth: &SurfaceView,
        (trajectories, reach): (&LinearTrajectories, &Reach),
        clearance: Clearance,
    ) -> (Vec<Region>, FrontQuery) {
        let (grown, fewest) = REBUILD_AFTER_GROWTH;
        let most = self.rebuilt_with + fewest + (grown * self.rebuilt_with as f64) as usize;
        let rebuild = self.clearance != Some(clearance)
            || self.from.len() != trajectories.from.len()
            || self.entries.len() > most
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

    /// How vertices, now at `x`, moved since the last query.
    fn since(&self, cloth: &SurfaceView, x: &[Vec3]) -> MovesSince {
        let same = |places: &[Vec3]| {
            let mut both = x.iter().zip(places);
            both.all(|(x, place)| (x - place).norm_squared() <= SAME * SAME)
        };
        if self.from == x {
            return MovesSince::Still;
        }
        if same(&self.to) {
            return MovesSince::AsQueried;
        }
        let moved = |v: u32| x[v as usize] - self.from[v as usize];
        MovesSince::Moved(Arc::new(Moves::new(cloth, &self.from, moved)))
    }

    /// Searches the regions of expired entries and adds the entries that this ends at. The tree is fitted at `x`
    /// [m], where the trajectories begin. Returns how many regions were opened, and how many of them were tested
    /// for contact with themselves.
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
        let sort = |&pair: &[u32; 2]| {
            let region = tree.region(pair);
            match query.lists(&region) {
                true => Either::Left(pair),
                false => {
                    let drift = query.drift(&region);
                    Either::Right(FrontEntry::new(region, Verdict::Open, drift))
                }
            }
        };
        let pairs = found.pairs.par_iter().with_min_len(64);
        let (listed, open): (Vec<[u32; 2]>, Vec<FrontEntry>) = pairs.partition_map(sort);
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
            FrontEntry::new(region, Verdict::Listed(list), query.drift(&region))
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
        [found.opened, found.told]
    }

    /// Fits the boxes of leaves without a list round the trajectories. Where only marked vertices go another way
    /// than in the last query, only pairs of leaves with one of them stay open.
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
            let mut nodes = entry.region.nodes().map(|node| node.first);
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

/// The leaves of some pairs, sorted.
fn leaves_of(cloth: &SurfaceView, pairs: impl Iterator<Item = [u32; 2]>) -> Vec<u32> {
    let mut named = vec![false; cloth.tree.leaves()];
    pairs.flatten().for_each(|leaf| named[leaf as usize] = true);
    let leaves = 0..named.len() as u32;
    leaves.filter(|&leaf| named[leaf as usize]).collect()
}

/// Mean over the vertices of every leaf of the shortest edge there [m].
fn shortest_edges(cloth: &SurfaceView) -> Arc<[f64]> {
    let of_leaf = |leaf: usize| {
        let vertices = cloth.leaf(leaf);
        let sum: f64 = vertices.iter().map(|&v| cloth.room[v as usize]).sum();
        sum / vertices.len() as f64
    };
    (0..cloth.tree.leaves()).map(of_leaf).collect()
}
