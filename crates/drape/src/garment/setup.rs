//! What a garment's drape is made from, and the systems of its levels.

use crate::merge::{merge_map, merged_layers};
use crate::{
    Cloth, Collider, ContactSettings, DrapeError, RestSettings, SewSettings, System, SystemBuilder,
};
use std::sync::Arc;
use toile_geometry::{SurfaceTree, Vec2, Vec3};

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
    /// New index of every vertex once stitched ones are one, and how many are left.
    pub(super) fn merge_map(&self) -> (Vec<u32>, usize) {
        let pairs = self.stitches.iter().copied();
        merge_map(self.cloth.positions.len(), pairs)
    }
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

    /// Its solid surfaces.
    pub(super) fn solids(&self) -> Vec<Collider> {
        self.colliders.iter().cloned().map(Collider::new).collect()
    }

    /// The panels of a level while they are sewn: no gravity, no friction, layers apart.
    pub(super) fn panels(
        &self,
        level: usize,
        colliders: Vec<Collider>,
    ) -> Result<System, DrapeError> {
        let GarmentLevel { cloth, layer, .. } = &self.levels[level];
        let mut builder = SystemBuilder::new("garment", cloth)?;
        builder.colliders = colliders;
        builder.contact = ContactSettings {
            friction: false,
            cloth_offset: 0.0,
            ..self.contact
        };
        builder.control.gravity = Vec3::zeros();
        // Layers pass through each other meanwhile; so most of each comes to lie where it belongs.
        builder.keep_layers_off(layer, self.contact.cloth_offset);
        Ok(builder.build())
    }

    /// The cloth of a level once it is merged: gravity and friction act.
    pub(super) fn merged(
        &self,
        level: usize,
        cloth: &Cloth,
        colliders: Vec<Collider>,
    ) -> Result<System, DrapeError> {
        let level = &self.levels[level];
        let (target, count) = level.merge_map();
        let mut builder = SystemBuilder::new("garment", cloth)?;
        builder.colliders = colliders;
        builder.contact = self.contact;
        builder.control.gravity = self.gravity;
        builder.layer = merged_layers(&level.layer, &target, count);
        Ok(builder.build())
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

/// Rest shapes of the triangles of the merged cloth from those of its panels.
pub(super) fn merged_shapes(cloth: &Cloth, target: &[u32], rest: &[[Vec2; 3]]) -> Vec<[Vec2; 3]> {
    let merged = cloth.merged_triangles(target);
    merged.into_iter().map(|t| rest[t]).collect()
}
