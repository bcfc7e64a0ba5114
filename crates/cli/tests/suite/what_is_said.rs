//! What the command says where it once kept quiet.

use crate::common::{patterns, toile, words};
use serde_json::Value;

#[test]
fn durations_have_units() {
    let folder = tempfile::tempdir().unwrap();
    let pose = |time: &str, out: &str| {
        let arguments = ["body", "--motion", "walk", "--time", time, "--out", out];
        let output = toile(folder.path(), &arguments);
        assert_eq!(output.status.code(), Some(0), "{}", words(&output.stderr));
        std::fs::read(folder.path().join(out)).unwrap()
    };
    let seconds = pose("0.3", "a.obj");
    assert_eq!(seconds, pose("0.3s", "b.obj"));
    assert_eq!(seconds, pose("300ms", "c.obj"));
    assert_ne!(seconds, pose("0s", "d.obj"));
}

#[test]
fn several_files_are_checked_with_a_verdict_each() {
    let folder = tempfile::tempdir().unwrap();
    let shirt = patterns().join("t-shirt.toile.json");
    let skirt = patterns().join("gathered-skirt.toile.json");
    let (shirt, skirt) = (shirt.to_str().unwrap(), skirt.to_str().unwrap());
    std::fs::write(folder.path().join("broken.json"), "{\"toile\": 1,").unwrap();
    let output = toile(
        folder.path(),
        &["check", shirt, "broken.json", skirt, "--json"],
    );
    assert_eq!(output.status.code(), Some(2));
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["error"], "1 of 3 files failed");
    let verdicts = report["checks"].as_array().unwrap();
    let oks: Vec<&Value> = verdicts.iter().map(|verdict| &verdict["ok"]).collect();
    assert_eq!(oks, [&Value::from(true), &false.into(), &true.into()]);
    assert!(
        verdicts[1]["error"]
            .as_str()
            .unwrap()
            .contains("broken.json: line 1")
    );
    assert!(verdicts[2]["diagnostics"].is_array());
    let output = toile(folder.path(), &["check", shirt, skirt]);
    assert_eq!(output.status.code(), Some(0));
    let said = words(&output.stdout);
    assert!(
        said.contains(shirt) && said.contains("all 2 files passed"),
        "{said}"
    );
}

#[test]
fn proportions_that_are_only_nearly_met_are_said() {
    let folder = tempfile::tempdir().unwrap();
    let heads = |heads: &str| {
        let output = toile(folder.path(), &["body", "--heads", heads, "--out", "b.obj"]);
        assert_eq!(output.status.code(), Some(0), "{}", words(&output.stderr));
        words(&output.stderr)
    };
    let said = heads("5");
    assert!(said.contains("heads: asked 5.00, got 5.02"), "{said}");
    assert!(!heads("6").contains("asked"));
}

#[test]
fn gaits_are_blended_by_their_share() {
    let folder = tempfile::tempdir().unwrap();
    let pose = |more: &[&str], out: &str| {
        let usual = ["body", "--time", "0.2s", "--out", out];
        let all: Vec<&str> = usual.iter().chain(more).copied().collect();
        let output = toile(folder.path(), &all);
        assert_eq!(output.status.code(), Some(0), "{}", words(&output.stderr));
        std::fs::read(folder.path().join(out)).unwrap()
    };
    let walk = pose(&["--motion", "walk"], "walk.obj");
    let half = pose(&["--motion", "walk", "--blend", "run:0.5"], "half.obj");
    assert_ne!(half, walk);
    assert_ne!(half, pose(&["--motion", "run"], "run.obj"));
}

#[test]
fn a_report_names_the_fabric_that_the_pattern_names() {
    let folder = tempfile::tempdir().unwrap();
    let poncho = patterns().join("poncho.toile.json");
    let poncho = poncho.to_str().unwrap();
    std::fs::write(
        folder.path().join("ponte.json"),
        r#"{"toile": 1, "kind": "fabric", "name": "ponte", "fabric": "wool", "kept": [0, 0.2]}"#,
    )
    .unwrap();
    let drape = |more: &[&str]| {
        let usual = ["drape", poncho, "--quality", "preview", "--json"];
        let all: Vec<&str> = usual.iter().chain(more).copied().collect();
        let output = toile(folder.path(), &all);
        assert_eq!(output.status.code(), Some(0), "{}", words(&output.stderr));
        serde_json::from_slice::<Value>(&output.stdout).unwrap()["report"].clone()
    };
    let report = drape(&[]);
    assert_eq!(report["fabric"], report["pieces"][0]["fabric"]);
    assert_eq!(report["fabric"], "melton");
    let report = drape(&["--fabric", "ponte.json"]);
    assert_eq!(report["fabric"], "ponte");
    let warnings = report["warnings"].to_string();
    assert!(
        warnings.contains("kept folds act in motion only"),
        "{warnings}"
    );
}

#[test]
fn a_dress_form_wears_what_needs_no_arms_and_legs() {
    let folder = tempfile::tempdir().unwrap();
    let drape = |pattern: &str| {
        let pattern = patterns().join(format!("{pattern}.toile.json"));
        let pattern = pattern.to_str().unwrap();
        let body = ["drape", pattern, "--body", "dress-form"];
        let usual = ["--quality", "preview", "--json"];
        toile(folder.path(), &[body.as_slice(), &usual].concat())
    };
    for (pattern, piece, part) in [
        ("t-shirt", "sleeve", "the left arm"),
        ("trousers", "front", "the left leg"),
    ] {
        let output = drape(pattern);
        assert_eq!(output.status.code(), Some(2), "{pattern}");
        let said = words(&output.stdout) + &words(&output.stderr);
        assert!(
            said.contains(piece) && said.contains(&format!("worn on {part}, which this body")),
            "{said}"
        );
    }
    let output = drape("gathered-skirt");
    assert_eq!(output.status.code(), Some(0), "{}", words(&output.stderr));
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    for crossings in ["body_intersections", "self_intersections"] {
        assert_eq!(report["report"][crossings], 0, "{crossings}");
    }
}
