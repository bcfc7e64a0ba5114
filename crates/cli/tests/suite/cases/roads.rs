//! Roads into the program: tables with formulas, files that come through pipes, journals.

use super::{case, toile, words};
use serde_json::Value;

#[test]
fn a_table_of_measurements_may_hold_formulas() {
    let folder = tempfile::tempdir().unwrap();
    let table = case("measurements-with-formulas").join("inch.vit");
    let arguments = ["body", "--json", "--out", "b.obj", "--measurements"];
    let output = toile(
        folder.path(),
        &[&arguments[..], &[table.to_str().unwrap()]].concat(),
    );
    assert!(output.status.success(), "{}", words(&output.stderr));
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let rows = report["measurements"].as_array().unwrap();
    for (name, inches) in [
        ("height", 67.5),
        ("bust", 36.5),
        ("waist", 28.25),
        ("hips", 38.25),
    ] {
        let row = rows.iter().find(|row| row["name"] == name).unwrap();
        let asked = row["asked"].as_f64().unwrap();
        assert!((asked - inches * 0.0254).abs() < 1e-9, "{name}: {asked}");
    }
    // Formulas that need each other are named.
    let text = std::fs::read_to_string(&table).unwrap();
    let circle = text.replace("value=\"36.5\"", "value=\"hip_circ - 1\"");
    assert_ne!(circle, text);
    std::fs::write(folder.path().join("circle.smis"), circle).unwrap();
    let output = toile(folder.path(), &[&arguments[..], &["circle.smis"]].concat());
    assert_eq!(output.status.code(), Some(2));
    let said = words(&output.stderr);
    let named = "line 8: formulas need each other: bust_circ needs hip_circ needs waist_circ needs bust_circ";
    assert!(said.contains(named), "{said}");
}

/// Runs the command with a text on its standard input, which is a pipe.
fn piped(folder: &std::path::Path, arguments: &[&str], text: &[u8]) -> std::process::Output {
    use std::io::Write;
    use std::process::{Command, Stdio};
    let mut child = Command::new(env!("CARGO_BIN_EXE_toile"))
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(text).unwrap();
    child.wait_with_output().unwrap()
}

#[test]
fn patterns_tables_and_markers_come_through_pipes() {
    let folder = tempfile::tempdir().unwrap();
    let pattern = std::fs::read(case("pipe-read-as-empty").join("p.toile.json")).unwrap();
    std::fs::write(folder.path().join("p.json"), &pattern).unwrap();
    let table = std::fs::read(case("measurements-with-formulas").join("inch.vit")).unwrap();
    let nest = ["nest", "p.json", "--evaluations", "10", "--out", "n"];
    assert!(toile(folder.path(), &nest).status.success());
    let marker = std::fs::read(folder.path().join("n/marker.json")).unwrap();
    let inputs: &[&str] = match cfg!(unix) {
        true => &["-", "/dev/stdin"],
        false => &["-"],
    };
    for input in inputs {
        for (arguments, text) in [
            (&["check", input][..], &pattern),
            (&["convert", input, "o.json"], &pattern),
            (&["print", input, "--out", "o.svg"], &pattern),
            (
                &["nest", input, "--evaluations", "10", "--out", "o"],
                &pattern,
            ),
            (&["check", input], &marker),
            (
                &[
                    "nest",
                    "p.json",
                    "--from",
                    input,
                    "--evaluations",
                    "10",
                    "--out",
                    "o",
                ],
                &marker,
            ),
            (&["body", "--measurements", input, "--out", "o.obj"], &table),
        ] {
            let output = piped(folder.path(), arguments, text);
            assert!(
                output.status.success(),
                "{arguments:?}: {}",
                words(&output.stderr)
            );
        }
    }
    let as_file = toile(folder.path(), &["check", "p.json", "--json"]);
    let as_pipe = piped(folder.path(), &["check", "-", "--json"], &pattern);
    let pieces = |output: &std::process::Output| {
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        report["pieces"].clone()
    };
    assert_eq!(pieces(&as_file), pieces(&as_pipe));
}
