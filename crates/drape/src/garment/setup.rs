//! The setup of a garment's run, and the world made from it.

use crate::world::{Layers, MeshVertex, Object, ObjectId, Solids, World};
use crate::{
    Air, Cloth, Collider, ContactSettings, Damping, DrapeError, Environment, RestSettings,
    SewSettings,
};
use std::sync::Arc;
use toile_geometry::{SurfaceTree, Vec3};

/// One mesh of a garment's panels and how it is sewn.
#[derive(Clone, Debug, Default)]
pub struct GarmentLevel {
    /// Unmerged panels; those of the coarsest level are placed round the body.
    pub cloth: Cloth,
    /// Vertex pairs that the seams join.
    pub stitches: Vec<[u32; 2]>,
    /// Layer of each vertex where several garments are worn, larger numbers farther out; empty for one garment.
    pub layer: Vec<u16>,
}

/// The setup of a garment's run.
#[derive(Clone)]
pub struct GarmentSetup {
    /// Meshes of the same panels, from coarse to fine; the last is that of the result. Only the first needs placed
    /// panels: each other starts in the shape that the one before reached.
    pub levels: Vec<GarmentLevel>,
    /// One flag for each triangle of the last level: whether its strain counts, as it does away from gathers.
    pub counted: Vec<bool>,
    /// The body and other solid surfaces.
    pub colliders: Vec<Arc<SurfaceTree>>,
    /// Contact settings.
    pub contact: ContactSettings,
    /// Acceleration of gravity (m/s2).
    pub gravity: Vec3,
    /// Sewing settings.
    pub sew: SewSettings,
    /// Settings of pseudo-transient continuation.
    pub rest: RestSettings,
}

/// Net force over weight at which a level other than the last is finished.
const COARSE_RESIDUAL: f64 = 2e-2;

impl GarmentLevel {
    /// The layers of its cloth.
    pub(super) fn layers(&self) -> Layers {
        match self.layer.is_empty() {
            true => Layers::One(0),
            false => Layers::Each(self.layer.clone()),
        }
    }

    /// The vertex pairs that its seams join, as vertices of the garment's object.
    pub(super) fn seams(&self, object: ObjectId) -> Vec<[MeshVertex; 2]> {
        let of_object = |vertex| MeshVertex { object, vertex };
        let stitches = self.stitches.iter();
        stitches.map(|pair| pair.map(of_object)).collect()
    }
}

/// A garment's world, the garment's object, and the solids with their distance fields.
pub(super) struct GarmentWorld {
    pub world: World,
    pub garment: ObjectId,
    pub solids: Solids,
}

impl GarmentLevel {
    /// Leaves restitution out of the materials.
    pub(super) fn leave_out_restitution(&mut self) {
        for material in &mut self.cloth.materials {
            material.restitution = None;
        }
    }
}

impl GarmentSetup {
    /// The setup with contact offsets enlarged for the thickness of its cloth, which has no restitution: on the way to
    /// rest impacts do not matter.
    ///
    /// # Errors
    /// No level, contact that reaches too far.
    pub(super) fn prepared(mut self) -> Result<Self, DrapeError> {
        self.levels
            .iter_mut()
            .for_each(GarmentLevel::leave_out_restitution);
        let Some(first) = self.levels.first() else {
            return Err(DrapeError::Scene {
                place: "garment".to_owned(),
                what: "it has no mesh".to_owned(),
                remedy: "give at least one level".to_owned(),
            });
        };
        self.contact = self.contact.for_cloth(&first.cloth.materials);
        self.contact.check_reach("thickness of the fabrics")?;
        Ok(self)
    }

    /// The environment of sewing round solids thinner by `recess` (m): no gravity, no friction. Layers pass through each other; the contact offset from
    /// solids grows with the layer, so that most of each comes to lie in order.
    pub(super) fn sewing_environment(&self, recess: f64) -> Environment {
        Environment {
            gravity: Vec3::zeros(),
            contact: ContactSettings {
                friction: false,
                cloth_offset: 0.0,
                ..self.contact
            },
            layers_apart: Some(self.contact.cloth_offset),
            ..self.worn_environment(recess)
        }
    }

    /// The environment of the merged garment round solids thinner by `recess` (m): gravity and friction.
    pub(super) fn worn_environment(&self, recess: f64) -> Environment {
        Environment {
            gravity: self.gravity,
            air: Air::default(),
            damping: Damping::default(),
            contact: self.contact,
            layers_apart: None,
            recess,
        }
    }

    /// The world of sewing: the solids, thinner by `recess` (m), and the panels of a level with open seams.
    pub(super) fn world(&self, level: usize, recess: f64) -> GarmentWorld {
        let mut world = World::new("garment", self.sewing_environment(recess));
        let mut solids = Solids::new();
        for (index, surface) in self.colliders.iter().enumerate() {
            let solid = Object::fixed(format!("solid {index}"), surface.mesh().clone());
            let (mesh, collider) = (solid.mesh.clone(), Collider::new(surface.clone()));
            solids.insert(world.insert(solid), (mesh, collider));
        }
        let level = &self.levels[level];
        let garment = world.insert(Object {
            layers: level.layers(),
            ..Object::deformable("garment", level.cloth.clone())
        });
        GarmentWorld {
            world,
            garment,
            solids,
        }
    }

    /// Settings of pseudo-transient continuation on a level; a coarser level ends at a larger residual.
    pub(super) fn rest_on(&self, level: usize) -> RestSettings {
        match level + 1 == self.levels.len() {
            true => self.rest,
            false => RestSettings {
                residual: self.rest.residual.max(COARSE_RESIDUAL),
                ..self.rest
            },
        }
    }
}
