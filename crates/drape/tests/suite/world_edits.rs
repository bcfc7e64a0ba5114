//! Edits of a world in motion one by one: policies, changes of kind, seams that are opened, and edits that are refused.

use crate::support::sheets::{object, sheet};
use crate::support::solids;
use toile_drape::{
    AttachmentEnd, Cloth, ContactSettings, Kind, Layers, MeshVertex, MethodKind, MethodSettings,
    Motion, MotionKey, Object, ObjectAttachment, ObjectKind, PairPolicy, Scene, SceneObject,
    SceneRun, WorldEdit,
};
use toile_geometry::{Vec2, Vec3};

fn standing(name: &str, mesh: toile_geometry::TriangleMesh) -> SceneObject {
    SceneObject {
        kind: ObjectKind::Static,
        ..object(name, mesh, vec![])
    }
}

#[test]
fn objects_that_ignore_each_other_pass_through_each_other_until_they_are_told_to_meet() {
    // A sheet held by its border, one that falls on it, and a block below.
    let border = (0..25)
        .filter(|v| v % 5 % 4 == 0 || v / 5 % 4 == 0)
        .collect();
    let level = |height| sheet([4, 4], [0.1; 2], move |u, v| Vec3::new(u, height, v));
    let low = Vec3::new(-0.1, -0.2, -0.1);
    let scene = Scene {
        objects: vec![
            object("held", level(0.1), border),
            object("falling", level(0.12), vec![]),
            standing("block", solids::block(low, Vec3::new(0.2, 0.0, 0.2))),
        ],
        contact: ContactSettings {
            cloth_offset: 2e-3,
            ..ContactSettings::default()
        },
        duration: 9.0,
        ..Scene::default()
    };
    let [held, falling, block] = [0, 1, 2].map(SceneObject::id);
    for kind in [MethodKind::Xpbd, MethodKind::ImplicitEuler] {
        let lowest = |run: &SceneRun| {
            let places = run.mesh_of(falling).unwrap().positions;
            places.iter().map(|p| p.y).fold(f64::INFINITY, f64::min)
        };
        let mut run = SceneRun::new(
            &Scene {
                method: kind.into(),
                ..scene.clone()
            },
            MethodSettings::build,
        )
        .unwrap();
        run.edit(WorldEdit::SetPolicy([falling, held], PairPolicy::Ignore))
            .unwrap();
        assert_eq!(run.world().policy([held, falling]), PairPolicy::Ignore);
        let steps = |run: &mut SceneRun, count| {
            for _ in 0..count {
                run.advance().unwrap();
            }
        };
        steps(&mut run, 48);
        let height = lowest(&run);
        assert!(
            (0.002..0.02).contains(&height),
            "{kind:?}: the block did not stop it: {height}"
        );
        run.edit(WorldEdit::SetPolicy([block, falling], PairPolicy::Ignore))
            .unwrap();
        steps(&mut run, 48);
        let height = lowest(&run);
        assert!(
            height < -0.05,
            "{kind:?}: the block still holds it: {height}"
        );
        let error = run.edit(WorldEdit::Remove(held)).err();
        assert!(error.is_none(), "{error:?}");
        assert!(
            run.edit(WorldEdit::SetPolicy([held, falling], PairPolicy::Meet))
                .is_err()
        );
    }
    // Without a policy the held sheet catches the other one.
    let mut run = SceneRun::new(&scene, MethodSettings::build).unwrap();
    for _ in 0..48 {
        run.advance().unwrap();
    }
    let places = run.mesh_of(falling).unwrap().positions;
    assert!(places.iter().all(|p| p.y > 0.05), "it fell through");
}

/// Moves by 0.3 m within the first second.
fn sideways() -> Motion {
    let key = |time, x| MotionKey {
        time,
        translation: Vec3::x() * x,
        rotation: Vec3::zeros(),
    };
    Motion {
        pivot: Vec3::zeros(),
        keys: vec![key(0.0, 0.0), key(1.0, 0.3)],
    }
}

