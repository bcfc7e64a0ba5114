//! Solid surfaces that cloth collides with, and vertices with a prescribed motion.
//!
//! # Decided with
//! - [`toile_geometry::DistanceField`]: smooth distance, for forces;
//! - [`toile_geometry::SurfaceTree`], [`toile_geometry::MeshDefect`], [`toile_geometry::closest_on_face`]:
//!   exact distance, for counts; defects of a mesh;
//! - [`crate::contact_settings::FIELD_REACH`]: how far the field is sampled;
//! - [`crate::motion::Motion`], [`crate::track::Track`]: solids that move rigidly, or vertex by vertex;
//! - [`crate::xpbd`] (`moving_solids.rs`, `carried_plane.rs`): moving solids: XPBD alone follows them;
//! - [`crate::xpbd`] (`skin_contacts.rs`, `skin_edges.rs`): their vertices and edges against faces and edges
//!   of the cloth;
//! - [`crate::world::World::solids`] (`compile.rs`), crate `reference` (`patches/`: `patch_contacts.rs`,
//!   `query_surface`): solids made for the system; patches query the distance field directly;
//! - [`crate::world::Object::check`], [`crate::scene::Scene::check_motions`],
//!   [`crate::method::MethodKind::supports`] (`features.rs`): checks of meshes, motions and methods.
//!
//! Motions in files: crate `interchange`, `scene_motion.rs`. A solid without a mesh answers what is asked
//! here; objects, scenes and garments ask for a mesh.

use crate::contact_settings::FIELD_REACH;
use crate::track::animated_positions;
use crate::{Motion, Pose, SharedTrack};
use nalgebra::Matrix3;
use std::sync::{Arc, OnceLock};
use toile_geometry::{
    ClosestPoint, DistanceField, MovingSurface, SurfaceTree, TriangleMesh, Vec3, triangle_area,
};

/// A solid surface: the exact mesh for counts of crossings, a smooth distance field for forces.
#[derive(Clone)]
pub struct Collider {
    /// The surface with its tree.
    pub surface: Arc<SurfaceTree>,
    /// Smooth signed distance to it.
    pub field: Arc<DistanceField>,
    /// Its motion; none at rest.
    pub motion: Option<Arc<Motion>>,
    /// The way of its vertices before that motion, where they move one by one.
    pub track: Option<SharedTrack>,
    /// Its surface as one that moves, where that was asked for.
    moving: Arc<OnceLock<MovingSurface>>,
}

/// Cell of a collider's distance field (m): a third of the radius of the sharpest crease that holds cloth.
const FIELD_CELL: f64 = 6e-3;

impl Collider {
    /// A surface at rest with its distance field, which is sampled only where cloth comes near.
    pub fn new(surface: Arc<SurfaceTree>) -> Self {
        let field = Arc::new(DistanceField::new(surface.clone(), FIELD_CELL, FIELD_REACH));
        Self {
            surface,
            field,
            motion: None,
            track: None,
            moving: Arc::default(),
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
            && self.track == other.track
    }

    /// Its pose at a time (s); none without a motion.
    pub fn pose(&self, time: f64) -> Option<Pose> {
        self.motion.as_ref().map(|motion| motion.pose(time))
    }

    /// Whether any of it moves at any time.
    pub fn is_moving(&self) -> bool {
        self.motion.is_some() || self.track.is_some()
    }

    /// Places of its vertices at a time (s) (m).
    pub fn positions(&self, time: f64) -> Vec<Vec3> {
        let loaded = &self.surface.mesh().positions;
        animated_positions(loaded, self.track.as_ref(), self.motion.as_deref(), time)
    }

    /// Poses of the frames of its track at a time (s), moved with it as a whole.
    pub fn frames(&self, time: f64) -> Vec<Pose> {
        let Some(track) = &self.track else {
            return Vec::new();
        };
        let frames = track.frames(time);
        match self.pose(time) {
            None => frames,
            Some(whole) => {
                let moved = frames.into_iter().map(|frame| Pose {
                    rotation: whole.rotation * frame.rotation,
                    shift: whole.apply(frame.shift),
                });
                moved.collect()
            }
        }
    }

    /// Its surface as one that moves; the tree over it is built once.
    pub(crate) fn moving_surface(&self) -> MovingSurface {
        let build = || MovingSurface::new(self.surface.mesh());
        self.moving.get_or_init(build).clone()
    }

    /// The surface at a time (s).
    pub fn at(&self, time: f64) -> PlacedSolid<'_> {
        PlacedSolid {
            solid: self,
            pose: self.pose(time),
            tracked: self.track.as_ref().map(|_| {
                let positions = self.positions(time);
                let mut surface = self.moving_surface();
                surface.set_step(&positions, &positions);
                surface
            }),
        }
    }
}

