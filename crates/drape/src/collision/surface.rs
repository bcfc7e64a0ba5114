//! The cloth as collision sees it: its triangles, edges and vertices, each feature in the care of
//! one triangle, so that a pair of features is looked at once (Curtis, Tamstorf and Manocha 2008).

use super::boxes::{BoxTree, Region};
use super::curvature::Clearance;
use super::regions::{Cloth, Regions, Ways};
use crate::{Model, merge_map};
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
    /// Edges that each triangle cares for.
    own_edges: Vec<[u32; 3]>,
    /// Vertices that each triangle cares for.
    own_vertices: Vec<[u32; 3]>,
    tree: BoxTree,
    regions: Regions,
    opened: usize,
}

/// Share of the shortest edge nearby above which no distance is kept: neighbours are not contacts.
pub(super) const ROOM: f64 = 0.5;

/// No feature.
const NONE: u32 = u32::MAX;

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
            own_edges: vec![[NONE; 3]; mesh.triangles.len()],
            own_vertices: vec![[NONE; 3]; mesh.triangles.len()],
            triangles: mesh.triangles.clone(),
            room,
            area: vec![0.0; count],
            friction: vec![0.0; count],
            restitution: vec![None; count],
            border: vec![false; count],
            ..Self::default()
        };
        for (e, triangles) in topology.edge_triangles.iter().enumerate() {
            if let Some(&t) = triangles.first() {
                put(&mut surface.own_edges[t as usize], e as u32);
            }
            if triangles.len() < 2 {
                for v in topology.edges[e] {
                    surface.border[v as usize] = true;
                }
            }
        }
        let mut cared = vec![false; count];
        let mut centres = Vec::with_capacity(mesh.triangles.len());
        for (t, corners) in mesh.triangles.iter().enumerate() {
            for &v in corners {
                if !std::mem::replace(&mut cared[v as usize], true) {
                    put(&mut surface.own_vertices[t], v);
                }
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

    /// Pairs of triangles that come within `reach` [m] of each other on the way of the cloth; more
    /// than those, but never fewer.
    pub fn near_triangles(&mut self, ways: Ways, reach: f64) -> Vec<[u32; 2]> {
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

    /// [`Self::near_triangles`] without those of a region that keeps clear of itself: no two of their
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

    /// Forgets what earlier searches found of regions.
    pub fn forget(&mut self) {
        self.regions.forget();
    }

    /// Those of some pairs of triangles whose boxes come within `reach` [m] of each other on the way.
    pub fn meeting(&self, pairs: &[[u32; 2]], ways: Ways, reach: f64) -> Vec<[u32; 2]> {
        let bounds = |t: u32| ways.bounds(self.triangles[t as usize], 0.5 * reach);
        let meet = |&&[t, u]: &&[u32; 2]| bounds(t).meets(&bounds(u));
        pairs.iter().filter(meet).copied().collect()
    }

    fn refit(&mut self, ways: Ways, reach: f64) {
        let triangles = &self.triangles;
        (self.tree).refit(|t| ways.bounds(triangles[t as usize], 0.5 * reach));
    }

    /// Pairs of features of two triangles, those that share a vertex left out.
    pub fn features(&self, pair: [u32; 2], mut each: impl FnMut(FeaturePair)) {
        let [t, u] = pair.map(|t| t as usize);
        for (t, u) in [(t, u), (u, t)] {
            let face = self.triangles[u];
            for v in self.own_vertices[t].into_iter().take_while(|&v| v != NONE) {
                if !face.contains(&v) {
                    each(FeaturePair::VertexFace([v, face[0], face[1], face[2]]));
                }
            }
        }
        for e in self.own_edges[t].into_iter().take_while(|&e| e != NONE) {
            let [a, b] = self.edges[e as usize];
            for f in self.own_edges[u].into_iter().take_while(|&f| f != NONE) {
                let [c, d] = self.edges[f as usize];
                if a != c && a != d && b != c && b != d {
                    // The same pair reads the same whichever triangle comes first.
                    let four = if e < f { [a, b, c, d] } else { [c, d, a, b] };
                    each(FeaturePair::EdgeEdge(four));
                }
            }
        }
    }

    /// Edges that a triangle cares for.
    pub fn own_edges(&self, t: u32) -> impl Iterator<Item = u32> + use<> {
        self.own_edges[t as usize]
            .into_iter()
            .take_while(|&e| e != NONE)
    }

    /// Whether two triangles share a vertex.
    pub fn adjacent(&self, [t, u]: [u32; 2]) -> bool {
        let other = self.triangles[u as usize];
        self.triangles[t as usize].iter().any(|v| other.contains(v))
    }
}

fn put(slots: &mut [u32; 3], value: u32) {
    if let Some(slot) = slots.iter_mut().find(|slot| **slot == NONE) {
        *slot = value;
    }
}