/// One hung sheet, and a block that moves beside it, run for half a second by `xpbd`.
fn beside_a_moving_block() -> SceneRun {
    let block = solids::block(Vec3::new(0.5, 0.0, -0.1), Vec3::new(0.6, 0.1, 0.1));
    let motion = sideways();
    let moving = SceneObject {
        kind: ObjectKind::moving(motion),
        ..object("block", block, vec![])
    };
    let mesh = sheet([4, 4], [0.1; 2], |u, v| Vec3::new(u, 0.3 - v, 0.0));
    let scene = Scene {
        objects: vec![object("hung", mesh, vec![0, 4]), moving],
        duration: 9.0,
        step: 1.0 / 60.0,
        method: MethodKind::Xpbd.into(),
        ..Scene::default()
    };
    let mut run = SceneRun::new(&scene, MethodSettings::build).unwrap();
    for _ in 0..30 {
        run.advance().unwrap();
    }
    run
}

#[test]
fn an_object_stays_where_it_is_when_its_kind_changes_and_so_does_what_is_attached_to_it() {
    let mut run = beside_a_moving_block();
    let [hung, block] = [0, 1].map(SceneObject::id);
    let start = run.world().object(block).unwrap().mesh.positions[0];
    let attachment = ObjectAttachment {
        ends: [
            AttachmentEnd::Vertex(MeshVertex {
                object: hung,
                vertex: 24,
            }),
            AttachmentEnd::Frame {
                object: block,
                point: start,
            },
        ],
        stiffness: 1.0,
        merge_within: None,
    };
    run.edit(WorldEdit::Attach(attachment)).unwrap();
    let lies = |run: &SceneRun| run.mesh_of(block).unwrap().positions;
    let near = |a: &[Vec3], b: &[Vec3]| {
        let each = a.iter().zip(b).map(|(a, b)| (a - b).norm());
        each.fold(0.0, f64::max)
    };
    let before = lies(&run);
    assert!((before[0] - start).norm() > 0.1, "the block had not moved");
    let ends_at = |run: &SceneRun| match run.system.control.frames.first() {
        Some(frame) => frame.target(run.state.time),
        None => run.system.control.attachments.all()[0].place,
    };
    assert!((ends_at(&run) - before[0]).norm() < 1e-12);
    for kind in [Kind::Static, Kind::Animated, Kind::Static] {
        run.edit(WorldEdit::ChangeKind(block, kind)).unwrap();
        assert!(near(&lies(&run), &before) < 1e-12, "{kind:?}: it jumped");
        assert!((ends_at(&run) - before[0]).norm() < 1e-12, "{kind:?}");
    }
    // Cloth has no frame; the sheet stays where it is as a solid and as cloth again.
    let said = run
        .edit(WorldEdit::ChangeKind(block, Kind::Deformable))
        .err();
    assert!(said.unwrap().to_string().contains("no frame"));
    let other = Object::deformable(
        "other",
        run.world()
            .object(hung)
            .unwrap()
            .cloth
            .as_deref()
            .unwrap()
            .clone(),
    );
    run.edit(WorldEdit::Add(Box::new(other))).unwrap();
    let places = run.mesh_of(hung).unwrap().positions;
    run.edit(WorldEdit::ChangeKind(hung, Kind::Static)).unwrap();
    run.advance().unwrap();
    assert_eq!(run.mesh_of(hung).unwrap().positions, places);
    run.edit(WorldEdit::ChangeKind(hung, Kind::Deformable))
        .unwrap();
    assert_eq!(run.mesh_of(hung).unwrap().positions, places);
    run.advance().unwrap();
    assert_eq!(
        run.mesh_of(hung).unwrap().positions[4],
        places[4],
        "a pin moved"
    );
}

