//! Order of cloths worn one over another: vertices on the wrong side of a layer, edges that cross one, and the
//! direction of recovery for both. The outside of a cloth is the side of its triangles' normals; the cloth with the
//! larger layer number belongs on the outside of the other.
//!
//! # Decided with
//! - [`crate::world::World::layers`] (`compile.rs`), [`crate::merge::merged_layers`]: layer of a vertex, of
//!   merged ones;
//! - [`crate::collision::layer_order::layer_order`]: which of two lies outside;
//! - [`crate::collision`] (`recovery.rs`, `violation_pull`): pull back to the right side;
//! - [`crate::system::SystemBuilder::offset_layers`], [`crate::garment::GarmentSetup::sewing_environment`]:
//!   panels apart by layers while sewn;
//! - [`crate::measure`](mod@crate::measure) (`by_layer`): vertices on the wrong side, counted;
//! - [`crate::scene::Scene::check_layers`], [`crate::world::World::check`]: layers that are refused.

use super::intersections::{CrossingGeometry, EdgeFaceIntersection, area_vector};
use super::layer_order::{BETWEEN_LAYERS, layer_order};
use super::surface::ClothSurface;
use crate::PairPolicies;
use rayon::prelude::*;
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};
use toile_geometry::{ClosestPoint, SurfaceTree, TriangleMesh, Vec3};

/// A vertex of an outer cloth on the inside of an inner one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerViolation {
    /// The vertex.
    pub vertex: u32,
    /// The face of the inner cloth nearest to the vertex.
    pub face: [u32; 3],
    /// Barycentric weights of the closest point on the face.
    pub weights: [f64; 3],
    /// Unit direction from the vertex to the closest point: outwards.
    pub direction: Vec3,
    /// Distance from the vertex to the closest point (m).
    pub depth: f64,
}

/// The layers of a surface, innermost first.
pub fn layers_of(surface: &ClothSurface) -> Vec<u16> {
    let mut layers = surface.layer.clone();
    layers.retain(|&layer| layer != BETWEEN_LAYERS);
    layers.sort_unstable();
    layers.dedup();
    layers
}

/// Every vertex of an outer layer that lies on the inside of an inner one within `reach` (m) of it, in order of inner
/// layers and vertices. A vertex whose closest point is on the border of a cloth is on neither side of it. Objects
/// that ignore each other have no order.
pub fn layer_violations(
    surface: &ClothSurface,
    policies: &PairPolicies,
    x: &[Vec3],
    reach: f64,
) -> Vec<LayerViolation> {
    let layers = layers_of(surface);
    let mut found = Vec::new();
    for &inner in layers.iter().rev().skip(1).rev() {
        match policies.ignored().is_empty() {
            true => layer_violations_of(surface, inner, x, reach, &mut found),
            false => found.extend(violations_between_objects(
                surface,
                policies,
                inner,
                (x, reach),
            )),
        }
    }
    found
}

/// [`layer_violations`] of one inner layer without regard to policies, appended to `found`.
pub fn layer_violations_of(
    surface: &ClothSurface,
    inner: u16,
    x: &[Vec3],
    reach: f64,
    found: &mut Vec<LayerViolation>,
) {
    let faces = faces_of(surface, inner).collect();
    let is_outer = |v: usize| is_outside(surface, inner, v);
    found.extend(vertices_inside(surface, faces, is_outer, x, reach));
}

/// [`layer_violations`] of one inner layer under policies: one search for each set of objects that ignore the same
/// others, against the faces of the objects that they do not ignore.
fn violations_between_objects(
    surface: &ClothSurface,
    policies: &PairPolicies,
    inner: u16,
    (x, reach): (&[Vec3], f64),
) -> Vec<LayerViolation> {
    let object_of = |v: usize| policies.object_of(&[v as u32]);
    let outer = (0..x.len()).filter(|&v| is_outside(surface, inner, v));
    let objects: BTreeSet<Option<u16>> = outer.map(object_of).collect();
    let mut alike: BTreeMap<Vec<u16>, Vec<Option<u16>>> = BTreeMap::new();
    for object in objects {
        let ignored = object.map_or_else(Vec::new, |object| policies.ignored_by(object));
        alike.entry(ignored).or_default().push(object);
    }
    let mut found = Vec::new();
    for (ignored, objects) in alike {
        let meets = |face: &[u32; 3]| {
            let object = policies.object_of(face);
            object.is_none_or(|object| ignored.binary_search(&object).is_err())
        };
        let faces = faces_of(surface, inner).filter(meets).collect();
        let is_outer = |v: usize| is_outside(surface, inner, v) && objects.contains(&object_of(v));
        found.extend(vertices_inside(surface, faces, is_outer, x, reach));
    }
    found.sort_by_key(|violation| violation.vertex);
    found
}

