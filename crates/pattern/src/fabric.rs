//! Fabrics: what cloth panels are cut from.
//!
//! # Decided with
//! - [`toile_fabric::FIGURES`]: keys, units, domains and ranges of all figures of the material;
//! - [`crate::plan::FabricFigure`]: the numbers that the window's table changes;
//! - `record.rs` beside this file: how journals write a fabric.

mod record;
mod visit;

use crate::fields::{ValueField, group, key};
use crate::{FabricId, fields};
use toile_fabric::Material;
use visit::{Presence, VisitFigures};

/// A fabric of the document: a material, and the roll that it comes on.
#[derive(Clone, Debug, PartialEq)]
pub struct Fabric {
    /// Identifier of the fabric.
    pub id: FabricId,
    /// Name to show.
    pub name: String,
    /// The material: the figures of the cloth.
    pub material: Material,
    /// Width of the roll (m).
    pub width: f64,
    /// Whether the cloth has a nap, so that all pieces must point one way.
    pub nap: bool,
    /// Base colour, sRGB 0..=1.
    pub colour: [f64; 3],
}

impl Default for Fabric {
    fn default() -> Self {
        Self {
            id: FabricId::default(),
            name: String::new(),
            material: Material::default(),
            width: 0.0,
            nap: false,
            colour: [0.8; 3],
        }
    }
}

fields!(Fabric, |self, v| {
    let Self {
        id,
        name,
        material,
        width,
        nap,
        colour: [red, green, blue],
    } = self;
    v.own(id);
    v.value(ValueField::NAME, name);
    material.visit_figures(Presence::Always, v);
    v.value(key("width_m"), width);
    v.value(key("nap").may_lack(), nap);
    v.list(group("colour").may_lack(), &mut |v| {
        v.value(key("red"), red);
        v.value(key("green"), green);
        v.value(key("blue"), blue);
    });
    material.visit_figures(Presence::UnlessDefault, v);
});

impl Fabric {
    /// Cotton poplin: a light, firm plain weave for shirts and skirts. 1.5 m wide.
    pub fn poplin(id: FabricId) -> Self {
        Self {
            id,
            name: "poplin".into(),
            material: Material {
                density: 0.12,
                thickness: 0.4e-3,
                stretch: [1500.0, 1200.0],
                shear: 120.0,
                poisson: 0.2,
                bend: [1.0e-5, 0.8e-5, 0.7e-5],
                friction: 0.35,
                ..Material::default()
            },
            width: 1.5,
            nap: false,
            colour: [0.55, 0.68, 0.80],
        }
    }
}
