//! A scene's run is saved, read by a new process and goes on there to the same bytes: by two methods, with cloth on
//! cloth, before and after seams of it are merged, at one thread and two.

use std::path::Path;
use std::process::Command;
use toile_drape::{
    ContactSettings, Material, MethodKind, ObjectKind, Scene, SceneElastic, SceneEnd, SceneObject,
    SceneRun,
};
use toile_geometry::{TriangleMesh, Vec3};
use toile_interchange::{read_checkpoint, read_text, write_atomically, write_checkpoint};

/// A square sheet of 8 x 8 cells of 20 mm, level, with a corner at `at`.
fn sheet(name: &str, at: Vec3, pins: Vec<u32>) -> SceneObject {
    let mut mesh = TriangleMesh::default();
    for v in 0..81u32 {
        let [x, z] = [v % 9, v / 9].map(|k| 0.02 * f64::from(k));
        mesh.positions.push(at + Vec3::new(x, 0.1 * x * z, z));
    }
    for q in 0..64u32 {
        let a = q / 8 * 9 + q % 8;
        (mesh.triangles).extend([[a, a + 10, a + 1], [a, a + 9, a + 10]]);
    }
    SceneObject {
        name: name.to_owned(),
        kind: ObjectKind::Deformable {
            material: Material::default(),
            pins,
        },
        mesh,
        cloth: None,
        layer: 0,
    }
}

/// Two sheets that hang side by side by two corners each and are drawn together along their common border, and a
/// third that falls on them.
fn scene(kind: MethodKind) -> Scene {
    let vertex = |object, vertex| SceneEnd::Vertex { object, vertex };
    let seam = (0..9).map(|k| SceneElastic {
        from: vertex(0, 9 * k + 8),
        to: vertex(1, 9 * k),
        stiffness: 60.0,
        merge_within: Some(2e-3),
    });
    Scene {
        step: 1.0 / 60.0,
        duration: 10.0,
        method: kind.into(),
        contact: ContactSettings {
            cloth_offset: 2e-3,
            ..ContactSettings::default()
        },
        objects: vec![
            sheet("left", Vec3::zeros(), vec![0, 72]),
            sheet("right", Vec3::new(0.175, 0.0, 0.0), vec![8, 80]),
            sheet("falling", Vec3::new(0.08, 0.05, 0.01), vec![]),
        ],
        elastics: seam.collect(),
        ..Scene::default()
    }
}

/// All that a run is seen to be, to the last bit.
fn told(run: &SceneRun) -> String {
    let state = serde_json::to_string(&run.state).unwrap();
    let merged = run.world().merged().count();
    format!("{} {merged} {:?}\n{state}", run.steps(), run.cloth_tally())
}

fn go_on(run: &mut SceneRun, steps: usize) -> String {
    for _ in 0..steps {
        run.advance().unwrap();
    }
    told(run)
}

/// What the process that goes on is told by its environment.
const FILE: &str = "TOILE_SCENE_CHECKPOINT";
const OUT: &str = "TOILE_SCENE_CHECKPOINT_OUT";
const METHOD: &str = "TOILE_SCENE_CHECKPOINT_METHOD";
/// Steps that are taken from a checkpoint.
const STEPS: usize = 25;

fn method(name: &str) -> MethodKind {
    let found = MethodKind::ALL.iter().find(|(known, _)| *known == name);
    found.unwrap().1
}

/// Saves a run, lets new processes go on from there, and holds what comes of it to the run that goes on itself.
fn check(run: &mut SceneRun, scene: &Scene) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("run.json");
    let said = format!("{} after {}", scene.method.kind.name(), run.steps());
    let text = write_checkpoint(&run.checkpoint().unwrap()).unwrap();
    write_atomically(&file, text.as_bytes()).unwrap();
    let expected = go_on(run, STEPS);
    for threads in ["1", "2"] {
        let out = folder.path().join(threads);
        let done = Command::new(std::env::current_exe().unwrap())
            .args([
                "--exact",
                "scene_checkpoints::a_new_process_goes_on_to_the_same_bytes",
            ])
            .env("RAYON_NUM_THREADS", threads)
            .env(FILE, &file)
            .env(OUT, &out)
            .env(METHOD, scene.method.kind.name())
            .output()
            .unwrap();
        let printed = String::from_utf8_lossy(&done.stdout);
        assert!(
            done.status.success(),
            "{said}, {threads} threads: {printed}"
        );
        let got = std::fs::read_to_string(&out).unwrap();
        let head = |text: &str| text.lines().next().unwrap().to_owned();
        assert_eq!(head(&got), head(&expected), "{said}, {threads} threads");
        assert!(got == expected, "{said}, {threads} threads: states differ");
    }
}

#[test]
fn a_new_process_goes_on_to_the_same_bytes() {
    if let Ok(file) = std::env::var(FILE) {
        let value = |name: &str| std::env::var(name).unwrap();
        let scene = scene(method(&value(METHOD)));
        let checkpoint = read_checkpoint(&read_text(Path::new(&file)).unwrap()).unwrap();
        let mut run = SceneRun::resume(&scene, checkpoint, toile_reference::build).unwrap();
        std::fs::write(value(OUT), go_on(&mut run, STEPS)).unwrap();
        return;
    }
    for kind in [MethodKind::Xpbd, MethodKind::ImplicitEuler] {
        let scene = scene(kind);
        let mut run = SceneRun::new(&scene, toile_reference::build).unwrap();
        check(&mut run, &scene);
        // Once a second where nothing is merged, and where something is.
        for _ in 0..2 {
            let mut steps = 0;
            while run.steps_to_checkpoint() > 0 {
                run.advance().unwrap();
                steps += 1;
                assert!(steps <= 60);
            }
            check(&mut run, &scene);
        }
        assert!(run.world().merged().count() > 0, "nothing was merged");
        assert!(kind != MethodKind::Xpbd || run.cloth_tally().unwrap().looks > 0);
    }
}

#[test]
fn what_cannot_be_saved_or_resumed_is_refused_by_name() {
    let sewn = scene(MethodKind::Xpbd);
    let mut run = SceneRun::new(&sewn, toile_reference::build).unwrap();
    let checkpoint = run.checkpoint().unwrap();
    let refused = |scene: &Scene, checkpoint| {
        let resumed = SceneRun::resume(scene, checkpoint, toile_reference::build);
        resumed.err().unwrap().to_string()
    };
    let mut other = sewn.clone();
    other.objects[0].mesh.positions[3].x += 1e-12;
    let said = refused(&other, checkpoint.clone());
    assert!(said.contains("another scene"), "{said}");
    let text = write_checkpoint(&checkpoint).unwrap();
    let said = read_checkpoint::<toile_drape::Checkpoint>(&text)
        .err()
        .unwrap();
    assert!(said.to_string().contains("toile-checkpoint"), "{said}");

    run.advance().unwrap();
    run.advance().unwrap();
    if run.steps_to_checkpoint() > 0 {
        let said = run.checkpoint().err().unwrap().to_string();
        assert!(said.contains("steps off"), "{said}");
    }
    for kind in [MethodKind::Rest, MethodKind::ImplicitMidpoint] {
        let scene = scene(kind);
        let run = SceneRun::new(&scene, toile_reference::build).unwrap();
        let said = run.checkpoint().err().unwrap().to_string();
        assert!(said.contains(kind.name()), "{said}");
    }
}
