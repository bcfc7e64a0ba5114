//! What a garment's drape is made from, and the world that it is.

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
    /// Panels, not yet merged; the coarsest is placed round the body.
    pub cloth: Cloth,
    /// Vertex pairs the seams join.
    pub stitches: Vec<[u32; 2]>,
    /// Layer of each vertex where several garments are worn, larger numbers farther out; empty for one.
    pub layer: Vec<u16>,
}

/// What a garment's drape is made from.
#[derive(Clone)]
pub struct GarmentSetup {
    /// The same panels ever finer; the last is the garment wanted. Only the first needs to be
    /// placed: the others take over the shape of the one before.
    pub levels: Vec<GarmentLevel>,
    /// Triangles of the last level (one flag each) where strain counts: away from gathers.
    pub counted: Vec<bool>,
    /// The body and other solid surfaces.
    pub colliders: Vec<Arc<SurfaceTree>>,
    /// Contact.
    pub contact: ContactSettings,
    /// Acceleration of gravity [m/s2].
    pub gravity: Vec3,
    /// Sewing.
    pub sew: SewSettings,
    /// The way to rest.
    pub rest: RestSettings,
}

/// Net force over weight at which a coarser level is left.
const COARSE_RESIDUAL: f64 = 2e-2;

impl GarmentLevel {
    /// The layers of its cloth.
    pub(super) fn layers(&self) -> Layers {
        match self.layer.is_empty() {
            true => Layers::One(0),
            false => Layers::Each(self.layer.clone()),
        }
    }

    /// The vertex pairs that its seams join, of the object that it is.
    pub(super) fn seams(&self, object: ObjectId) -> Vec<[MeshVertex; 2]> {
        let of_object = |vertex| MeshVertex { object, vertex };
        let stitches = self.stitches.iter();
        stitches.map(|pair| pair.map(of_object)).collect()
    }
}

/// A garment's world, which object the garment is, and the solids with their distance fields.
pub(super) struct GarmentWorld {
    pub world: World,
    pub garment: ObjectId,
    pub solids: Solids,
}

impl GarmentSetup {
    /// The same with contact as its cloth has it.
    ///
    /// # Errors
    /// No level, contact that reaches too far.
    pub(super) fn prepared(mut self) -> Result<Self, DrapeError> {
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

    /// What acts on panels that are sewn: no gravity, no friction. Layers pass through each other meanwhile; each
    /// is kept off solids by as much more as it lies farther out, so that most of it comes to lie where it belongs.
    pub(super) fn sewing_environment(&self) -> Environment {
        Environment {
            gravity: Vec3::zeros(),
            contact: ContactSettings {
                friction: false,
                cloth_offset: 0.0,
                ..self.contact
            },
            layers_apart: Some(self.contact.cloth_offset),
            ..self.worn_environment()
        }
    }

    /// What acts on the merged garment: gravity and friction.
    pub(super) fn worn_environment(&self) -> Environment {
        Environment {
            gravity: self.gravity,
            air: Air::default(),
            damping: Damping::default(),
            contact: self.contact,
            layers_apart: None,
        }
    }

    /// The solids, and the panels of a level with their seams open, while they are sewn.
    pub(super) fn world(&self, level: usize) -> GarmentWorld {
        let mut world = World::new("garment", self.sewing_environment());
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

    /// The way to rest on a level: a coarser one is left when its large motion is over.
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
