//! Solid surfaces that cloth collides with, and vertices with a prescribed motion.

use crate::contact_settings::FIELD_REACH;
use crate::{Motion, Pose};
use nalgebra::Matrix3;
use std::sync::Arc;
use toile_geometry::{ClosestPoint, DistanceField, SurfaceTree, TriangleMesh, Vec3};

/// A solid surface: the exact mesh for counts of crossings, a smooth distance field for forces.
#[derive(Clone)]
pub struct Collider {
    /// The surface with its tree.
    pub surface: Arc<SurfaceTree>,
    /// Smooth signed distance to it.
    pub field: Arc<DistanceField>,
    /// Its motion; none at rest.
    pub motion: Option<Arc<Motion>>,
    /// Corners of its bounding box in its own frame [m].
    corners: [Vec3; 8],
}

/// Cell of a collider's distance field [m]: a third of the radius of the sharpest crease that holds cloth.
const FIELD_CELL: f64 = 6e-3;

impl Collider {
    /// A surface at rest with its distance field, which is sampled only where cloth comes near.
    pub fn new(surface: Arc<SurfaceTree>) -> Self {
        let field = Arc::new(DistanceField::new(surface.clone(), FIELD_CELL, FIELD_REACH));
        Self {
            corners: box_corners(&surface.mesh().positions),
            surface,
            field,
            motion: None,
        }
    }

    /// [`Self::new`] with a motion.
    pub fn moving(surface: Arc<SurfaceTree>, motion: Motion) -> Self {
        Self {
            motion: Some(Arc::new(motion)),
            ..Self::new(surface)
        }
    }

    /// Whether it is the same surface with the same field and an equal motion.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.surface, &other.surface)
            && Arc::ptr_eq(&self.field, &other.field)
            && self.motion == other.motion
    }

    /// Its pose at a time [s]; none without a motion.
    pub fn pose(&self, time: f64) -> Option<Pose> {
        self.motion.as_ref().map(|motion| motion.pose(time))
    }

    /// Smooth signed distance [m] and its gradient at a point [m], under a pose of the surface.
    pub fn distance(&self, pose: Option<&Pose>, point: Vec3) -> Option<(f64, Vec3)> {
        match pose {
            None => self.field.distance(point),
            Some(pose) => {
                let (distance, slope) = self.field.distance(pose.undo(point))?;
                Some((distance, pose.rotation * slope))
            }
        }
    }

    /// Hessian of the smooth distance [1/m] at a point [m], under a pose of the surface.
    pub fn curvature(&self, pose: Option<&Pose>, point: Vec3) -> Option<Matrix3<f64>> {
        match pose {
            None => self.field.curvature(point),
            Some(pose) => {
                let own = self.field.curvature(pose.undo(point))?;
                let rotation = pose.rotation.matrix();
                Some(rotation * own * rotation.transpose())
            }
        }
    }

    /// Bound of the displacement of any point of the surface between two poses [m]: the displacement is affine in the
    /// point, so its norm is largest at a corner of the bounding box.
    pub fn travel(&self, from: &Pose, to: &Pose) -> f64 {
        let displacement = |&corner: &Vec3| (to.apply(corner) - from.apply(corner)).norm();
        self.corners.iter().map(displacement).fold(0.0, f64::max)
    }

    /// Pairs of a triangle of `cloth` and one of the surface at a time [s] that intersect, by exact predicates on
    /// corners rounded to the frame of the solid; the triangle of the cloth comes first.
    pub fn crossings(&self, time: f64, cloth: &TriangleMesh) -> Vec<[u32; 2]> {
        match self.pose(time) {
            None => self.surface.intersections_with(cloth),
            Some(pose) => {
                let positions = cloth.positions.iter().map(|&p| pose.undo(p));
                self.surface.intersections_with(&TriangleMesh {
                    positions: positions.collect(),
                    triangles: cloth.triangles.clone(),
                })
            }
        }
    }

    /// Exact signed distance of a point from the surface [m], under a pose of the surface.
    pub fn exact_distance(&self, pose: Option<&Pose>, point: Vec3) -> f64 {
        let closest = self.closest_point(pose, point);
        closest.map_or(f64::INFINITY, |c| c.signed_distance)
    }

    /// The closest point of the surface, in the frame of the solid, to a point [m] under a pose of the surface; none to
    /// a point that is not finite.
    pub(crate) fn closest_point(&self, pose: Option<&Pose>, point: Vec3) -> Option<ClosestPoint> {
        let point = pose.map_or(point, |pose| pose.undo(point));
        self.surface.closest_point(point, f64::INFINITY)
    }
}

fn box_corners(positions: &[Vec3]) -> [Vec3; 8] {
    let mut low = Vec3::repeat(f64::INFINITY);
    let mut high = Vec3::repeat(f64::NEG_INFINITY);
    for position in positions {
        low = low.inf(position);
        high = high.sup(position);
    }
    let of = |axis: usize, k: usize| [low, high][k >> axis & 1][axis];
    [0, 1, 2, 3, 4, 5, 6, 7].map(|k| Vec3::new(of(0, k), of(1, k), of(2, k)))
}

/// A vertex with a prescribed motion; it is no unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct PrescribedVertex {
    /// The vertex.
    pub vertex: u32,
    /// Its position under the identity pose of the motion [m].
    pub home: Vec3,
    /// The motion.
    pub motion: Arc<Motion>,
}
