//! Recorded frames: written by a run, read as objects of another scene, gone on from, written for other programs.

use std::ops::ControlFlow;
use std::path::PathBuf;
use toile_interchange::{Frames, read_frames, read_obj, read_pc2};
use toile_session::{
    FramesExport, RunOptions, SceneOutcome, SessionError, Silent, export_frames, run_scene,
};

/// A level square of 4 x 4 cells of 40 mm at a height, as OBJ.
fn square(height: f64) -> String {
    use std::fmt::Write;
    let mut text = String::new();
    for v in 0..25 {
        let [x, z] = [v % 5, v / 5].map(|k| 0.04 * f64::from(k));
        writeln!(text, "v {x} {} {z}", height + 0.2 * x * z).unwrap();
    }
    for q in 0..16 {
        let a = 1 + q / 4 * 5 + q % 4;
        let (b, c, d) = (a + 1, a + 6, a + 5);
        writeln!(text, "f {a} {c} {b}\nf {a} {d} {c}").unwrap();
    }
    text
}

/// A cloth that falls on a plate which rises, 0.5 s with a frame each 0.05 s.
const FALL: &str = r#"{ "duration": 0.5, "step": 0.01, "frame_step": 0.05, "method": { "name": "xpbd" },
    "collision": { "cloth_offset": 0.002 }, "objects": [
    { "name": "cloth", "kind": "deformable", "mesh": "cloth.obj", "pins": [0], "material": { "density": 0.25 } },
    { "name": "ground", "kind": "static", "mesh": "ground.obj" },
    { "name": "plate", "kind": "animated", "mesh": "plate.obj",
      "motion": { "keys": [ { "time": 0 }, { "time": 0.5, "translation": [0, 0.04, 0] } ] } } ] }"#;

struct Place(tempfile::TempDir);

impl Place {
    fn new() -> Self {
        let place = Self(tempfile::tempdir().unwrap());
        for (name, height) in [("cloth", 0.1), ("plate", 0.02), ("ground", -0.3)] {
            place.write(&format!("{name}.obj"), &square(height));
        }
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) -> PathBuf {
        std::fs::write(self.path(name), text).unwrap();
        self.path(name)
    }

    fn run(&self, scene: &str, text: &str) -> SceneOutcome {
        let path = self.write(scene, text);
        run_scene(&path, self.0.path(), &RunOptions::default(), &mut Silent).unwrap()
    }

    fn refused(&self, text: &str) -> String {
        let path = self.write("refused.json", text);
        let out = self.path("refused");
        let error = run_scene(&path, &out, &RunOptions::default(), &mut Silent).unwrap_err();
        assert!(error.is_bad_input(), "{error}");
        assert!(!out.exists());
        error.to_string()
    }

    fn frames(&self, name: &str) -> Frames {
        read_frames(&std::fs::read(self.path(name)).unwrap()).unwrap()
    }

    fn export(&self, out: &str, export: &FramesExport) -> Vec<PathBuf> {
        let from = self.path("fall.frames");
        export_frames(&from, &self.path(out), export).unwrap().files
    }
}

/// The positions of a surface in all frames.
fn course(frames: &Frames, surface: &str) -> Vec<Vec<[f64; 3]>> {
    let section = &frames.sections[0];
    let surfaces = &section.head.surfaces;
    let at = surfaces.iter().position(|s| s.name == surface).unwrap();
    let mesh = |frame| section.mesh(at, frame).unwrap().positions;
    let all = (0..section.frames.len()).map(mesh);
    all.map(|positions| positions.iter().map(|p| [p.x, p.y, p.z]).collect())
        .collect()
}

fn names(files: &[PathBuf]) -> Vec<String> {
    let name = |path: &PathBuf| path.file_name().unwrap().to_string_lossy().into_owned();
    files.iter().map(name).collect()
}

