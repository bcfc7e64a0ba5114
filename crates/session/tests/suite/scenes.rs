//! Scenes: frames are on disk as they come, and every object has a file of its own.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;
use toile_interchange::read_frames;
use toile_session::{RunOptions, SessionError, Silent, run_scene};

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
    let stopped = run_scene(&path, &out, &RunOptions::default(), &mut watcher);
    assert!(matches!(stopped, Err(SessionError::Cancelled)));
    let frames = || {
        let bytes = std::fs::read(out.join("scene.frames")).unwrap();
        let read = read_frames(&bytes).unwrap();
        assert_eq!((read.sections.len(), read.left_out), (1, 0));
        let names = read.sections[0].head.surfaces.iter();
        assert_eq!(names.map(|s| &*s.name).collect::<Vec<_>>(), ["one", "two"]);
        read.sections[0].frames.len()
    };
    assert_eq!(frames(), 3);
    let outcome = run_scene(&path, &out, &RunOptions::default(), &mut Silent).unwrap();
    assert!(outcome.files.iter().all(|file| file.is_file()));
    assert_eq!(outcome.files.len(), 5, "{:?}", outcome.files);
    assert_eq!(frames(), 5);
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
        let error = run_scene(&path, &out, &RunOptions::default(), &mut Silent).unwrap_err();
        assert!(error.is_bad_input(), "{error}");
        assert!(error.to_string().contains(place), "{error}");
        assert!(!out.exists());
    }
}

#[test]
fn objects_that_are_sewn_together_are_written_as_one_surface() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("cloth.obj"), OBJ).unwrap();
    let text = r#"{ "duration": 0.05, "gravity": [0, 0, 0], "objects": [
        { "name": "left", "kind": "deformable", "mesh": "cloth.obj" },
        { "name": "right", "kind": "deformable", "mesh": "cloth.obj",
          "transform": { "translation": [0.0005, 0, 0] } } ],
        "elastics": [ { "from": ["left", 0], "to": ["right", 0], "stiffness": 1, "merge_within": 0.002 } ] }"#;
    let path = folder.path().join("scene.json");
    std::fs::write(&path, text).unwrap();
    let out = folder.path().join("out");
    let outcome = run_scene(&path, &out, &RunOptions::default(), &mut Silent).unwrap();
    assert_eq!(outcome.report["vertices"], 5);
    assert!(!out.join("left.obj").exists() && !out.join("right.obj").exists());
    let written = std::fs::read_to_string(out.join("left+right.obj")).unwrap();
    let lines = |start: &str| {
        written
            .lines()
            .filter(|line| line.starts_with(start))
            .count()
    };
    assert_eq!([lines("v "), lines("f ")], [5, 2], "{written}");
    for name in ["left", "right"] {
        let named = |line: &str| line.starts_with("g ") && line.ends_with(name);
        assert!(written.lines().any(named), "{written}");
    }
}

/// A square of `cells` cells a side in OBJ, its vertices placed by `place` from 0 to 1.
fn square(cells: usize, place: impl Fn(f64, f64) -> [f64; 3]) -> String {
    use std::fmt::Write;
    let mut text = String::new();
    let share = |k: usize| k as f64 / cells as f64;
    for j in 0..=cells {
        for i in 0..=cells {
            let [x, y, z] = place(share(i), share(j));
            writeln!(text, "v {x} {y} {z}").unwrap();
        }
    }
    for j in 0..cells {
        for i in 0..cells {
            let a = 1 + j * (cells + 1) + i;
            let (b, c, d) = (a + 1, a + cells + 2, a + cells + 1);
            writeln!(text, "f {a} {b} {c}\nf {a} {c} {d}").unwrap();
        }
    }
    text
}