/// The faces of a layer.
fn faces_of(surface: &ClothSurface, layer: u16) -> impl Iterator<Item = [u32; 3]> {
    let is_of = move |face: &[u32; 3]| face.iter().all(|&v| surface.layer[v as usize] == layer);
    surface.triangles.iter().copied().filter(is_of)
}

/// Whether a vertex belongs outside of a layer.
fn is_outside(surface: &ClothSurface, inner: u16, v: usize) -> bool {
    let layer = surface.layer[v];
    layer > inner && layer != BETWEEN_LAYERS
}

/// Outer vertices on the inside of some faces within `reach` (m) of them, in order.
fn vertices_inside(
    surface: &ClothSurface,
    faces: Vec<[u32; 3]>,
    is_outer: impl Fn(usize) -> bool + Sync,
    x: &[Vec3],
    reach: f64,
) -> Vec<LayerViolation> {
    if faces.is_empty() {
        return Vec::new();
    }
    let tree = SurfaceTree::new(TriangleMesh {
        positions: x.to_vec(),
        triangles: faces,
    });
    let each = (0..x.len()).into_par_iter().with_min_len(64);
    let violations: Vec<Option<LayerViolation>> = each
        .map(|v| {
            let closest = is_outer(v).then(|| tree.closest_point(x[v], reach))??;
            let face = tree.mesh().triangles[closest.triangle as usize];
            if closest.signed_distance >= 0.0 || on_border(surface, face, &closest) {
                return None;
            }
            Some(LayerViolation {
                vertex: v as u32,
                face,
                weights: closest.weights,
                direction: closest.normal,
                depth: -closest.signed_distance,
            })
        })
        .collect();
    violations.into_iter().flatten().collect()
}

/// Whether the closest point lies on an edge with a triangle on one side only.
fn on_border(surface: &ClothSurface, face: [u32; 3], closest: &ClosestPoint) -> bool {
    let corners: Vec<u32> = (0..3)
        .filter(|&k| closest.weights[k] > 0.0)
        .map(|k| face[k])
        .collect();
    match corners[..] {
        [v] => surface.border[v as usize],
        [a, b] => surface
            .edges
            .binary_search(&[a.min(b), a.max(b)])
            .is_ok_and(|e| surface.edge_triangles[e].len() < 2),
        _ => false,
    }
}

/// The intersections of two layers (edge and face) with the direction given by their order: an edge of the outer layer
/// moves along the normal of the face that it crosses; an edge of the inner layer moves against the mean normal of
/// its own triangles.
pub fn layer_crossings(
    surface: &ClothSurface,
    crossings: &[[u32; 2]],
    x: &[Vec3],
) -> Vec<EdgeFaceIntersection> {
    let each = crossings.iter();
    each.filter_map(|&[e, t]| order_direction(surface, e as usize, t as usize, x))
        .collect()
}

/// The intersection of two layers with the direction that restores their order; none between features without an
/// order.
fn order_direction(
    surface: &ClothSurface,
    e: usize,
    t: usize,
    x: &[Vec3],
) -> Option<EdgeFaceIntersection> {
    let crossing = CrossingGeometry::new(surface, e, t, x)?;
    let direction = match layer_order(&surface.layer, crossing.edge[0], crossing.face[0]) {
        Ordering::Equal => return None,
        Ordering::Greater => crossing.normal,
        Ordering::Less => {
            let faces = surface.edge_triangles[e].iter();
            let sum: Vec3 = faces
                .map(|&t| area_vector(surface.triangles[t as usize].map(|v| x[v as usize])))
                .sum();
            -sum.try_normalize(0.0)?
        }
    };
    Some(crossing.with_direction(direction))
}

#[cfg(test)]
mod tests {
    use super::super::trajectories::LinearTrajectories;
    use super::*;
    use crate::BETWEEN_OBJECTS;