#[test]
fn a_recorded_cloth_is_an_animated_object_to_the_bit() {
    let place = Place::new();
    let made = place.run("fall.json", FALL);
    assert!(
        names(&made.files).contains(&"fall.frames".to_owned()),
        "{:?}",
        made.files
    );
    let first = place.frames("fall.frames");
    assert_eq!(first.sections[0].frames.len(), 10);
    let ground = first.sections[0]
        .head
        .surfaces
        .iter()
        .find(|s| s.name == "ground");
    assert_eq!(ground.unwrap().still.as_ref().unwrap().len(), 25);

    place.run(
        "again.json",
        r#"{ "duration": 0.5, "step": 0.01, "frame_step": 0.05, "method": { "name": "xpbd" }, "objects": [
            { "name": "cloth", "kind": "animated", "frames": "fall.frames" },
            { "name": "second", "kind": "deformable", "mesh": "cloth.obj",
              "transform": { "translation": [0, 0.02, 0] } },
            { "name": "lifted", "kind": "animated", "frames": "fall.frames", "object": "plate",
              "transform": { "translation": [5, 0, 0] } } ] }"#,
    );
    let again = place.frames("again.frames");
    assert_eq!(course(&again, "cloth"), course(&first, "cloth"));
    let lifted = course(&again, "lifted");
    assert!((lifted[9][3][0] - 5.0 - course(&first, "plate")[9][3][0]).abs() < 1e-6);
    assert!((lifted[9][3][1] - course(&first, "plate")[9][3][1]).abs() < 1e-7);
    assert!(lifted[9][3][1] > lifted[0][3][1] + 0.03);
}

