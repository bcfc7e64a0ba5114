//! The laboratory's commands as a person runs them.

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
    let cases: [(&[&str], &str); 8] = [
        (&["validate", "gravity"], "cantilever, resolution"),
        (&["validate", "gravity", "--list"], "cantilever, resolution"),
        (&["chart", "moon"], "cantilever, hang"),
        (&["bench", "moon"], "rest-"),
        (&["bench", "moon", "--list"], "--list"),
        (&["stability", "moon"], "moon"),
        (&["accuracy", "moon"], "laws, stability"),
        (&["accuracy", "moon", "--list"], "laws, stability"),
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
fn a_section_of_the_page_of_accuracy_is_measured_and_written_and_the_rest_stays() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("page.md");
    let around = [
        "# By hand\n\n<!-- meshes -->\n",
        "\n<!-- /meshes -->\n\nBy hand too.\n",
    ];
    std::fs::write(&page, around.join("old")).unwrap();
    let output = toile(folder.path(), &["accuracy", "meshes", "--write", "page.md"]);
    assert_eq!(output.status.code(), Some(0), "{}", words(&output.stderr));
    let text = std::fs::read_to_string(&page).unwrap();
    let section = text.strip_prefix(around[0]).unwrap();
    let section = section.strip_suffix(around[1]).unwrap();
    assert!(section.starts_with("## Meshes\n\n"), "{section}");
    for words in ["| T-shirt | ", "`toile mesh PATTERN", " threads, "] {
        assert!(section.contains(words), "{words:?} in {section}");
    }
    let (table, provenance) = section.rsplit_once("\n\n").unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(said.contains(table) && said.contains(provenance), "{said}");
    // Nothing else is left beside it.
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn a_place_that_cannot_be_written_is_refused_before_the_long_work() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("taken"), "kept").unwrap();
    let cases: [&[&str]; 3] = [
        &["stability", "--out", "taken"],
        &["chart", "--out", "taken"],
        &["accuracy", "--write", "gone.md"],
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
