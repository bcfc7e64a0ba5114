//! Pictures of scenes: which files there are, what is refused, and that a resumed run paints the same.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use toile_session::{PictureOptions, PictureTime, RunOptions, Silent, run_scene};

/// A cloth that falls beside a plate at rest for 0.1 s.
fn scene(folder: &Path, more: &str) -> PathBuf {
    let cloth = "v 0 1 0\nv 0.1 1 0\nv 0 1 0.1\nf 1 2 3\n";
    std::fs::write(folder.join("cloth.obj"), cloth).unwrap();
    let plate = "v 0 0.8 0\nv 0 0.8 0.1\nv 0.1 0.8 0\nf 1 2 3\n";
    std::fs::write(folder.join("plate.obj"), plate).unwrap();
    let text = format!(
        r#"{{ "duration": 0.1, "step": 0.01 {more}, "objects": [
            {{ "name": "plate", "kind": "static", "mesh": "plate.obj" }},
            {{ "name": "cloth", "kind": "deformable", "mesh": "cloth.obj" }} ] }}"#
    );
    let path = folder.join("falls.json");
    std::fs::write(&path, text).unwrap();
    path
}

fn asked(times: &[&str], of: Option<&str>) -> RunOptions {
    RunOptions {
        pictures: PictureOptions {
            times: times.iter().map(|time| time.parse().unwrap()).collect(),
            of: of.map(str::to_owned),
        },
        ..RunOptions::default()
    }
}

fn pictures(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let files = std::fs::read_dir(folder).unwrap().map(|file| {
        let path = file.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        (name, std::fs::read(path).unwrap())
    });
    let mut pictures: Vec<_> = files.filter(|(name, _)| name.ends_with(".png")).collect();
    pictures.sort();
    pictures
}

#[test]
fn first_last_and_any_time_are_painted() {
    let folder = tempfile::tempdir().unwrap();
    let path = scene(folder.path(), "");
    let out = folder.path().join("out");
    let options = asked(&["first", "50ms", "last"], Some("cloth"));
    run_scene(&path, &out, &options, &mut Silent).unwrap();
    let painted = pictures(&out);
    let names: Vec<&str> = painted.iter().map(|(name, _)| &**name).collect();
    let [first, last, time] = ["first", "last", "0.05s"].map(|when| format!("picture-{when}.png"));
    assert_eq!(names, [&*time, &*first, &*last]);
    let of = |name: &str| &painted.iter().find(|(known, _)| known == name).unwrap().1;
    assert!(of(&first).starts_with(b"\x89PNG"));
    assert!(of(&first) != of(&time) && of(&time) != of(&last));
}

#[test]
fn a_resumed_run_paints_what_one_without_interruption_does() {
    let folder = tempfile::tempdir().unwrap();
    let path = scene(folder.path(), "");
    let [whole, broken] = ["whole", "broken"].map(|name| folder.path().join(name));
    let mut options = asked(&["first", "90ms", "last"], None);
    run_scene(&path, &whole, &options, &mut Silent).unwrap();
    options.checkpoint_step = Some(0.05);
    let mut stop = |_: &str, share: f64, _: &str| match share > 0.7 {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    };
    assert!(run_scene(&path, &broken, &options, &mut stop).is_err());
    options.resume = true;
    run_scene(&path, &broken, &options, &mut Silent).unwrap();
    assert!(pictures(&whole) == pictures(&broken));
    let passed = RunOptions {
        resume: true,
        ..asked(&["20ms"], None)
    };
    let error = run_scene(&path, &broken, &passed, &mut Silent).unwrap_err();
    assert!(error.to_string().contains("goes on from later"), "{error}");
}

#[test]
fn times_and_objects_that_are_not_there_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let refused = |more: &str, options: RunOptions, words: &str| {
        let path = scene(folder.path(), more);
        let error = run_scene(&path, &out, &options, &mut Silent).unwrap_err();
        assert!(error.is_bad_input(), "{error}");
        assert!(error.to_string().contains(words), "{error}");
        assert!(!out.exists());
    };
    refused("", asked(&["2s"], None), "to the scene's duration");
    refused("", asked(&["-1s"], None), "to the scene's duration");
    refused("", asked(&["last"], Some("shirt")), r#""plate", "cloth""#);
    let rest = r#", "method": { "name": "rest" }"#;
    refused(rest, asked(&["0.05s"], None), "a run to rest has no times");
    let wrong = "noon".parse::<PictureTime>().unwrap_err();
    assert!(wrong.contains("write first, last"), "{wrong}");
}