/// A solid at one time.
pub struct PlacedSolid<'a> {
    solid: &'a Collider,
    pose: Option<Pose>,
    /// Its surface where its vertices move one by one.
    tracked: Option<MovingSurface>,
}

impl PlacedSolid<'_> {
    /// Whether it lies where it was loaded.
    pub fn is_at_rest(&self) -> bool {
        self.pose.is_none() && self.tracked.is_none()
    }

    fn to_own(&self, point: Vec3) -> Vec3 {
        self.pose.as_ref().map_or(point, |pose| pose.undo(point))
    }

    /// Signed distance (m) of a point (m) and its gradient: smooth, but exact where vertices move one by one; none far
    /// away.
    pub fn distance(&self, point: Vec3) -> Option<(f64, Vec3)> {
        if let Some(surface) = &self.tracked {
            let closest = surface.closest_point(point, 1.0, FIELD_REACH, None)?;
            return Some((closest.signed_distance, closest.normal));
        }
        let (distance, slope) = self.solid.field.distance(self.to_own(point))?;
        let slope = self
            .pose
            .as_ref()
            .map_or(slope, |pose| pose.rotation * slope);
        Some((distance, slope))
    }

    /// Hessian of the smooth distance (1/m) at a point (m); none where the distance is exact.
    pub fn curvature(&self, point: Vec3) -> Option<Matrix3<f64>> {
        if self.tracked.is_some() {
            return None;
        }
        let own = self.solid.field.curvature(self.to_own(point))?;
        Some(match &self.pose {
            None => own,
            Some(pose) => {
                let rotation = pose.rotation.matrix();
                rotation * own * rotation.transpose()
            }
        })
    }

    /// Pairs of a triangle of `cloth` and one of the surface that intersect, by exact predicates; of a solid that moves
    /// rigidly on corners rounded to its frame. The triangle of the cloth comes first.
    pub fn crossings(&self, cloth: &TriangleMesh) -> Vec<[u32; 2]> {
        match (&self.tracked, &self.pose) {
            (Some(surface), _) => surface.intersections_with(cloth),
            (None, None) => self.solid.surface.intersections_with(cloth),
            (None, Some(pose)) => {
                let positions = cloth.positions.iter().map(|&p| pose.undo(p));
                self.solid.surface.intersections_with(&TriangleMesh {
                    positions: positions.collect(),
                    triangles: cloth.triangles.clone(),
                })
            }
        }
    }

    /// Area of a triangle of a surface whose vertices move one by one, where it is partly inside another part of it (m2).
    pub fn buried_area(&self, triangle: u32) -> Option<f64> {
        let surface = self.tracked.as_ref()?;
        let area = || triangle_area(surface.corners(triangle, 1.0));
        surface.has_buried(triangle, 1.0).then(area)
    }

    /// Exact signed distance of a point from the surface (m).
    pub fn exact_distance(&self, point: Vec3) -> f64 {
        let closest = self.closest_point(point);
        closest.map_or(f64::INFINITY, |c| c.signed_distance)
    }

    /// The closest point of the surface to a point (m), in the frame of a solid that moves rigidly; none to a point that
    /// is not finite.
    pub(crate) fn closest_point(&self, point: Vec3) -> Option<ClosestPoint> {
        match &self.tracked {
            Some(surface) => surface.closest_point(point, 1.0, f64::INFINITY, None),
            None => (self.solid.surface).closest_point(self.to_own(point), f64::INFINITY),
        }
    }
}

/// A vertex with a prescribed motion; it is no unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct PrescribedVertex {
    /// The vertex.
    pub vertex: u32,
    /// Its position under the identity pose of the motion (m).
    pub home: Vec3,
    /// The motion.
    pub motion: Arc<Motion>,
}
