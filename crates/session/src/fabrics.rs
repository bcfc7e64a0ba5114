//! Fabrics by name: a pattern's own, then the library's, then those of files.

use crate::SessionError;
use crate::input::is_input;
use crate::open::read_input;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toile_fabric::{LIBRARY, LibraryFabric, Material};
use toile_interchange::{ExpectedKind, FabricFile, read_fabric};
use toile_pattern::{Draft, Fabric, FabricId, Pattern};

/// Width of a roll of a fabric that comes without one (m).
const WIDTH: f64 = 1.5;

/// A fabric that replaces the fabric of every panel.
#[derive(Clone, Debug, PartialEq)]
pub enum FabricChoice {
    /// A fabric of the pattern or of the library, by its name.
    Named(String),
    /// A fabric of a fabric file.
    File {
        /// The file.
        path: PathBuf,
        /// Content of the file; `None` if the file could not be read when the pattern that names it was
        /// opened.
        fabric: Option<Arc<Fabric>>,
    },
}

impl FabricChoice {
    /// Name of the fabric; path of the file if the file could not be read.
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

    /// The fabric that was read from a fabric file. `None`: the choice is a name, or the file could not be
    /// read.
    pub fn of_file(&self) -> Option<&Fabric> {
        match self {
            Self::Named(_) => None,
            Self::File { fabric, .. } => fabric.as_deref(),
        }
    }

    /// The fabric that the pieces of `pattern` are cut from; `None` if neither the pattern nor the library
    /// has a fabric of that name, or if the fabric file could not be read.
    pub(crate) fn fabric(&self, pattern: &Pattern) -> Option<Fabric> {
        match self {
            Self::Named(name) => fabric_of(pattern, name),
            Self::File { fabric, .. } => fabric.as_deref().cloned(),
        }
    }

    /// Makes `fabric` the only fabric of a draft and cuts every piece from it.
    pub(crate) fn cut(fabric: Fabric, draft: &mut Draft) {
        draft.fabrics = vec![fabric];
        for piece in &mut draft.pieces {
            piece.fabric = 0;
        }
    }
}

/// Finds a fabric by its name or reads it from its file, with notes for the user.
///
/// # Errors
/// An unknown name (the message lists the known names), or a file that cannot be read.
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

/// Reads the fabric of a garment from a file, with notes for the user.
///
/// # Errors
/// The file cannot be read.
pub(crate) fn fabric_of_file(path: &Path) -> Result<(Arc<Fabric>, Vec<String>), SessionError> {
    let file = open_fabric(path)?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let name = file.name.clone().unwrap_or_else(|| stem.into_owned());
    Ok((Arc::new(on_a_roll(&name, file.material)), file.notes))
}

/// Whether a pattern or the library has a fabric of a name.
pub(crate) fn is_known_fabric(pattern: &Pattern, name: &str) -> bool {
    fabric_of(pattern, name).is_some()
}

/// Reads a fabric file.
///
/// # Errors
/// The file cannot be read.
pub(crate) fn open_fabric(path: &Path) -> Result<FabricFile, SessionError> {
    read_fabric(&read_input(path, ExpectedKind::Fabric)?).map_err(|error| SessionError::Format {
        path: path.to_owned(),
        error,
    })
}

/// Finds a fabric by its name: first in the pattern, then in the library.
fn fabric_of(pattern: &Pattern, name: &str) -> Option<Fabric> {
    let own = pattern.fabrics.iter().find(|f| f.name == name);
    match own {
        Some(own) => Some((**own).clone()),
        None => library_fabric(name),
    }
}

/// A fabric of the library in the form that a pattern stores; `None` if the library has no fabric of that
/// name.
pub fn library_fabric(name: &str) -> Option<Fabric> {
    let library = LibraryFabric::named(name)?;
    Some(Fabric {
        colour: library.colour,
        ..on_a_roll(name, library.material())
    })
}

/// The library fabric that a fabric was copied from: the one that agrees with it in the most groups of values
/// (see `figures`), in at least three of the six.
pub fn library_origin(fabric: &Fabric) -> Option<&'static LibraryFabric> {
    let own = figures(&cloth_material(fabric));
    let shared = |library: &LibraryFabric| {
        let known = figures(&library.material());
        own.iter().zip(&known).filter(|(a, b)| a == b).count()
    };
    let nearest = LIBRARY.iter().max_by_key(|library| shared(library))?;
    (shared(nearest) >= 3).then_some(nearest)
}

/// Values of a material in the six groups for which the library states a source.
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

/// A copy of a fabric whose hardening is the one that its cloth is simulated with (`cloth_material`).
pub fn with_hardening(fabric: &Fabric) -> Fabric {
    Fabric {
        material: cloth_material(fabric),
        ..fabric.clone()
    }
}

/// Names of the fabrics that [`fabric_of`] finds, in alphabetical order.
fn fabric_names(pattern: &Pattern) -> Vec<&str> {
    let own = pattern.fabrics.iter().map(|f| &*f.name);
    let library = LIBRARY.iter().map(|f| f.name);
    let mut names: Vec<&str> = own.chain(library).collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// A fabric of a material, on a roll of the usual width.
fn on_a_roll(name: &str, material: Material) -> Fabric {
    Fabric {
        id: FabricId(0),
        name: name.into(),
        material,
        width: WIDTH,
        nap: false,
        colour: [0.72, 0.70, 0.66],
    }
}

/// The material that a fabric is simulated with. If the fabric has the name and the stretch of a library
/// fabric but no hardening, it takes the hardening of that library fabric: pattern files older than hardening
/// keep the cloth that they name.
pub(crate) fn cloth_material(fabric: &Fabric) -> Material {
    let mut material = fabric.material.clone();
    let library = LibraryFabric::named(&fabric.name).map(LibraryFabric::material);
    if let Some(library) = library
        && library.stretch == material.stretch
        && material.hardening == [0.0; 2]
    {
        material.hardening = library.hardening;
    }
    material
}

/// Notes on properties of the fabrics of a draft that have no effect on a garment at rest.
pub(crate) fn unseen_at_rest(draft: &Draft) -> Vec<String> {
    let mut notes = Vec::new();
    for fabric in &draft.fabrics {
        let Fabric { name, material, .. } = fabric;
        if material.acts_in_time() {
            notes.push(format!(
                "fabric {name:?}: viscosity and kept folds act in motion only; the garment at rest is draped without them"
            ));
        }
        if material.restitution.is_some() {
            notes.push(format!(
                "fabric {name:?}: restitution acts on impacts only; the garment is draped without it"
            ));
        }
    }
    notes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_library_is_reached_by_name() {
        let pattern = Pattern::default();
        let denim = fabric_of(&pattern, "denim").expect("in the library");
        assert!((denim.material.density - 0.334).abs() < 1e-12);
        assert!(fabric_of(&pattern, "unobtainium").is_none());
        for name in fabric_names(&pattern) {
            let fabric = fabric_of(&pattern, name).expect(name);
            if let Some(library) = LibraryFabric::named(name) {
                assert_eq!(cloth_material(&fabric), library.material());
            }
        }
    }

    #[test]
    fn a_fabric_file_takes_the_place_of_every_panels_fabric_with_all_its_figures() {
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
        let (choice, _) = chosen(&pattern, asked).unwrap();
        let fabric = choice.fabric(&pattern).unwrap();
        assert_eq!(cloth_material(&fabric).restitution, Some(0.5));
    }
}
