//! The cloth as collision sees it: its triangles, edges and vertices, each feature in the care of
//! one triangle, so that a pair of features is tested once (Curtis, Tamstorf and Manocha 2008).

use super::boxes::{Bounds, BoxTree, Region};
use super::bvtt_front::BvttFront;
use super::curvature::Clearance;
use super::feature_pair::FeaturePair;
use super::leaf_aabbs::{Corners, Hits, LeafAabbs};
use super::reach::Reach;
use super::regions::Regions;
use super::separation_filter::{Candidates, SeparationFilter};
use super::surface_view::{ROOM, SurfaceView};
use super::trajectories::LinearTrajectories;
use crate::{Model, merge_map};
use pulp::Arch;
use rayon::prelude::*;
use toile_geometry::{TriangleMesh, Vec3};

/// Where near features are taken from: valid until the next search of any kind.
#[derive(Clone, Copy, Debug)]
pub enum Near<'a> {
    /// From pairs of leaves that a search found.
    Leaves(&'a [[u32; 2]]),
    /// From the lists of the last look.
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

/// Features of the cloth.
#[derive(Clone, Debug, Default)]
pub struct ClothSurface {
    /// Corners of the triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Ends of the edges, the smaller index first, sorted.
    pub edges: Vec<[u32; 2]>,
    /// Triangles on each edge; more than two only where plies share a seam.
    pub edge_triangles: Vec<Vec<u32>>,
    /// Length of the shortest edge at each vertex when the model was built [m].
    pub room: Vec<f64>,
    /// Area of cloth at each vertex [m2].
    pub area: Vec<f64>,
    /// Friction coefficient at each vertex.
    pub friction: Vec<f64>,
    /// Share of the speed of an impact that comes back at each vertex, where any cloth says it.
    pub restitution: Vec<Option<f64>>,
    /// Layer of each vertex; empty where all are of one.
    pub layer: Vec<u16>,
    /// Vertices at an edge with cloth on one side only.
    pub border: Vec<bool>,
    /// The triangle that cares for each vertex, or [`NONE`].
    vertex_owners: Vec<u32>,
    /// The triangle that cares for each edge.
    edge_owners: Vec<u32>,
    leaves: LeafAabbs,
    tree: BoxTree,
    /// The corners of each leaf's triangles, leaf after leaf; where those of each begin, and the end.
    leaf_vertices: [Vec<u32>; 2],
    regions: Regions,
    front: BvttFront,
    opened: [usize; 2],
}

/// Share of the shortest edge above which no distance is kept between features of triangles that share a vertex
/// and face alike: in a triangle with angles of 20 degrees and more a corner is a third of an edge from the side
/// opposite.
const NEIGHBOURS: f64 = 0.1;

/// No triangle.
const NONE: u32 = u32::MAX;

/// Pairs of leaves that one task tests.
const AT_ONCE: usize = 32;

impl ClothSurface {
    /// Features of a model's cloth.
    pub fn new(model: &Model) -> Self {
        let mesh = model.mesh(&model.topology.layout);
        let mut surface = Self::of_mesh(&mesh);
        surface.layer.clone_from(&model.layer);
        for sample in model.rest.samples.iter().filter(|s| s.triangle.is_none()) {
            let v = sample.vertices[0] as usize;
            surface.area[v] = sample.area;
            surface.friction[v] = sample.friction;
            surface.restitution[v] = sample.restitution;
        }
        surface
    }

    /// Features of any mesh, without friction.
    pub fn of_mesh(mesh: &TriangleMesh) -> Self {
        let topology = mesh.topology();
        let count = mesh.positions.len();
        let mut room = vec![f64::INFINITY; count];
        for &[a, b] in &topology.edges {
            let length = (mesh.positions[a as usize] - mesh.positions[b as usize]).norm();
            for v in [a, b] {
                room[v as usize] = room[v as usize].min(length);
            }
        }
        let mut surface = Self {
            vertex_owners: vec![NONE; count],
            triangles: mesh.triangles.clone(),
            room,
            area: vec![0.0; count],
            friction: vec![0.0; count],
            restitution: vec![None; count],
            border: vec![false; count],
            ..Self::default()
        };
        for (e, triangles) in topology.edge_triangles.iter().enumerate() {
            let owner = triangles.first().copied().unwrap_or(NONE);
            surface.edge_owners.push(owner);
            if triangles.len() < 2 {
                for v in topology.edges[e] {
                    surface.border[v as usize] = true;
                }
            }
        }
        let mut centres = Vec::with_capacity(mesh.triangles.len());
        for (t, corners) in mesh.triangles.iter().enumerate() {
            for &v in corners {
                let owner = &mut surface.vertex_owners[v as usize];
                *owner = (*owner).min(t as u32);
            }
            centres.push(mesh.corners(t).iter().sum::<Vec3>() / 3.0);
        }
        surface.edges = topology.edges;
        surface.edge_triangles = topology.edge_triangles;
        let sides = surface.edges.iter().copied();
        let (piece, _) = merge_map(count, sides);
        let pieces: Vec<u32> = (surface.triangles.iter())
            .map(|t| piece[t[0] as usize])
            .collect();
        surface.tree = BoxTree::new(&centres, &pieces);
        let owners = [&surface.vertex_owners[..], &surface.edge_owners];
        let corners = Corners {
            edges: &surface.edges,
            triangles: &surface.triangles,
        };
        surface.leaves = LeafAabbs::new(&surface.tree, owners, corners);
        let [mut vertices, mut starts] = [Vec::new(), vec![0]];
        for leaf in 0..surface.tree.leaves() {
            let items = surface.tree.items(leaf).iter();
            let mut own: Vec<u32> = items.flat_map(|&t| surface.triangles[t as usize]).collect();
            own.sort_unstable();
            own.dedup();
            vertices.extend(own);
            starts.push(vertices.len() as u32);
        }
        surface.leaf_vertices = [vertices, starts];
        surface.regions = Regions::new(&surface.cloth(), &surface.edge_triangles);
        surface
    }

    /// The most that is kept between features at a vertex [m]: neighbours are not contacts.
    pub fn most_kept(&self, v: u32) -> f64 {
        ROOM * self.room[v as usize]
    }

    /// What is kept between two features [m]: `asked`, as far as there is room between them. Features of
    /// neighbouring triangles that face alike have little.
    pub fn kept(&self, pair: FeaturePair, neighbours: bool, asked: f64) -> f64 {
        let share = if neighbours { NEIGHBOURS } else { ROOM };
        let rooms = pair.vertices().map(|v| share * self.room[v as usize]);
        rooms.into_iter().fold(asked, f64::min)
    }

    fn cloth(&self) -> SurfaceView<'_> {
        SurfaceView {
            tree: &self.tree,
            leaf_vertices: self.leaf_vertices.each_ref().map(|list| &list[..]),
            triangles: &self.triangles,
            edges: &self.edges,
            room: &self.room,
        }
    }

    /// Pairs of leaves that come within `reach` [m] of each other on the trajectories, and leaves with
    /// themselves; more than those, but never fewer.
    pub fn near(&mut self, ways: LinearTrajectories, reach: f64) -> Vec<[u32; 2]> {
        self.refit(ways, reach);
        let root: Vec<Region> = self.tree.root().map(Region::Own).into_iter().collect();
        let tree = &self.tree;
        let all = tree.pairs(&root, |_: &mut (), region| !tree.meets(region));
        self.opened = [all.opened, 0];
        all.pairs
    }

    /// How many regions of the tree the last search looked into, and how many of them it looked at
    /// closely to leave them out.
    pub fn opened(&self) -> [usize; 2] {
        self.opened
    }

    /// [`Self::near`] without those of a region that keeps clear of itself: no two of their
    /// features without a common vertex come nearer than the clearance says.
    pub fn near_unless_clear(
        &mut self,
        ways: LinearTrajectories,
        reach: f64,
        clearance: Clearance,
    ) -> Vec<[u32; 2]> {
        self.refit(ways, reach);
        let mut regions = std::mem::take(&mut self.regions);
        let found = regions.near(&self.cloth(), &ways, clearance);
        self.regions = regions;
        self.opened = [found.opened, found.told];
        found.pairs
    }

    /// Lists features that come within reach of each other on the way of the cloth, and edges and faces that
    /// may cross where it begins, and more, but for those of a region that keeps clear of itself. What is
    /// listed serves the next looks as long as vertices stray little from their neighbours.
    pub fn look(&mut self, ways: LinearTrajectories, reach: &Reach, clearance: Clearance) {
        self.look_again(ways, reach, clearance, None);
    }

    /// [`Self::look`] for features with a marked vertex, where no other goes another way than in the last look,
    /// which was for the same.
    pub fn look_again(
        &mut self,
        ways: LinearTrajectories,
        reach: &Reach,
        clearance: Clearance,
        marks: Option<&[bool]>,
    ) {
        let mut front = std::mem::take(&mut self.front);
        let (expired, query) = front.expired(&self.cloth(), (&ways, reach), clearance);
        let (x, [vertices, starts]) = (ways.from, &self.leaf_vertices);
        if !expired.is_empty() {
            self.tree.refit(|leaf| {
                let own = &vertices[starts[leaf] as usize..starts[leaf + 1] as usize];
                Bounds::round_all(own.iter().map(|&v| x[v as usize]))
            });
        }
        let mut regions = std::mem::take(&mut self.regions);
        let mut leaves = std::mem::take(&mut self.leaves);
        let (cloth, mut opened) = (self.cloth(), [0; 2]);
        if !expired.is_empty() {
            let fitted = (&mut regions, &mut leaves);
            opened = front.search(&cloth, fitted, x, (&expired, &query));
        }
        front.fit(&cloth, &mut leaves, (&ways, &query), marks);
        self.opened = opened;
        (self.regions, self.leaves) = (regions, leaves);
        self.front = front;
    }

    /// Has the next look search all.
    pub fn forget(&mut self) {
        self.front.forget();
    }

    fn refit(&mut self, ways: LinearTrajectories, reach: f64) {
        let corners = Corners {
            edges: &self.edges,
            triangles: &self.triangles,
        };
        self.leaves.fit(&ways, corners, 0.5 * reach);
        let leaves = &self.leaves;
        self.tree.refit(|leaf| leaves.bounds(leaf));
    }

    /// Collects what `each` makes of pairs of features that are near, in an order that does
    /// not depend on threads: all that come as near each other as was asked for when they
    /// were searched for, and more; those that share a vertex left out. `each` is given the triangles
    /// that care for the two as well.
    pub fn features<'a, T: Clone + Send + Sync>(
        &self,
        near: impl Into<Near<'a>>,
        each: impl Fn(FeaturePair, [u32; 2], &mut Vec<T>) + Sync,
    ) -> Vec<T> {
        self.filtered(near, None, each)
    }

    /// [`Self::features`] without those that a filter separates.
    pub fn filtered<'a, T: Clone + Send + Sync>(
        &self,
        near: impl Into<Near<'a>>,
        filter: Option<&SeparationFilter>,
        each: impl Fn(FeaturePair, [u32; 2], &mut Vec<T>) + Sync,
    ) -> Vec<T> {
        let cloth = self.cloth();
        let of_hits = |candidates: &mut Candidates, found: &mut Vec<T>| {
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
        let hold = |pair, reach, hits: &mut Hits| {
            (self.leaves).near_within(Arch::new(), pair, reach, hits);
        };
        let reach = filter.map_or(0.0, SeparationFilter::reach);
        self.collected((near.into(), reach), hold, of_hits)
    }

    /// Collects edges and faces that `crosses` says yes to, of those that are near, in an order that
    /// does not depend on threads; those that share a vertex left out.
    pub fn edges_and_faces<'a>(
        &self,
        near: impl Into<Near<'a>>,
        crosses: impl Fn([u32; 2]) -> bool + Sync,
    ) -> Vec<[u32; 2]> {
        let cloth = self.cloth();
        let of_hits = |candidates: &mut Candidates, found: &mut Vec<[u32; 2]>| {
            let apart = (candidates.hits.edge_face.iter()).filter(|hit| cloth.are_apart(**hit));
            found.extend(apart.filter(|hit| crosses(**hit)));
        };
        let hold = |pair, _: f64, hits: &mut Hits| {
            (self.leaves).crossing(Arch::new(), pair, hits);
        };
        self.collected((near.into(), 0.0), hold, of_hits)
    }

    /// Collects what `of_hits` makes of listed features, and of those that `hold` finds in pairs of leaves without
    /// a list, their boxes enlarged by its second argument [m]. Features count that come within `reach` [m], or in
    /// pairs of leaves of the last look within the distance noted there.
    fn collected<T: Clone + Send + Sync>(
        &self,
        (near, reach): (Near, f64),
        hold: impl Fn([u32; 2], f64, &mut Hits) + Sync,
        of_hits: impl Fn(&mut Candidates, &mut Vec<T>) + Sync,
    ) -> Vec<T> {
        let of_pairs =
            |candidates: &mut Candidates, pairs: &mut dyn Iterator<Item = ([u32; 2], f64, f64)>| {
                candidates.clear();
                for (pair, wider, reach) in pairs {
                    hold(pair, wider, &mut candidates.hits);
                    candidates.come_within(reach);
                }
                let mut found = Vec::new();
                of_hits(candidates, &mut found);
                found
            };
        let of_lists = |candidates: &mut Candidates, lists: Vec<Option<&Hits>>| {
            candidates.clear();
            let lists = lists.into_iter().flatten();
            lists.for_each(|hits| candidates.hits.append(hits));
            candidates.come_within(reach);
            let mut found = Vec::new();
            of_hits(candidates, &mut found);
            found
        };
        let found: Vec<Vec<T>> = match near {
            Near::Leaves(pairs) => (pairs.par_chunks(AT_ONCE))
                .map_init(Candidates::default, |candidates, pairs| {
                    of_pairs(
                        candidates,
                        &mut pairs.iter().map(|&pair| (pair, 0.0, reach)),
                    )
                })
                .collect(),
            Near::Listed => {
                let lists = self.front.lists().chunks(AT_ONCE);
                let listed = lists.map_init(Candidates::default, of_lists);
                let open = self.front.open().par_chunks(AT_ONCE);
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

    /// Whether two triangles share a vertex.
    pub fn adjacent(&self, [t, u]: [u32; 2]) -> bool {
        let other = self.triangles[u as usize];
        self.triangles[t as usize].iter().any(|v| other.contains(v))
    }
}
