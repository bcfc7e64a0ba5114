//! Meshes of other programs: how they stand, their polygons, and their kinds of file.

use super::{case, toile, words};
use serde_json::Value;
use std::path::Path;

/// The skin of the program's own mannequin, each line of its OBJ through a change of places.
fn person(to: &Path, change: impl Fn([f64; 3]) -> [f64; 3]) {
    let folder = to.parent().unwrap();
    assert!(
        toile(folder, &["body", "--out", "own.obj"])
            .status
            .success()
    );
    let own = std::fs::read_to_string(folder.join("own.obj")).unwrap();
    let line = |line: &str| match line.strip_prefix("v ") {
        Some(place) => {
            let place: Vec<f64> = place.split(' ').map(|x| x.parse().unwrap()).collect();
            let [x, y, z] = change([place[0], place[1], place[2]]);
            format!("v {x:.9} {y:.9} {z:.9}\n")
        }
        None => format!("{line}\n"),
    };
    std::fs::write(to, own.lines().map(line).collect::<String>()).unwrap();
}

/// The measurements of a mesh (m) and what was said of it.
fn measured(folder: &Path, more: &[&str]) -> (Vec<(String, f64)>, Vec<String>) {
    let arguments = ["body", "--mesh", "p.obj", "--out", "t.json", "--json"];
    let output = toile(folder, &[&arguments, more].concat());
    assert!(output.status.success(), "{}", words(&output.stderr));
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let rows = report["measurements"].as_array().unwrap();
    let row = |row: &Value| {
        let name = row["name"].as_str().unwrap().to_owned();
        (name, row["got"].as_f64().unwrap())
    };
    let notes = report["notes"].as_array().unwrap().iter();
    (
        rows.iter().map(row).collect(),
        notes.map(|n| n.as_str().unwrap().to_owned()).collect(),
    )
}

#[test]
fn a_person_is_stood_upright_whatever_is_up_forward_and_the_unit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.obj");
    person(&path, |p| p);
    let (own, notes) = measured(folder.path(), &[]);
    assert!(notes.is_empty(), "{notes:?}");
    type Change = fn([f64; 3]) -> [f64; 3];
    let changes: [(Change, &str); 5] = [
        (|[x, y, z]| [x, -z, y], "z is up, -y is forward, in m"),
        (
            |[x, y, z]| [-100.0 * x, 100.0 * z, 100.0 * y],
            "z is up, y is forward, in cm",
        ),
        (|[x, y, z]| [-x, y, -z], "y is up, -z is forward, in m"),
        (
            |[x, y, z]| [1e3 * y, 1e3 * z, 1e3 * x],
            "x is up, y is forward, in mm",
        ),
        (
            |[x, y, z]| [x / 0.3048, -y / 0.3048, -z / 0.3048],
            "-y is up, -z is forward, in ft",
        ),
    ];
    for (change, said) in changes {
        person(&path, change);
        let (found, notes) = measured(folder.path(), &[]);
        assert!(
            notes.len() == 1 && notes[0].contains(said),
            "{said}: {notes:?}"
        );
        for ((name, value), (_, right)) in found.iter().zip(&own) {
            assert!(
                (value - right).abs() < 1e-4,
                "{said}: {name} {value} {right}"
            );
        }
    }
    // An option says otherwise; then it is no person, or one of another size.
    person(&path, |p| p);
    let arguments = ["body", "--mesh", "p.obj", "--out", "t.json", "--unit", "mm"];
    let output = toile(folder.path(), &arguments);
    assert_eq!(output.status.code(), Some(2));
    assert!(words(&output.stderr).contains("between 0.12 and 6 m tall"));
    person(&path, |p| p.map(|x| x / 0.0254));
    let output = toile(folder.path(), &arguments[..5]);
    assert_eq!(output.status.code(), Some(2));
    let said = words(&output.stderr);
    assert!(
        said.contains("cm if it is in in") && said.contains("--unit"),
        "{said}"
    );
    let (found, _) = measured(folder.path(), &["--unit", "in"]);
    assert!((found[0].1 - own[0].1).abs() < 1e-4);
}

#[test]
fn a_person_inside_out_or_in_part_is_turned() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.obj");
    person(&path, |p| p);
    let (own, _) = measured(folder.path(), &[]);
    let text = std::fs::read_to_string(&path).unwrap();
    for (every, said) in [(1, "inside out"), (7, "face the other way")] {
        let turn = |(k, line): (usize, &str)| match line.strip_prefix("f ") {
            Some(face) if k % every == 0 => {
                let corners: Vec<&str> = face.split(' ').rev().collect();
                format!("f {}\n", corners.join(" "))
            }
            _ => format!("{line}\n"),
        };
        let turned: String = text.lines().enumerate().map(turn).collect();
        std::fs::write(&path, turned).unwrap();
        let (found, notes) = measured(folder.path(), &[]);
        assert!(notes.len() == 1 && notes[0].contains(said), "{notes:?}");
        assert_eq!(found, own);
    }
}

