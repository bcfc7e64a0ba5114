//! A garment's run is saved, read by a new process and goes on there to the same bytes: sewn, swinging,
//! settling and at rest, after edits, with cloth on cloth, at one thread and two.

use std::path::Path;
use std::process::Command;
use std::sync::Arc;
use toile_drape::{
    Attachment, Cloth, ContactSettings, DrapeError, GarmentLevel, GarmentRun, GarmentSetup,
    Material, RestSettings, SewSettings, Stage,
};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec2, Vec3};
use toile_interchange::{read_checkpoint, read_text, write_atomically, write_checkpoint};

/// An octahedron divided and drawn onto a sphere.
fn ball(radius: f64) -> TriangleMesh {
    let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
    let mut faces: Vec<[Vec3; 3]> = Vec::new();
    for signs in 0..8u32 {
        let [a, b, c] = [0, 1, 2].map(|k| axes[k] * if signs >> k & 1 == 0 { 1.0 } else { -1.0 });
        faces.push(if signs.count_ones() % 2 == 0 {
            [a, b, c]
        } else {
            [a, c, b]
        });
    }
    for _ in 0..4 {
        let cut = |[a, b, c]: [Vec3; 3]| {
            let [ab, bc, ca] = [a + b, b + c, c + a].map(|p| p.normalize());
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        faces = faces.into_iter().flat_map(cut).collect();
    }
    let mut mesh = TriangleMesh::default();
    let mut known = std::collections::BTreeMap::new();
    for face in faces {
        let corners = face.map(|p| {
            let key = [p.x, p.y, p.z].map(|x| (x * 1e9).round() as i64);
            *known.entry(key).or_insert_with(|| {
                mesh.positions.push(p * radius + Vec3::y() * 1.1);
                mesh.positions.len() as u32 - 1
            })
        });
        mesh.triangles.push(corners);
    }
    mesh
}

/// Cells across a panel of the finest mesh, and of the one that it is meshed anew with.
const FINE: usize = 16;
const ANEW: usize = 18;

/// Two tubes of two panels each, the second worn over the first; `n` cells across a panel.
fn level(n: usize) -> GarmentLevel {
    let mut level = GarmentLevel {
        cloth: Cloth {
            materials: vec![Material::default()],
            ..Cloth::default()
        },
        ..GarmentLevel::default()
    };
    for tube in 0..2u16 {
        let [width, height] = [0.6 + 0.2 * f64::from(tube), 0.36];
        let rows = (n as f64 * height / width).round() as usize;
        let per_panel = ((n + 1) * (rows + 1)) as u32;
        for (panel, side) in [1.0, -1.0].into_iter().enumerate() {
            let cloth = &mut level.cloth;
            let first = cloth.positions.len() as u32;
            let flat = |i: usize, j: usize| {
                let [across, up] = [i as f64 / n as f64 - 0.5, j as f64 / rows as f64];
                Vec2::new(width * across, height * up)
            };
            let away = side * (0.22 + 0.1 * f64::from(tube));
            for (i, j) in (0..=rows).flat_map(|j| (0..=n).map(move |i| (i, j))) {
                let p = flat(i, j);
                cloth
                    .positions
                    .push(Vec3::new(p.x * side, p.y + 0.95, away));
                level.layer.push(tube);
            }
            let at = |i: usize, j: usize| first + (j * (n + 1) + i) as u32;
            for (i, j) in (0..rows).flat_map(|j| (0..n).map(move |i| (i, j))) {
                let [a, b, c, d] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
                for corners in [[a, b, c], [a, c, d]] {
                    cloth.triangles.push(corners.map(|(i, j)| at(i, j)));
                    cloth.rest.push(corners.map(|(i, j)| flat(i, j)));
                    cloth.material.push(0);
                    cloth.panel.push(2 * u32::from(tube) + panel as u32);
                }
            }
            if panel == 0 {
                for j in 0..=rows {
                    level.stitches.push([at(0, j), at(n, j) + per_panel]);
                    level.stitches.push([at(n, j), at(0, j) + per_panel]);
                }
                for i in (0..=n).filter(|i| i * 3 <= n || (n - i) * 3 <= n) {
                    level
                        .stitches
                        .push([at(i, rows), at(n - i, rows) + per_panel]);
                }
            }
        }
    }
    level
}

fn setup() -> GarmentSetup {
    setup_of(FINE)
}

/// The garment with so many cells across a panel of its finest mesh.
fn setup_of(fine: usize) -> GarmentSetup {
    GarmentSetup {
        levels: vec![level(10), level(fine)],
        counted: Vec::new(),
        colliders: vec![Arc::new(SurfaceTree::new(ball(0.16)))],
        contact: ContactSettings {
            cloth_offset: 2e-3,
            ..ContactSettings::default()
        },
        gravity: Vec3::new(0.0, -9.81, 0.0),
        sew: SewSettings::default(),
        rest: RestSettings {
            residual: 1e-9,
            steps: 40,
            ..RestSettings::default()
        },
    }
}

/// Rest shapes of the finest mesh, wider by a share at the hem of the outer tube.
fn wider(by: f64) -> Vec<[Vec2; 3]> {
    let cloth = level(FINE).cloth;
    let shapes = cloth.rest.iter().zip(&cloth.panel);
    let wide = |p: Vec2, panel: u32| match panel {
        0 | 1 => p,
        _ => Vec2::new(p.x * (1.0 + by * (1.0 - p.y / 0.36)), p.y),
    };
    shapes
        .map(|(shape, &panel)| shape.map(|p| wide(p, panel)))
        .collect()
}

/// All that a run is seen to be, to the last bit.
fn told(run: &GarmentRun) -> String {
    let state = serde_json::to_string(&run.state).unwrap();
    let tally = run.cloth_tally();
    let counts = [tally.impulses, tally.zoned, tally.cut, tally.looks];
    format!("{:?} {:?} {counts:?}\n{state}", run.progress(), run.steps())
}

/// What is done with a run after it was saved.
#[derive(Clone, Copy)]
struct Task {
    steps: usize,
    /// The hem is made wider at first.
    edit: bool,
    /// Cells across a panel of the finest mesh.
    fine: usize,
}

fn go_on(run: &mut GarmentRun, task: Task) -> String {
    if task.edit {
        run.reshape(wider(0.05), Vec::new()).unwrap();
    }
    for _ in 0..task.steps {
        run.advance().unwrap();
    }
    told(run)
}

/// What the process that goes on is told by its environment: the checkpoint, where to write what came of it,
/// how many steps to take, whether the hem is made wider, and the finest mesh.
const FILE: &str = "TOILE_CHECKPOINT";
const OUT: &str = "TOILE_CHECKPOINT_OUT";
const STEPS: &str = "TOILE_CHECKPOINT_STEPS";
const EDIT: &str = "TOILE_CHECKPOINT_EDIT";
const MESH: &str = "TOILE_CHECKPOINT_MESH";

/// Goes on as the environment says.
fn be_the_new_process(file: &str) {
    let value = |name: &str| std::env::var(name).unwrap();
    let checkpoint = read_checkpoint(&read_text(Path::new(file)).unwrap()).unwrap();
    let task = Task {
        steps: value(STEPS).parse().unwrap(),
        edit: value(EDIT) == "true",
        fine: value(MESH).parse().unwrap(),
    };
    let mut run = GarmentRun::resume(setup_of(task.fine), checkpoint).unwrap();
    std::fs::write(value(OUT), go_on(&mut run, task)).unwrap();
}

/// Saves a run, lets new processes go on from there, and holds what comes of it to the run that goes on
/// itself.
fn check(name: &str, run: &mut GarmentRun, task: Task) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("run.json");
    let checkpoint = run
        .checkpoint()
        .unwrap_or_else(|| panic!("{name}: no checkpoint"));
    let text = write_checkpoint(&checkpoint).unwrap();
    write_atomically(&file, text.as_bytes()).unwrap();
    let before = told(run);
    let expected = go_on(run, task);
    assert_ne!(before, expected, "{name}");
    for threads in ["1", "2"] {
        let out = folder.path().join(threads);
        let done = Command::new(std::env::current_exe().unwrap())
            .args([
                "--exact",
                "checkpoints::a_new_process_goes_on_to_the_same_bytes",
            ])
            .env("RAYON_NUM_THREADS", threads)
            .env(FILE, &file)
            .env(OUT, &out)
            .env(STEPS, task.steps.to_string())
            .env(EDIT, task.edit.to_string())
            .env(MESH, task.fine.to_string())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&done.stdout);
        assert!(done.status.success(), "{name}, {threads} threads: {said}");
        let got = std::fs::read_to_string(&out).unwrap();
        let head = |text: &str| text.lines().next().unwrap().to_owned();
        assert_eq!(head(&got), head(&expected), "{name}, {threads} threads");
        assert!(
            got == expected,
            "{name}, {threads} threads: the states differ"
        );
    }
}

