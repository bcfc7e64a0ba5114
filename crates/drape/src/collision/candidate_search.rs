//! Search for candidate pairs: features of the cloth that may come near each other or cross. A search of the tree
//! gives pairs of leaves ([`ClothSurface::near_leaves`]); a query gives neighbour lists that later queries go on
//! from ([`ClothSurface::query`]). Candidates are then read from either.
//!
//! # Decided with
//! - [`crate::collision::Reach`]: how near is near;
//! - [`crate::collision`] (`proximity.rs`), [`crate::collision::nearness`],
//!   [`crate::collision::feature_pair`]: pairs measured;
//! - [`crate::collision::leaf_aabbs`], [`crate::collision::boxes`]: boxes of features and of regions;
//! - [`crate::collision::curvature`], [`crate::collision`] (`regions.rs`): regions that cannot touch
//!   themselves, and those far apart;
//! - [`crate::collision::bvtt_front`], [`crate::collision::front_query`], [`crate::collision::moves`]: what
//!   an earlier query found and still holds;
//! - [`crate::collision::neighbour_lists`]: neighbour lists;
//! - [`crate::xpbd`] (`cloth.rs`, `substeps_before_detection`): when XPBD looks again.

use super::boxes::{Bounds, Region};
use super::curvature::Clearance;
use super::feature_pair::FeaturePair;
use super::leaf_aabbs::{Corners, Hits};
use super::reach::Reach;
use super::separation_filter::{Candidates, SeparationFilter};
use super::surface::ClothSurface;
use super::trajectories::LinearTrajectories;
use pulp::Arch;
use rayon::prelude::*;

/// Source of candidate pairs; valid until the next search or query.
#[derive(Clone, Copy, Debug)]
pub enum Near<'a> {
    /// Pairs of leaves from [`ClothSurface::near_leaves`].
    Leaves(&'a [[u32; 2]]),
    /// Neighbour lists of the last [`ClothSurface::query`].
    Listed,
}

impl<'a> From<&'a Vec<[u32; 2]>> for Near<'a> {
    fn from(pairs: &'a Vec<[u32; 2]>) -> Self {
        Self::Leaves(pairs)
    }
}

impl<'a> From<&'a [[u32; 2]]> for Near<'a> {
    fn from(pairs: &'a [[u32; 2]]) -> Self {
        Self::Leaves(pairs)
    }
}

/// Pairs of leaves, or lists, that one task tests.
const PAIRS_PER_TASK: usize = 32;

impl ClothSurface {
    /// Pairs of leaves whose boxes come within `reach` (m) of each other on the trajectories, and each leaf with
    /// itself. Boxes are conservative: no pair is missed.
    pub fn near_leaves(&mut self, trajectories: LinearTrajectories, reach: f64) -> Vec<[u32; 2]> {
        self.refit(trajectories, reach);
        let root: Vec<Region> = self.tree.root().map(Region::Own).into_iter().collect();
        let tree = &self.tree;
        let found = tree.leaf_pairs(&root, |_: &mut (), region| !tree.meets(region));
        self.region_counts = [found.opened, 0];
        found.pairs
    }

    /// [`Self::near_leaves`] without regions that pass the curvature test: on the trajectories no two of their
    /// features without a common vertex come nearer than the clearance says.
    pub fn near_leaves_unless_clear(
        &mut self,
        trajectories: LinearTrajectories,
        reach: f64,
        clearance: Clearance,
    ) -> Vec<[u32; 2]> {
        self.refit(trajectories, reach);
        let mut regions = std::mem::take(&mut self.regions);
        let found = regions.near_leaves(&self.view(), &trajectories, clearance);
        self.regions = regions;
        self.region_counts = [found.opened, found.tested];
        found.pairs
    }

    /// Number of regions of the tree that the last search or query opened, and number that it gave the curvature
    /// test.
    pub fn region_counts(&self) -> [usize; 2] {
        self.region_counts
    }

    /// Lists the features that come within reach of each other on the trajectories, and the edges and faces that
    /// may cross where the trajectories begin. Regions that pass the curvature test are left out. Lists are
    /// conservative, and later queries use them again while vertices deviate little from their neighbours' motion.
    pub fn query(&mut self, trajectories: LinearTrajectories, reach: &Reach, clearance: Clearance) {
        self.query_marked(trajectories, reach, clearance, None);
    }

    /// [`Self::query`] for pairs with a marked vertex alone. The query before must have had the same reach and
    /// clearance, and the same trajectories for all vertices that are not marked.
    pub fn query_marked(
        &mut self,
        trajectories: LinearTrajectories,
        reach: &Reach,
        clearance: Clearance,
        marks: Option<&[bool]>,
    ) {
        let mut front = std::mem::take(&mut self.front);
        let (expired, query) = front.expired(&self.view(), (&trajectories, reach), clearance);
        let (x, [vertices, starts]) = (trajectories.from, &self.leaf_vertices);
        if !expired.is_empty() {
            self.tree.refit(|leaf| {
                let own = &vertices[starts[leaf] as usize..starts[leaf + 1] as usize];
                Bounds::of_all(own.iter().map(|&v| x[v as usize]))
            });
        }
        let mut regions = std::mem::take(&mut self.regions);
        let mut leaves = std::mem::take(&mut self.leaves);
        let (cloth, mut region_counts) = (self.view(), [0; 2]);
        if !expired.is_empty() {
            let fitted = (&mut regions, &mut leaves);
            region_counts = front.search(&cloth, fitted, x, (&expired, &query));
        }
        front.fit(&cloth, &mut leaves, (&trajectories, &query), marks);
        self.region_counts = region_counts;
        (self.regions, self.leaves) = (regions, leaves);
        self.front = front;
    }

