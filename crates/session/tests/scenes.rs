//! Scenes: frames are on disk as they come, and every object has a file of its own.
#![allow(clippy::unwrap_used)]

use std::ops::ControlFlow;
use std::path::Path;
use toile_session::{SessionError, Silent, run_scene};

const OBJ: &str = "v 0 1 0\nv 0.1 1 0\nv 0 1 0.1\nf 1 2 3\n";

/// A scene of two triangles of cloth.
fn scene(folder: &Path, names: [&str; 2], frame_step: f64) -> std::path::PathBuf {
    std::fs::write(folder.join("cloth.obj"), OBJ).unwrap();
    let object = |name: &str| {
        format!(r#"{{ "name": "{name}", "kind": "deformable", "mesh": "cloth.obj", "pins": [0] }}"#)
    };
    let text = format!(
        r#"{{ "duration": 0.1, "frame_step": {frame_step}, "objects": [{}] }}"#,
        names.map(object).join(", ")
    );
    let path = folder.join("scene.json");
    std::fs::write(&path, text).unwrap();
    path
}

#[test]
fn frames_of_a_run_that_was_stopped_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let path = scene(folder.path(), ["one", "two"], 0.02);
    let out = folder.path().join("out");
    let mut watcher = |_: &str, share: f64, _: &str| match share > 0.5 {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    };
    let stopped = run_scene(&path, &out, &mut watcher);
    assert!(matches!(stopped, Err(SessionError::Cancelled)));
    for frame in 0..3 {
        for name in ["one", "two"] {
            let file = format!("frame-{frame:05}-{name}.obj");
            assert!(out.join(&file).is_file(), "{file}");
        }
    }
    let outcome = run_scene(&path, &out, &mut Silent).unwrap();
    assert!(outcome.files.iter().all(|file| file.is_file()));
    assert!(outcome.files.len() >= 2 * 5 + 2 + 2, "{:?}", outcome.files);
}

#[test]
fn names_of_one_file_and_endless_frames_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (names, step, place) in [
        (["a b", "a_b"], 0.05, "objects[1]"),
        (["cloth", "Cloth"], 0.05, "objects[1]"),
        (["a", "b"], 1e-7, "frame_step"),
    ] {
        let path = scene(folder.path(), names, step);
        let out = folder.path().join("out");
        let error = run_scene(&path, &out, &mut Silent).unwrap_err();
        assert!(error.is_bad_input(), "{error}");
        assert!(error.to_string().contains(place), "{error}");
        assert!(!out.exists());
    }
}

#[test]
fn objects_that_were_sewn_together_are_named_as_two_files() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("cloth.obj"), OBJ).unwrap();
    let text = r#"{ "duration": 0.05, "gravity": [0, 0, 0], "objects": [
        { "name": "left", "kind": "deformable", "mesh": "cloth.obj" },
        { "name": "right", "kind": "deformable", "mesh": "cloth.obj",
          "transform": { "translation": [0.0005, 0, 0] } } ],
        "elastics": [ { "from": ["left", 0], "to": ["right", 0], "stiffness": 1, "merge_within": 0.002 } ] }"#;
    let path = folder.path().join("scene.json");
    std::fs::write(&path, text).unwrap();
    let outcome = run_scene(&path, &folder.path().join("out"), &mut Silent).unwrap();
    assert_eq!(outcome.report["vertices"], 5);
    let warnings = outcome.report["warnings"].to_string();
    let words = r#"\"left\" and \"right\" were sewn together"#;
    assert!(
        warnings.contains(words) && warnings.contains("two files"),
        "{warnings}"
    );
}