/// Advances to the first checkpoint from here on where `is_it` holds.
fn advance_to(run: &mut GarmentRun, is_it: impl Fn(&GarmentRun) -> bool) {
    for _ in 0..2000 {
        run.advance().unwrap();
        assert_eq!(run.is_checkpoint(), run.steps_to_checkpoint() == 0);
        assert_eq!(run.is_checkpoint(), run.checkpoint().is_some());
        if run.is_checkpoint() && is_it(run) {
            return;
        }
    }
    panic!("no such checkpoint");
}

/// Whether it has taken some steps of a stage on a level; those of the swing are not counted.
fn within(stage: Stage, level: usize, steps: usize) -> impl Fn(&GarmentRun) -> bool {
    move |run| {
        let progress = run.progress();
        progress.stage == stage && run.level()[0] == level && progress.step >= steps
    }
}

#[test]
fn a_new_process_goes_on_to_the_same_bytes() {
    if let Ok(file) = std::env::var(FILE) {
        return be_the_new_process(&file);
    }
    let task = |steps| Task {
        steps,
        edit: false,
        fine: FINE,
    };
    let edit = |steps| Task {
        edit: true,
        ..task(steps)
    };
    let anew = |steps| Task {
        fine: ANEW,
        ..task(steps)
    };
    let mut run = GarmentRun::new(setup()).unwrap();
    check("placed", &mut run, task(2));
    advance_to(&mut run, within(Stage::Sewing, 0, 1));
    check("sewing", &mut run, task(2));
    advance_to(&mut run, within(Stage::Swinging, 0, 0));
    check("merged", &mut run, task(13));
    advance_to(&mut run, within(Stage::Swinging, 0, 0));
    check("swinging", &mut run, task(25));
    advance_to(&mut run, within(Stage::Swinging, 0, 0));
    check("swinging slowly", &mut run, task(5));
    advance_to(&mut run, within(Stage::Settling, 0, 0));
    check("settling on the coarse mesh", &mut run, task(4));
    advance_to(&mut run, within(Stage::Swinging, 1, 0));
    let hand = hand(&run, 40);
    run.control_mut().attachments = [hand].into_iter().collect();
    check(
        "swinging on the fine mesh, held, beyond a checkpoint",
        &mut run,
        task(43),
    );
    advance_to(&mut run, within(Stage::Settling, 1, 1));
    run.control_mut().attachments = Default::default();
    check("settling", &mut run, task(19));
    assert!(run.cloth_tally().looks > 0 && !run.state.cloth.friction.is_empty());
    advance_to(&mut run, within(Stage::Finished, 1, 1));
    check("at rest, then edited", &mut run, edit(3));
    advance_to(&mut run, within(Stage::Settling, 1, 1));
    check("settling after an edit", &mut run, task(10));
    advance_to(&mut run, |_| true);
    run.reshape(wider(0.03), Vec::new()).unwrap();
    check("after another edit, edited once more", &mut run, edit(9));
    run.remesh(level(ANEW), Vec::new()).unwrap();
    check("meshed anew", &mut run, anew(4));
    advance_to(&mut run, within(Stage::Settling, 1, 0));
    check("settling on the new mesh", &mut run, anew(9));
}

