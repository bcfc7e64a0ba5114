//! Digests of a garment's setup, by which a checkpoint refuses to be resumed with another setup.

use super::{GarmentLevel, GarmentSetup};
use crate::DrapeError;
use crate::digest::Digest;
use serde::{Deserialize, Serialize};

/// Digest of a setup from one of its levels on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SetupDigest {
    levels: usize,
    /// Meshes of the levels from the present one on.
    meshes: Vec<MeshDigest>,
    fabrics: u64,
    body: u64,
    settings: u64,
}

/// Digest of a mesh of the panels.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct MeshDigest {
    vertices: usize,
    triangles: usize,
    stitches: usize,
    /// Hash of the triangles with their panels, fabrics and layers, and of the stitches.
    structure: u64,
    /// Hash of the rest shapes and of the starting positions.
    shapes: u64,
}

impl MeshDigest {
    fn of(level: &GarmentLevel) -> Self {
        let GarmentLevel {
            cloth,
            stitches,
            layer,
        } = level;
        let mut structure = Digest::new();
        structure.whole(cloth.triangles.iter().flatten().copied());
        structure.whole(cloth.panel.iter().copied());
        structure.whole(cloth.material.iter().map(|&m| u32::from(m)));
        structure.whole(stitches.iter().flatten().copied());
        structure.whole(layer.iter().map(|&l| u32::from(l)));
        let mut shapes = Digest::new();
        shapes.shapes(&cloth.rest);
        shapes.vectors(&cloth.positions);
        Self {
            vertices: cloth.positions.len(),
            triangles: cloth.triangles.len(),
            stitches: stitches.len(),
            structure: structure.value(),
            shapes: shapes.value(),
        }
    }
}

impl SetupDigest {
    /// The digest of a setup from a level on.
    pub fn of(setup: &GarmentSetup, level: usize) -> Self {
        let mut body = Digest::new();
        for surface in &setup.colliders {
            let mesh = surface.mesh();
            body.vectors(&mesh.positions);
            body.whole(mesh.triangles.iter().flatten().copied());
        }
        // The debug format of a number is exact to the last bit.
        let text_hash = |text: String| {
            let mut hash = Digest::new();
            hash.text(&text);
            hash.value()
        };
        let fabrics = setup.levels.iter().skip(level);
        let fabrics: Vec<_> = fabrics.map(|level| &level.cloth.materials).collect();
        let meshes = setup.levels.iter().skip(level);
        Self {
            levels: setup.levels.len(),
            meshes: meshes.map(MeshDigest::of).collect(),
            fabrics: text_hash(format!("{fabrics:?}")),
            body: body.value(),
            settings: text_hash(format!(
                "{:?} {:?} {:?} {:?}",
                setup.contact, setup.gravity, setup.sew, setup.rest
            )),
        }
    }

    /// Refuses another setup and names the property that differs. Shapes are not compared where the checkpoint has
    /// edited ones.
    pub fn check(&self, other: &Self, is_edited: bool) -> Result<(), DrapeError> {
        differs("count of meshes", self.levels, other.levels)?;
        for (own, given) in self.meshes.iter().zip(&other.meshes) {
            differs("count of vertices", own.vertices, given.vertices)?;
            differs("count of triangles", own.triangles, given.triangles)?;
            differs("count of stitches", own.stitches, given.stitches)?;
            same("triangles and seams", own.structure == given.structure)?;
            same(
                "shape of the panels",
                is_edited || own.shapes == given.shapes,
            )?;
        }
        same("body", self.body == other.body)?;
        same("fabrics", self.fabrics == other.fabrics)?;
        same("settings", self.settings == other.settings)
    }
}

/// The remedy for a checkpoint of another setup.
const REMEDY: &str = "go on with the pattern, body, fabrics and quality that it was saved of, or drape from the start";

fn differs(what: &str, own: usize, given: usize) -> Result<(), DrapeError> {
    match own == given {
        true => Ok(()),
        false => Err(DrapeError::Scene {
            place: format!("checkpoint, {what}"),
            what: format!("it is {own} there and {given} in the garment"),
            remedy: REMEDY.to_owned(),
        }),
    }
}

fn same(what: &str, is_same: bool) -> Result<(), DrapeError> {
    match is_same {
        true => Ok(()),
        false => Err(DrapeError::Scene {
            place: format!("checkpoint, {what}"),
            what: "it was saved of another garment".to_owned(),
            remedy: REMEDY.to_owned(),
        }),
    }
}