    /// Two squares of two triangles, the second `height` (m) above the first; normals point up.
    fn squares(height: f64) -> (ClothSurface, Vec<Vec3>) {
        let mut mesh = TriangleMesh::default();
        for (k, y) in [0.0, height].into_iter().enumerate() {
            let inset = 0.2 * k as f64;
            let (low, high) = (inset, 1.0 - inset);
            let flat = [[low, low], [low, high], [high, high], [high, low]];
            (mesh.positions).extend(flat.map(|[x, z]| Vec3::new(x, y, z)));
            let first = 4 * k as u32;
            (mesh.triangles).extend([[0, 1, 2], [0, 2, 3]].map(|t| t.map(|v: u32| v + first)));
        }
        let mut surface = ClothSurface::of_mesh(&mesh);
        surface.layer = vec![1, 1, 1, 1, 2, 2, 2, 2];
        (surface, mesh.positions)
    }

    fn violations(surface: &ClothSurface, x: &[Vec3], reach: f64) -> Vec<LayerViolation> {
        layer_violations(surface, &PairPolicies::default(), x, reach)
    }

    #[test]
    fn cloth_that_ignores_the_inner_layer_does_not_violate_the_order() {
        let (surface, x) = squares(-0.1);
        let all = violations(&surface, &x, 0.5);
        let found = |ignored: &[[u16; 2]]| {
            // The last vertex of the upper square belongs to several objects.
            let objects = vec![0, 0, 0, 0, 1, 1, 2, BETWEEN_OBJECTS];
            let policies = PairPolicies::new(objects, ignored.to_vec(), []);
            layer_violations(&surface, &policies, &x, 0.5)
        };
        assert_eq!(found(&[[1, 2]]), all, "none ignores the inner one");
        assert_eq!(found(&[[0, 1]]), all[2..]);
        assert_eq!(found(&[[0, 2]]), [all[0], all[1], all[3]]);
        assert_eq!(found(&[[0, 1], [0, 2]]), all[3..]);
    }

    #[test]
    fn cloth_beneath_the_inner_layer_violates_the_order() {
        let (surface, x) = squares(0.1);
        assert!(violations(&surface, &x, 0.5).is_empty());
        let (mut surface, x) = squares(-0.1);
        let found = violations(&surface, &x, 0.5);
        assert_eq!(found.len(), 4);
        for violation in &found {
            assert!(violation.vertex >= 4 && violation.face.iter().all(|&v| v < 4));
            assert!((violation.direction - Vec3::y()).norm() < 1e-12);
            assert!((violation.depth - 0.1).abs() < 1e-12);
        }
        assert!(violations(&surface, &x, 0.05).is_empty(), "out of reach");
        // The opposite order, and one layer.
        surface.layer = vec![3, 3, 3, 3, 2, 2, 2, 2];
        assert!(violations(&surface, &x, 0.5).is_empty());
        surface.layer = vec![2; 8];
        assert!(violations(&surface, &x, 0.5).is_empty());
    }

    #[test]
    fn a_vertex_beyond_the_border_is_on_neither_side() {
        let (surface, mut x) = squares(-0.1);
        for p in &mut x[4..] {
            p.x += 2.0;
        }
        assert!(violations(&surface, &x, 5.0).is_empty());
    }

    #[test]
    fn crossings_of_layers_move_the_outer_one_outwards() {
        let (mut surface, mut x) = squares(0.1);
        x[4].y = -0.1;
        let near = surface.near_leaves(LinearTrajectories::still(&x), 0.0);
        let crossed = super::super::intersections::crossings(&surface, &near, &x);
        let found = layer_crossings(&surface, &crossed, &x);
        assert!(!found.is_empty() && found.len() == crossed.len());
        for crossing in &found {
            let upwards = if crossing.vertices[0] >= 4 { 1.0 } else { -1.0 };
            assert!(crossing.direction.y * upwards > 0.5, "{crossing:?}");
            assert!(crossing.weights.iter().sum::<f64>().abs() < 1e-12);
        }
    }

    #[test]
    fn vertices_of_several_layers_have_no_order() {
        let layer = [0, 1, BETWEEN_LAYERS];
        assert_eq!(layer_order(&layer, 0, 1), Ordering::Less);
        assert_eq!(layer_order(&layer, 1, 0), Ordering::Greater);
        assert_eq!(layer_order(&layer, 1, 2), Ordering::Equal);
        assert_eq!(layer_order(&[], 0, 1), Ordering::Equal);
    }
}
