//! Fabrics: what cloth panels are cut from.

use crate::fields::{ValueField, group, key};
use crate::{FabricId, fields};
use serde::{Deserialize, Serialize};

/// Properties of a fabric, in SI units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fabric {
    /// The fabric of the document.
    pub id: FabricId,
    /// Name to show.
    pub name: String,
    /// Mass per area (kg/m2).
    pub density: f64,
    /// Thickness (m).
    pub thickness: f64,
    /// Stretch stiffness along warp and weft (N/m).
    pub stretch: [f64; 2],
    /// Shear stiffness (N/m).
    pub shear: f64,
    /// Poisson ratio of warp to weft.
    pub poisson: f64,
    /// Bending stiffness along warp, weft and bias (N m).
    pub bend: [f64; 3],
    /// Coulomb friction coefficient against skin.
    pub friction: f64,
    /// Width of the roll (m).
    pub width: f64,
    /// Whether the cloth has a nap, so that all pieces must point one way.
    pub nap: bool,
    /// Base colour, sRGB 0..=1.
    pub colour: [f64; 3],
    /// What its stress depends on besides the strain of the moment.
    #[serde(default)]
    pub rheology: Rheology,
}

impl Default for Fabric {
    fn default() -> Self {
        Self {
            id: FabricId::default(),
            name: String::new(),
            density: 0.0,
            thickness: 0.0,
            stretch: [0.0; 2],
            shear: 0.0,
            poisson: 0.0,
            bend: [0.0; 3],
            friction: 0.0,
            width: 0.0,
            nap: false,
            colour: [0.8; 3],
            rheology: Rheology::default(),
        }
    }
}

fields!(Fabric, |self, v| {
    let Self {
        id,
        name,
        density,
        thickness,
        stretch: [stretch_warp, stretch_weft],
        shear,
        poisson,
        bend: [bend_warp, bend_weft, bend_bias],
        friction,
        width,
        nap,
        colour: [red, green, blue],
        rheology,
    } = self;
    v.own(id);
    v.value(ValueField::NAME, name);
    v.value(key("density_kg_per_m2"), density);
    v.value(key("thickness_m"), thickness);
    v.list(group("stretch_N_per_m"), &mut |v| {
        v.value(key("warp"), stretch_warp);
        v.value(key("weft"), stretch_weft);
    });
    v.value(key("shear_N_per_m"), shear);
    v.value(key("poisson"), poisson);
    v.list(group("bend_N_m"), &mut |v| {
        v.value(key("warp"), bend_warp);
        v.value(key("weft"), bend_weft);
        v.value(key("bias"), bend_bias);
    });
    v.value(key("friction"), friction);
    v.value(key("width_m"), width);
    v.value(key("nap").may_lack(), nap);
    v.list(group("colour").may_lack(), &mut |v| {
        v.value(key("red"), red);
        v.value(key("green"), green);
        v.value(key("blue"), blue);
    });
    v.flat(rheology);
});

/// How a cloth hardens, damps and keeps folds. All zero: linear and elastic.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Rheology {
    /// Hardening k of warp and weft: stress C (E + k E^3) in tension (1).
    pub hardening: [f64; 2],
    /// Viscosity of stretch and shear (Kelvin-Voigt) (N s/m).
    pub viscosity: f64,
    /// Viscosity of bending (Kelvin-Voigt) (N m s).
    pub bend_viscosity: f64,
    /// Share of a stretch and of a fold that is kept when held for long, 0 to 0.95 (1).
    pub kept: [f64; 2],
    /// Time in which the kept share settles (s).
    pub relaxation_time: f64,
}

impl Default for Rheology {
    fn default() -> Self {
        Self {
            hardening: [0.0; 2],
            viscosity: 0.0,
            bend_viscosity: 0.0,
            kept: [0.0; 2],
            relaxation_time: 10.0,
        }
    }
}

fields!(Rheology, |self, v| {
    let usual = Rheology::default();
    let Self {
        hardening: [hardening_warp, hardening_weft],
        viscosity,
        bend_viscosity,
        kept: [kept_stretch, kept_fold],
        relaxation_time,
    } = self;
    let is_usual = [*hardening_warp, *hardening_weft] == usual.hardening;
    v.list(group("hardening").left_out_if(is_usual), &mut |v| {
        v.value(key("warp"), hardening_warp);
        v.value(key("weft"), hardening_weft);
    });
    v.value(
        key("viscosity_N_s_per_m").left_out_if(*viscosity == usual.viscosity),
        viscosity,
    );
    let is_usual = *bend_viscosity == usual.bend_viscosity;
    v.value(
        key("bend_viscosity_N_m_s").left_out_if(is_usual),
        bend_viscosity,
    );
    let is_usual = [*kept_stretch, *kept_fold] == usual.kept;
    v.list(group("kept").left_out_if(is_usual), &mut |v| {
        v.value(key("stretch"), kept_stretch);
        v.value(key("fold"), kept_fold);
    });
    let is_usual = *relaxation_time == usual.relaxation_time;
    v.value(
        key("relaxation_time_s").left_out_if(is_usual),
        relaxation_time,
    );
});

impl Rheology {
    /// Whether the stress depends on time: on speeds, or on what was held before.
    pub fn acts_in_time(&self) -> bool {
        self.viscosity > 0.0 || self.bend_viscosity > 0.0 || self.kept != [0.0; 2]
    }

    /// What no cloth has, in words; nothing where all is in order.
    pub fn defect(&self) -> Option<&'static str> {
        let good = |x: f64| x.is_finite() && x >= 0.0;
        if !self.hardening.iter().all(|&k| good(k)) {
            Some("its hardening is not two numbers of 0 or more")
        } else if !(good(self.viscosity) && good(self.bend_viscosity)) {
            Some("its viscosity is not 0 or more")
        } else if !self.kept.iter().all(|k| (0.0..=0.95).contains(k)) {
            Some("its kept shares are not from 0 to 0.95")
        } else if !(good(self.relaxation_time) && self.relaxation_time > 0.0) {
            Some("its relaxation time is not above 0")
        } else {
            None
        }
    }
}

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
