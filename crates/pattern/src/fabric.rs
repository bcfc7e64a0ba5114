//! Fabrics to begin with: figures of common cloths, rounded.

use crate::{Fabric, FabricId, Rheology};

impl Fabric {
    /// Cotton poplin: a light, firm plain weave for shirts and skirts. 1.5 m wide.
    pub fn poplin(id: FabricId) -> Self {
        Self {
            id,
            name: "poplin".into(),
            density: 0.12,
            thickness: 0.4e-3,
            stretch: [1500.0, 1200.0],
            shear: 120.0,
            poisson: 0.2,
            bend: [1.0e-5, 0.8e-5, 0.7e-5],
            friction: 0.35,
            width: 1.5,
            nap: false,
            colour: [0.55, 0.68, 0.80],
            rheology: Rheology::default(),
        }
    }

    /// Cotton jersey: a soft knit for T-shirts. 1.5 m wide.
    pub fn jersey(id: FabricId) -> Self {
        Self {
            id,
            name: "jersey".into(),
            density: 0.18,
            thickness: 0.7e-3,
            stretch: [600.0, 450.0],
            shear: 160.0,
            poisson: 0.3,
            bend: [1.2e-5, 1.0e-5, 1.0e-5],
            friction: 0.4,
            width: 1.5,
            nap: false,
            colour: [0.78, 0.36, 0.32],
            rheology: Rheology::default(),
        }
    }
}