    /// Has the next query search the whole tree.
    pub fn forget(&mut self) {
        self.front.forget();
    }

    /// Fits the boxes of the tree to the trajectories, enlarged by half of `reach` (m).
    fn refit(&mut self, trajectories: LinearTrajectories, reach: f64) {
        let corners = Corners {
            edges: &self.edges,
            triangles: &self.triangles,
        };
        self.leaves.fit(&trajectories, corners, 0.5 * reach);
        let leaves = &self.leaves;
        self.tree.refit(|leaf| leaves.bounds(leaf));
    }

    /// Calls `each` for every candidate pair without a common vertex, and collects what it pushes, in an order
    /// that does not depend on the number of threads. `each` is also given the triangles that own the two
    /// features. All pairs within the reach of the search are candidates, and others.
    pub fn features<'a, T: Clone + Send + Sync>(
        &self,
        near: impl Into<Near<'a>>,
        each: impl Fn(FeaturePair, [u32; 2], &mut Vec<T>) + Sync,
    ) -> Vec<T> {
        self.filtered(near, None, each)
    }

    /// [`Self::features`] without the pairs that a filter separates.
    pub fn filtered<'a, T: Clone + Send + Sync>(
        &self,
        near: impl Into<Near<'a>>,
        filter: Option<&SeparationFilter>,
        each: impl Fn(FeaturePair, [u32; 2], &mut Vec<T>) + Sync,
    ) -> Vec<T> {
        let cloth = self.view();
        let read_hits = |candidates: &mut Candidates, found: &mut Vec<T>| {
            if let Some(filter) = filter {
                candidates.discard(filter, &cloth);
            }
            for &[v, t] in &candidates.hits.vertex_face {
                if let Some(pair) = cloth.vertex_face([v, t]) {
                    each(pair, [self.vertex_owners[v as usize], t], found);
                }
            }
            for &[e, f] in &candidates.hits.edge_edge {
                if let Some(pair) = cloth.edge_edge([e, f]) {
                    let owners = [e.min(f), e.max(f)].map(|e| self.edge_owners[e as usize]);
                    each(pair, owners, found);
                }
            }
        };
        let test_leaves = |pair, distance, hits: &mut Hits| {
            (self.leaves).near_within(Arch::new(), pair, distance, hits);
        };
        let reach = filter.map_or(0.0, SeparationFilter::reach);
        self.collected((near.into(), reach), test_leaves, read_hits)
    }

    /// Collects the candidate pairs of an edge and a face without a common vertex for which `crosses` is true, in
    /// an order that does not depend on the number of threads.
    pub fn edges_and_faces<'a>(
        &self,
        near: impl Into<Near<'a>>,
        crosses: impl Fn([u32; 2]) -> bool + Sync,
    ) -> Vec<[u32; 2]> {
        let cloth = self.view();
        let read_hits = |candidates: &mut Candidates, found: &mut Vec<[u32; 2]>| {
            let disjoint =
                (candidates.hits.edge_face.iter()).filter(|hit| cloth.are_disjoint(**hit));
            found.extend(disjoint.filter(|hit| crosses(**hit)));
        };
        let test_leaves = |pair, _: f64, hits: &mut Hits| {
            (self.leaves).crossing(Arch::new(), pair, hits);
        };
        self.collected((near.into(), 0.0), test_leaves, read_hits)
    }

    /// Collects what `read_hits` makes of candidates: of listed hits, and of hits that `test_leaves` finds in a
    /// pair of leaves with boxes enlarged by its second argument (m). Candidates come within `reach` (m), or within
    /// the distance that the front notes for a pair of leaves without a list.
    fn collected<T: Clone + Send + Sync>(
        &self,
        (near, reach): (Near, f64),
        test_leaves: impl Fn([u32; 2], f64, &mut Hits) + Sync,
        read_hits: impl Fn(&mut Candidates, &mut Vec<T>) + Sync,
    ) -> Vec<T> {
        let of_pairs =
            |candidates: &mut Candidates, pairs: &mut dyn Iterator<Item = ([u32; 2], f64, f64)>| {
                candidates.clear();
                for (pair, enlargement, reach) in pairs {
                    test_leaves(pair, enlargement, &mut candidates.hits);
                    candidates.set_reach(reach);
                }
                let mut found = Vec::new();
                read_hits(candidates, &mut found);
                found
            };
        let of_lists = |candidates: &mut Candidates, lists: Vec<Option<&Hits>>| {
            candidates.clear();
            let lists = lists.into_iter().flatten();
            lists.for_each(|hits| candidates.hits.append(hits));
            candidates.set_reach(reach);
            let mut found = Vec::new();
            read_hits(candidates, &mut found);
            found
        };
        let found: Vec<Vec<T>> = match near {
            Near::Leaves(pairs) => (pairs.par_chunks(PAIRS_PER_TASK))
                .map_init(Candidates::default, |candidates, pairs| {
                    of_pairs(
                        candidates,
                        &mut pairs.iter().map(|&pair| (pair, 0.0, reach)),
                    )
                })
                .collect(),
            Near::Listed => {
                let lists = self.front.lists().chunks(PAIRS_PER_TASK);
                let listed = lists.map_init(Candidates::default, of_lists);
                let open = self.front.open().par_chunks(PAIRS_PER_TASK);
                let open = open.map_init(Candidates::default, |candidates, pairs| {
                    of_pairs(
                        candidates,
                        &mut pairs.iter().map(|&(pair, reach)| (pair, reach, reach)),
                    )
                });
                listed.chain(open).collect()
            }
        };
        found.concat()
    }
}
