//! The laboratory's commands as a person runs them.
#![allow(clippy::unwrap_used)]

use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

/// Runs the command in a folder.
fn toile(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_toile"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

/// What it printed.
fn words(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

#[test]
fn names_that_do_not_exist_exit_with_2_and_the_names_there_are_even_where_they_are_listed() {
    let folder = tempfile::tempdir().unwrap();
    let cases: [(&[&str], &str); 6] = [
        (&["validate", "gravity"], "cantilever, resolution"),
        (&["validate", "gravity", "--list"], "cantilever, resolution"),
        (&["chart", "moon"], "cantilever, hang"),
        (&["bench", "moon"], "rest-"),
        (&["bench", "moon", "--list"], "--list"),
        (&["stability", "moon"], "moon"),
    ];
    for (arguments, named) in cases {
        let output = toile(folder.path(), arguments);
        let said = words(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.contains(named), "{arguments:?}: {said}");
    }
}

#[test]
fn laws_are_listed_with_all_their_tolerances() {
    let folder = tempfile::tempdir().unwrap();
    let output = toile(folder.path(), &["validate", "--list"]);
    assert_eq!(output.status.code(), Some(0));
    let said = words(&output.stdout);
    for line in [
        "order: within 3.0e-2 of the expected value",
        "outside the band: within 2.0e-2 of the whole ring",
        "frequency, rad/s: within 2.0e-2 of the expected value (mode 3)",
    ] {
        assert!(said.contains(line), "{said}");
    }
    let output = toile(folder.path(), &["validate", "rigid", "--list", "--json"]);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["laws"].as_array().unwrap().len(), 1);
    assert_eq!(report["laws"][0]["tolerances"][0]["share"], 1e-12);
}

#[test]
fn laws_that_are_met_exit_with_0_and_the_report_has_every_tolerance() {
    let folder = tempfile::tempdir().unwrap();
    let output = toile(folder.path(), &["validate", "rigid", "--json"]);
    assert_eq!(output.status.code(), Some(0));
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(
        (&report["failed"], &report["ok"]),
        (&0.into(), &true.into())
    );
    for check in report["checks"].as_array().unwrap() {
        assert_eq!(check["tolerance"], 1e-12);
        assert_eq!(check["of"], "stiffness times width");
        assert_eq!(check["pass"], true);
    }
}

#[test]
fn a_place_that_cannot_be_written_is_refused_before_the_long_work() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("taken"), "kept").unwrap();
    let cases: [&[&str]; 4] = [
        &["stability", "--out", "taken"],
        &["stability", "--into", "gone.md"],
        &["chart", "--out", "taken"],
        &["chart", "--into", "gone.md"],
    ];
    for arguments in cases {
        let start = std::time::Instant::now();
        let output = toile(folder.path(), arguments);
        let said = words(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {said}");
        assert!(said.contains(arguments[2]), "{arguments:?}: {said}");
        assert!(start.elapsed().as_secs() < 10, "{arguments:?}");
    }
    let kept = std::fs::read_to_string(folder.path().join("taken")).unwrap();
    assert_eq!(kept, "kept");
}
