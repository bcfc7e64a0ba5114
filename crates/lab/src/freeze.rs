//! Generates the standard scenes.

use crate::flat::STRAIGHT;
use crate::scenes::{Card, ClothCard, Reference, SCENES, apart, card};
use crate::settle::in_time;
use crate::{Flat, LabError, MeshKind, rectangle};
use nalgebra::Rotation3;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use toile_drape::{Cloth, GarmentRun, Material, MethodKind, MethodSettings, Stage};
use toile_geometry::{TriangleMesh, Vec2, Vec3};
use toile_interchange::{ObjGroup, ObjMesh, write_all_atomically, write_obj};
use toile_session::{Command, Quality, Session, Silent, Watcher};

type File = (String, String);

fn failed(error: impl ToString) -> LabError {
    LabError::Files {
        what: error.to_string(),
    }
}

/// Digits that matter: a hundredth of a millimetre.
fn rounded(x: f64) -> f64 {
    (x * 1e5).round() / 1e5
}

fn cloth_obj(cloth: &Cloth) -> Result<String, LabError> {
    let mut mesh = ObjMesh {
        positions: cloth.positions.iter().map(|p| p.map(rounded)).collect(),
        triangles: cloth.triangles.clone(),
        ..ObjMesh::default()
    };
    let mut known = std::collections::BTreeMap::new();
    for rest in &cloth.rest {
        mesh.texture_triangles.push(rest.map(|p| {
            let p = p.map(|x| (x * 1e6).round() / 1e6);
            *known
                .entry([(p.x * 1e6).round() as i64, (p.y * 1e6).round() as i64])
                .or_insert_with(|| {
                    mesh.texture.push(p);
                    (mesh.texture.len() - 1) as u32
                })
        }));
    }
    for (t, &panel) in cloth.panel.iter().enumerate() {
        let name = format!("panel-{panel}");
        match mesh.groups.last_mut() {
            Some(group) if group.name == name => group.triangles.end = t + 1,
            _ => mesh.groups.push(ObjGroup {
                name,
                triangles: t..t + 1,
            }),
        }
    }
    write_obj(&mesh).map_err(failed)
}

fn solid_obj(solid: &TriangleMesh) -> Result<String, LabError> {
    let mesh = ObjMesh {
        positions: solid.positions.iter().map(|p| p.map(rounded)).collect(),
        triangles: solid.triangles.clone(),
        ..ObjMesh::default()
    };
    write_obj(&mesh).map_err(failed)
}

/// A card of a cloth, its cloths still missing.
fn blank(name: &str, title: &str, duration: f64, material: &Material) -> Card {
    Card {
        name: name.to_owned(),
        title: title.to_owned(),
        duration,
        air_drag: 0.0,
        density: material.density,
        stretch: material.stretch,
        shear: material.shear,
        poisson: material.poisson,
        bend: material.bend,
        friction: material.friction,
        collider: None,
        cloths: Vec::new(),
    }
}

fn add(
    files: &mut Vec<File>,
    card: &mut Card,
    flat: &Flat,
    place: impl Fn(Vec2) -> Vec3,
    pinned: impl Fn(Vec2) -> bool,
) -> Result<(), LabError> {
    let letter = ["a", "b", "c"][card.cloths.len()];
    let mesh = format!("{}-{letter}.obj", card.name);
    files.push((
        mesh.clone(),
        cloth_obj(&flat.cloth(card.material(), place))?,
    ));
    card.cloths.push(ClothCard {
        mesh,
        pins: flat.chosen(pinned),
    });
    Ok(())
}

fn finish(files: &mut Vec<File>, card: &Card) -> Result<(), LabError> {
    let text = serde_json::to_string_pretty(card).map_err(failed)?;
    files.push((format!("{}.json", card.name), text + "\n"));
    Ok(())
}

fn cantilever(files: &mut Vec<File>) -> Result<(), LabError> {
    let material = Material {
        bend: [2e-4; 3],
        stretch: [500.0; 2],
        shear: 250.0,
        poisson: 0.0,
        ..Material::default()
    };
    let title = "a strip of 0.2 m is let go horizontally and bends down";
    let mut card = blank("cantilever", title, 0.25, &material);
    for elements in [16, 40] {
        let cell = 0.2 / (f64::from(elements) + 0.5);
        let from = -(STRAIGHT as f64 - 0.5) * cell;
        let rows = (elements / 4) as usize;
        let flat = rectangle(
            MeshKind::Delaunay,
            Vec2::new(from, 0.0),
            Vec2::new(0.2, rows as f64 * cell),
            [elements as usize + STRAIGHT, rows],
        )?;
        let held = |p: Vec2| p.x < 0.51 * cell;
        add(files, &mut card, &flat, |p| Vec3::new(p.x, 0.0, p.y), held)?;
    }
    finish(files, &card)
}

/// A cotton whose stretch a person would not notice.
fn cotton() -> Material {
    Material {
        stretch: [500.0; 2],
        shear: 60.0,
        bend: [1e-5; 3],
        ..Material::default()
    }
}