#[test]
fn a_scene_whose_person_lies_is_set_upright_as_a_whole() {
    let folder = tempfile::tempdir().unwrap();
    person(&folder.path().join("p.obj"), |[x, y, z]| {
        [100.0 * x, -100.0 * z, 100.0 * y]
    });
    let cloth = "v -5 -5 180\nv 5 -5 180\nv 5 5 180\nv -5 5 180\nf 1 2 3 4\n";
    std::fs::write(folder.path().join("c.obj"), cloth).unwrap();
    let scene = |more: &str| {
        format!(
            r#"{{ "duration": 0.01, "step": 0.01, {more} "objects": [
            {{ "name": "p", "kind": "static", "mesh": "p.obj" }},
            {{ "name": "c", "kind": "deformable", "mesh": "c.obj" }} ] }}"#
        )
    };
    for (more, height, said) in [
        ("", 1.8, true),
        (r#""meshes": { "up": "z", "unit": "cm" },"#, 1.8, false),
        (r#""meshes": { "up": "y", "unit": "m" },"#, -5.0, false),
    ] {
        std::fs::write(folder.path().join("s.json"), scene(more)).unwrap();
        let output = toile(folder.path(), &["run", "s.json", "--out", "o"]);
        let text = std::fs::read_to_string(folder.path().join("o/c.obj")).unwrap();
        let first = text.lines().find(|line| line.starts_with("v ")).unwrap();
        let y: f64 = first.split(' ').nth(2).unwrap().parse().unwrap();
        assert!((y - height).abs() < 0.01, "{more}: {first}");
        let told = words(&output.stderr) + &words(&output.stdout);
        assert_eq!(told.contains("z is up"), said, "{told}");
    }
}

/// The area of a mesh in an OBJ file of triangles (m2).
fn area(path: &Path) -> f64 {
    let text = std::fs::read_to_string(path).unwrap();
    let numbers = |line: &str| -> Vec<f64> {
        let words = line.split(' ').skip(1);
        words
            .map(|w| w.split('/').next().unwrap().parse().unwrap())
            .collect()
    };
    let rows = |start: &str| -> Vec<Vec<f64>> {
        text.lines()
            .filter(|l| l.starts_with(start))
            .map(numbers)
            .collect()
    };
    let places = rows("v ");
    let triangle = |face: Vec<f64>| {
        let [a, b, c] = [0, 1, 2].map(|k| &places[face[k] as usize - 1]);
        let side = |p: &[f64]| [0, 1, 2].map(|k| p[k] - a[k]);
        let (u, v) = (side(b), side(c));
        let cross = [0, 1, 2].map(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            u[i] * v[j] - u[j] * v[i]
        });
        0.5 * cross.iter().map(|x| x * x).sum::<f64>().sqrt()
    };
    rows("f ").into_iter().map(triangle).sum()
}

#[test]
fn polygons_of_obj_and_ply_have_their_own_area() {
    let folder = tempfile::tempdir().unwrap();
    let to = folder.path().to_str().unwrap();
    for (name, right) in [("L", 0.03), ("octagon", 0.04)] {
        let scene = format!("{name}.json");
        let output = toile(&case("obj-polygons"), &["run", &scene, "--out", to]);
        assert!(output.status.success(), "{}", words(&output.stderr));
        let got = area(&folder.path().join("c.obj"));
        assert!((got - right).abs() < 1e-6, "{name}: {got}");
        // The same as PLY.
        let obj =
            std::fs::read_to_string(case("obj-polygons").join(format!("{name}.obj"))).unwrap();
        let rows = |start: &str| -> Vec<String> {
            obj.lines()
                .filter_map(|l| l.strip_prefix(start).map(str::to_owned))
                .collect()
        };
        let (places, faces) = (rows("v "), rows("f "));
        let corners: Vec<String> = faces[0]
            .split_whitespace()
            .map(|k| (k.parse::<u32>().unwrap() - 1).to_string())
            .collect();
        let ply = format!(
            "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
             element face 1\nproperty list uchar int vertex_index\nend_header\n{}\n{} {}\n",
            places.len(),
            places.join("\n"),
            corners.len(),
            corners.join(" "),
        );
        let text = std::fs::read_to_string(case("obj-polygons").join(&scene)).unwrap();
        let text = text.replace(&format!("{name}.obj"), "polygon.ply");
        std::fs::write(folder.path().join("polygon.ply"), ply).unwrap();
        std::fs::write(folder.path().join("ply.json"), text).unwrap();
        let output = toile(folder.path(), &["run", "ply.json", "--out", "o"]);
        assert!(output.status.success(), "{}", words(&output.stderr));
        let got = area(&folder.path().join("o/c.obj"));
        assert!((got - right).abs() < 1e-6, "{name} as PLY: {got}");
    }
}
