//! A box tree over the triangles of a mesh: which triangles are near, which point is closest,
//! which side of a closed surface a point is on.

use crate::{
    Feature, TriangleMesh, Vec3, closest_point_on_triangle, segment_intersects_triangle,
    triangles_intersect,
};
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::math::Vector;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhNode};

/// A mesh with a box tree and pseudo-normals, for closest point and side queries.
///
/// The side is decided by the angle-weighted pseudo-normal of the closest feature (Baerentzen
/// and Aanaes 2005): exact for a closed, oriented, non-self-crossing surface, with no ray and so
/// no unlucky direction.
pub struct SurfaceTree {
    mesh: TriangleMesh,
    boxes: Bvh,
    face_normals: Vec<Vec3>,
    edge_normals: Vec<[Vec3; 3]>,
    vertex_normals: Vec<Vec3>,
}

/// The closest point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosestPoint {
    /// The point on the surface (m).
    pub point: Vec3,
    /// Distance, negative inside a closed surface (m).
    pub signed_distance: f64,
    /// Outward unit direction: from the surface point to the query point, turned outward; the
    /// pseudo-normal where the two coincide.
    pub normal: Vec3,
    /// The triangle the point lies on.
    pub triangle: u32,
    /// Barycentric weights of the point in that triangle.
    pub weights: [f64; 3],
}

impl ClosestPoint {
    /// What is closest to a point: a triangle with its corners and the weights of its closest point,
    /// and the pseudo-normal there.
    pub(crate) fn of(
        point: Vec3,
        (triangle, corners, weights): (u32, [Vec3; 3], [f64; 3]),
        pseudo_normal: Vec3,
    ) -> Self {
        let on_surface = weighted(corners, weights);
        let offset = point - on_surface;
        let distance = offset.norm();
        let side = if offset.dot(&pseudo_normal) < 0.0 {
            -1.0
        } else {
            1.0
        };
        Self {
            point: on_surface,
            signed_distance: side * distance,
            normal: if distance > 1e-9 {
                offset * (side / distance)
            } else {
                pseudo_normal
            },
            triangle,
            weights,
        }
    }
}

fn vector(p: Vec3) -> Vector {
    Vector::new(p.x, p.y, p.z)
}

fn triangle_box(corners: [Vec3; 3], margin: f64) -> Aabb {
    let low = corners[0].inf(&corners[1]).inf(&corners[2]) - Vec3::repeat(margin);
    let high = corners[0].sup(&corners[1]).sup(&corners[2]) + Vec3::repeat(margin);
    Aabb::new(vector(low), vector(high))
}

fn box_tree(mesh: &TriangleMesh) -> Bvh {
    let leaves: Vec<Aabb> = (0..mesh.triangles.len())
        .map(|t| triangle_box(mesh.corners(t), 0.0))
        .collect();
    Bvh::from_leaves(BvhBuildStrategy::Binned, &leaves)
}

impl SurfaceTree {
    /// Builds the tree of a mesh whose indices are valid ([`TriangleMesh::check`]).
    pub fn new(mesh: TriangleMesh) -> Self {
        let face_normals = mesh.face_normals();
        let topology = mesh.topology();
        let edge_sums: Vec<Vec3> = topology
            .edge_triangles
            .iter()
            .map(|triangles| {
                let sum: Vec3 = triangles.iter().map(|&t| face_normals[t as usize]).sum();
                sum.try_normalize(0.0).unwrap_or_default()
            })
            .collect();
        let edge_normals = mesh
            .triangles
            .iter()
            .map(|&[a, b, c]| {
                [[a, b], [b, c], [c, a]].map(|[p, q]| {
                    topology
                        .edge(p, q)
                        .map_or_else(Vec3::zeros, |e| edge_sums[e])
                })
            })
            .collect();
        Self {
            boxes: box_tree(&mesh),
            vertex_normals: mesh.vertex_normals(),
            face_normals,
            edge_normals,
            mesh,
        }
    }

    /// The mesh the tree was built over.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// Unit pseudo-normals of the vertices.
    pub fn vertex_normals(&self) -> &[Vec3] {
        &self.vertex_normals
    }

    /// Closest point of the surface no farther than `reach` (m). Exact up to rounding.
    pub fn closest_point(&self, point: Vec3, reach: f64) -> Option<ClosestPoint> {
        if !point.iter().all(|x| x.is_finite()) {
            return None;
        }
        let target = vector(point);
        let (triangle, _) = self.boxes.find_best(
            reach,
            |node: &BvhNode, _| {
                let outside = (node.mins() - target)
                    .max(target - node.maxs())
                    .max(Vector::ZERO);
                outside.length()
            },
            |leaf, _| {
                let corners = self.mesh.corners(leaf as usize);
                let (weights, _) = closest_point_on_triangle(point, corners);
                Some((weighted(corners, weights) - point).norm())
            },
        )?;
        Some(self.closest_on(triangle, point))
    }

    /// The closest point of one triangle.
    pub(crate) fn closest_on(&self, triangle: u32, point: Vec3) -> ClosestPoint {
        let t = triangle as usize;
        let corners = self.mesh.corners(t);
        let (weights, feature) = closest_point_on_triangle(point, corners);
        let pseudo_normal = match feature {
            Feature::Corner(k) => self.vertex_normals[self.mesh.triangles[t][k] as usize],
            Feature::Edge(k) => self.edge_normals[t][k],
            Feature::Face => self.face_normals[t],
        };
        ClosestPoint::of(point, (triangle, corners, weights), pseudo_normal)
    }