/// The same with the bending stiffness of a heavy twill: fewer folds, better determined.
fn stiff_cotton() -> Material {
    Material {
        bend: [5e-5; 3],
        ..cotton()
    }
}

fn hang(files: &mut Vec<File>) -> Result<(), LabError> {
    let title = "a square of 0.5 m held at two corners swings down";
    let mut card = blank("hang", title, 0.4, &cotton());
    for cells in [12, 28] {
        let flat = rectangle(
            MeshKind::Alternating,
            Vec2::zeros(),
            Vec2::new(0.5, 0.5),
            [cells, cells],
        )?;
        let corner = |p: Vec2| p.y < 1e-9 && (p.x < 1e-9 || p.x > 0.5 - 1e-9);
        add(
            files,
            &mut card,
            &flat,
            |p| Vec3::new(p.x, 0.0, p.y),
            corner,
        )?;
    }
    finish(files, &card)
}

/// A ball of a radius about the origin: an icosahedron cut so many times.
pub(crate) fn ball(radius: f64, cuts: usize) -> TriangleMesh {
    let g = 0.5 * (1.0 + 5.0f64.sqrt());
    let mut mesh = TriangleMesh::default();
    for (a, b) in [(-1.0, g), (1.0, g), (-1.0, -g), (1.0, -g)] {
        mesh.positions.push(Vec3::new(a, b, 0.0));
    }
    for (a, b) in [(-1.0, g), (1.0, g), (-1.0, -g), (1.0, -g)] {
        mesh.positions.push(Vec3::new(0.0, a, b));
    }
    for (a, b) in [(g, -1.0), (g, 1.0), (-g, -1.0), (-g, 1.0)] {
        mesh.positions.push(Vec3::new(a, 0.0, b));
    }
    mesh.triangles = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..cuts {
        let cloth = Cloth {
            positions: mesh.positions,
            rest: vec![[Vec2::zeros(); 3]; mesh.triangles.len()],
            material: vec![0; mesh.triangles.len()],
            panel: vec![0; mesh.triangles.len()],
            triangles: mesh.triangles,
            materials: Vec::new(),
        };
        mesh = crate::subdivided(&cloth).mesh();
    }
    for p in &mut mesh.positions {
        *p = p.normalize() * radius;
    }
    mesh
}

fn sphere(files: &mut Vec<File>) -> Result<(), LabError> {
    let title = "a square of 0.5 m falls on a ball of 0.12 m radius";
    let mut card = blank("sphere", title, 0.12, &stiff_cotton());
    card.friction = 0.3;
    card.collider = Some("ball.obj".to_owned());
    files.push(("ball.obj".to_owned(), solid_obj(&ball(0.12, 3))?));
    // Off the middle, so that where it folds does not hang on rounding.
    let place = |p: Vec2| Vec3::new(p.x + 0.03, 0.13, p.y + 0.017);
    for cells in [12, 28] {
        let flat = rectangle(
            MeshKind::Alternating,
            Vec2::new(-0.25, -0.25),
            Vec2::new(0.25, 0.25),
            [cells, cells],
        )?;
        add(files, &mut card, &flat, place, |_| false)?;
    }
    finish(files, &card)
}

fn tube(files: &mut Vec<File>) -> Result<(), LabError> {
    let title =
        "a tube of 0.1 m radius sewn of one panel, held at its upper edge, swings from a slant";
    let mut card = blank("tube", title, 0.25, &stiff_cotton());
    let (radius, height, columns, rows) = (0.1, 0.4, 24, 16);
    let around = std::f64::consts::TAU * radius;
    let flat = rectangle(
        MeshKind::Alternating,
        Vec2::zeros(),
        Vec2::new(around, height),
        [columns, rows],
    )?;
    let slant = 0.5f64;
    let cloth = flat.cloth(card.material(), |p| {
        let angle = p.x / radius;
        Rotation3::from_axis_angle(&Vec3::z_axis(), slant)
            * Vec3::new(radius * angle.cos(), -p.y, radius * angle.sin())
    });
    // The first and the last column are sewn.
    let mut target = Vec::new();
    let mut count = 0;
    for (v, p) in flat.points.iter().enumerate() {
        if p.x > around - 1e-9 {
            target.push(target[v - columns]);
        } else {
            target.push(count);
            count += 1;
        }
    }
    let sewn = cloth.merged(&target, count as usize);
    let mut pins: Vec<u32> = flat.chosen(|p| p.y < 1e-9);
    pins = pins.iter().map(|&v| target[v as usize]).collect();
    pins.sort_unstable();
    pins.dedup();
    files.push(("tube-a.obj".to_owned(), cloth_obj(&sewn)?));
    card.cloths.push(ClothCard {
        mesh: "tube-a.obj".to_owned(),
        pins,
    });
    finish(files, &card)
}

