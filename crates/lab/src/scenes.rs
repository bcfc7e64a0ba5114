//! The standard scenes: frozen meshes and settings, so that later changes of meshing or of the
//! mannequin move no chart. [`crate::freeze()`] made them once.

use crate::LabError;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use toile_drape::{Cloth, Collider, Material, State, System, SystemBuilder};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec2, Vec3};
use toile_interchange::{ObjMesh, read_obj};

/// A scene as its file has it.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Card {
    /// Its name.
    pub name: String,
    /// What happens in it.
    pub title: String,
    /// Simulated time (s).
    pub duration: f64,
    /// Drag of the air per mass (1/s).
    pub air_drag: f64,
    /// Mass per area (kg/m2).
    pub density: f64,
    /// Stretch stiffness along warp and weft (N/m).
    pub stretch: [f64; 2],
    /// Shear stiffness (N/m).
    pub shear: f64,
    /// Poisson ratio.
    pub poisson: f64,
    /// Bending stiffness along warp, weft and bias (N m).
    pub bend: [f64; 3],
    /// Friction coefficient.
    pub friction: f64,
    /// File of a solid surface.
    pub collider: Option<String>,
    /// The cloth at several resolutions, coarse first.
    pub cloths: Vec<ClothCard>,
}

/// A cloth of a scene, as written.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct ClothCard {
    /// File of its mesh: positions at the start, texture coordinates the rest shape (m).
    pub mesh: String,
    /// Vertices that do not move.
    pub pins: Vec<u32>,
}

/// Where a motion ends, agreed on by two unlike methods.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Reference {
    /// The two methods.
    pub methods: [String; 2],
    /// Their steps (s).
    pub steps: [f64; 2],
    /// Root of the mean squared distance between their ends (m).
    pub agreement: f64,
    /// Positions at the end by the first (m).
    pub positions: Vec<[f32; 3]>,
}

macro_rules! files {
    ($($name:literal),* $(,)?) => {
        [$(($name, include_str!(concat!("../scenes/", $name)))),*]
    };
}

const FILES: [(&str, &str); 23] = files![
    "ball.obj",
    "body.obj",
    "cantilever.json",
    "cantilever-a.obj",
    "cantilever-b.obj",
    "cantilever-a.reference.json",
    "cantilever-b.reference.json",
    "hang.json",
    "hang-a.obj",
    "hang-b.obj",
    "hang-a.reference.json",
    "hang-b.reference.json",
    "sphere.json",
    "sphere-a.obj",
    "sphere-b.obj",
    "sphere-a.reference.json",
    "sphere-b.reference.json",
    "tube.json",
    "tube-a.obj",
    "tube-a.reference.json",
    "shirt.json",
    "shirt-a.obj",
    "shirt-a.reference.json",
];

/// Names of the standard scenes.
pub const SCENES: [&str; 5] = ["cantilever", "hang", "sphere", "tube", "shirt"];

fn damaged(file: &str, what: impl ToString) -> LabError {
    LabError::Damaged {
        file: file.to_owned(),
        what: what.to_string(),
    }
}

fn file(name: &str) -> Result<&'static str, LabError> {
    FILES
        .iter()
        .find(|(known, _)| *known == name)
        .map(|(_, text)| *text)
        .ok_or_else(|| damaged(name, "it is not part of the laboratory"))
}

fn obj(name: &str) -> Result<ObjMesh, LabError> {
    read_obj(file(name)?.as_bytes()).map_err(|error| damaged(name, error))
}

/// The card of a scene.
///
/// # Errors
/// A name that is no scene.
pub fn card(name: &str) -> Result<Card, LabError> {
    if !SCENES.contains(&name) {
        return Err(LabError::Unknown {
            what: "scene",
            name: name.to_owned(),
            known: SCENES.join(", "),
        });
    }
    let name = format!("{name}.json");
    serde_json::from_str(file(&name)?).map_err(|error| damaged(&name, error))
}

impl Card {
    /// The material of the cloth.
    pub fn material(&self) -> Material {
        Material {
            density: self.density,
            stretch: self.stretch,
            shear: self.shear,
            poisson: self.poisson,
            bend: self.bend,
            friction: self.friction,
            ..Material::default()
        }
    }

    /// The cloth at a resolution.
    ///
    /// # Errors
    /// A file of the laboratory is damaged.
    pub fn cloth(&self, resolution: usize) -> Result<Cloth, LabError> {
        let name = &self.cloths[resolution].mesh;
        let mesh = obj(name)?;
        if mesh.texture_triangles.len() != mesh.triangles.len() {
            return Err(damaged(name, "it has no rest shape"));
        }
        let rest = mesh
            .texture_triangles
            .iter()
            .map(|t| t.map(|k| mesh.texture[k as usize]))
            .collect::<Vec<[Vec2; 3]>>();
        // Groups are panels: triangles of one share a plane at rest.
        let mut panel = vec![0; rest.len()];
        for (number, group) in mesh.groups.iter().enumerate() {
            panel[group.triangles.clone()].fill(number as u32);
        }
        Ok(Cloth {
            positions: mesh.positions,
            material: vec![0; rest.len()],
            panel,
            triangles: mesh.triangles,
            rest,
            materials: vec![self.material()],
        })
    }

