//! `toile flatten` as its user gives it: regions of meshes and of a body.

use crate::common::{toile, words};
use serde_json::Value;
use std::fmt::Write;
use std::path::Path;

fn report(folder: &Path, name: &str) -> Value {
    let text = std::fs::read(folder.join(name)).unwrap();
    serde_json::from_slice(&text).unwrap()
}

#[test]
fn a_region_of_a_flat_mesh_is_a_panel_of_its_shape() {
    let folder = tempfile::tempdir().unwrap();
    let mut mesh = String::new();
    for j in 0..=10 {
        for i in 0..=10 {
            writeln!(mesh, "v {} {} 0", 0.05 * f64::from(i), 0.05 * f64::from(j)).unwrap();
        }
    }
    for j in 0..10 {
        for i in 0..10 {
            let a = j * 11 + i + 1;
            writeln!(mesh, "f {} {} {} {}", a, a + 1, a + 12, a + 11).unwrap();
        }
    }
    let square = r#"{"toile": 1, "kind": "loop", "colour": 3,
        "places": [[0.11, 0.12, 0], [0.41, 0.12, 0.002], [0.41, 0.32, 0], [0.11, 0.32, 0]]}"#;
    std::fs::write(folder.path().join("mesh.obj"), mesh).unwrap();
    std::fs::write(folder.path().join("loop.json"), square).unwrap();
    let run = "flatten mesh.obj --loop loop.json --ease 5mm --edge 2cm --out p.toile.json";
    let output = toile(folder.path(), &run.split(' ').collect::<Vec<_>>());
    let said = words(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert!(
        said.contains("colour") && said.contains("2.0 mm off"),
        "{said}"
    );
    let report = report(folder.path(), "p-flatten.json");
    let area = report["panel_area_m2"].as_f64().unwrap();
    assert!((area - 0.06).abs() < 1e-9, "{area}");
    assert!(report["stretch_99"].as_f64().unwrap() < 1e-6);
    assert_eq!(report["edge_m"], 0.02);
    let surface = std::fs::read_to_string(folder.path().join("p-surface.obj")).unwrap();
    let heights = surface.lines().filter(|line| line.starts_with("v "));
    assert!(heights.clone().count() > 100);
    assert!(
        heights
            .map(|line| line.split(' ').nth(3).unwrap())
            .all(|z| z.parse::<f64>().unwrap() == 0.005)
    );
    let output = toile(folder.path(), &["check", "p.toile.json"]);
    assert!(output.status.success(), "{}", words(&output.stderr));
}

#[test]
fn the_bodice_front_of_the_guide_is_cut_from_the_woman_with_two_darts() {
    let folder = tempfile::tempdir().unwrap();
    let example =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/examples/bodice-front.loop.json");
    let example = example.to_string_lossy();
    let run = [
        "flatten", "--body", "woman", "--loop", &example, "--ease", "10mm", "--darts", "2",
    ];
    let all = [&run[..], &["--out", "front.toile.json"]].concat();
    let output = toile(folder.path(), &all);
    assert!(output.status.success(), "{}", words(&output.stderr));
    let report = report(folder.path(), "front-flatten.json");
    let number = |name: &str| report[name].as_f64().unwrap();
    let (surface, panel) = (number("surface_area_m2"), number("panel_area_m2"));
    assert!((0.03..0.2).contains(&surface), "{surface}");
    assert!((panel / surface - 1.0).abs() < 0.03, "{panel} {surface}");
    assert!((1..=2).contains(&report["darts"].as_array().unwrap().len()));
    assert_eq!(report["at_rest"], true);
    let output = toile(folder.path(), &["check", "front.toile.json"]);
    assert!(output.status.success(), "{}", words(&output.stderr));
}