#[test]
fn a_run_that_ends_tangled_says_so_with_numbers_and_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: String| std::fs::write(folder.path().join(name), text).unwrap();
    write("flat.obj", square(8, |u, v| [0.2 * u, 1.0, 0.2 * v]));
    write(
        "upright.obj",
        square(8, |u, v| [0.2 * u + 0.003, 0.9 + 0.2 * v, 0.1]),
    );
    write(
        "over.obj",
        square(8, |u, v| [0.2 * u + 0.003, 1.1, 0.2 * v]),
    );
    let run = |other: &str, pins: &str, collision: &str| {
        let text = format!(
            r#"{{ "duration": 0.05, "step": 0.01, "collision": {{ {collision} }}, "objects": [
                {{ "name": "one", "kind": "deformable", "mesh": "flat.obj", "pins": [{pins}] }},
                {{ "name": "other", "kind": "deformable", "mesh": "{other}", "pins": [72] }} ] }}"#
        );
        write("scene.json", text);
        let path = folder.path().join("scene.json");
        run_scene(
            &path,
            &folder.path().join("out"),
            &RunOptions::default(),
            &mut Silent,
        )
        .unwrap()
        .report
    };
    let tangled = |report: &serde_json::Value| -> Vec<String> {
        let warnings = report["warnings"].as_array().unwrap().iter();
        let texts = warnings.map(|w| w.as_str().unwrap().to_owned());
        texts.filter(|text| text.contains("cross")).collect()
    };

    // Through each other from the start, and cloth passes through cloth.
    let report = run("upright.obj", "0, 8, 72, 80", "");
    let counts = ["start", "most", "end"].map(|at| report["crossings"][at].as_u64().unwrap());
    assert!(
        counts[0] > 0 && counts[1] >= counts[0] && counts[2] > 0,
        "{counts:?}"
    );
    assert_eq!(report["self_intersections"].as_u64(), Some(counts[2]));
    let words = tangled(&report);
    assert_eq!(words.len(), 1, "{words:?}");
    for part in [
        format!("{} at the start", counts[0]),
        format!("{} pairs", counts[2]),
        "collision.cloth_offset".to_owned(),
    ] {
        assert!(words[0].contains(&part), "{part}: {words:?}");
    }

    // Apart, and kept so.
    let report = run("over.obj", "0, 8, 72, 80", r#""cloth_offset": 0.002"#);
    assert_eq!(
        report["crossings"],
        serde_json::json!({ "start": 0, "most": 0, "end": 0 })
    );
    assert_eq!(tangled(&report), Vec::<String>::new());
}

