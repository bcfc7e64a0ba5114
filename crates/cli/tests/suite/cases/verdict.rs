//! A run that failed is told: in words, in `warnings`, as `verdict` and by the exit status.

use super::case;
use crate::common::{toile, words};
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::Path;

/// A square of `cells` x `cells` cells as OBJ, mapped by `place` from 0..1 x 0..1; vertices row after row.
fn square(cells: usize, place: impl Fn(f64, f64) -> [f64; 3]) -> String {
    let share = |k: usize| k as f64 / cells as f64;
    let mut text = String::new();
    for j in 0..=cells {
        for i in 0..=cells {
            let [x, y, z] = place(share(i), share(j));
            writeln!(text, "v {x} {y} {z}").unwrap();
        }
    }
    for j in 0..cells {
        for i in 0..cells {
            let a = 1 + j * (cells + 1) + i;
            let (b, c, d) = (a + 1, a + cells + 2, a + cells + 1);
            writeln!(text, "f {a} {b} {c}\nf {a} {c} {d}").unwrap();
        }
    }
    text
}

/// The meshes of the scenes here: a level cloth of 30 cm with corners 0, 4, 20 and 24, one upright through it, two
/// upright ones beside each other with vertex 14 of the first facing vertex 10 of the second 5 cm away, and a block.
fn meshes(folder: &Path) {
    let write = |name: &str, text: String| std::fs::write(folder.join(name), text).unwrap();
    write("level.obj", square(4, |u, v| [0.3 * u, 1.0, -0.3 * v]));
    write(
        "upright.obj",
        square(4, |u, v| [0.3 * u + 0.003, 0.85 + 0.3 * v, -0.14]),
    );
    write("left.obj", square(4, |u, v| [0.2 * u, 0.2 * v, 0.0]));
    write(
        "right.obj",
        square(4, |u, v| [0.25 + 0.2 * u, 0.2 * v, 0.0]),
    );
    let corner = |k: usize| [k & 1, k >> 1 & 1, k >> 2].map(|bit| bit as f64);
    let mut block = String::new();
    for [x, y, z] in (0..8).map(corner) {
        writeln!(
            block,
            "v {} {} {}",
            0.4 * x - 0.05,
            0.2 * y + 0.9,
            0.05 - 0.4 * z
        )
        .unwrap();
    }
    for [a, b, c, d] in [
        [1, 2, 4, 3],
        [5, 7, 8, 6],
        [1, 5, 6, 2],
        [3, 4, 8, 7],
        [1, 3, 7, 5],
        [2, 6, 8, 4],
    ] {
        writeln!(block, "f {a} {b} {c}\nf {a} {c} {d}").unwrap();
    }
    write("block.obj", block);
}

fn cloth(mesh: &str, pins: &[u32]) -> Value {
    let file = format!("{mesh}.obj");
    json!({ "name": mesh, "kind": "deformable", "mesh": file, "pins": pins })
}

/// A scene of half a second unless `more` says otherwise.
fn scene(objects: &[Value], more: Value) -> Value {
    let mut scene = json!({ "duration": 0.5, "step": 0.01, "objects": objects });
    let fields = more.as_object().unwrap().clone();
    scene.as_object_mut().unwrap().extend(fields);
    scene
}

/// Runs a scene: exit status, what was said, report.
fn run(folder: &Path, scene: &Value, more: &[&str]) -> (Option<i32>, String, Value) {
    std::fs::write(folder.join("scene.json"), scene.to_string()).unwrap();
    let arguments = [&["run", "scene.json", "--out", "out"], more].concat();
    let output = toile(folder, &arguments);
    let report = std::fs::read(folder.join("out/report.json")).unwrap();
    let report = serde_json::from_slice(&report).unwrap();
    (output.status.code(), words(&output.stderr), report)
}

const CORNERS: [u32; 4] = [0, 4, 20, 24];

/// An elastic between the two cloths that face each other, to merge their vertices.
fn elastic(stiffness: f64) -> Value {
    json!([{ "from": ["left", 14], "to": ["right", 10], "stiffness": stiffness, "merge_within": 0.001 }])
}

