//! Fabrics by name: a pattern's own, then the library's, then those of files.

use crate::SessionError;
use crate::input::is_input;
use crate::open::read_input;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toile_drape::{Compression, LIBRARY, LibraryFabric, Material};
use toile_interchange::{ExpectedKind, FabricFile, FormatError, read_fabric};
use toile_pattern::{Draft, Fabric, FabricId, Pattern, Rheology};

/// Width of a roll of a fabric that comes without one (m).
const WIDTH: f64 = 1.5;

/// A fabric that takes the place of every panel's.
#[derive(Clone, Debug, PartialEq)]
pub enum FabricChoice {
    /// One of the pattern's, or of the library.
    Named(String),
    /// One of a file.
    File {
        /// The file.
        path: PathBuf,
        /// What it says; nothing where it could not be read when the pattern that names it was
        /// opened.
        fabric: Option<Arc<Fabric>>,
    },
}

impl FabricChoice {
    /// Its name; that of its file where that could not be read.
    pub fn name(&self) -> &str {
        match self {
            Self::Named(name) => name,
            Self::File {
                fabric: Some(fabric),
                ..
            } => &fabric.name,
            Self::File { path, .. } => path.to_str().unwrap_or_default(),
        }
    }

    /// The fabric, if it is of a file that could be read.
    pub fn of_file(&self) -> Option<&Fabric> {
        match self {
            Self::Named(_) => None,
            Self::File { fabric, .. } => fabric.as_deref(),
        }
    }

    /// The fabric, for a pattern; nothing where neither it nor the library has one of that name, or
    /// its file could not be read.
    pub(crate) fn fabric(&self, pattern: &Pattern) -> Option<Fabric> {
        match self {
            Self::Named(name) => fabric_of(pattern, name),
            Self::File { fabric, .. } => fabric.as_deref().cloned(),
        }
    }

    /// Cuts every piece of a draft from it.
    pub(crate) fn cut(fabric: Fabric, draft: &mut Draft) {
        draft.fabrics = vec![fabric];
        for piece in &mut draft.pieces {
            piece.fabric = 0;
        }
    }
}

/// The fabric asked for by its name or its file, with what is worth telling.
///
/// # Errors
/// A name that is not there, with those that are; a file that cannot be read, or that says more
/// than the fabric of a garment has.
pub(crate) fn chosen(
    pattern: &Pattern,
    asked: &str,
) -> Result<(FabricChoice, Vec<String>), SessionError> {
    if fabric_of(pattern, asked).is_some() {
        return Ok((FabricChoice::Named(asked.to_owned()), Vec::new()));
    }
    let path = Path::new(asked);
    if !is_input(path) {
        let names = fabric_names(pattern);
        return Err(SessionError::Unknown {
            kind: "fabric",
            name: asked.to_owned(),
            hint: format!("choose one of {}, or name a fabric file", names.join(", ")),
        });
    }
    let (fabric, notes) = fabric_of_file(path)?;
    let choice = FabricChoice::File {
        path: path.to_owned(),
        fabric: Some(fabric),
    };
    Ok((choice, notes))
}

/// The fabric of a garment in a file, with what is worth telling.
///
/// # Errors
/// The file cannot be read, or says more than the fabric of a garment has.
pub(crate) fn fabric_of_file(path: &Path) -> Result<(Arc<Fabric>, Vec<String>), SessionError> {
    let file = open_fabric(path)?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let name = file.name.clone().unwrap_or_else(|| stem.into_owned());
    let fabric = of_material(&name, &file.material).map_err(|what| SessionError::Format {
        path: path.to_owned(),
        error: FormatError::new(
            what,
            "the fabric of a garment has no such figure",
            "leave it out, or use it in a scene (`toile run`)",
        ),
    })?;
    Ok((Arc::new(fabric), file.notes))
}

/// Whether a pattern or the library has a fabric of a name.
pub(crate) fn is_known_fabric(pattern: &Pattern, name: &str) -> bool {
    fabric_of(pattern, name).is_some()
}

/// The fabric in a file.
///
/// # Errors
/// The file cannot be read.
pub(crate) fn open_fabric(path: &Path) -> Result<FabricFile, SessionError> {
    read_fabric(&read_input(path, ExpectedKind::Fabric)?).map_err(|error| SessionError::Format {
        path: path.to_owned(),
        error,
    })
}

/// A fabric by name: one of the pattern's, else one of the library.
fn fabric_of(pattern: &Pattern, name: &str) -> Option<Fabric> {
    let own = pattern.fabrics.iter().find(|f| f.name == name);
    match own {
        Some(own) => Some((**own).clone()),
        None => library_fabric(name),
    }
}

/// A fabric of the library as one that a pattern can have; nothing where there is none of that name.
pub fn library_fabric(name: &str) -> Option<Fabric> {
    let library = LibraryFabric::named(name)?;
    let fabric = of_material(name, &library.material()).ok()?;
    Some(Fabric {
        colour: library.colour,
        ..fabric
    })
}

/// The fabric of the library that most figures of a fabric are those of, three at the least: it was copied from
/// that one.
pub fn library_origin(fabric: &Fabric) -> Option<&'static LibraryFabric> {
    let own = figures(&cloth_material(fabric));
    let shared = |library: &LibraryFabric| {
        let known = figures(&library.material());
        own.iter().zip(&known).filter(|(a, b)| a == b).count()
    };
    let nearest = LIBRARY.iter().max_by_key(|library| shared(library))?;
    (shared(nearest) >= 3).then_some(nearest)
}