/// A hand that holds a vertex a little higher.
fn hand(run: &GarmentRun, vertex: u32) -> Attachment {
    Attachment {
        vertex,
        place: run.state.positions[vertex as usize] + Vec3::y() * 0.01,
        law: toile_drape::laws::elastic::ElasticLaw {
            stiffness: 50.0,
            largest_force: f64::INFINITY,
        },
    }
}

/// What makes another setup of one.
type Change<'a> = &'a dyn Fn(&mut GarmentSetup);

/// Why a setup does not go on from a checkpoint.
fn refusal(setup: GarmentSetup, text: &str) -> String {
    match GarmentRun::resume(setup, read_checkpoint(text).unwrap()) {
        Err(error @ DrapeError::Scene { .. }) => error.to_string(),
        Err(error) => panic!("{error}"),
        Ok(_) => panic!("it goes on"),
    }
}

#[test]
fn a_checkpoint_of_another_garment_is_refused_by_what_differs() {
    let run = GarmentRun::new(setup()).unwrap();
    let text = write_checkpoint(&run.checkpoint().unwrap()).unwrap();
    let with = |change: Change| {
        let mut other = setup();
        change(&mut other);
        refusal(other, &text)
    };
    let cases: [(&str, Change); 8] = [
        ("count of meshes", &|s| s.levels.truncate(1)),
        ("count of vertices", &|s| s.levels[1] = level(12)),
        ("count of stitches", &|s| s.levels[0].stitches.truncate(5)),
        ("triangles and seams", &|s| {
            s.levels[0].cloth.triangles[3].rotate_left(1)
        }),
        ("shape of the panels", &|s| {
            s.levels[1].cloth.rest[3][0].x += 1e-6
        }),
        ("fabrics", &|s| {
            s.levels[0].cloth.materials[0].density *= 2.0
        }),
        ("body", &|s| {
            s.colliders[0] = Arc::new(SurfaceTree::new(ball(0.15)))
        }),
        ("settings", &|s| s.rest.residual *= 2.0),
    ];
    for (what, change) in cases {
        let said = with(change);
        assert!(said.starts_with(&format!("checkpoint, {what}: ")), "{said}");
        assert!(said.contains("drape from the start"), "{said}");
    }
    assert!(GarmentRun::resume(setup(), read_checkpoint(&text).unwrap()).is_ok());
}