/// Scenes that fail: what of the verdict says so, and words that must be told.
fn failing_scenes() -> Vec<(Value, [&'static str; 2])> {
    let rest =
        |iterations: usize| json!({ "method": { "name": "rest", "iterations": iterations } });
    let level = |pins| [cloth("level", pins)];
    let facing = |left, right| [cloth("left", left), cloth("right", right)];
    let crossing = [cloth("level", &CORNERS), cloth("upright", &CORNERS)];
    let block = json!({ "name": "block", "kind": "static", "mesh": "block.obj" });
    let relaxation = json!({ "method": { "name": "dynamic-relaxation", "iterations": 9 } });
    let held = |method: &str| json!({ "method": { "name": method }, "elastics": elastic(40.0) });
    let weak = |method: &str| json!({ "method": { "name": method }, "elastics": elastic(0.2), "damping": { "mass": 9 } });
    let mut failing = vec![
        (
            scene(&level(&[0, 4]), rest(3)),
            ["at_rest", "did not come to rest"],
        ),
        (
            scene(&level(&CORNERS), relaxation),
            ["at_rest", "did not come to rest"],
        ),
        (
            scene(&level(&[]), rest(40)),
            ["at_rest", "nothing holds a cloth"],
        ),
        (
            scene(
                &[block, cloth("level", &CORNERS)],
                json!({ "duration": 0.05 }),
            ),
            ["tangled", "inside"],
        ),
    ];
    for method in ["implicit-euler", "xpbd", "rest"] {
        let both = facing(&[14, 20, 24], &[10, 20, 24]);
        let one = facing(&[0, 10, 20], &[4, 14, 24]);
        failing.push((
            scene(&both, held(method)),
            ["seams_closed", "can never close: both ends are held"],
        ));
        failing.push((
            scene(&one, weak(method)),
            ["seams_closed", "closes no more"],
        ));
    }
    for method in ["implicit-euler", "xpbd"] {
        let more = json!({ "method": { "name": method }, "duration": 0.05 });
        failing.push((scene(&crossing, more), ["tangled", "it ends tangled"]));
    }
    failing
}

#[test]
fn each_scene_that_fails_is_told_in_words_in_warnings_and_by_exit_status_3() {
    let folder = tempfile::tempdir().unwrap();
    meshes(folder.path());
    for (scene, [aspect, expected]) in failing_scenes() {
        let (status, said, report) = run(folder.path(), &scene, &[]);
        assert_eq!(status, Some(3), "{scene}: {said}");
        let warnings = report["warnings"].as_array().unwrap();
        let is_told = |warning: &Value| warning.as_str().unwrap().contains(expected);
        assert!(warnings.iter().any(is_told), "{scene}: {warnings:?}");
        assert!(said.contains(expected), "{scene}: {said}");
        let verdict = &report["verdict"];
        assert_eq!(verdict["sound"], false, "{scene}");
        let fails = aspect == "tangled";
        assert_eq!(verdict[aspect], fails, "{scene}: {verdict}");
    }
}

#[test]
fn scenes_that_do_what_they_ought_to_have_no_warning() {
    let folder = tempfile::tempdir().unwrap();
    meshes(folder.path());
    let rest = json!({ "method": { "name": "rest" } });
    let mut sound = vec![
        scene(&[cloth("level", &CORNERS)], rest.clone()),
        scene(&[cloth("left", &[20, 21, 22, 23, 24])], rest),
        // Still moving, and falling, when the time is over.
        scene(&[cloth("level", &[0, 4])], json!({})),
        scene(
            &[cloth("level", &[])],
            json!({ "method": { "name": "xpbd" } }),
        ),
        // A spring that is to merge nothing is open as long as it pulls.
        scene(
            &[cloth("left", &[20])],
            json!({ "elastics": [{ "from": ["left", 4], "to": [0.4, 0.2, 0], "stiffness": 4 }] }),
        ),
    ];
    let seam = (0..5).map(|row| {
        let ends = [("left", 5 * row + 4), ("right", 5 * row)];
        json!({ "from": ends[0], "to": ends[1], "stiffness": 200, "merge_within": 0.002 })
    });
    let seam: Vec<Value> = seam.collect();
    for method in ["implicit-euler", "xpbd"] {
        let more = json!({ "method": { "name": method }, "elastics": seam, "duration": 2,
            "damping": { "mass": 2 } });
        let cloths = [cloth("left", &[0, 20]), cloth("right", &[])];
        sound.push(scene(&cloths, more));
    }
    for scene in sound {
        let (status, said, report) = run(folder.path(), &scene, &[]);
        assert_eq!(report["warnings"], json!([]), "{scene}");
        assert_eq!(report["verdict"]["sound"], true, "{scene}");
        assert_eq!(report["verdict"]["findings"], json!([]), "{scene}");
        assert_eq!((status, &*said), (Some(0), ""), "{scene}");
    }
}

#[test]
fn a_scene_stopped_before_rest_says_how_far_it_is_from_it() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let output = toile(
        &case("rest-not-reached-unsaid"),
        &["run", "hang.json", "--out", out.to_str().unwrap()],
    );
    let said = words(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(said.contains("after 4 steps the net force is"), "{said}");
    assert!(said.contains("above the 1.0e-3 asked for"), "{said}");
}

#[test]
fn a_run_that_is_given_up_leaves_its_files_and_goes_on_from_them() {
    let folder = tempfile::tempdir().unwrap();
    meshes(folder.path());
    let long = scene(&[cloth("level", &[0, 4])], json!({ "duration": 20 }));
    let (status, said, report) = run(folder.path(), &long, &["--give-up", "20ms"]);
    assert_eq!(status, Some(3), "{said}");
    assert!(said.contains("it was given up at"), "{said}");
    assert_eq!(report["verdict"]["slowed"], true);
    let time = report["time_s"].as_f64().unwrap();
    assert!(time < 20.0, "{time}");
    for file in ["checkpoint.json", "level.obj"] {
        assert!(folder.path().join("out").join(file).is_file(), "{file}");
    }
    let (status, said, report) = run(folder.path(), &long, &["--resume", "--give-up", "20ms"]);
    assert_eq!(status, Some(3), "{said}");
    assert!(report["time_s"].as_f64().unwrap() > time, "it began anew");

    // It asks for seconds, of a run that has them.
    let rest = scene(
        &[cloth("level", &[0, 4])],
        json!({ "method": { "name": "rest" } }),
    );
    std::fs::write(folder.path().join("scene.json"), rest.to_string()).unwrap();
    let refused = toile(folder.path(), &["run", "scene.json", "--give-up", "1s"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(words(&refused.stderr).contains("a run to rest has no simulated seconds"));
    std::fs::write(folder.path().join("scene.json"), long.to_string()).unwrap();
    let refused = toile(folder.path(), &["run", "scene.json", "--give-up", "0s"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(words(&refused.stderr).contains("give a time above zero"));
}

/// A tube of a girth and a length (cm) round a part of the body, of two pieces, as a pattern.
fn tube(folder: &Path, part: &str, [girth, length]: [f64; 2]) {
    let width = 0.5 * girth;
    let sheet = |first: u32| {
        let corners = [[0.0, 0.0], [width, 0.0], [width, length], [0.0, length]];
        let ids = first + 1..;
        let points = ids
            .zip(corners)
            .map(|(id, at)| json!({ "id": id, "name": format!("p{id}"), "at": at }));
        let curve = |k: u32| {
            let [from, to] = [first + 1 + k, first + 1 + (k + 1) % 4];
            json!({ "id": first + 5 + k, "name": format!("c{k}"), "from": from, "to": to })
        };
        json!({ "id": first, "name": format!("s{first}"), "points": points.collect::<Vec<_>>(),
            "curves": (0..4).map(curve).collect::<Vec<_>>() })
    };
    let panel = |first: u32, name: &str| {
        let edge = |k: u32| {
            let [from, to] = [first + 1 + k, first + 1 + (k + 1) % 4];
            json!({ "id": first + 11 + k, "name": format!("e{k}"), "curve": first + 5 + k, "from": from, "to": to })
        };
        json!({ "id": first + 9, "name": name, "sheet": first, "fabric": 1, "allowance": 1,
            "worn": { "part": part, "facing": name },
            "lines": [{ "id": first + 10, "name": "outline", "kind": "outline",
                "edges": (0..4).map(edge).collect::<Vec<_>>() }] })
    };
    let seam = |id: u32, from: u32, to: u32| {
        let right =
            json!([{ "panel": from + 9, "line": from + 10, "from": from + 2, "to": from + 3 }]);
        let left = json!([{ "panel": to + 9, "line": to + 10, "from": to + 1, "to": to + 4, "backwards": true }]);
        json!({ "id": id, "name": format!("seam {id}"), "sides": [right, left] })
    };
    let pattern = json!({ "toile": 2, "kind": "pattern", "name": "tube", "unit": "cm", "base_size": 0,
        "sizes": [{ "id": 0, "name": "M", "measurements": { "height": 172, "bust": 100, "waist": 84.5, "hips": 103.5 } }],
        "variables": [],
        "fabrics": [{ "id": 1, "name": "cotton", "density_kg_per_m2": 0.15, "thickness_m": 0.0005,
            "stretch_N_per_m": [600, 600], "bend_N_m": [1.5e-5, 1.5e-5, 1.2e-5], "shear_N_per_m": 60,
            "poisson": 0.2, "friction": 0.4, "width_m": 1.5 }],
        "sheets": [sheet(10), sheet(30)], "panels": [panel(10, "front"), panel(30, "back")],
        "seams": [seam(50, 10, 30), seam(51, 30, 10)], "next_id": 52 });
    std::fs::write(folder.join("tube.toile.json"), pattern.to_string()).unwrap();
}

/// The arguments that drape the tube.
const DRAPE: [&str; 6] = [
    "drape",
    "tube.toile.json",
    "--quality",
    "preview",
    "--out",
    "out",
];

/// Drapes the tube: exit status, what was said, report.
fn drape(folder: &Path) -> (Option<i32>, String, Value) {
    let output = toile(folder, &DRAPE);
    let report = std::fs::read(folder.join("out/report.json")).unwrap();
    (
        output.status.code(),
        words(&output.stderr),
        serde_json::from_slice(&report).unwrap(),
    )
}

#[test]
fn a_garment_that_the_arms_go_through_is_told_so_and_not_as_tight() {
    let folder = tempfile::tempdir().unwrap();
    tube(folder.path(), "trunk", [210.0, 20.0]);
    let (status, said, report) = drape(folder.path());
    assert_eq!(status, Some(3), "{said}");
    assert!(said.contains("cloth went through the body"), "{said}");
    for other in ["too tight", "stretched", "shorter step"] {
        assert!(!said.contains(other), "{other}: {said}");
    }
    assert!(report["edges_through_body"].as_u64().unwrap() > 0);
    let verdict = &report["verdict"];
    assert_eq!(verdict["sound"], false);
    assert_eq!(verdict["tangled"], true);
    assert_eq!(verdict["too_tight"], Value::Null);
    assert!(folder.path().join("out/garment.obj").is_file());
}

#[test]
fn a_garment_that_falls_off_a_leg_is_not_put_on_the_chest() {
    let folder = tempfile::tempdir().unwrap();
    tube(folder.path(), "left_leg", [100.0, 30.0]);
    let output = toile(folder.path(), &DRAPE);
    let said = words(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(
        said.contains("it was put on round the left leg, and fell within a second;"),
        "{said}"
    );
}

#[test]
fn a_scene_whose_cloth_is_pulled_to_many_times_its_length_says_so_and_stands() {
    let folder = tempfile::tempdir().unwrap();
    meshes(folder.path());
    let key = |time: f64, rise: f64| json!({ "time": time, "translation": [0, rise, 0], "rotation": [0, 0, 0] });
    let motion = json!({ "pivot": [0, 0, 0], "keys": [key(0.0, 0.0), key(0.2, 3.0)] });
    let mut pulled = cloth("left", &[0, 1, 2, 3, 4]);
    pulled["grips"] = json!([{ "vertices": [20, 21, 22, 23, 24], "motion": motion }]);
    let more = json!({ "duration": 0.3, "method": { "name": "xpbd" } });
    let (status, said, report) = run(folder.path(), &scene(&[pulled], more), &[]);
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("times its length along the"), "{said}");
    assert_eq!(report["warnings"].as_array().unwrap().len(), 1, "{said}");
    assert_eq!(report["verdict"]["sound"], true);
}

#[test]
fn a_garment_that_fell_once_is_told_and_so_is_its_replay() {
    let folder = tempfile::tempdir().unwrap();
    tube(folder.path(), "trunk", [230.0, 12.0]);
    let (status, said, report) = drape(folder.path());
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("fell off the body: put on again"), "{said}");
    assert_eq!(report["verdict"]["on_body"], true);
    assert_eq!(report["verdict"]["put_on_otherwise"], true);
    for file in ["garment.obj", "drape.png", "fit.png", "timing.json"] {
        let path = folder.path().join("out").join(file);
        assert!(path.is_file(), "{file}");
    }
    let journal = ["replay", "out/journal.jsonl", "--out", "again"];
    let replayed = toile(folder.path(), &journal);
    let said = words(&replayed.stderr);
    assert_eq!(replayed.status.code(), Some(0), "{said}");
    assert!(said.contains("fell off the body: put on again"), "{said}");
}

#[test]
fn a_garment_worn_has_no_warning() {
    let folder = tempfile::tempdir().unwrap();
    tube(folder.path(), "trunk", [88.0, 25.0]);
    let (status, said, report) = drape(folder.path());
    assert_eq!((status, &*said), (Some(0), ""));
    assert_eq!(report["warnings"], json!([]));
    for aspect in ["at_rest", "on_body", "seams_closed", "in_one_part"] {
        assert_eq!(report["verdict"][aspect], true, "{aspect}");
    }
    for aspect in ["tangled", "crumpled"] {
        assert_eq!(report["verdict"][aspect], false, "{aspect}");
    }
}
