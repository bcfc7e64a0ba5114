//! Bodies for whole tables of sizes: every measurement as asked on the finished skin.

use crate::common::freesewing::freesewing;
use crate::common::survey::people;
use crate::common::{is_sound, shared};
use toile_body::{Conflict, Figure, Mannequin, Part};
use toile_geometry::{closed_length, convex_hull, horizontal_section};
use toile_measure::{Measurements, Origin};

/// Names that contradict one another, and by how much each may be missed for it (m).
type Contradiction = (&'static [&'static str], f64);

/// What cannot be together by what was asked alone. The waist's height is rise and inside leg
/// together: each is missed by its share of the misfit. The straight way from the side of the neck
/// to the level of the waist is no longer than the one over the bust and down, however the front
/// falls under it up to 45 degrees: then the way under the bust is missed by no more than makes
/// straight and round way equal.
fn contradictions(table: &Measurements) -> Vec<Contradiction> {
    let get = |name: &str| table.get(name).unwrap();
    let around = get("waist_height") - get("waist_to_crotch") - get("inside_leg");
    let [straight, bust] = ["hps_to_waist_front", "bust_line"].map(get);
    let [under, below] = ["bust_to_underbust", "waist_to_underbust"].map(get);
    let mut found: Vec<Contradiction> = Vec::new();
    if around.abs() > 1e-3 {
        let names = &["waist_height", "waist_to_crotch", "inside_leg"];
        found.push((names, 0.5 * around.abs()));
    }
    if bust + under + 2f64.sqrt() * below < straight {
        let more = straight - bust - under - below;
        found.push((&["bust_to_underbust"], more + 0.02 * straight));
    }
    found
}

/// Whether a measurement is the height of the hips and is said to be missed: where the largest girth
/// lies elsewhere than asked, the girth is met.
fn gives_way_to_hips(name: &str, conflicts: &[Conflict]) -> bool {
    ["hips_line", "hip_height"].contains(&name) && conflicts.iter().any(|c| c.names.contains(&name))
}

/// Girth of the trunk by a level tape, by nothing of the library's own tape: the hull of the whole
/// section of the mesh between the arms.
fn girth(body: &Mannequin, height: f64) -> f64 {
    let (mesh, parts) = (body.skin(), body.part_of_triangle());
    let own = |part: Part| matches!(part, Part::Trunk | Part::LeftLeg | Part::RightLeg);
    let triangles = (0..mesh.triangles.len()).filter(|&t| own(parts[t]));
    closed_length(&convex_hull(&horizontal_section(mesh, triangles, height)))
}

/// Largest (1) or smallest (-1) such girth between two shares of the way from crotch to crown.
fn extreme(body: &Mannequin, [low, high]: [f64; 2], sign: f64) -> f64 {
    let levels = body.levels();
    let girths = (0..=100).map(|k| {
        let share = low + (high - low) * f64::from(k) / 100.0;
        sign * girth(body, levels.crotch + share * (levels.crown - levels.crotch))
    });
    sign * girths.fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn every_freesewing_set_has_its_girths_and_names_what_contradicts() {
    let mut missed = Vec::new();
    for (name, figure, table) in freesewing() {
        let body = Mannequin::new(&table, figure).unwrap();
        dump(&name, &body);
        if !is_sound(&body) {
            missed.push(format!("{name}: not sound"));
        }
        let contradictions = contradictions(&table);
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
            let limit = match (row.is_angle(), row.is_girth()) {
                (true, _) => 0.02,
                (_, true) => 5e-4,
                _ => 1e-3,
            };
            // Only what contradicts itself is missed, and no farther than it must.
            let own = contradictions.iter().filter(|c| c.0.contains(&row.name));
            let limit = own.map(|c| c.1).fold(limit, f64::max);
            if row.deviation().abs() > limit && !gives_way_to_hips(row.name, &conflicts) {
                missed.push(format!(
                    "{name}: {} {:.1} mm",
                    row.name,
                    1e3 * row.deviation()
                ));
            }
        }
        for (names, _) in &contradictions {
            let named = |c: &Conflict| names.iter().all(|name| c.names.contains(name));
            assert!(
                conflicts.iter().any(named),
                "{name}: {names:?} {conflicts:?}"
            );
        }
        // Women's ways over the bust go together.
        assert_eq!(
            conflicts
                .iter()
                .any(|c| c.names.contains(&"bust_to_underbust")),
            figure == Figure::Man,
            "{name}: {conflicts:?}"
        );
        for (measure, places, sign) in [
            ("bust", [0.44, 0.5], 1.0),
            ("waist", [0.28, 0.35], -1.0),
            ("hips", [0.035, 0.11], 1.0),
        ] {
            let gap = extreme(&body, places, sign) - table.get(measure).unwrap();
            assert!(gap.abs() <= 5e-4, "{name} {measure}: {gap}");
        }
        let high = conflicts.iter().any(|c| c.names == ["bust", "high_bust"]);
        assert_eq!(high, figure == Figure::Man, "{name}");
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
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
            row.deviation() * 1e3,
            row.origin
        );
    }
    for conflict in body.conflicts() {
        table += &format!("! {:?} {:.1} mm\n", conflict.names, conflict.gap * 1e3);
    }
    std::fs::write(format!("{folder}/{}.txt", name.replace(' ', "_")), table).unwrap();
}

#[test]
fn people_of_the_survey_have_what_was_measured() {
    // All 6,068 with TOILE_ALL set; every 101st else.
    let step = if std::env::var("TOILE_ALL").is_ok() {
        1
    } else {
        101
    };
    let Some(path) = shared("body/measurements/ansur2_subjects_garment.csv") else {
        return;
    };
    let all = people(&std::fs::read_to_string(path).unwrap());
    let everyone: Vec<_> = all.iter().step_by(step).collect();
    let mut failed = Vec::new();
    let mut crossed = Vec::new();
    for person in &everyone {
        let index = person.row;
        let body = match Mannequin::new(&person.asked(), person.figure) {
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
        let conflicts = body.conflicts();
        let missed: Vec<String> = asked
            .filter(|row| row.deviation().abs() > 1e-3)
            .filter(|row| !gives_way_to_hips(row.name, &conflicts))
            .map(|row| format!("{} {:.1} mm", row.name, row.deviation() * 1e3))
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
    assert!(failed.is_empty());
    assert!(crossed.is_empty());
}