#[test]
fn no_residual_is_told_of_a_method_that_balances_other_forces() {
    let folder = tempfile::tempdir().unwrap();
    let path = scene(folder.path(), ["one", "two"], 0.1);
    let text = std::fs::read_to_string(&path).unwrap();
    for (method, told) in [("xpbd", false), ("implicit-euler", true), ("rest", true)] {
        let method = format!(r#"{{ "method": {{ "name": "{method}" }}, "#);
        std::fs::write(&path, text.replacen('{', &method, 1)).unwrap();
        let report = run_scene(
            &path,
            &folder.path().join("out"),
            &RunOptions::default(),
            &mut Silent,
        )
        .unwrap()
        .report;
        assert_eq!(report["residual"].is_number(), told, "{method}");
        assert_eq!(report["residual"].is_null(), !told, "{method}");
    }
}

/// Every file of a folder with its bytes, but for times of this machine and checkpoints.
fn results(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let files = std::fs::read_dir(folder)
        .unwrap()
        .map(|file| file.unwrap().path());
    let files = files.filter(|path| path.is_file()).map(|path| {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        (name, std::fs::read(path).unwrap())
    });
    files
        .filter(|(name, _)| name != "timing.json" && name != "checkpoint.json")
        .collect()
}

#[test]
fn an_interrupted_run_goes_on_from_its_checkpoint_to_the_same_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = scene(folder.path(), ["one", "two"], 0.02);
    let [whole, broken] = ["whole", "broken"].map(|name| folder.path().join(name));
    run_scene(&path, &whole, &RunOptions::default(), &mut Silent).unwrap();
    let mut options = RunOptions {
        checkpoint_step: Some(0.03),
        ..RunOptions::default()
    };
    let mut watcher = |_: &str, share: f64, _: &str| match share > 0.7 {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    };
    let stopped = run_scene(&path, &broken, &options, &mut watcher);
    assert!(matches!(stopped, Err(SessionError::Cancelled)));
    assert!(broken.join("checkpoint.json").is_file());
    assert!(!broken.join("report.json").exists());
    options.resume = true;
    let mut first = None;
    let mut watcher = |_: &str, share: f64, _: &str| {
        first.get_or_insert(share);
        ControlFlow::Continue(())
    };
    run_scene(&path, &broken, &options, &mut watcher).unwrap();
    assert!(first.unwrap() > 0.6, "it began anew: {first:?}");
    assert_eq!(results(&whole), results(&broken));

    // What it cannot go on from is refused by its place.
    let refused = |path: &Path, out: &Path, options: &RunOptions, place: &str| {
        let error = run_scene(path, out, options, &mut Silent).unwrap_err();
        assert!(error.to_string().contains(place), "{error}");
    };
    refused(&path, &whole, &options, "there is nothing to resume");
    let other = scene(folder.path(), ["one", "three"], 0.02);
    refused(&other, &broken, &options, "saved of another scene");
    let endless = RunOptions {
        checkpoint_step: Some(0.0),
        ..RunOptions::default()
    };
    refused(
        &other,
        &whole,
        &endless,
        "the time between checkpoints is 0",
    );
    let text = std::fs::read_to_string(&other).unwrap();
    let text = text.replacen('{', r#"{ "method": { "name": "rest" },"#, 1);
    std::fs::write(&other, text).unwrap();
    let saved = RunOptions {
        checkpoint_step: Some(1.0),
        ..RunOptions::default()
    };
    refused(&other, &whole, &saved, "a run by \"rest\" has none");
}

#[test]
fn a_cloth_falls_through_what_it_ignores() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("cloth.obj"),
        OBJ.replace("1 0", "0.02 0").replace("1 0.1", "0.02 0.1"),
    )
    .unwrap();
    let plate = "v -1 0 -1\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nf 1 2 3\nf 1 3 4\n";
    std::fs::write(folder.path().join("plate.obj"), plate).unwrap();
    let path = folder.path().join("scene.json");
    let write = |ignore: &str| {
        let text = format!(
            r#"{{ "duration": 0.2, "collision": {{ "ignore": {ignore} }}, "objects": [
                {{ "name": "plate", "kind": "static", "mesh": "plate.obj" }},
                {{ "name": "cloth", "kind": "deformable", "mesh": "cloth.obj" }} ] }}"#
        );
        std::fs::write(&path, text).unwrap();
    };
    let out = folder.path().join("out");
    // The first checkpoint makes the folder.
    let options = RunOptions {
        checkpoint_step: Some(0.1),
        ..RunOptions::default()
    };
    let run = || run_scene(&path, &out, &options, &mut Silent);
    let height = || {
        let report = run().unwrap().report;
        let text = std::fs::read_to_string(out.join("cloth.obj")).unwrap();
        let vertex = text.lines().find(|line| line.starts_with("v ")).unwrap();
        let y = vertex.split(' ').nth(2).unwrap().parse::<f64>().unwrap();
        (y, report["body_penetration_max_m"].as_f64().unwrap())
    };
    write("[]");
    let (lies, _) = height();
    assert!((lies - 0.004).abs() < 1e-3, "{lies}");
    write(r#"[["cloth", "plate"]]"#);
    let (fell, depth) = height();
    assert!(fell < -0.1, "{fell}");
    assert!(depth <= 0.0, "what is ignored does not count: {depth}");
    for (ignore, said) in [
        (
            r#"[["cloth", "pole"]]"#,
            "collision.ignore[0]: there is no object \"pole\"",
        ),
        (r#"[["plate", "plate"]]"#, "are solids, which never meet"),
    ] {
        write(ignore);
        let error = run().unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }
}