/// The figures of a material that a library tells the source of.
fn figures(material: &Material) -> [Vec<f64>; 6] {
    [
        vec![material.density],
        vec![material.thickness],
        [material.stretch, material.hardening].concat(),
        vec![material.shear],
        material.bend.to_vec(),
        vec![material.friction],
    ]
}

/// A fabric with the hardening that its cloth has: one of a name of the library may say none of its own.
pub fn with_hardening(fabric: &Fabric) -> Fabric {
    Fabric {
        rheology: Rheology {
            hardening: cloth_material(fabric).hardening,
            ..fabric.rheology
        },
        ..fabric.clone()
    }
}

/// Names that [`fabric_of`] knows, in order.
fn fabric_names(pattern: &Pattern) -> Vec<&str> {
    let own = pattern.fabrics.iter().map(|f| &*f.name);
    let library = LIBRARY.iter().map(|f| f.name);
    let mut names: Vec<&str> = own.chain(library).collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// A fabric of a material.
///
/// # Errors
/// The name of the first figure that a pattern's fabric has no place for.
fn of_material(name: &str, material: &Material) -> Result<Fabric, &'static str> {
    // Taken apart whole: a new figure does not compile before it has a place here.
    let &Material {
        density,
        thickness,
        stretch,
        shear,
        poisson,
        hardening,
        strain_limit,
        compression,
        bend,
        bend_poisson,
        viscosity,
        bend_viscosity,
        stiffness_damping,
        relaxed_fraction,
        relaxation_time,
        friction,
        restitution,
    } = material;
    let usual = Material::default();
    let beyond = [
        ("strain_limit", strain_limit != usual.strain_limit),
        ("compression", compression != Compression::Full),
        ("bend_poisson", bend_poisson != usual.bend_poisson),
        (
            "stiffness_damping",
            stiffness_damping != usual.stiffness_damping,
        ),
        ("restitution", restitution.is_some()),
    ];
    if let Some((field, _)) = beyond.iter().find(|(_, beyond)| *beyond) {
        return Err(field);
    }
    Ok(Fabric {
        id: FabricId(0),
        name: name.into(),
        density,
        thickness,
        stretch,
        shear,
        poisson,
        bend,
        friction,
        width: WIDTH,
        nap: false,
        colour: [0.72, 0.70, 0.66],
        rheology: Rheology {
            hardening,
            viscosity,
            bend_viscosity,
            kept: relaxed_fraction,
            relaxation_time,
        },
    })
}

/// The material of a fabric.
pub(crate) fn cloth_material(fabric: &Fabric) -> Material {
    let own = &fabric.rheology;
    // A fabric that has the name and the stretch of one of the library and says no hardening of its own has that
    // of the library: patterns older than hardening keep the cloth that they name.
    let library = LibraryFabric::named(&fabric.name).map(LibraryFabric::material);
    let hardening = library
        .filter(|material| material.stretch == fabric.stretch && own.hardening == [0.0; 2])
        .map_or(own.hardening, |material| material.hardening);
    Material {
        density: fabric.density,
        thickness: fabric.thickness,
        stretch: fabric.stretch,
        shear: fabric.shear,
        poisson: fabric.poisson,
        bend: fabric.bend,
        friction: fabric.friction,
        hardening,
        viscosity: own.viscosity,
        bend_viscosity: own.bend_viscosity,
        relaxed_fraction: own.kept,
        relaxation_time: own.relaxation_time,
        ..Material::default()
    }
}

/// What of the fabrics of a draft a garment at rest does not show, in words.
pub(crate) fn unseen_at_rest(draft: &Draft) -> Vec<String> {
    let timed = draft.fabrics.iter().filter(|f| f.rheology.acts_in_time());
    timed
        .map(|fabric| {
            format!(
                "fabric {:?}: viscosity and kept folds act in motion only; the garment at rest is draped without them",
                fabric.name
            )
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_library_is_reached_by_name() {
        let pattern = Pattern::default();
        let denim = fabric_of(&pattern, "denim").expect("in the library");
        assert!((denim.density - 0.334).abs() < 1e-12);
        assert!(fabric_of(&pattern, "unobtainium").is_none());
        for name in fabric_names(&pattern) {
            let fabric = fabric_of(&pattern, name).expect(name);
            if let Some(library) = LibraryFabric::named(name) {
                assert_eq!(cloth_material(&fabric), library.material());
            }
        }
    }

    #[test]
    fn a_fabric_file_takes_the_place_of_every_panels_fabric_and_says_what_it_cannot_hold() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("ponte.json");
        let text = |more: &str| {
            format!(
                r#"{{"toile": 1, "kind": "fabric", "viscosity": 0.02, "kept": [0, 0.2]{more}}}"#
            )
        };
        std::fs::write(&path, text("")).unwrap();
        let pattern = Pattern::default();
        let asked = path.to_str().unwrap();
        let (choice, notes) = chosen(&pattern, asked).unwrap();
        assert!(notes.is_empty() && choice.name() == "ponte");
        let fabric = choice.fabric(&pattern).unwrap();
        let material = cloth_material(&fabric);
        assert_eq!(
            (material.viscosity, material.relaxed_fraction),
            (0.02, [0.0, 0.2])
        );
        std::fs::write(&path, text(r#", "restitution": 0.5"#)).unwrap();
        let error = chosen(&pattern, asked).unwrap_err().to_string();
        assert!(
            error.contains("restitution") && error.contains("ponte.json"),
            "{error}"
        );
    }
}
