//! A scene's run with what was done to it: done again from its inputs and from checkpoints on the way, at one thread and
//! two, it comes to the same bytes.

use toile_drape::{
    Action, Air, AttachmentEnd, AttachmentId, ContactSettings, Input, Material, MeshVertex,
    MethodKind, Motion, MotionKey, ObjectAttachment, ObjectKind, Parameter, Scene, SceneCheckpoint,
    SceneObject, SceneRun, SharedTrack, Spot, Track, WorldEdit,
};
use toile_geometry::{TriangleMesh, Vec2, Vec3};
use toile_interchange::{read_checkpoint, write_checkpoint};

/// A level square sheet of 6 x 6 cells of 30 mm with a corner at `at`.
fn sheet(name: &str, at: Vec3, pins: Vec<u32>) -> SceneObject {
    let mut mesh = TriangleMesh::default();
    for v in 0..49u32 {
        let [x, z] = [v % 7, v / 7].map(|k| 0.03 * f64::from(k));
        mesh.positions.push(at + Vec3::new(x, 0.1 * x * z, z));
    }
    for q in 0..36u32 {
        let a = q / 6 * 7 + q % 6;
        (mesh.triangles).extend([[a, a + 8, a + 1], [a, a + 7, a + 8]]);
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

/// A box that rises and sinks vertex by vertex.
#[derive(Clone, Copy)]
struct Breathing(f64);

fn solid() -> TriangleMesh {
    TriangleMesh::cuboid(Vec3::new(0.05, -0.16, 0.05), Vec3::new(0.13, -0.08, 0.13))
}

impl Track for Breathing {
    fn positions(&self, time: f64) -> Vec<Vec3> {
        let lift = |p: &Vec3| p + Vec3::y() * self.0 * (3.0 * time).sin() * (p.x + 0.1);
        solid().positions.iter().map(lift).collect()
    }

    fn digest(&self) -> u64 {
        self.0.to_bits()
    }
}

/// 3 s of a sheet that hangs by two corners over a box which moves, and a second that falls on it.
fn scene(amplitude: f64) -> Scene {
    let glide = [0.0, 1.5, 3.0].map(|time| MotionKey {
        time,
        translation: Vec3::new(0.03 * time, 0.0, 0.0),
        rotation: Vec3::y() * 0.2 * time,
    });
    let box_kind = ObjectKind::Animated {
        motion: Some(Motion {
            pivot: Vec3::zeros(),
            keys: glide.to_vec(),
        }),
        track: Some(SharedTrack::new(Breathing(amplitude))),
    };
    Scene {
        step: 1.0 / 60.0,
        duration: 3.0,
        method: MethodKind::Xpbd.into(),
        contact: ContactSettings {
            cloth_offset: 2e-3,
            ..ContactSettings::default()
        },
        objects: vec![
            sheet("hanging", Vec3::zeros(), vec![0, 6]),
            sheet("falling", Vec3::new(0.02, 0.03, 0.01), vec![]),
            SceneObject {
                name: "box".to_owned(),
                kind: box_kind,
                mesh: solid(),
                cloth: None,
                layer: 0,
            },
        ],
        ..Scene::default()
    }
}

/// What is done: attach, detach, pin, wind, and a hand that pulls, moves and lets go.
fn inputs() -> Vec<Input> {
    let corner = |vertex| MeshVertex {
        object: SceneObject::id(1),
        vertex,
    };
    let attach = ObjectAttachment {
        ends: [
            AttachmentEnd::Vertex(corner(48)),
            AttachmentEnd::Point(Vec3::new(0.2, 0.1, 0.2)),
        ],
        stiffness: 20.0,
        merge_within: None,
    };
    let wind = Air {
        density: 1.2,
        wind: Vec3::new(4.0, 0.0, 2.0),
        ..Air::default()
    };
    let spot = Spot::Triangle {
        object: SceneObject::id(0),
        triangle: 70,
        weights: [0.2, 0.5, 0.3],
    };
    let pull = |y| Action::Pull {
        spot,
        to: Vec3::new(0.2, y, 0.15),
        force: 2.0,
    };
    let mut first = AttachmentIdOf::default();
    let all = [
        (20, Action::Edit(WorldEdit::Attach(attach))),
        (35, pull(0.05)),
        (50, pull(0.1)),
        (77, Action::Edit(WorldEdit::Detach(first.next()))),
        (
            100,
            Action::Edit(WorldEdit::Pin(SceneObject::id(0), vec![0, 6, 3])),
        ),
        (120, Action::LetGo(spot)),
        (131, Action::Set(Parameter::Air(wind))),
    ];
    let inputs = all.into_iter().map(|(step, action)| Input { step, action });
    inputs.collect()
}

/// Numbers of attachments in the order in which a world gives them.
#[derive(Default)]
struct AttachmentIdOf(u32);

impl AttachmentIdOf {
    fn next(&mut self) -> AttachmentId {
        self.0 += 1;
        serde_json::from_value(serde_json::json!(self.0 - 1)).unwrap()
    }
}

/// All that a run is seen to be, to the last bit.
fn told(run: &SceneRun) -> String {
    let state = serde_json::to_string(&run.state).unwrap();
    format!("{} {:?}\n{state}", run.steps(), run.cloth_tally())
}

/// A run with its inputs to its end: the state at each step, and checkpoints where a recording keeps them.
fn recorded(inputs: &[Input], threads: usize) -> (Vec<String>, Vec<String>) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    pool.build().unwrap().install(|| {
        let mut run = SceneRun::new(&scene(0.2), toile_reference::build).unwrap();
        let (mut states, mut checkpoints) = (vec![told(&run)], Vec::new());
        loop {
            if run.is_landmark() {
                let saved = write_checkpoint(&run.checkpoint().unwrap()).unwrap();
                checkpoints.push(saved);
            }
            if run.finished() {
                return (states, checkpoints);
            }
            run.advance_by(inputs).unwrap();
            states.push(told(&run));
        }
    })
}

fn read(text: &str) -> SceneCheckpoint {
    read_checkpoint(text).unwrap()
}

#[test]
fn a_run_is_done_again_from_its_inputs_and_from_any_frame() {
    let inputs = inputs();
    let (states, checkpoints) = recorded(&inputs, 1);
    assert_eq!(states.len(), 181);
    let (again, _) = recorded(&inputs, 2);
    assert!(again == states, "two threads differ");
    // Edits and actions make a difference.
    let (still, _) = recorded(&[], 2);
    assert!(still[20] == states[20] && still[21] != states[21]);

    let mut seed = 1_u64;
    for _ in 0..10 {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        let frame = (seed >> 33) as usize % 181;
        let mut kept = checkpoints.iter().map(|text| read(text));
        let checkpoint = kept.rfind(|saved| saved.steps() <= frame).unwrap();
        assert!(frame - checkpoint.steps() < 60);
        let mut run = SceneRun::resume(&scene(0.2), checkpoint, toile_reference::build).unwrap();
        while run.steps() < frame {
            run.advance_by(&inputs).unwrap();
        }
        assert!(told(&run) == states[frame], "frame {frame} differs");
    }
}

#[test]
fn a_checkpoint_is_taken_after_every_edit() {
    let mut run = SceneRun::new(&scene(0.2), toile_reference::build).unwrap();
    let given = inputs();
    for input in &given {
        while (run.steps() as u64) < input.step {
            run.advance().unwrap();
        }
        run.give(input.action.clone()).unwrap();
        if run.steps_to_checkpoint() > 0 {
            // A hand changes no structure.
            assert!(matches!(
                input.action,
                Action::Pull { .. } | Action::LetGo(_)
            ));
            continue;
        }
        let text = write_checkpoint(&run.checkpoint().unwrap()).unwrap();
        let mut resumed =
            SceneRun::resume(&scene(0.2), read(&text), toile_reference::build).unwrap();
        assert_eq!(resumed.world(), run.world());
        for _ in 0..3 {
            resumed.advance().unwrap();
            run.advance().unwrap();
        }
        assert!(told(&resumed) == told(&run), "after step {}", input.step);
    }
    let logged: Vec<Action> = run.inputs().iter().map(|i| i.action.clone()).collect();
    let done: Vec<Action> = given.into_iter().map(|input| input.action).collect();
    assert_eq!(logged, done);
    let line = serde_json::to_string(run.inputs()).unwrap();
    let read: Vec<Input> = serde_json::from_str(&line).unwrap();
    assert_eq!(read, run.inputs());
}

#[test]
fn checkpoints_of_another_track_and_actions_that_do_not_fit_are_refused() {
    let mut run = SceneRun::new(&scene(0.2), toile_reference::build).unwrap();
    let saved = write_checkpoint(&run.checkpoint().unwrap()).unwrap();
    let said = SceneRun::resume(&scene(0.3), read(&saved), toile_reference::build)
        .err()
        .unwrap();
    assert!(said.to_string().contains("another scene"), "{said}");

    let spot = |object: usize, triangle, weights| Spot::Triangle {
        object: SceneObject::id(object),
        triangle,
        weights,
    };
    let third = [1.0 / 3.0; 3];
    let to = Vec3::zeros();
    for (spot, to, force, words) in [
        (spot(2, 0, third), to, 1.0, "no cloth"),
        (spot(7, 0, third), to, 1.0, "not there"),
        (spot(0, 72, third), to, 1.0, "no triangle 72"),
        (spot(0, 0, [0.5; 3]), to, 1.0, "no weights"),
        (spot(0, 0, [f64::NAN; 3]), to, 1.0, "no weights"),
        (spot(0, 0, third), Vec3::x() * 1e3, 1.0, "within 100 m"),
        (spot(0, 0, third), Vec3::x() * f64::NAN, 1.0, "within 100 m"),
        (spot(0, 0, third), to, -1.0, "0 N or more"),
    ] {
        let said = run.give(Action::Pull { spot, to, force }).err().unwrap();
        assert!(said.to_string().contains(words), "{said}");
    }
    assert!(run.inputs().is_empty());

    // Rest shapes that the structure was not made for cannot be saved.
    let rest = run.world().cloths().next().unwrap().1.rest.clone();
    let wider: Vec<[Vec2; 3]> = rest.iter().map(|t| t.map(|p| 1.01 * p)).collect();
    run.edit(WorldEdit::Reshape(SceneObject::id(0), wider))
        .unwrap();
    let said = run.checkpoint().err().unwrap().to_string();
    assert!(said.contains("rest shapes"), "{said}");
}

#[test]
fn hands_pull_at_their_spot_and_let_go_of_what_is_removed() {
    let mut run = SceneRun::new(
        &Scene {
            gravity: Vec3::zeros(),
            objects: vec![
                sheet("a", Vec3::zeros(), vec![]),
                sheet("b", Vec3::x(), vec![]),
            ],
            ..scene(0.0)
        },
        toile_reference::build,
    )
    .unwrap();
    let weights = [0.25, 0.25, 0.5];
    let spot = Spot::Triangle {
        object: SceneObject::id(1),
        triangle: 30,
        weights,
    };
    let place = |run: &SceneRun| -> Vec3 {
        let mesh = run.mesh_of(spot.object()).unwrap();
        let corners = mesh.triangles[30].map(|v| mesh.positions[v as usize]);
        corners.iter().zip(weights).map(|(p, w)| p * w).sum()
    };
    let to = place(&run) + Vec3::new(0.0, 0.05, 0.0);
    let pull = Action::Pull {
        spot,
        to,
        force: 5.0,
    };
    run.give(pull).unwrap();
    for _ in 0..90 {
        run.advance().unwrap();
    }
    assert!((place(&run) - to).norm() < 0.03, "{:?}", place(&run) - to);
    assert_eq!(run.system.control.attachments.all().len(), 3);
    run.edit(WorldEdit::Remove(spot.object())).unwrap();
    assert!(run.system.control.attachments.all().is_empty());
    run.advance().unwrap();
}