    /// Whether a point lies inside the closed surface.
    pub fn contains(&self, point: Vec3) -> bool {
        self.closest_point(point, f64::INFINITY)
            .is_some_and(|c| c.signed_distance < 0.0)
    }

    /// Triangles whose boxes come within `margin` (m) of the box from `low` to `high` (m).
    pub fn near_box(&self, low: Vec3, high: Vec3, margin: f64) -> Vec<u32> {
        let query = Aabb::new(
            vector(low - Vec3::repeat(margin)),
            vector(high + Vec3::repeat(margin)),
        );
        self.boxes.intersect_aabb(&query).collect()
    }

    /// Pairs (triangle of `other`, triangle of this surface) that intersect, exactly, sorted.
    pub fn intersections_with(&self, other: &TriangleMesh) -> Vec<[u32; 2]> {
        let mut pairs = Vec::new();
        for t in 0..other.triangles.len() {
            let corners = other.corners(t);
            for near in self.boxes.intersect_aabb(&triangle_box(corners, 0.0)) {
                if triangles_intersect(corners, self.mesh.corners(near as usize)) {
                    pairs.push([t as u32, near]);
                }
            }
        }
        pairs.sort_unstable();
        pairs
    }

    /// Pairs of this mesh's own triangles that intersect, exactly, sorted. Two that share a vertex do
    /// where the side opposite to it of one meets the other; two that share a side do not.
    pub fn self_intersections(&self) -> Vec<[u32; 2]> {
        let mut pairs = Vec::new();
        for t in 0..self.mesh.triangles.len() {
            for near in (self.boxes).intersect_aabb(&triangle_box(self.mesh.corners(t), 0.0)) {
                if near as usize > t && self.own_meet([t, near as usize]) {
                    pairs.push([t as u32, near]);
                }
            }
        }
        pairs.sort_unstable();
        pairs
    }

    fn own_meet(&self, pair: [usize; 2]) -> bool {
        let [first, second] = pair.map(|t| self.mesh.triangles[t]);
        let [corners, others] = pair.map(|t| self.mesh.corners(t));
        let shared = |k: &usize| second.contains(&first[*k]);
        let mut common = (0..3).filter(shared);
        match (common.next(), common.next()) {
            (None, _) => triangles_intersect(corners, others),
            (Some(k), None) => {
                let opposite = |c: [Vec3; 3], k: usize| [c[(k + 1) % 3], c[(k + 2) % 3]];
                let other = (0..3).find(|&j| second[j] == first[k]).unwrap_or(0);
                segment_intersects_triangle(opposite(corners, k), others)
                    || segment_intersects_triangle(opposite(others, other), corners)
            }
            _ => false,
        }
    }
}

pub(crate) fn weighted(corners: [Vec3; 3], weights: [f64; 3]) -> Vec3 {
    corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::tests::cube;

    #[test]
    fn sides_and_distances_of_a_cube() {
        let tree = SurfaceTree::new(cube());
        for k in 0..500 {
            let s = f64::from(k);
            let p = Vec3::new((s * 0.731).sin(), (s * 1.37).sin(), (s * 2.11).sin())
                + Vec3::repeat(0.5);
            let outside = (p - Vec3::repeat(1.0)).sup(&(-p));
            let inside = outside.max();
            let expected = if inside < 0.0 {
                inside
            } else {
                outside.sup(&Vec3::zeros()).norm()
            };
            let got = tree.closest_point(p, 10.0).expect("a cube is not empty");
            assert!(
                (got.signed_distance - expected).abs() < 1e-12,
                "{p:?} {got:?} {expected}"
            );
        }
        assert!(tree.closest_point(Vec3::repeat(f64::NAN), 10.0).is_none());
        assert!(
            tree.closest_point(Vec3::repeat(9.0), 1.0).is_none(),
            "out of reach"
        );
    }

    #[test]
    fn intersections_equal_brute_force() {
        let mut moved = cube();
        for p in &mut moved.positions {
            *p = *p * 0.7 + Vec3::new(0.41, 0.37, 0.53);
        }
        let tree = SurfaceTree::new(cube());
        let mut expected = Vec::new();
        for a in 0..12 {
            for b in 0..12 {
                if triangles_intersect(moved.corners(a), tree.mesh().corners(b)) {
                    expected.push([a as u32, b as u32]);
                }
            }
        }
        assert!(!expected.is_empty());
        assert_eq!(tree.intersections_with(&moved), expected);
        assert_eq!(tree.self_intersections(), Vec::<[u32; 2]>::new());
    }

    #[test]
    fn a_free_corner_folded_through_its_neighbour_is_counted() {
        // Two triangles with one vertex in common; the free side of one goes through the other.
        let mesh = TriangleMesh {
            positions: [
                [0.0, 0.0, 0.0],
                [1.0, 0.0, -0.5],
                [1.0, 0.0, 0.5],
                [-1.5, -0.3, 0.0],
                [-1.5, 0.3, 0.0],
            ]
            .map(Vec3::from)
            .to_vec(),
            triangles: vec![[0, 1, 2], [0, 3, 4]],
        };
        let open = SurfaceTree::new(mesh.clone());
        assert!(open.self_intersections().is_empty());
        for far in [-1.0, -2.0] {
            let mut folded = mesh.clone();
            folded.positions[1] *= far;
            folded.positions[2] *= far;
            assert_eq!(SurfaceTree::new(folded).self_intersections(), [[0, 1]]);
        }
    }
}