#[test]
fn a_cloth_starts_from_a_frame_with_its_rest_shape() {
    let place = Place::new();
    place.run("fall.json", FALL);
    let recorded = course(&place.frames("fall.frames"), "cloth");
    let start = |frame: &str| {
        place.run(
            "start.json",
            &format!(
                r#"{{ "duration": 0.02, "step": 0.01, "frame_step": 0.01, "gravity": [0, 0, 0],
                "objects": [ {{ "name": "cloth", "kind": "deformable", "frames": "fall.frames" {frame} }} ] }}"#
            ),
        );
        place.frames("start.frames")
    };
    let last = start("");
    assert_eq!(course(&last, "cloth")[0], recorded[9]);
    let rest = |frames: &Frames| frames.sections[0].head.surfaces[0].rest.clone().unwrap();
    assert_eq!(rest(&last), rest(&place.frames("fall.frames")));
    assert_eq!(rest(&last).materials[0].density, 0.25);
    assert_eq!(course(&start(r#", "frame": 3"#), "cloth")[0], recorded[3]);
    let said = place.refused(
        r#"{ "objects": [ { "name": "cloth", "kind": "deformable", "frames": "fall.frames", "frame": 10 } ] }"#,
    );
    assert!(said.contains("10, counted from 0"), "{said}");
    let said = place.refused(
        r#"{ "objects": [ { "name": "plate", "kind": "deformable", "frames": "fall.frames" } ] }"#,
    );
    assert!(said.contains("is no cloth there"), "{said}");
}

#[test]
fn a_run_goes_on_from_any_frame_to_the_same_bytes() {
    let place = Place::new();
    let longer = FALL.replacen("0.5", "2.5", 1);
    let path = place.write("fall.json", &longer);
    let out = place.path("out");
    let run = |restart| {
        let options = RunOptions {
            restart,
            ..RunOptions::default()
        };
        run_scene(&path, &out, &options, &mut Silent)
    };
    run(None).unwrap();
    let bytes = |name: &str| std::fs::read(out.join(name)).unwrap();
    let whole = [bytes("fall.frames"), bytes("cloth.obj")];
    let kept = std::fs::read_dir(out.join("fall.checkpoints")).unwrap();
    let mut kept: Vec<PathBuf> = kept.map(|file| file.unwrap().path()).collect();
    kept.sort();
    let steps = ["00000000.json", "00000100.json", "00000200.json"];
    assert_eq!(names(&kept), steps);
    for frame in [0, 19, 20, 21, 45] {
        // What is written after the frame goes, and comes again.
        std::fs::write(out.join("fall.frames"), &whole[0]).unwrap();
        run(Some(frame)).unwrap();
        assert!(
            [bytes("fall.frames"), bytes("cloth.obj")] == whole,
            "frame {frame}"
        );
    }
    let said = run(Some(51)).unwrap_err().to_string();
    assert!(said.contains("the last one is 50"), "{said}");
    for path in &kept[..2] {
        std::fs::remove_file(path).unwrap();
    }
    assert!(run(Some(41)).is_ok());
    let said = run(Some(20)).unwrap_err().to_string();
    assert!(said.contains("no checkpoint beside the frames"), "{said}");
    let cut = &whole[0][..whole[0].len() / 2];
    std::fs::write(out.join("fall.frames"), cut).unwrap();
    let said = run(Some(45)).unwrap_err().to_string();
    assert!(
        said.contains("fewer frames than the checkpoint knows"),
        "{said}"
    );
}

#[test]
fn frames_are_written_for_other_programs() {
    let place = Place::new();
    place.run("fall.json", FALL);
    let recorded = place.frames("fall.frames");
    let cloth = course(&recorded, "cloth");
    let one = |object: &str| FramesExport {
        object: Some(object.to_owned()),
        frame: None,
    };

    let files = place.export("fall.glb", &FramesExport::default());
    let document = gltf::Gltf::open(&files[0]).unwrap();
    let targets = |mesh: gltf::Mesh| mesh.primitives().next().unwrap().morph_targets().count();
    let meshes = document
        .meshes()
        .map(|m| (m.name().unwrap().to_owned(), targets(m)));
    let expected = [("cloth", 9), ("plate", 9), ("ground", 0)];
    assert_eq!(
        meshes.collect::<Vec<_>>(),
        expected.map(|(name, n)| (name.to_owned(), n))
    );

    let files = place.export("both.pc2", &FramesExport::default());
    assert_eq!(
        names(&files),
        [
            "both-cloth.pc2",
            "both-cloth.obj",
            "both-plate.pc2",
            "both-plate.obj"
        ]
    );
    let files = place.export("cloth.pc2", &one("cloth"));
    assert_eq!(names(&files), ["cloth.pc2", "cloth.obj"]);
    let cache = read_pc2(&std::fs::read(&files[0]).unwrap()).unwrap();
    let samples = cache
        .samples
        .iter()
        .map(|s| s.iter().map(|p| p.map(f64::from)).collect::<Vec<_>>());
    assert_eq!(samples.collect::<Vec<_>>(), cloth);

    let files = place.export("some.obj", &one("cloth"));
    assert_eq!(names(&files).last().unwrap(), "some-00009.obj");
    let obj = read_obj(&std::fs::read(&files[9]).unwrap()).unwrap();
    let mesh = obj.into_triangle_mesh();
    assert!((mesh.positions[7].y - cloth[9][7][1]).abs() < 1e-6);
    let last = FramesExport {
        frame: Some(9),
        ..FramesExport::default()
    };
    assert_eq!(names(&place.export("one.obj", &last)), ["one.obj"]);
    let files = place.export(
        "one.png",
        &FramesExport {
            frame: Some(4),
            ..one("plate")
        },
    );
    assert_eq!(names(&files), ["one.png"]);
    assert!(std::fs::read(&files[0]).unwrap().starts_with(b"\x89PNG"));

    let refused = |out: &str, export: &FramesExport, words: &str| {
        let error =
            export_frames(&place.path("fall.frames"), &place.path(out), export).unwrap_err();
        assert!(
            error.is_bad_input() && error.to_string().contains(words),
            "{error}"
        );
    };
    refused(
        "a.abc",
        &FramesExport::default(),
        ".glb, .pc2, .obj or .png",
    );
    refused("a.glb", &last, "one frame is no motion");
    refused("a.obj", &one("shirt"), r#""cloth", "plate", "ground""#);
    let far = FramesExport {
        frame: Some(10),
        object: None,
    };
    refused("a.png", &far, "has 10, counted from 0");
}

#[test]
fn a_mesh_with_a_point_cache_moves_as_the_cache_says() {
    let place = Place::new();
    place.run("fall.json", FALL);
    let one = FramesExport {
        object: Some("plate".to_owned()),
        frame: None,
    };
    place.export("plate.pc2", &one);
    let scene = |more: &str| {
        format!(
            r#"{{ "duration": 0.2, "step": 0.01, "frame_step": 0.05, "method": {{ "name": "xpbd" }}, "objects": [
            {{ "name": "cloth", "kind": "deformable", "mesh": "cloth.obj" }},
            {{ "name": "plate", "kind": "animated", "mesh": "plate.obj", "frames": "plate.pc2" {more} }} ] }}"#
        )
    };
    place.run("cached.json", &scene(r#", "rate": 20"#));
    let expected = course(&place.frames("fall.frames"), "plate");
    let moved = course(&place.frames("cached.frames"), "plate");
    for (a, b) in moved.iter().zip(&expected) {
        assert!((a[6][1] - b[6][1]).abs() < 1e-7);
    }
    let said = place.refused(&scene(""));
    assert!(said.contains("give the object its rate"), "{said}");
    place.write("plate.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n");
    let said = place.refused(&scene(r#", "rate": 20"#));
    assert!(said.contains("25 points, the mesh 3 vertices"), "{said}");
}

#[test]
fn a_recording_whose_triangles_change_and_files_that_are_none_are_refused() {
    let place = Place::new();
    place.run(
        "sewn.json",
        r#"{ "duration": 0.1, "step": 0.01, "frame_step": 0.02, "gravity": [0, 0, 0], "objects": [
            { "name": "cloth", "kind": "deformable", "mesh": "cloth.obj" },
            { "name": "other", "kind": "deformable", "mesh": "cloth.obj", "transform": { "translation": [0.161, 0, 0] } } ],
          "elastics": [ { "from": ["cloth", 4], "to": ["other", 0], "stiffness": 10, "merge_within": 0.002 } ] }"#,
    );
    let recorded = place.frames("sewn.frames");
    assert_eq!(recorded.sections.len(), 2);
    assert_eq!(recorded.sections[1].head.surfaces[0].vertices, 49);
    let scene = |frames: &str| {
        format!(
            r#"{{ "method": {{ "name": "xpbd" }}, "objects": [
            {{ "name": "cloth", "kind": "deformable", "mesh": "cloth.obj" }},
            {{ "name": "both", "kind": "animated", "frames": "{frames}" }} ] }}"#
        )
    };
    let said = place.refused(&scene("sewn.frames"));
    assert!(said.contains("change at frame 1"), "{said}");
    // One object of the surface keeps its triangles, and the cloth starts from what was sewn.
    place.run(
        "part.json",
        r#"{ "duration": 0.02, "step": 0.01, "method": { "name": "xpbd" }, "objects": [
            { "name": "a", "kind": "deformable", "frames": "sewn.frames", "object": "cloth+other" },
            { "name": "b", "kind": "animated", "frames": "sewn.frames", "object": "cloth",
              "transform": { "translation": [0, 1, 0] } } ] }"#,
    );
    for (file, words) in [
        ("cloth.obj", "no file of frames"),
        ("gone.frames", "gone.frames"),
    ] {
        let said = place.refused(&scene(file));
        assert!(said.contains(words), "{said}");
    }
}

