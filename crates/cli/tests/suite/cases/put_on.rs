//! Garments that are put on: panels placed round another origin, arms held as sleeves are placed, circle skirts.

use crate::cases::case;
use crate::common::{toile, words};
use std::path::Path;

/// Runs the command in a case's folder, and returns what it said in both streams and its status.
fn run(name: &str, arguments: &[&str]) -> (String, Option<i32>) {
    let output = toile(&case(name), arguments);
    let said = words(&output.stdout) + &words(&output.stderr);
    (said, output.status.code())
}

/// Heights of the panels of a written pattern (m).
fn heights(path: &Path) -> Vec<f64> {
    let text = std::fs::read_to_string(path).unwrap();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    let panels = json["panels"].as_array().unwrap();
    let height = |p: &serde_json::Value| p["worn"]["translation_m"][1].as_f64().unwrap();
    panels.iter().map(height).collect()
}

#[test]
fn panels_round_the_pelvis_are_raised_and_written_so() {
    let folder = tempfile::tempdir().unwrap();
    let to = folder.path().join("skirt.toile.json");
    let to_name = to.to_str().unwrap();
    for (origin, raised) in [
        (None, 1.12),
        (Some("pelvis"), 1.12),
        (Some("floor"), 0.0),
        (Some("waist"), 1.05),
        (Some("90cm"), 0.9),
    ] {
        let mut arguments = vec!["convert", "skirt.json", to_name];
        arguments.extend(origin.iter().flat_map(|origin| ["--origin", origin]));
        let (said, status) = run("placed-round-the-pelvis", &arguments);
        assert_eq!(status, Some(0), "{said}");
        let told = said.contains("round the pelvis") && said.contains("1.12 m");
        assert_eq!(told, origin.is_none(), "{origin:?}: {said}");
        for height in heights(&to) {
            assert!(
                (height - (raised - 0.33)).abs() < 1e-9,
                "{origin:?}: {height}"
            );
        }
    }
    // What was written stands on the floor: nothing more is found.
    let (_, status) = run(
        "placed-round-the-pelvis",
        &["convert", "skirt.json", to_name],
    );
    assert_eq!(status, Some(0));
    let again = folder.path().join("again.toile.json");
    let (said, _) = run(
        "placed-round-the-pelvis",
        &["convert", to_name, again.to_str().unwrap()],
    );
    assert!(
        !said.contains("pelvis:") && !said.contains("raised"),
        "{said}"
    );
    assert_eq!(heights(&again), heights(&to));
}

#[test]
fn an_origin_that_is_none_is_refused() {
    let (said, status) = run(
        "placed-round-the-pelvis",
        &["convert", "skirt.json", "o.toile.json", "--origin", "knee"],
    );
    assert_eq!(status, Some(2), "{said}");
    assert!(said.contains("auto, floor, waist, pelvis"), "{said}");
}

#[test]
fn arms_can_be_held_from_straight_out_and_are_refused_in_degrees() {
    let folder = tempfile::tempdir().unwrap();
    let body = |degrees: f64| {
        let table = format!(
            r#"{{"toile":1,"kind":"measurements","unit":"cm","measurements":{{"height":168,"arm_pose_angle":{degrees}}}}}"#
        );
        std::fs::write(folder.path().join("m.json"), table).unwrap();
        let arguments = ["body", "--measurements", "m.json", "--out", "b.obj"];
        let output = toile(folder.path(), &arguments);
        (words(&output.stderr), output.status.code())
    };
    assert_eq!(body(0.0).1, Some(0));
    assert_eq!(body(80.0).1, Some(0));
    let (said, status) = body(85.0);
    assert_eq!(status, Some(2), "{said}");
    assert!(
        said.contains("arm_pose_angle is 85:") && said.contains("80.214 (degrees)"),
        "{said}"
    );
}

#[test]
fn a_garment_that_falls_off_is_put_on_again_and_refused_with_what_was_tried() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let arguments = ["drape", "tube.json", "--quality", "preview", "--out", out];
    let (said, status) = run("falls-off-both-ways", &arguments);
    assert_eq!(status, Some(2), "{said}");
    for words in [
        "falls off the body",
        "where its file places",
        "names and seams",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    assert!(!folder.path().join("garment.obj").exists());
}

/// Holds a skirt of a case to coming to rest without a tangle, and to hanging from the waist above the floor.
fn hangs_from_the_waist(name: &str, file: &str) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let arguments = ["drape", file, "--quality", "preview", "--out", out];
    let (said, status) = run(name, &arguments);
    assert_eq!(status, Some(0), "{file}: {said}");
    let mesh = std::fs::read_to_string(folder.path().join("garment.obj")).unwrap();
    let heights = mesh.lines().filter_map(|line| {
        let mut words = line.strip_prefix("v ")?.split_whitespace();
        words.nth(1)?.parse::<f64>().ok()
    });
    let (low, high) = heights.fold((f64::MAX, f64::MIN), |(l, h), y| (l.min(y), h.max(y)));
    assert!(
        low > 0.3 && (0.95..1.25).contains(&high),
        "{file}: from {low} to {high} m"
    );
    assert!(!said.contains("tangled"), "{file}: {said}");
}

#[test]
fn a_circle_skirt_hangs_from_the_waist() {
    hangs_from_the_waist("fell-off-unsaid", "circle.toile.json");
}

#[test]
fn a_quarter_circle_of_four_gores_without_a_band_hangs_from_the_waist() {
    hangs_from_the_waist("circle-skirts", "quarter4-noband.toile.json");
}
