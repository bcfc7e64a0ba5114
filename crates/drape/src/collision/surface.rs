//! The cloth as collision sees it: its triangles, edges and vertices, each feature in the care of
//! one triangle, so that a pair of features is looked at once (Curtis, Tamstorf and Manocha 2008).

use super::boxes::{BoxTree, Region};
use super::clusters::{Clusters, Corners, Hits};
use super::curvature::Clearance;
use super::regions::{Cloth, Regions, Ways};
use crate::{Model, merge_map};
use pulp::Arch;
use rayon::prelude::*;
use toile_geometry::{TriangleMesh, Vec3};

/// Two features that might touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum FeaturePair {
    /// A vertex and the corners of a face.
    VertexFace([u32; 4]),
    /// The ends of an edge, and those of another.
    EdgeEdge([u32; 4]),
}

impl FeaturePair {
    /// How many of the vertices are the first feature's.
    pub fn first(&self) -> usize {
        match self {
            Self::VertexFace(_) => 1,
            Self::EdgeEdge(_) => 2,
        }
    }

    /// The four vertices.
    pub fn vertices(&self) -> [u32; 4] {
        let (Self::VertexFace(v) | Self::EdgeEdge(v)) = *self;
        v
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
    clusters: Clusters,
    tree: BoxTree,
    regions: Regions,
    opened: usize,
}

/// Share of the shortest edge nearby above which no distance is kept: neighbours are not contacts.
pub(super) const ROOM: f64 = 0.5;

/// The same between features of triangles that share a vertex and face alike: in a triangle with angles of
/// 20 degrees and more a corner is a third of an edge from the side opposite.
const NEIGHBOURS: f64 = 0.1;

/// No triangle.
const NONE: u32 = u32::MAX;

/// Pairs of clusters that one core looks into at once.
const AT_ONCE: usize = 32;

impl ClothSurface {
    /// Features of a model's cloth.
    pub fn new(model: &Model) -> Self {
        let mesh = model.mesh(&model.layout);
        let mut surface = Self::of_mesh(&mesh);
        surface.layer.clone_from(&model.layer);
        for sample in model.samples.iter().filter(|s| s.triangle.is_none()) {
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
        surface.clusters = Clusters::new(&surface.tree, owners, corners);
        let cloth = Cloth {
            tree: &surface.tree,
            triangles: &surface.triangles,
            edges: &surface.edges,
            room: &[],
        };
        surface.regions = Regions::new(&cloth, &surface.edge_triangles);
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

    /// Pairs of clusters that come within `reach` [m] of each other on the way of the cloth, and clusters
    /// with themselves; more than those, but never fewer.
    pub fn near(&mut self, ways: Ways, reach: f64) -> Vec<[u32; 2]> {
        self.refit(ways, reach);
        let root: Vec<Region> = self.tree.root().map(Region::Own).into_iter().collect();
        let all = self.tree.pairs(&root, |_: &mut (), _| false);
        self.opened = all.opened;
        all.pairs
    }

    /// How many regions of the tree the last search looked into, and how many of them it looked at
    /// closely to leave them out.
    pub fn opened(&self) -> [usize; 2] {
        [self.opened, self.regions.told()]
    }

    /// [`Self::near`] without those of a region that keeps clear of itself: no two of their
    /// features without a common vertex come nearer than the clearance says. What was found of
    /// regions serves the next search with the same clearance too.
    pub fn near_unless_clear(
        &mut self,
        ways: Ways,
        reach: f64,
        clearance: Clearance,
    ) -> Vec<[u32; 2]> {
        self.refit(ways, reach);
        let cloth = Cloth {
            tree: &self.tree,
            triangles: &self.triangles,
            edges: &self.edges,
            room: &self.room,
        };
        let pairs;
        (pairs, self.opened) = self.regions.near(&cloth, &ways, clearance);
        pairs
    }

    /// [`Self::near`] for pairs in which a triangle has a marked corner, where no other vertex goes
    /// another way than in the last search, which had the same reach.
    pub fn near_marked(&mut self, ways: Ways, reach: f64, marks: &[bool]) -> Vec<[u32; 2]> {
        let (tree, triangles) = (&self.tree, &self.triangles);
        let has = |&t: &u32| triangles[t as usize].iter().any(|&v| marks[v as usize]);
        let of_leaf = |cluster: usize| tree.items(cluster).iter().any(has);
        let leaves: Vec<bool> = (0..tree.leaves()).into_par_iter().map(of_leaf).collect();
        let nodes = tree.folded(|cluster| leaves[cluster], |a, b| a | b);
        let corners = Corners {
            edges: &self.edges,
            triangles,
        };
        let clusters = (0u32..).zip(&leaves).filter(|(_, marked)| **marked);
        let clusters: Vec<u32> = clusters.map(|(cluster, _)| cluster).collect();
        self.clusters
            .fit_again(&ways, corners, 0.5 * reach, marks, &clusters);
        self.tree.refit(|leaf| self.clusters.bounds(leaf));
        let root: Vec<Region> = self.tree.root().map(Region::Own).into_iter().collect();
        let unmarked = |_: &mut (), region: &Region| !region.nodes().any(|n| nodes[n.at as usize]);
        self.tree.pairs(&root, unmarked).pairs
    }

    /// Forgets what earlier searches found of regions.
    pub fn forget(&mut self) {
        self.regions.forget();
    }

    fn refit(&mut self, ways: Ways, reach: f64) {
        let corners = Corners {
            edges: &self.edges,
            triangles: &self.triangles,
        };
        self.clusters.fit(&ways, corners, 0.5 * reach);
        let clusters = &self.clusters;
        self.tree.refit(|leaf| clusters.bounds(leaf));
    }

    /// Collects what `each` makes of pairs of features in some pairs of clusters, in an order that does
    /// not depend on threads: all that come as near each other as was asked for when the pairs of
    /// clusters were found, and more; those that share a vertex left out. `each` is given the triangles
    /// that care for the two as well.
    pub fn features<T: Clone + Send + Sync>(
        &self,
        near: &[[u32; 2]],
        each: impl Fn(FeaturePair, [u32; 2], &mut Vec<T>) + Sync,
    ) -> Vec<T> {
        let arch = Arch::new();
        let of_pairs = |pairs: &[[u32; 2]]| {
            let (mut hits, mut found) = (Hits::default(), Vec::new());
            for &pair in pairs {
                self.clusters.near(arch, pair, &mut hits);
                for [v, t] in hits.vertex_face.drain(..) {
                    let [a, b, c] = self.triangles[t as usize];
                    if v != a && v != b && v != c {
                        let owners = [self.vertex_owners[v as usize], t];
                        each(FeaturePair::VertexFace([v, a, b, c]), owners, &mut found);
                    }
                }
                for [e, f] in hits.edge_edge.drain(..) {
                    // The same pair reads the same whichever cluster comes first.
                    let (e, f) = (e.min(f), e.max(f));
                    let ([a, b], [c, d]) = (self.edges[e as usize], self.edges[f as usize]);
                    if a != c && a != d && b != c && b != d {
                        let owners = [e, f].map(|e| self.edge_owners[e as usize]);
                        each(FeaturePair::EdgeEdge([a, b, c, d]), owners, &mut found);
                    }
                }
            }
            found
        };
        let found: Vec<Vec<T>> = near.par_chunks(AT_ONCE).map(of_pairs).collect();
        found.concat()
    }

    /// Collects edges and faces that `crosses` says yes to, of those in some pairs of clusters whose ways
    /// meet, in an order that does not depend on threads; those that share a vertex left out.
    pub fn edges_and_faces(
        &self,
        near: &[[u32; 2]],
        crosses: impl Fn([u32; 2]) -> bool + Sync,
    ) -> Vec<[u32; 2]> {
        let arch = Arch::new();
        let of_pairs = |pairs: &[[u32; 2]]| {
            let (mut hits, mut found) = (Hits::default(), Vec::new());
            for &pair in pairs {
                self.clusters.crossing(arch, pair, &mut hits);
                let apart = |&[e, t]: &[u32; 2]| {
                    let face = self.triangles[t as usize];
                    !self.edges[e as usize].iter().any(|v| face.contains(v))
                };
                let pairs = hits.edge_face.drain(..).filter(apart);
                found.extend(pairs.filter(|&pair| crosses(pair)));
            }
            found
        };
        let found: Vec<Vec<[u32; 2]>> = near.par_chunks(AT_ONCE).map(of_pairs).collect();
        found.concat()
    }

    /// Whether two triangles share a vertex.
    pub fn adjacent(&self, [t, u]: [u32; 2]) -> bool {
        let other = self.triangles[u as usize];
        self.triangles[t as usize].iter().any(|v| other.contains(v))
    }
}