#[test]
fn a_damaged_file_is_refused_with_place_and_remedy() {
    let run = GarmentRun::new(setup()).unwrap();
    let text = write_checkpoint(&run.checkpoint().unwrap()).unwrap();
    let cut = &text[..text.len() / 2];
    let newer = text.replacen("\"version\":5", "\"version\":6", 1);
    let digit = text.rfind(|c: char| c.is_ascii_digit()).unwrap();
    let mut changed = text.clone();
    let other = if &text[digit..=digit] == "7" {
        "8"
    } else {
        "7"
    };
    changed.replace_range(digit..=digit, other);
    let head = text.lines().next().unwrap();
    let cases = [
        ("", "line 1: this is no checkpoint"),
        ("{}", "line 1: this is no checkpoint"),
        (
            "{\"format\":\"toile-marker\",\"version\":2}\n{}",
            "line 1: this is no checkpoint",
        ),
        (&head[..head.len() - 3], "line 1: "),
        (&newer, "version: it is 6; only version 5 is known"),
        (head, "line 2: it was cut short or changed"),
        (cut, "line 2: it was cut short or changed"),
        (&changed, "line 2: it was cut short or changed"),
    ];
    for (text, begins) in cases {
        let said = read_checkpoint::<toile_drape::Checkpoint>(text)
            .unwrap_err()
            .to_string();
        assert!(said.starts_with(begins), "{said}");
        assert!(said.contains("; "), "{said}");
    }
    // What fits its checksum is held to its own parts.
    let body = text.lines().nth(1).unwrap();
    let mut value: serde_json::Value = serde_json::from_str(body).unwrap();
    value["state"]["velocities"].as_array_mut().unwrap().pop();
    let unfit = serde_json::from_value(value.clone()).unwrap();
    let said = match GarmentRun::resume(setup(), unfit) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("it goes on"),
    };
    assert!(said.starts_with("state, velocities: "), "{said}");
    let read = |value| serde_json::from_value::<toile_drape::Checkpoint>(value);
    value["gap_before_merging"] = "much".into();
    let word = read(value.clone()).unwrap_err().to_string();
    assert!(word.contains("expected a number, \"infinite\""), "{word}");
    value["gap_before_merging"] = 0.0.into();
    value["more"] = true.into();
    let unknown = serde_json::from_value::<toile_drape::Checkpoint>(value).unwrap_err();
    assert!(
        unknown.to_string().contains("unknown field `more`"),
        "{unknown}"
    );
}
