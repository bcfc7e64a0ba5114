//! Scenes with figures: dressed, walking, and what is wrong with them told by place.

use std::path::{Path, PathBuf};
use toile_session::{RunOptions, SessionError, Silent, run_scene};

/// A scene file in a folder.
fn scene(folder: &Path, text: &str) -> PathBuf {
    let patterns = concat!(env!("CARGO_MANIFEST_DIR"), "/../../patterns/");
    let path = folder.join("scene.json");
    std::fs::write(&path, text.replace("PATTERNS/", patterns)).unwrap();
    path
}

fn run(text: &str) -> Result<serde_json::Value, SessionError> {
    let folder = tempfile::tempdir().unwrap();
    let path = scene(folder.path(), text);
    let triangle = "v 0 1 0\nv 0.1 1 0\nv 0 1 0.1\nf 1 2 3\n";
    std::fs::write(folder.path().join("a.obj"), triangle).unwrap();
    let out = folder.path().join("out");
    let outcome = run_scene(&path, &out, &RunOptions::default(), &mut Silent)?;
    Ok(outcome.report)
}

#[test]
fn a_dressed_woman_goes_a_stride_and_stands_still() {
    let report = run(r#"{ "frame_step": 0.05, "step": 0.016667, "objects": [
        { "name": "woman", "kind": "animated", "body": "woman", "motion": { "clip": "walk", "strides": 1 } },
        { "name": "shirt", "kind": "deformable", "pattern": "PATTERNS/t-shirt.toile.json", "on": "woman" } ] }"#)
    .unwrap();
    println!("{}", report["frames"]);
    let frames = &report["frames"];
    assert!(frames["frames"].as_u64().unwrap() > 40, "{frames}");
    assert_eq!(frames["crossing_solids"], 0, "{frames}");
    assert_eq!(frames["crossing_cloth"], 0, "{frames}");
    for stretch in frames["stretch_p99"].as_array().unwrap() {
        assert!(stretch.as_f64().unwrap() < 0.12, "{frames}");
    }
    assert_eq!(report["method"], "xpbd");
    // 1.1 s of a stride, the start and end of the clock, 1 s still, and the way into the clip before.
    let time = report["time_s"].as_f64().unwrap();
    assert!((2.2..2.5).contains(&time), "{time}");
}

/// A scene of a figure and a shirt, with other fields of each.
fn asked(figure: &str, shirt: &str) -> String {
    format!(
        r#"{{ "duration": 0.1, "objects": [
        {{ "name": "woman", "body": "woman", {figure} }},
        {{ "name": "shirt", "kind": "deformable", {shirt} }} ] }}"#
    )
}

#[test]
fn what_no_figure_can_do_is_refused_by_its_place() {
    let walks = r#""kind": "animated", "motion": { "clip": "walk" }"#;
    let worn = r#""pattern": "PATTERNS/t-shirt.toile.json", "on": "woman""#;
    let bare = r#""mesh": "a.obj""#;
    let motion = |fields: &str| format!(r#""kind": "animated", "motion": {{ {fields} }}"#);
    let cases = [
        (
            motion(r#""strides": 3"#),
            bare.to_owned(),
            "objects[0].motion.clip",
        ),
        (
            motion(r#""clip": "walk", "strides": -1"#),
            bare.to_owned(),
            "objects[0].motion.strides",
        ),
        (
            motion(r#""clip": "stand", "strides": 2"#),
            bare.to_owned(),
            "objects[0].motion.strides",
        ),
        (
            motion(r#""clip": "walk", "rate": 3"#),
            bare.to_owned(),
            "objects[0].motion.rate",
        ),
        (
            motion(r#""clip": "walk", "lead_in": false"#),
            bare.to_owned(),
            "objects[0].motion.lead_in",
        ),
        (
            motion(r#""clip": "walk", "pivot": [0, 1, 0]"#),
            bare.to_owned(),
            "objects[0].motion.pivot",
        ),
        (
            motion(r#""clip": "walk", "keys": [{ "time": 1 }, { "time": 1 }]"#),
            bare.to_owned(),
            "objects[0].motion.keys",
        ),
        (
            walks.to_owned(),
            worn.replace("\"woman\"", "\"nobody\""),
            "objects[1].on",
        ),
        (
            walks.to_owned(),
            worn.replace("\"on\": \"woman\"", "\"quality\": \"fit\""),
            "objects[1].quality",
        ),
        (
            walks.to_owned(),
            format!(r#"{worn}, "quality": "best""#),
            "objects[1].quality",
        ),
        (
            walks.to_owned(),
            format!(r#"{worn}, "transform": {{ "translation": [0, 1, 0] }}"#),
            "objects[1].transform",
        ),
        (
            walks.to_owned(),
            r#""mesh": "a.obj", "on": "woman""#.to_owned(),
            "objects[1].on",
        ),
        (
            r#""kind": "static", "motion": { "clip": "walk" }"#.to_owned(),
            bare.to_owned(),
            "objects[0]",
        ),
        (
            walks.replace(
                "\"kind\": \"animated\"",
                "\"kind\": \"animated\", \"mesh\": \"a.obj\"",
            ),
            r#""mesh": "a.obj""#.to_owned(),
            "objects[0]",
        ),
    ];
    for (figure, shirt, place) in cases {
        let error = run(&asked(&figure, &shirt)).unwrap_err();
        let said = error.to_string();
        assert!(error.is_bad_input(), "{said}");
        assert!(said.contains(place), "{place}: {said}");
    }
    let ball = r#"{ "objects": [ { "name": "ball", "kind": "animated", "mesh": "a.obj", "motion": { "clip": "walk" } } ] }"#;
    let said = run(ball).unwrap_err().to_string();
    assert!(
        said.contains("objects[0]") && said.contains("it is no body"),
        "{said}"
    );
    let missing = asked(&motion(r#""clip": "skip.bvh""#), bare);
    let said = run(&missing).unwrap_err().to_string();
    assert!(said.contains("skip.bvh"), "{said}");
}
