//! The cloth as collision sees it: its triangles, edges and vertices, each feature in the care of
//! one triangle, so that a pair of features is looked at once (Curtis, Tamstorf and Manocha 2008).

use super::boxes::{Bounds, BoxTree};
use super::curvature::{Clearance, Curvature};
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
    curvature: Curvature,
    opened: usize,
}

/// Share of the shortest edge nearby above which no distance is kept: neighbours are not contacts.
const ROOM: f64 = 0.5;

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
        surface.curvature = Curvature::new(
            &surface.tree,
            &surface.triangles,
            &surface.edges,
            &surface.edge_triangles,
        );
        surface
    }

    /// The most that is kept between features at a vertex [m]: neighbours are not contacts.
    pub fn most_kept(&self, v: u32) -> f64 {
        ROOM * self.room[v as usize]
    }

    /// The tree over the triangles, as last fitted.
    pub fn tree(&self) -> &BoxTree {
        &self.tree
    }

    /// Pairs of triangles that come within `reach` [m] of each other as the cloth moves straight
    /// from some positions to others; more than those, but never fewer.
    pub fn near_triangles(&mut self, from: &[Vec3], to: &[Vec3], reach: f64) -> Vec<[u32; 2]> {
        self.refit(from, to, reach);
        let (pairs, opened) = self.tree.pairs(|_| false);
        self.opened = opened;
        pairs
    }

    /// How many regions of the tree the last search looked into.
    pub fn opened(&self) -> usize {
        self.opened
    }

    /// [`Self::near_triangles`] without those of a region that keeps clear of itself: no two of their
    /// features without a common vertex come nearer than the clearance says.
    pub fn near_unless_clear(
        &mut self,
        from: &[Vec3],
        to: &[Vec3],
        reach: f64,
        clearance: Clearance,
    ) -> Vec<[u32; 2]> {
        self.refit(from, to, reach);
        let Self {
            curvature,
            tree,
            triangles,
            edges,
            room,
            opened,
            ..
        } = self;
        curvature.refit(tree, triangles, (from, |v| ROOM * room[v]), clearance);
        let pairs;
        (pairs, *opened) = tree.pairs(|region| curvature.is_clear(edges, from, region));
        pairs
    }

    fn refit(&mut self, from: &[Vec3], to: &[Vec3], reach: f64) {
        let triangles = &self.triangles;
        let still = std::ptr::eq(from, to);
        self.tree.refit(|t| {
            let corners = triangles[t as usize];
            let start = corners.map(|v| from[v as usize]);
            let bounds = Bounds::round(&start, 0.5 * reach);
            if still {
                return bounds;
            }
            bounds.join(&Bounds::round(
                &corners.map(|v| to[v as usize]),
                0.5 * reach,
            ))
        });
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