fn shirt(files: &mut Vec<File>) -> Result<(), LabError> {
    let title = "a T-shirt, just sewn, settles on a mannequin";
    let mut session = Session::new();
    let commands = [
        Command::open(toile_session::SAMPLE),
        Command::SetQuality {
            quality: Quality::Preview,
        },
    ];
    session
        .execute_all(&commands, &mut Silent)
        .map_err(failed)?;
    let job = session.garment_setup().map_err(failed)?;
    let mut setup = job.setup;
    setup.levels.truncate(1);
    let Some(placed) = setup.levels.first().map(|level| level.cloth.clone()) else {
        return Err(failed("the shirt has no mesh"));
    };
    let material = placed.materials[0].clone();
    let mut card = blank("shirt", title, 0.1, &material);
    card.collider = Some("body.obj".to_owned());
    if let Some(body) = setup.colliders.first() {
        files.push(("body.obj".to_owned(), solid_obj(body.mesh())?));
    }
    let mut run = GarmentRun::new(setup)?;
    while run.progress().stage == Stage::Sewing {
        run.advance()?;
    }
    let mut sewn = placed.merged(run.target(), run.state.positions.len());
    sewn.positions.clone_from(&run.state.positions);
    files.push(("shirt-a.obj".to_owned(), cloth_obj(&sewn)?));
    card.cloths.push(ClothCard {
        mesh: "shirt-a.obj".to_owned(),
        pins: Vec::new(),
    });
    finish(files, &card)
}

/// Makes the standard scenes anew in a folder.
///
/// # Errors
/// The garment cannot be sewn, or the folder not be written.
pub fn freeze(folder: &Path) -> Result<Vec<PathBuf>, LabError> {
    let mut files = Vec::new();
    for make in [cantilever, hang, sphere, tube, shirt] {
        make(&mut files)?;
    }
    write_all_atomically(folder, &files).map_err(failed)?;
    Ok(files.iter().map(|(name, _)| folder.join(name)).collect())
}

/// The unlike methods whose agreement makes a reference: one explicit, one implicit, both of
/// second order.
const METHODS: [MethodKind; 2] = [MethodKind::VelocityVerlet, MethodKind::Bdf2];

/// Their steps (s): the explicit one takes substeps within it by its own stability.
const STEPS: [f64; 2] = [1.0 / 7680.0, 1.0 / 3840.0];

/// Runs the scenes named (or all) with two unlike methods at fine steps and writes where they end.
///
/// # Errors
/// A method failed, or the folder cannot be written.
pub fn reference(
    names: &[String],
    folder: &Path,
    watcher: &mut dyn Watcher,
) -> Result<Vec<PathBuf>, LabError> {
    let chosen: Vec<&str> = SCENES
        .into_iter()
        .filter(|name| names.is_empty() || names.iter().any(|n| n == name))
        .collect();
    let mut written = Vec::new();
    for (k, name) in chosen.iter().enumerate() {
        let card = card(name)?;
        for (r, cloth_card) in card.cloths.iter().enumerate() {
            let cloth = card.cloth(r)?;
            let (system, start) = card.system(&cloth, &cloth_card.pins)?;
            let mut ends = Vec::new();
            for (kind, step) in METHODS.into_iter().zip(STEPS) {
                let share = k as f64 / chosen.len() as f64;
                let detail = format!("{}, {}", cloth_card.mesh, kind.name());
                if watcher.progress("reference", share, &detail) == ControlFlow::Break(()) {
                    return Err(LabError::Cancelled);
                }
                let mut state = start.clone();
                let settings = MethodSettings {
                    tolerance: Some(1e-9),
                    ..kind.into()
                };
                in_time(&system, &mut state, settings, [step, card.duration], |_| {})?;
                ends.push(state.positions);
            }
            let found = Reference {
                methods: METHODS.map(|m| m.name().to_owned()),
                steps: STEPS,
                agreement: apart(&ends[0], &ends[1]),
                positions: ends[0]
                    .iter()
                    .map(|p| [p.x as f32, p.y as f32, p.z as f32])
                    .collect(),
            };
            let text = serde_json::to_string(&found).map_err(failed)? + "\n";
            let name = cloth_card.mesh.replace(".obj", ".reference.json");
            write_all_atomically(folder, &[(&name, text)]).map_err(failed)?;
            written.push(folder.join(name));
        }
    }
    Ok(written)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_is_closed_and_round() {
        let ball = ball(0.12, 2);
        assert!(ball.is_closed_and_oriented());
        assert!(ball.volume() > 0.0);
        assert!(
            ball.positions
                .iter()
                .all(|p| (p.norm() - 0.12).abs() < 1e-12)
        );
    }

    #[test]
    fn the_frozen_cantilever_is_what_the_program_makes() {
        let mut files = Vec::new();
        cantilever(&mut files).unwrap();
        let made: Card = serde_json::from_str(&files.last().unwrap().1).unwrap();
        assert_eq!(made.cloths.len(), 2);
        assert!(made.cloths[0].pins.len() > 8);
    }
}
