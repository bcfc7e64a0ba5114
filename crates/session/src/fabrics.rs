//! Fabrics by name: a pattern's own, then the library's.

use crate::Project;
use toile_drape::{LIBRARY, LibraryFabric};
use toile_pattern::{Fabric, FabricId, Pattern};

/// Width of a roll of library fabric [m].
const WIDTH: f64 = 1.5;

/// A fabric by name: one of the pattern's, else `jersey` or `poplin` as patterns begin with, else
/// one of the library.
pub(crate) fn fabric_named(project: &Project, name: &str) -> Option<Fabric> {
    fabric_of(&project.pattern, name)
}

/// [`fabric_named`] for any pattern.
pub(crate) fn fabric_of(pattern: &Pattern, name: &str) -> Option<Fabric> {
    let own = pattern.fabrics.iter().find(|f| f.name == name);
    match (own, name) {
        (Some(own), _) => Some((**own).clone()),
        (None, "jersey") => Some(Fabric::jersey(FabricId(0))),
        (None, "poplin") => Some(Fabric::poplin(FabricId(0))),
        (None, _) => LibraryFabric::named(name).map(of_library),
    }
}

/// Names that [`fabric_named`] knows, in order.
pub(crate) fn fabric_names(project: &Project) -> Vec<&str> {
    let own = project.pattern.fabrics.iter().map(|f| &*f.name);
    let library = LIBRARY.iter().map(|f| f.name);
    let mut names: Vec<&str> = own.chain(library).collect();
    names.sort_unstable();
    names.dedup();
    names
}

fn of_library(fabric: &LibraryFabric) -> Fabric {
    let material = fabric.material();
    Fabric {
        id: FabricId(0),
        name: fabric.name.into(),
        density: material.density,
        thickness: material.thickness,
        stretch: material.stretch,
        shear: material.shear,
        poisson: material.poisson,
        bend: material.bend,
        friction: material.friction,
        width: WIDTH,
        nap: false,
        colour: [0.72, 0.70, 0.66],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_library_is_reached_by_name() {
        let project = Project::default();
        let denim = fabric_named(&project, "denim").expect("in the library");
        assert!((denim.density - 0.334).abs() < 1e-12);
        assert!(fabric_named(&project, "unobtainium").is_none());
        for name in fabric_names(&project) {
            assert!(fabric_named(&project, name).is_some(), "{name}");
        }
    }
}
