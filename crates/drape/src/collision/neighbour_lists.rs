//! Neighbour lists: pairs of near features of two leaves, which stay complete while vertices move little
//! (Verlet 1967).

use super::feature_pair::FeaturePair;
use super::leaf_aabbs::Hits;
use super::nearness::{Nearness, PARALLEL, is_far};
use super::surface_view::SurfaceView;
use toile_geometry::Vec3;

/// Bound of the rounding error in the distance of two boxes or two features (m).
pub const ROUNDING: f64 = 1e-9;

/// Pairs of features of two leaves, or of one leaf, that were near each other when the list was made.
#[derive(Clone, Debug)]
pub struct NeighbourList {
    /// Pairs of a vertex and a face, and of two edges, that are not listed were farther apart than this (m).
    pub gap: f64,
    /// An edge and a face that are not listed did not cross when both were moved by less than half of this (m).
    pub crossing_gap: f64,
    /// Listed pairs; none where the list is empty.
    pub hits: Option<Box<Hits>>,
}

impl NeighbourList {
    /// Lists those of some pairs that are no farther apart than `near` (m) at positions `x`, or `crossing` (m) for
    /// an edge and a face.
    pub fn of(cloth: &SurfaceView, x: &[Vec3], hits: &Hits, [near, crossing]: [f64; 2]) -> Self {
        let is_near = |pair: Option<FeaturePair>| pair.is_some_and(|pair| within(pair, x, near));
        let chosen = |hits: &[[u32; 2]], is_chosen: &dyn Fn([u32; 2]) -> bool| -> Vec<[u32; 2]> {
            hits.iter().copied().filter(|&hit| is_chosen(hit)).collect()
        };
        let may_cross = |hit| cloth.are_disjoint(hit) && edge_within(cloth, x, hit, crossing);
        let listed = Hits {
            vertex_face: chosen(&hits.vertex_face, &|hit| is_near(cloth.vertex_face(hit))),
            edge_edge: chosen(&hits.edge_edge, &|hit| is_near(cloth.edge_edge(hit))),
            edge_face: chosen(&hits.edge_face, &may_cross),
        };
        Self {
            gap: near - ROUNDING,
            crossing_gap: crossing - ROUNDING,
            hits: (!listed.is_empty()).then(|| Box::new(listed)),
        }
    }
}

/// Whether two features are no farther apart than `reach` (m); also true where their distance is NaN.
fn within(pair: FeaturePair, x: &[Vec3], reach: f64) -> bool {
    if is_far(pair, &pair.vertices().map(|v| x[v as usize]), reach) {
        return false;
    }
    let distance = Nearness::distance(pair, x);
    distance <= reach || distance.is_nan()
}

/// Whether an edge may come within `reach` (m) of crossing a face: its ends are not both farther than that from the
/// plane of the face on one side. A nearly degenerate face has no plane, and any edge may cross it.
fn edge_within(cloth: &SurfaceView, x: &[Vec3], [e, t]: [u32; 2], reach: f64) -> bool {
    let at = |v: u32| x[v as usize];
    let (ends, [p, q, r]) = (
        cloth.edges[e as usize].map(at),
        cloth.triangles[t as usize].map(at),
    );
    let sides = [q - p, r - p];
    let normal = sides[0].cross(&sides[1]);
    let square = normal.norm_squared();
    let has_plane = square > PARALLEL * sides[0].norm_squared() * sides[1].norm_squared();
    let [a, b] = ends.map(|end| normal.dot(&(end - p)));
    let limit = (reach + ROUNDING) * square.sqrt();
    !(has_plane && (a.min(b) > limit || a.max(b) < -limit))
}
