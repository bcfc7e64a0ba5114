//! Features of the cloth that collide: its triangles, edges and vertices, with the contact offset that there is
//! room for. Each edge and vertex is owned by one triangle, so that a pair of features is tested once (Curtis,
//! Tamstorf and Manocha 2008).

use super::boxes::BoxTree;
use super::bvtt_front::BvttFront;
use super::feature_pair::FeaturePair;
use super::leaf_aabbs::{Corners, LeafAabbs};
use super::regions::Regions;
use super::surface_view::{OFFSET_PER_EDGE, SurfaceView};
use crate::{Model, merge_map};
use toile_geometry::{TriangleMesh, Vec3};

/// Features of the cloth, and the structures that near pairs of them are searched with.
#[derive(Clone, Debug, Default)]
pub struct ClothSurface {
    /// Corners of the triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Ends of the edges, the smaller index first, sorted.
    pub edges: Vec<[u32; 2]>,
    /// Triangles on each edge; more than two only where plies share a seam.
    pub edge_triangles: Vec<Vec<u32>>,
    /// Length of the shortest edge at each vertex when the model was built (m).
    pub shortest_edge: Vec<f64>,
    /// Area of cloth at each vertex (m2).
    pub area: Vec<f64>,
    /// Friction coefficient at each vertex.
    pub friction: Vec<f64>,
    /// Coefficient of restitution at each vertex; none where its material gives none.
    pub restitution: Vec<Option<f64>>,
    /// Layer of each vertex; empty where all are of one.
    pub layer: Vec<u16>,
    /// Vertices at an edge with cloth on one side only.
    pub border: Vec<bool>,
    /// The triangle that owns each vertex; [`NO_TRIANGLE`] for a vertex without triangles.
    pub(super) vertex_owners: Vec<u32>,
    /// The triangle that owns each edge.
    pub(super) edge_owners: Vec<u32>,
    /// Boxes of the features in each leaf of the tree.
    pub(super) leaves: LeafAabbs,
    /// Tree of boxes over the triangles.
    pub(super) tree: BoxTree,
    /// Vertices of each leaf's triangles, leaf after leaf; start of each leaf in that list, and its end.
    pub(super) leaf_vertices: [Vec<u32>; 2],
    /// Curvature test of the tree's nodes.
    pub(super) regions: Regions,
    /// Front of the query before.
    pub(super) front: BvttFront,
    /// Regions that the last search opened, and regions that it gave the curvature test.
    pub(super) region_counts: [usize; 2],
}

/// Largest contact offset, as a share of the shortest edge nearby, of features whose triangles share a vertex and
/// face the same side. In a triangle whose angles are 20 degrees or more a corner is at least a third of an edge
/// from the opposite side: a tenth leaves a flat mesh without contacts.
const NEIGHBOUR_OFFSET_PER_EDGE: f64 = 0.1;

/// Owner of a vertex that no triangle has.
const NO_TRIANGLE: u32 = u32::MAX;

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

    /// Features of any mesh, with zero area and friction at every vertex.
    pub fn of_mesh(mesh: &TriangleMesh) -> Self {
        let topology = mesh.topology();
        let count = mesh.positions.len();
        let mut shortest_edge = vec![f64::INFINITY; count];
        for &[a, b] in &topology.edges {
            let length = (mesh.positions[a as usize] - mesh.positions[b as usize]).norm();
            for v in [a, b] {
                shortest_edge[v as usize] = shortest_edge[v as usize].min(length);
            }
        }
        let mut surface = Self {
            vertex_owners: vec![NO_TRIANGLE; count],
            triangles: mesh.triangles.clone(),
            shortest_edge,
            area: vec![0.0; count],
            friction: vec![0.0; count],
            restitution: vec![None; count],
            border: vec![false; count],
            ..Self::default()
        };
        for (e, triangles) in topology.edge_triangles.iter().enumerate() {
            let owner = triangles.first().copied().unwrap_or(NO_TRIANGLE);
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
        surface.build_tree(&centres);
        surface
    }

    /// Builds the tree over triangles with these centres (m), and everything that hangs on its leaves and nodes.
    fn build_tree(&mut self, centres: &[Vec3]) {
        let edges = self.edges.iter().copied();
        let (component_of, _) = merge_map(self.shortest_edge.len(), edges);
        let components: Vec<u32> = (self.triangles.iter())
            .map(|t| component_of[t[0] as usize])
            .collect();
        self.tree = BoxTree::new(centres, &components);
        let owners = [&self.vertex_owners[..], &self.edge_owners];
        let corners = Corners {
            edges: &self.edges,
            triangles: &self.triangles,
        };
        self.leaves = LeafAabbs::new(&self.tree, owners, corners);
        let [mut vertices, mut starts] = [Vec::new(), vec![0]];
        for leaf in 0..self.tree.leaves() {
            let items = self.tree.items(leaf).iter();
            let mut own: Vec<u32> = items.flat_map(|&t| self.triangles[t as usize]).collect();
            own.sort_unstable();
            own.dedup();
            vertices.extend(own);
            starts.push(vertices.len() as u32);
        }
        self.leaf_vertices = [vertices, starts];
        self.regions = Regions::new(&self.view(), &self.edge_triangles);
    }

    /// Largest contact offset at a vertex (m). A larger one would make contacts of neighbours in a flat mesh.
    pub fn max_offset(&self, v: u32) -> f64 {
        OFFSET_PER_EDGE * self.shortest_edge[v as usize]
    }

    /// Contact offset of two features (m): the `nominal` one, limited by a share of the shortest edge at their
    /// vertices. The share is smaller for `neighbours`, whose triangles share a vertex and face the same side.
    pub fn contact_offset(&self, pair: FeaturePair, neighbours: bool, nominal: f64) -> f64 {
        let share = if neighbours {
            NEIGHBOUR_OFFSET_PER_EDGE
        } else {
            OFFSET_PER_EDGE
        };
        let limits = (pair.vertices()).map(|v| share * self.shortest_edge[v as usize]);
        limits.into_iter().fold(nominal, f64::min)
    }

    /// Whether two triangles share a vertex.
    pub fn adjacent(&self, [t, u]: [u32; 2]) -> bool {
        let other = self.triangles[u as usize];
        self.triangles[t as usize].iter().any(|v| other.contains(v))
    }

    /// The tree and the topology, as searches read them.
    pub(super) fn view(&self) -> SurfaceView<'_> {
        SurfaceView {
            tree: &self.tree,
            leaf_vertices: self.leaf_vertices.each_ref().map(|list| &list[..]),
            triangles: &self.triangles,
            edges: &self.edges,
            shortest_edge: &self.shortest_edge,
        }
    }
}
