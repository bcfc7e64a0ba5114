//! What a setup is told by: whether a checkpoint is of it.

use super::{GarmentLevel, GarmentSetup};
use crate::DrapeError;
use serde::{Deserialize, Serialize};
use toile_geometry::{Vec2, Vec3};

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

/// FNV-1a over the bits of numbers.
struct Hash(u64);

impl Hash {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn bytes(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn whole(&mut self, numbers: impl IntoIterator<Item = u32>) {
        let numbers: Vec<u32> = numbers.into_iter().collect();
        self.bytes(&(numbers.len() as u64).to_le_bytes());
        for number in numbers {
            self.bytes(&number.to_le_bytes());
        }
    }

    fn places(&mut self, places: &[Vec3]) {
        for number in places.iter().flat_map(Vec3::iter) {
            self.bytes(&number.to_bits().to_le_bytes());
        }
    }

    fn shapes(&mut self, shapes: &[[Vec2; 3]]) {
        for number in shapes.iter().flatten().flat_map(Vec2::iter) {
            self.bytes(&number.to_bits().to_le_bytes());
        }
    }
}

impl MeshDigest {
    fn of(level: &GarmentLevel) -> Self {
        let GarmentLevel {
            cloth,
            stitches,
            layer,
        } = level;
        let mut structure = Hash::new();
        structure.whole(cloth.triangles.iter().flatten().copied());
        structure.whole(cloth.panel.iter().copied());
        structure.whole(cloth.material.iter().map(|&m| u32::from(m)));
        structure.whole(stitches.iter().flatten().copied());
        structure.whole(layer.iter().map(|&l| u32::from(l)));
        let mut shapes = Hash::new();
        shapes.shapes(&cloth.rest);
        shapes.places(&cloth.positions);
        Self {
            vertices: cloth.positions.len(),
            triangles: cloth.triangles.len(),
            stitches: stitches.len(),
            structure: structure.0,
            shapes: shapes.0,
        }
    }
}

impl SetupDigest {
    /// Of a setup from a level on.
    pub fn of(setup: &GarmentSetup, level: usize) -> Self {
        let mut body = Hash::new();
        for surface in &setup.colliders {
            let mesh = surface.mesh();
            body.places(&mesh.positions);
            body.whole(mesh.triangles.iter().flatten().copied());
        }
        // As written, numbers are told apart to the last bit.
        let written = |words: String| {
            let mut hash = Hash::new();
            hash.bytes(words.as_bytes());
            hash.0
        };
        let fabrics = setup.levels.iter().skip(level);
        let fabrics: Vec<_> = fabrics.map(|level| &level.cloth.materials).collect();
        let meshes = setup.levels.iter().skip(level);
        Self {
            levels: setup.levels.len(),
            meshes: meshes.map(MeshDigest::of).collect(),
            fabrics: written(format!("{fabrics:?}")),
            body: body.0,
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
