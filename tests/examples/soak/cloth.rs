//! Long runs of cloth on cloth: hard scenes at full size, and planted tangles.

#[path = "../../../crates/drape/tests/suite/support/hard_run.rs"]
mod hard_run;
#[path = "../../../crates/drape/tests/suite/support/hard_scenes.rs"]
mod hard_scenes;
#[path = "../../../crates/drape/tests/suite/support/numbers.rs"]
mod numbers;
#[path = "../../../crates/drape/tests/suite/support/tangles.rs"]
mod planted;
#[path = "../../../crates/drape/tests/suite/support/sheets.rs"]
mod sheets;
#[path = "../../../crates/drape/tests/suite/support/solids.rs"]
mod solids;

use hard_run::run;
use hard_scenes::{Size, hard_scenes};
use std::path::{Path, PathBuf};
use std::time::Instant;
use toile_drape::{Kind, SceneRun};
use toile_picture::{Finish, Scene, Sheet, Surface, drape_picture};

/// Colours of the cloths of a scene, in turn.
const COLOURS: [[f64; 3]; 6] = [
    [0.75, 0.30, 0.28],
    [0.30, 0.52, 0.36],
    [0.28, 0.40, 0.68],
    [0.78, 0.66, 0.30],
    [0.50, 0.36, 0.60],
    [0.32, 0.60, 0.62],
];

/// Runs the hard scenes named, or all.
pub fn hard(arguments: &[String]) -> Result<(), String> {
    let (mut out, mut size) = (None, Size::Long);
    let mut names = Vec::new();
    let mut rest = arguments.iter();
    while let Some(argument) = rest.next() {
        match argument.as_str() {
            "--out" => out = Some(PathBuf::from(rest.next().ok_or("--out needs a folder")?)),
            "--short" => size = Size::Short,
            option if option.starts_with("--") => return Err(format!("{option} is not known")),
            name => names.push(name.to_owned()),
        }
    }
    let known: Vec<&str> = hard_scenes(size).iter().map(|scene| scene.name).collect();
    if let Some(name) = names.iter().find(|name| !known.contains(&name.as_str())) {
        return Err(format!(
            "{name} is no scene; there are: {}",
            known.join(", ")
        ));
    }
    println!(
        "scene,triangles,steps,crossings_most,crossings_end,body_crossings,penetration_m,energy_rise_J,energy_scale_J,momentum,angular_momentum,impulses,cut,wall_s"
    );
    let mut left = Vec::new();
    for scene in hard_scenes(size) {
        if !names.is_empty() && !names.iter().any(|name| name == scene.name) {
            continue;
        }
        let (name, start) = (scene.name, Instant::now());
        let (end, found) = run(scene);
        println!(
            "{name},{},{},{},{},{},{:.1e},{:.2e},{:.2e},{:.1e},{:.1e},{},{},{:.1}",
            end.system.topology.triangles.len(),
            found.steps,
            found.crossings[0],
            found.crossings[1],
            found.body_crossings,
            found.penetration,
            found.energy_rise,
            found.energy_scale,
            found.momentum[0],
            found.momentum[1],
            found.tally.impulses,
            found.tally.cut,
            start.elapsed().as_secs_f64()
        );
        if let Some(out) = &out {
            picture(
                &end,
                &out.join(format!("{}.png", name.replace([' ', '/'], "-"))),
            )?;
        }
        let faults = found.faults();
        if !faults.is_empty() {
            left.push(format!("{name}: {}", faults.join(", ")));
        }
    }
    match left.is_empty() {
        true => Ok(()),
        false => Err(left.join("\n")),
    }
}

/// Runs so many planted tangles.
pub fn tangles(arguments: &[String]) -> Result<(), String> {
    let count = match arguments.first() {
        None => 100,
        Some(text) => text.parse().map_err(|_| format!("{text}: no number"))?,
    };
    println!("seed,kind,cloth_start,body_start,cloth_end,body_end,wall_s");
    let mut left = Vec::new();
    for seed in 0..count {
        let said = |error: toile_drape::DrapeError| format!("seed {seed}: {error}");
        let start = Instant::now();
        let mut run =
            SceneRun::new(&planted::tangle(seed), toile_reference::build).map_err(said)?;
        let before = run.measure();
        while !run.finished() {
            run.advance().map_err(said)?;
        }
        let after = run.measure();
        let (cloth, body) = (after.self_intersections, after.body_intersections);
        println!(
            "{seed},{},{},{},{cloth},{body},{:.1}",
            planted::KINDS[seed as usize % planted::KINDS.len()],
            before.self_intersections,
            before.body_intersections,
            start.elapsed().as_secs_f64()
        );
        if cloth + body > 0 {
            left.push(seed.to_string());
        }
    }
    match left.is_empty() {
        true => Ok(()),
        false => Err(format!("crossings are left in seeds {}", left.join(", "))),
    }
}

/// Draws where everything lies.
fn picture(run: &SceneRun, file: &Path) -> Result<(), String> {
    let mut surfaces = Vec::new();
    let mut cloths = COLOURS.iter().cycle();
    for ((_, object), mesh) in run.world().objects().zip(run.meshes()) {
        if object.kind == Kind::Deformable {
            let colour = cloths.next().copied().unwrap_or_default();
            surfaces.push(Surface::plain(mesh, colour, Finish::Cloth));
        } else if !matches!(
            object.name.as_str(),
            "floor" | "lid" | "left" | "right" | "front" | "back"
        ) {
            surfaces.push(Surface::plain(mesh, [0.8; 3], Finish::Smooth));
        }
    }
    let said = |error: toile_picture::PictureError| error.to_string();
    let picture = drape_picture(&Scene { surfaces }, &Sheet::studio("")).map_err(said)?;
    let bytes = picture.to_png().map_err(said)?;
    if let Some(folder) = file.parent() {
        std::fs::create_dir_all(folder).map_err(|error| error.to_string())?;
    }
    std::fs::write(file, bytes).map_err(|error| error.to_string())
}