#[test]
fn damaged_frames_and_scenes_are_refused_and_nothing_panics() {
    let place = Place::new();
    place.run("fall.json", FALL);
    let scene = r#"{ "duration": 0.02, "step": 0.01, "frame_step": 0.01, "method": { "name": "xpbd" }, "objects": [
        { "name": "cloth", "kind": "deformable", "mesh": "cloth.obj", "pins": [0, 4] },
        { "name": "plate", "kind": "animated", "frames": "damaged.frames", "object": "plate" },
        { "name": "start", "kind": "deformable", "frames": "damaged.frames", "object": "cloth", "frame": 2 } ] }"#;
    let bytes = std::fs::read(place.path("fall.frames")).unwrap();
    let mut seed = 7_u64;
    let mut next = |below: usize| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 33) as usize % below
    };
    let out = place.path("damaged");
    // Stopped at its first step: what is read is in question.
    let run = |text: &str| {
        let path = place.write("damaged.json", text);
        let mut stop = |_: &str, _: f64, _: &str| ControlFlow::Break(());
        run_scene(&path, &out, &RunOptions::default(), &mut stop).unwrap_err()
    };
    for round in 0..300 {
        let mut frames = bytes.clone();
        let mut text = scene.as_bytes().to_vec();
        match round % 3 {
            // A changed bit of the frames is found out wherever it is.
            0 => frames[next(bytes.len())] ^= 1 << next(8),
            1 => frames.truncate(next(bytes.len())),
            _ => {
                let at = next(text.len());
                text[at] = b"0123456789-\"{}[],:ae. "[next(22)];
            }
        }
        std::fs::write(place.path("damaged.frames"), &frames).unwrap();
        let error = run(&String::from_utf8(text).unwrap());
        let is_stopped = matches!(error, SessionError::Cancelled);
        assert!(error.is_bad_input() || is_stopped, "{round}: {error}");
        assert!(round % 3 != 0 || !is_stopped || read_frames(&frames).is_ok());
    }
}
