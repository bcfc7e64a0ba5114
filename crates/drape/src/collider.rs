//! Solid surfaces that cloth meets, and vertices that are led.

use crate::contact_settings::FIELD_REACH;
use crate::{Motion, Pose};
use nalgebra::Matrix3;
use std::sync::Arc;
use toile_geometry::{DistanceField, SurfaceTree, TriangleMesh, Vec3};

/// A solid surface: exact for counting, smooth for forces.
#[derive(Clone)]
pub struct Collider {
    /// The surface with its tree.
    pub surface: Arc<SurfaceTree>,
    /// Smooth signed distance to it.
    pub field: Arc<DistanceField>,
    /// How it moves; nothing when it stands.
    pub motion: Option<Arc<Motion>>,
    /// Corners of the box round it as loaded [m].
    corners: [Vec3; 8],
}

/// Cells of a collider's distance field [m]: a third of the sharpest crease cloth is held in.
const FIELD_CELL: f64 = 6e-3;

impl Collider {
    /// Lays a distance field over a surface; it is sampled where cloth comes near.
    pub fn new(surface: Arc<SurfaceTree>) -> Self {
        let field = Arc::new(DistanceField::new(surface.clone(), FIELD_CELL, FIELD_REACH));
        Self {
            corners: box_corners(&surface.mesh().positions),
            surface,
            field,
            motion: None,
        }
    }

    /// The same on the move.
    pub fn moving(surface: Arc<SurfaceTree>, motion: Motion) -> Self {
        Self {
            motion: Some(Arc::new(motion)),
            ..Self::new(surface)
        }
    }

    /// Whether it is the same surface with the same field, moved alike.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.surface, &other.surface)
            && Arc::ptr_eq(&self.field, &other.field)
            && self.motion == other.motion
    }

    /// Where it stands at a time [s]; nothing when it never moves.
    pub fn pose(&self, time: f64) -> Option<Pose> {
        self.motion.as_ref().map(|motion| motion.pose(time))
    }

    /// Smooth signed distance [m] and its gradient at a place, the surface standing as given.
    pub fn distance(&self, pose: Option<&Pose>, place: Vec3) -> Option<(f64, Vec3)> {
        match pose {
            None => self.field.distance(place),
            Some(pose) => {
                let (distance, slope) = self.field.distance(pose.undo(place))?;
                Some((distance, pose.rotation * slope))
            }
        }
    }

    /// Second derivative of the distance [1/m], likewise.
    pub fn curvature(&self, pose: Option<&Pose>, place: Vec3) -> Option<Matrix3<f64>> {
        match pose {
            None => self.field.curvature(place),
            Some(pose) => {
                let own = self.field.curvature(pose.undo(place))?;
                let turn = pose.rotation.matrix();
                Some(turn * own * turn.transpose())
            }
        }
    }

    /// How far any point of the surface moves between two placings [m], from the corners of its
    /// box: the way is largest at one of them, being affine in the point.
    pub fn travel(&self, from: &Pose, to: &Pose) -> f64 {
        let way = |&corner: &Vec3| (to.apply(corner) - from.apply(corner)).norm();
        self.corners.iter().map(way).fold(0.0, f64::max)
    }

    /// Pairs of a triangle of the surface as it stands at a time [s] and one of `cloth` that
    /// intersect, exactly for corners rounded to the body's own frame; the cloth's comes first.
    pub fn crossings(&self, time: f64, cloth: &TriangleMesh) -> Vec<[u32; 2]> {
        match self.pose(time) {
            None => self.surface.intersections_with(cloth),
            Some(pose) => {
                let places = cloth.positions.iter().map(|&p| pose.undo(p));
                self.surface.intersections_with(&TriangleMesh {
                    positions: places.collect(),
                    triangles: cloth.triangles.clone(),
                })
            }
        }
    }

    /// Exact signed distance [m] of a place from the surface as it stands at a time [s].
    pub fn exact_distance(&self, pose: Option<&Pose>, place: Vec3) -> f64 {
        let place = pose.map_or(place, |pose| pose.undo(place));
        let closest = self.surface.closest_point(place, f64::INFINITY);
        closest.map_or(f64::INFINITY, |c| c.signed_distance)
    }
}

fn box_corners(positions: &[Vec3]) -> [Vec3; 8] {
    let mut low = Vec3::repeat(f64::INFINITY);
    let mut high = Vec3::repeat(f64::NEG_INFINITY);
    for place in positions {
        low = low.inf(place);
        high = high.sup(place);
    }
    let of = |axis: usize, k: usize| [low, high][k >> axis & 1][axis];
    [0, 1, 2, 3, 4, 5, 6, 7].map(|k| Vec3::new(of(0, k), of(1, k), of(2, k)))
}

/// A vertex whose motion is prescribed: it is pinned, and led along a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct PrescribedVertex {
    /// The vertex.
    pub vertex: u32,
    /// Where it was loaded [m].
    pub home: Vec3,
    /// The motion.
    pub motion: Arc<Motion>,
}
