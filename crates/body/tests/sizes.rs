//! Bodies for whole tables of sizes: every measurement as asked on the finished skin.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::collections::BTreeMap;
use std::path::PathBuf;
use toile_body::{Figure, Mannequin, Part};
use toile_geometry::{closed_length, convex_hull, horizontal_section};
use toile_measure::{FREESEWING, Measurements, Origin, UnitKind, definition, translated};

fn shared(file: &str) -> Option<String> {
    let start = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let found = start
        .ancestors()
        .map(|folder| folder.join("shared/data").join(file))
        .find(|path| path.is_file());
    match found {
        Some(path) => std::fs::read_to_string(path).ok(),
        None => {
            println!("skipped: no shared data folder");
            None
        }
    }
}

type Sets = BTreeMap<String, BTreeMap<String, BTreeMap<String, f64>>>;

/// All FreeSewing sets: name, figure and table.
fn freesewing() -> Vec<(String, Figure, Measurements)> {
    let Some(text) = shared("body/measurements/freesewing_models_4.10.2.json") else {
        return Vec::new();
    };
    let file: serde_json::Value = serde_json::from_str(&text).unwrap();
    let mut all = Vec::new();
    for group in ["adult", "doll", "giant"] {
        let sets: Sets = serde_json::from_value(file[group].clone()).unwrap();
        for (sex, sizes) in sets {
            let figure = if sex == "cisFemale" {
                Figure::Woman
            } else {
                Figure::Man
            };
            for (size, values) in sizes {
                let mut table = Measurements::new();
                for (name, value) in values {
                    let own = translated(FREESEWING, &name).unwrap();
                    let si = match definition(own).unwrap().kind {
                        UnitKind::Length => value * 1e-3,
                        UnitKind::Angle => value.to_radians(),
                    };
                    table.set(own, si, Origin::Asked).unwrap();
                }
                all.push((format!("{group} {sex} {size}"), figure, table));
            }
        }
    }
    all
}

/// Girth of the trunk by a level tape, by nothing of the library's own tape: the hull of the whole
/// section of the mesh between the arms.
fn girth(body: &Mannequin, height: f64) -> f64 {
    let (mesh, parts) = (body.skin(), body.part_of_triangle());
    let own = |part: Part| matches!(part, Part::Trunk | Part::LeftLeg | Part::RightLeg);
    let triangles = (0..mesh.triangles.len()).filter(|&t| own(parts[t]));
    closed_length(&convex_hull(&horizontal_section(mesh, triangles, height)))
}

fn is_sound(body: &Mannequin) -> bool {
    let skin = body.skin();
    skin.check() == Ok(())
        && skin.is_closed_and_oriented()
        && skin.euler_characteristic() == 2
        && skin.component_count() == 1
        && skin.volume() > 0.0
        && body.skin_tree().self_intersections().is_empty()
}

#[test]
fn every_freesewing_set_has_its_girths_and_names_what_contradicts() {
    for (name, figure, table) in freesewing() {
        let body = Mannequin::new(&table, figure).unwrap();
        assert!(is_sound(&body), "{name}");
        let scale = body.levels().crown / 1.7;
        let conflicts = body.conflicts();
        // Every measure is in the table or said to be beyond a standing body.
        let rows = body.measure();
        let asked = rows.iter().filter(|row| row.origin == Origin::Asked);
        assert_eq!(
            asked.clone().count() + body.untaken().len(),
            table.len(),
            "{name}"
        );
        assert_eq!(body.untaken(), ["crotch_depth"], "{name}");
        for row in asked {
            let limit = if row.is_girth() { 5e-4 } else { 1e-3 };
            let named = conflicts.iter().any(|c| c.names.contains(&row.name));
            let within = row.is_angle() || row.gap().abs() <= limit * scale.max(1.0);
            assert!(within || (named && !row.is_girth()), "{name}: {row:?}");
        }
        let levels = body.levels();
        for (measure, height) in [
            ("bust", levels.chest),
            ("waist", levels.waist),
            ("hips", levels.hip),
        ] {
            let gap = girth(&body, height) - table.get(measure).unwrap();
            assert!(
                gap.abs() <= 5e-4 * scale.max(1.0),
                "{name} {measure}: {gap}"
            );
        }
        let high = conflicts.iter().any(|c| c.names == ["bust", "high_bust"]);
        assert_eq!(high, figure == Figure::Man, "{name}");
        dump(&name, &body);
    }
}