    /// The model of a cloth in this scene, and its state at the start.
    ///
    /// # Errors
    /// A file of the laboratory is damaged.
    pub fn system(&self, cloth: &Cloth, pins: &[u32]) -> Result<(System, State), LabError> {
        let mut builder = SystemBuilder::new(&self.name, cloth)?;
        builder.control.air_drag = self.air_drag;
        for &pin in pins {
            builder.pinned[pin as usize] = true;
        }
        if let Some(name) = &self.collider {
            let solid = obj(name)?;
            let surface = SurfaceTree::new(TriangleMesh {
                positions: solid.positions,
                triangles: solid.triangles,
            });
            builder.colliders.push(Collider::new(Arc::new(surface)));
        }
        let system = builder.build();
        let state = State::at_rest(&system, cloth.positions.clone());
        Ok((system, state))
    }

    /// Where the motion ends at a resolution; nothing when no two methods agreed on it.
    ///
    /// # Errors
    /// A file of the laboratory is damaged.
    pub fn reference(&self, resolution: usize) -> Result<Option<Reference>, LabError> {
        let name = self.cloths[resolution]
            .mesh
            .replace(".obj", ".reference.json");
        let text = file(&name)?;
        if text.trim().is_empty() {
            return Ok(None);
        }
        let found: Reference = serde_json::from_str(text).map_err(|error| damaged(&name, error))?;
        Ok(Some(found))
    }
}

/// A cloth with every triangle cut into four, its rest shape and its pins with it.
pub fn subdivided(cloth: &Cloth) -> Cloth {
    let mut fine = Cloth {
        positions: cloth.positions.clone(),
        materials: cloth.materials.clone(),
        ..Cloth::default()
    };
    let mut middles = std::collections::BTreeMap::new();
    for (t, corners) in cloth.triangles.iter().enumerate() {
        let rest = cloth.rest[t];
        let middle = [0, 1, 2].map(|k| {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let place: Vec3 = fine.positions[a as usize] + fine.positions[b as usize];
                fine.positions.push(place * 0.5);
                (fine.positions.len() - 1) as u32
            })
        });
        let half = [0, 1, 2].map(|k| (rest[k] + rest[(k + 1) % 3]) * 0.5);
        let [a, b, c] = *corners;
        let [ab, bc, ca] = middle;
        fine.triangles
            .extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        fine.rest.extend([
            [rest[0], half[0], half[2]],
            [half[0], rest[1], half[1]],
            [half[2], half[1], rest[2]],
            [half[0], half[1], half[2]],
        ]);
        fine.material.extend([cloth.material[t]; 4]);
        fine.panel.extend([cloth.panel[t]; 4]);
    }
    fine
}

/// Root of the mean squared distance of two sets of places (m).
pub(crate) fn apart(a: &[Vec3], b: &[Vec3]) -> f64 {
    let sum: f64 = a.iter().zip(b).map(|(p, q)| (p - q).norm_squared()).sum();
    (sum / a.len().max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_can_be_built() {
        for name in SCENES {
            let card = card(name).unwrap();
            for (k, cloth_card) in card.cloths.iter().enumerate() {
                let cloth = card.cloth(k).unwrap();
                let (system, state) = card.system(&cloth, &cloth_card.pins).unwrap();
                assert!(state.first_not_finite().is_none());
                assert!(system.topology.triangles.len() > 30, "{name}");
                let reference = card.reference(k).unwrap();
                if let Some(reference) = reference {
                    assert_eq!(reference.positions.len(), state.positions.len());
                }
            }
        }
        assert!(card("nowhere").is_err());
    }

    #[test]
    fn subdividing_keeps_area_and_doubles_the_resolution() {
        let card = card("hang").unwrap();
        let cloth = card.cloth(0).unwrap();
        let fine = subdivided(&cloth);
        assert_eq!(fine.triangles.len(), 4 * cloth.triangles.len());
        let area = |c: &Cloth| -> f64 {
            let areas = c
                .rest
                .iter()
                .map(|r| 0.5 * (r[1] - r[0]).perp(&(r[2] - r[0])).abs());
            areas.sum()
        };
        assert!((area(&fine) - area(&cloth)).abs() < 1e-12);
        assert_eq!(fine.mesh().component_count(), 1);
    }
}
