//! Digests of a garment's setup: a checkpoint is resumed with the setup it was saved of, and with no other.

use super::{GarmentLevel, GarmentSetup};
use crate::DrapeError;
use crate::digest::Digest;
use serde::{Deserialize, Serialize};

/// A setup from one of its levels on, in short.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SetupDigest {
    levels: usize,
    /// Those from the present one on.
    meshes: Vec<MeshDigest>,
    fabrics: u64,
    body: u64,
    settings: u64,
}

/// A mesh of the panels, in short.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct MeshDigest {
    vertices: usize,
    triangles: usize,
    stitches: usize,
    /// Of the triangles, with panels, fabrics and layers, and of the stitches.
    structure: u64,
    /// Of the rest shapes and of where the panels were placed.
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
        shapes.places(&cloth.positions);
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
    /// Of a setup from a level on.
    pub fn of(setup: &GarmentSetup, level: usize) -> Self {
        let mut body = Digest::new();
        for surface in &setup.colliders {
            let mesh = surface.mesh();
            body.places(&mesh.positions);
            body.whole(mesh.triangles.iter().flatten().copied());
        }
        // As written, numbers are told apart to the last bit.
        let written = |words: String| {
            let mut hash = Digest::new();
            hash.text(&words);
            hash.value()
        };
        let fabrics = setup.levels.iter().skip(level);
        let fabrics: Vec<_> = fabrics.map(|level| &level.cloth.materials).collect();
        let meshes = setup.levels.iter().skip(level);
        Self {
            levels: setup.levels.len(),
            meshes: meshes.map(MeshDigest::of).collect(),
            fabrics: written(format!("{fabrics:?}")),
            body: body.value(),
            settings: written(format!(
                "{:?} {:?} {:?} {:?}",
                setup.contact, setup.gravity, setup.sew, setup.rest
            )),
        }
    }

    /// Refuses another setup, which is named by what differs; where the garment's shapes came by an edit,
    /// those of the setup do not count.
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

/// What to do about a checkpoint of something else.
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