/// Writes the body where the variable says, to be looked at.
fn dump(name: &str, body: &Mannequin) {
    let Ok(folder) = std::env::var("TOILE_DUMP") else {
        return;
    };
    let mut text = String::new();
    for p in &body.skin().positions {
        text += &format!("v {} {} {}\n", p.x, p.y, p.z);
    }
    for t in &body.skin().triangles {
        text += &format!("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
    }
    std::fs::write(format!("{folder}/{}.obj", name.replace(' ', "_")), text).unwrap();
    let mut table = String::new();
    for row in body.measure() {
        table += &format!(
            "{:24} {:8.1} {:8.1} {:7.2} {:?}\n",
            row.name,
            row.asked * 1e3,
            row.got * 1e3,
            row.gap() * 1e3,
            row.origin
        );
    }
    for conflict in body.conflicts() {
        table += &format!("! {:?} {:.1} mm\n", conflict.names, conflict.gap * 1e3);
    }
    std::fs::write(format!("{folder}/{}.txt", name.replace(' ', "_")), table).unwrap();
}

/// The survey's names and the catalogue's: twelve girths and ten lengths.
const ASKED: [(&str, &str); 22] = [
    ("chestcircumference", "bust"),
    ("waistcircumference", "waist"),
    ("buttockcircumference", "hips"),
    ("neckcircumference", "neck"),
    ("bicepscircumferenceflexed", "upper_arm"),
    ("forearmcircumferenceflexed", "forearm"),
    ("wristcircumference", "wrist"),
    ("thighcircumference", "leg_circ"),
    ("lowerthighcircumference", "lower_thigh"),
    ("calfcircumference", "calf"),
    ("anklecircumference", "ankle"),
    ("headcircumference", "head"),
    ("stature", "height"),
    ("cervicaleheight", "nape_height"),
    ("acromialheight", "shoulder_height"),
    ("chestheight", "bust_height"),
    ("waistheightomphalion", "waist_height"),
    ("buttockheight", "hip_height"),
    ("crotchheight", "inside_leg"),
    ("kneeheightmidpatella", "knee_height"),
    ("sleeveoutseam", "arm_length"),
    ("biacromialbreadth", "shoulder_w"),
];

/// Every `step`th of the survey's people with the measurements asked.
fn people(step: usize) -> Vec<(usize, Figure, Measurements, BTreeMap<String, f64>)> {
    let Some(text) = shared("body/measurements/ansur2_subjects_garment.csv") else {
        return Vec::new();
    };
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    lines
        .enumerate()
        .step_by(step)
        .map(|(index, line)| {
            let cells: Vec<&str> = line.split(',').collect();
            let all: BTreeMap<String, f64> = names
                .iter()
                .zip(&cells)
                .filter_map(|(name, cell)| {
                    Some(((*name).to_owned(), cell.parse::<f64>().ok()? * 1e-3))
                })
                .collect();
            let mut table = Measurements::new();
            for (from, name) in ASKED {
                table.set(name, all[from], Origin::Asked).unwrap();
            }
            let figure = if cells[0] == "f" {
                Figure::Woman
            } else {
                Figure::Man
            };
            (index, figure, table, all)
        })
        .collect()
}

#[test]
fn people_of_the_survey_have_what_was_measured() {
    // All 6,068 with TOILE_ALL set; every 101st else.
    let step = if std::env::var("TOILE_ALL").is_ok() {
        1
    } else {
        101
    };
    let everyone = people(step);
    let mut failed = Vec::new();
    let mut crossed = Vec::new();
    for (index, figure, table, _) in &everyone {
        let body = match Mannequin::new(table, *figure) {
            Ok(body) => body,
            Err(error) => {
                failed.push(format!("person {index}: {error}"));
                continue;
            }
        };
        let asked = body
            .measure()
            .into_iter()
            .filter(|row| row.origin == Origin::Asked);
        let missed: Vec<String> = asked
            .filter(|row| row.gap().abs() > 1e-3)
            .map(|row| format!("{} {:.1} mm", row.name, row.gap() * 1e3))
            .collect();
        if !missed.is_empty() {
            failed.push(format!("person {index}: {}", missed.join(", ")));
        }
        if !is_sound(&body) {
            crossed.push(index);
        }
    }
    println!(
        "{} people, {} missed, {} not sound",
        everyone.len(),
        failed.len(),
        crossed.len()
    );
    for line in &failed {
        println!("{line}");
    }
    println!("not sound: {crossed:?}");
    assert!(
        failed.len() * 200 <= everyone.len(),
        "{} of {}",
        failed.len(),
        everyone.len()
    );
    assert!(crossed.is_empty());
}
