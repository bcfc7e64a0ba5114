//! Sizes: what takes in nothing in one of them, and how they are named to every command.

use super::{case, toile, words};
use serde_json::Value;

fn checked(arguments: &[&str]) -> (Option<i32>, Value) {
    let output = toile(&case("dart-vanishes-in-a-size"), arguments);
    let report = serde_json::from_slice(&output.stdout).unwrap();
    (output.status.code(), report)
}

#[test]
fn a_dart_that_is_nothing_in_one_size_is_left_out_there() {
    let (status, report) = checked(&["check", "dart.toile.json", "--size", "B", "--json"]);
    assert_eq!(status, Some(0));
    let piece = &report["pieces"][0];
    let area = piece["sewn"]["area_cm2"].as_f64().unwrap();
    assert!((area - 24.0 * 50.0).abs() < 1e-9, "{area}");
    assert_eq!(piece["darts"], serde_json::json!([]));
    let note = &report["diagnostics"][0];
    assert_eq!(note["severity"], "note");
    assert_eq!(note["sizes"], serde_json::json!(["B"]));
    assert!(note["message"].as_str().unwrap().contains("has no width"));
}

#[test]
fn check_looks_at_every_size_and_names_the_one_that_fails() {
    let folder = tempfile::tempdir().unwrap();
    let path = case("dart-vanishes-in-a-size").join("dart.toile.json");
    let text = std::fs::read_to_string(path).unwrap();
    let failing = text.replace("max(hips - waist, 0cm) / 4", "(hips - waist) / 4 - 1cm");
    assert_ne!(failing, text);
    std::fs::write(folder.path().join("p.json"), failing).unwrap();
    for arguments in [
        &["check", "p.json"][..],
        &["print", "p.json", "--size", "all", "--out", "p.pdf"],
        &["print", "p.json", "--all-sizes", "--out", "p.pdf"],
        &["nest", "p.json", "--size", "A,B:2", "--out", "n"],
        &["nest", "p.json", "--size", "all", "--out", "n"],
        &["drape", "p.json", "--size", "B", "--out", "d"],
    ] {
        let output = toile(folder.path(), arguments);
        let said = words(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.contains("size B: "), "{arguments:?}: {said}");
    }
    let sound = toile(folder.path(), &["check", "p.json", "--size", "A"]);
    assert!(sound.status.success());
}

#[test]
fn every_command_takes_sizes_by_the_same_words() {
    let folder = tempfile::tempdir().unwrap();
    let pattern = case("dart-vanishes-in-a-size").join("dart.toile.json");
    let pattern = pattern.to_str().unwrap();
    for arguments in [
        &["check", pattern, "--size", "all"][..],
        &["check", pattern, "--size", "B,A"],
        &["print", pattern, "--size", "A,B", "--out", "p.svg"],
        &["print", pattern, "--size", "all", "--out", "p.svg"],
        &[
            "nest",
            pattern,
            "--size",
            "A:2,B",
            "--evaluations",
            "1",
            "--out",
            "n",
        ],
        &[
            "nest",
            pattern,
            "--sizes",
            "A:2,B",
            "--evaluations",
            "1",
            "--out",
            "n",
        ],
        &[
            "nest",
            pattern,
            "--size",
            "all",
            "--evaluations",
            "1",
            "--out",
            "n",
        ],
    ] {
        let output = toile(folder.path(), arguments);
        let said = words(&output.stderr);
        assert!(output.status.success(), "{arguments:?}: {said}");
    }
}
