//! Materials of cloth, as scenes and fabric files write them.

use crate::FormatError;
use crate::scene_motion::Unknown;
use serde::{Deserialize, Serialize};
use toile_drape::{Compression, LIBRARY, LibraryFabric, Material};

/// A cloth in a scene; what is left out is that of the fabric named, else of
/// [`Material::default`].
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
pub struct MaterialFile {
    /// Name of a fabric of the library.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fabric: Option<String>,
    /// Mass per area (kg/m2).
    pub density: Option<f64>,
    /// Thickness (m).
    pub thickness: Option<f64>,
    /// Stretch stiffness along warp and weft (N/m).
    pub stretch: Option<[f64; 2]>,
    /// Shear stiffness (N/m).
    pub shear: Option<f64>,
    /// Poisson ratio.
    pub poisson: Option<f64>,
    /// Hardening along warp and weft.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hardening: Option<[f64; 2]>,
    /// Stretch that warp and weft hardly exceed, as a share; nothing for none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strain_limit: Option<[Option<f64>; 2]>,
    /// `full` or `tension-field`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compression: Option<String>,
    /// Bending stiffness along warp, weft and bias (N m).
    pub bend: Option<[f64; 3]>,
    /// Poisson ratio in bending.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bend_poisson: Option<f64>,
    /// Viscosity of stretch (N s/m).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub viscosity: Option<f64>,
    /// Viscosity of bending (N m s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bend_viscosity: Option<f64>,
    /// Viscosity in proportion to stiffness (s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness_damping: Option<f64>,
    /// Share of stretch and of folds that is kept.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kept: Option<[f64; 2]>,
    /// Time in which it settles (s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub relaxation_time: Option<f64>,
    /// Friction coefficient.
    pub friction: Option<f64>,
    /// Share of the speed of an impact that comes back.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub restitution: Option<f64>,
    #[serde(flatten)]
    pub(crate) unknown: Unknown,
}

impl MaterialFile {
    /// The material, with the fabric's figures or defaults where nothing is written.
    ///
    /// # Errors
    /// A fabric or a kind of compression that is not known; `place` says where it stands.
    pub fn material(&self, place: &str) -> Result<Material, FormatError> {
        let usual = match &self.fabric {
            None => Material::default(),
            Some(name) => LibraryFabric::named(name)
                .map(LibraryFabric::material)
                .ok_or_else(|| {
                    let known: Vec<_> = LIBRARY.iter().map(|fabric| fabric.name).collect();
                    FormatError::new(
                        format!("{place}.fabric"),
                        format!("\"{name}\" is neither a fabric of the library nor a file"),
                        format!("write one of {}, or name a fabric file", known.join(", ")),
                    )
                })?,
        };
        self.over(usual, place)
    }

    /// The fields that are not known here, taken out.
    pub(crate) fn take_unknown(&mut self) -> Vec<String> {
        std::mem::take(&mut self.unknown).into_keys().collect()
    }

    /// The material with the figures of another, `usual`, where nothing is written, whatever
    /// fabric is named.
    ///
    /// # Errors
    /// A kind of compression that is not known; `place` says where it stands.
    pub fn over(&self, usual: Material, place: &str) -> Result<Material, FormatError> {
        let compression = match self.compression.as_deref() {
            None => usual.compression,
            Some("full") => Compression::Full,
            Some("tension-field") => Compression::TensionField,
            Some(other) => {
                return Err(FormatError::new(
                    format!("{place}.compression"),
                    format!("\"{other}\" is not known"),
                    "write \"full\" or \"tension-field\"".to_owned(),
                ));
            }
        };
        let limit = |limit: [Option<f64>; 2]| limit.map(|l| l.unwrap_or(f64::INFINITY));
        // Stretch given anew makes the fabric's curve its own no longer.
        let hardening = if self.stretch.is_some() {
            [0.0; 2]
        } else {
            usual.hardening
        };
        Ok(Material {
            density: self.density.unwrap_or(usual.density),
            thickness: self.thickness.unwrap_or(usual.thickness),
            stretch: self.stretch.unwrap_or(usual.stretch),
            shear: self.shear.unwrap_or(usual.shear),
            poisson: self.poisson.unwrap_or(usual.poisson),
            hardening: self.hardening.unwrap_or(hardening),
            strain_limit: self.strain_limit.map_or(usual.strain_limit, limit),
            compression,
            bend: self.bend.unwrap_or(usual.bend),
            bend_poisson: self.bend_poisson.unwrap_or(usual.bend_poisson),
            viscosity: self.viscosity.unwrap_or(usual.viscosity),
            bend_viscosity: self.bend_viscosity.unwrap_or(usual.bend_viscosity),
            stiffness_damping: self.stiffness_damping.unwrap_or(usual.stiffness_damping),
            relaxed_fraction: self.kept.unwrap_or(usual.relaxed_fraction),
            relaxation_time: self.relaxation_time.unwrap_or(usual.relaxation_time),
            friction: self.friction.unwrap_or(usual.friction),
            restitution: self.restitution.or(usual.restitution),
        })
    }
}
