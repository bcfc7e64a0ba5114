//! The fabric that a new pattern begins with: rounded figures of a common cloth.

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
}