#[test]
fn edits_that_do_not_fit_are_refused_by_name_and_change_nothing() {
    let mut run = beside_a_moving_block();
    let [hung, block] = [0, 1].map(SceneObject::id);
    let cloth = run
        .world()
        .object(hung)
        .unwrap()
        .cloth
        .as_deref()
        .unwrap()
        .clone();
    let with = |change: &dyn Fn(&mut Cloth)| {
        let mut other = cloth.clone();
        change(&mut other);
        Box::new(Object::deformable("other", other))
    };
    let vertex = |object, vertex| MeshVertex { object, vertex };
    let layers = Object {
        layers: Layers::Each(vec![0; 3]),
        ..*with(&|_| {})
    };
    let mut windy = run.world().environment().clone();
    windy.gravity.x = f64::NAN;
    let mut far = run.world().environment().clone();
    far.contact.offset = 0.5;
    let rest = vec![[Vec2::repeat(f64::NAN); 3]; cloth.triangles.len()];
    let cases: Vec<(WorldEdit, &str)> = vec![
        (WorldEdit::Add(with(&|c| c.rest.truncate(3))), "rest shapes"),
        (
            WorldEdit::Add(with(&|c| c.material.fill(9))),
            "no material 9",
        ),
        (
            WorldEdit::Add(with(&|c| c.panel.fill(u32::MAX))),
            "out of range",
        ),
        (
            WorldEdit::Add(with(&|c| c.positions[3].x = f64::NAN)),
            "other",
        ),
        (
            WorldEdit::Add(with(&|c| c.materials[0].thickness = 0.4)),
            "other",
        ),
        (WorldEdit::Add(Box::new(layers)), "3 layers"),
        (
            WorldEdit::Merge(vec![[vertex(hung, 3), vertex(block, 0)]]),
            "no cloth",
        ),
        (
            WorldEdit::Merge(vec![[vertex(hung, 3), vertex(hung, 99)]]),
            "no vertex 99",
        ),
        (
            WorldEdit::Merge(vec![[vertex(hung, 0), vertex(hung, 4)]]),
            "held apart",
        ),
        (
            WorldEdit::Open(vec![[vertex(hung, 7), vertex(hung, 8)]]),
            "not merged",
        ),
        (WorldEdit::Pin(hung, vec![25]), "no vertex 25"),
        (WorldEdit::Reshape(block, vec![]), "rest shapes"),
        (WorldEdit::Reshape(hung, rest), "triangle"),
        (WorldEdit::SetEnvironment(Box::new(windy)), "gravity"),
        (WorldEdit::SetEnvironment(Box::new(far)), "offset"),
        (WorldEdit::SetMotion(block, Motion::default()), "no key"),
        (WorldEdit::Remove(hung), "no deformable object"),
    ];
    for (edit, word) in cases {
        let before = (run.world().clone(), run.state.clone());
        let name = format!("{edit:?}");
        let said = run.edit(edit).err();
        let said = said.unwrap_or_else(|| panic!("taken: {name}")).to_string();
        assert!(said.contains(word), "{word}: {said}");
        assert!(
            *run.world() == before.0 && run.state == before.1,
            "{word}: changed"
        );
    }
}

#[test]
fn vertices_that_are_one_by_way_of_others_are_opened_together_and_stay_apart() {
    let flat = |x: f64| sheet([2, 2], [0.1; 2], move |u, v| Vec3::new(x + u, 0.0, v));
    let vertex = |object: usize, vertex| MeshVertex {
        object: SceneObject::id(object),
        vertex,
    };
    let [a, b, c] = [vertex(0, 2), vertex(1, 0), vertex(2, 0)];
    let end = |v: MeshVertex, k| toile_drape::SceneEnd::Vertex {
        object: k,
        vertex: v.vertex,
    };
    let elastic = |from, to| toile_drape::SceneElastic {
        from,
        to,
        stiffness: 0.0,
        merge_within: Some(0.02),
    };
    let scene = Scene {
        gravity: Vec3::zeros(),
        objects: vec![
            object("a", flat(0.0), vec![]),
            object("b", flat(0.1), vec![]),
            object("c", flat(0.105), vec![]),
        ],
        elastics: vec![
            elastic(end(a, 0), end(b, 1)),
            elastic(end(b, 1), end(c, 2)),
            elastic(end(a, 0), end(c, 2)),
        ],
        duration: 9.0,
        ..Scene::default()
    };
    let mut run = SceneRun::new(&scene, MethodSettings::build).unwrap();
    run.advance().unwrap();
    let whole = 27;
    assert_eq!(run.state.positions.len(), whole - 2);
    let all: Vec<[MeshVertex; 2]> = run.world().merged().collect();
    if all.len() == 3 {
        let said = run.edit(WorldEdit::Open(vec![all[0]])).err().unwrap();
        assert!(said.to_string().contains("by way of others"), "{said}");
    }
    run.edit(WorldEdit::Open(all)).unwrap();
    assert_eq!(run.state.positions.len(), whole);
    run.advance().unwrap();
    assert_eq!(run.state.positions.len(), whole, "they were merged again");
}
