//! Lists of the features of two leaves that are near each other, valid while vertices move little
//! (Verlet 1967).

use super::feature_pair::FeaturePair;
use super::leaf_aabbs::Hits;
use super::nearness::{Nearness, PARALLEL, is_far};
use super::surface_view::SurfaceView;
use toile_geometry::Vec3;

/// Distances of boxes and of features are known no better than this [m].
pub const ROUNDING: f64 = 1e-9;

/// The features of two leaves, or of one with itself, that were near each other when the list was made.
#[derive(Clone, Debug)]
pub struct NeighbourList {
    /// Vertices and faces, and edges, that are not listed were farther apart than this [m].
    pub gap: f64,
    /// Edges and faces that are not listed were farther from crossing than this [m].
    pub crossing_gap: f64,
    /// The listed features; none where there are none.
    pub hits: Option<Box<Hits>>,
}

impl NeighbourList {
    /// Those of some features that are no farther apart than `near` [m], or `crossing` [m] for an edge
    /// and a face, at positions `x`.
    pub fn of(cloth: &SurfaceView, x: &[Vec3], hits: &Hits, [near, crossing]: [f64; 2]) -> Self {
        let is_near = |pair: Option<FeaturePair>| pair.is_some_and(|pair| within(pair, x, near));
        let some = |hits: &[[u32; 2]], keep: &dyn Fn([u32; 2]) -> bool| -> Vec<[u32; 2]> {
            hits.iter().copied().filter(|&hit| keep(hit)).collect()
        };
        let may_cross = |hit| cloth.are_apart(hit) && edge_within(cloth, x, hit, crossing);
        let listed = Hits {
            vertex_face: some(&hits.vertex_face, &|hit| is_near(cloth.vertex_face(hit))),
            edge_edge: some(&hits.edge_edge, &|hit| is_near(cloth.edge_edge(hit))),
            edge_face: some(&hits.edge_face, &may_cross),
        };
        Self {
            gap: near - ROUNDING,
            crossing_gap: crossing - ROUNDING,
            hits: (!listed.is_empty()).then(|| Box::new(listed)),
        }
    }
}

/// Whether two features are no farther apart than `far` [m]; also where their distance is no number.
fn within(pair: FeaturePair, x: &[Vec3], far: f64) -> bool {
    if is_far(pair, &pair.vertices().map(|v| x[v as usize]), far) {
        return false;
    }
    let distance = Nearness::distance(pair, x);
    distance <= far || distance.is_nan()
}

/// Whether an edge may cross a face, or come no farther from it than `far` [m]: its ends are not both farther
/// from the plane of the face on one side. A face that is hardly more than a line has no plane.
fn edge_within(cloth: &SurfaceView, x: &[Vec3], [e, t]: [u32; 2], far: f64) -> bool {
    let at = |v: u32| x[v as usize];
    let (ends, [p, q, r]) = (
        cloth.edges[e as usize].map(at),
        cloth.triangles[t as usize].map(at),
    );
    let sides = [q - p, r - p];
    let across = sides[0].cross(&sides[1]);
    let square = across.norm_squared();
    let known = square > PARALLEL * sides[0].norm_squared() * sides[1].norm_squared();
    let [a, b] = ends.map(|end| across.dot(&(end - p)));
    let most = (far + ROUNDING) * square.sqrt();
    !(known && (a.min(b) > most || a.max(b) < -most))
}
