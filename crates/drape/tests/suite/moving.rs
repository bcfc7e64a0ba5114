//! Bodies that move and vertices that are led.

use crate::support::sheets;
use crate::support::solids;
use toile_drape::{
    Material, MethodKind, MethodSettings, Motion, MotionKey, ObjectKind, Scene, SceneElastic,
    SceneEnd, SceneGrip, SceneObject, SceneRun,
};
use toile_geometry::Vec3;

fn key(time: f64, translation: Vec3) -> MotionKey {
    MotionKey {
        time,
        translation,
        rotation: Vec3::zeros(),
    }
}

fn object(name: &str, kind: ObjectKind, mesh: toile_geometry::TriangleMesh) -> SceneObject {
    SceneObject {
        name: name.to_owned(),
        kind,
        mesh,
        cloth: None,
        layer: 0,
    }
}

fn deformable() -> ObjectKind {
    ObjectKind::Deformable {
        material: Material::default(),
        pins: vec![],
    }
}

/// A small sheet on a plate that starts off at once.
fn carried(way: Vec3, friction: f64) -> Scene {
    let plate = solids::block(Vec3::new(-0.3, -0.1, -0.3), Vec3::new(0.3, 0.0, 0.3));
    let sheet = sheets::sheet([6, 6], [0.1; 2], |x, z| Vec3::new(x, 0.004, z));
    let motion = Motion {
        pivot: Vec3::zeros(),
        keys: vec![key(0.2, Vec3::zeros()), key(0.7, way)],
    };
    let mut kind = deformable();
    if let ObjectKind::Deformable { material, .. } = &mut kind {
        material.friction = friction;
    }
    Scene {
        duration: 0.9,
        method: MethodKind::Xpbd.into(),
        objects: vec![
            object("sheet", kind, sheet),
            object("plate", ObjectKind::moving(motion), plate),
        ],
        ..Scene::default()
    }
}

fn middle_after(scene: Scene) -> Vec3 {
    let mut run = SceneRun::new(&scene, MethodSettings::build).unwrap();
    while !run.finished() {
        run.advance().unwrap();
    }
    assert_eq!(run.measure().body_intersections, 0);
    let count = run.state.positions.len() as f64;
    run.state.positions.iter().sum::<Vec3>() / count
}

#[test]
fn a_plate_takes_its_cloth_along_by_friction_and_lifts_it() {
    let start = Vec3::new(0.05, 0.004, 0.05);
    // Off at once to 0.3 m/s: at 0.4 g the sheet slides v^2 / 2a at the start, and as far at the end.
    let moved = middle_after(carried(Vec3::new(0.15, 0.0, 0.0), 0.4)) - start;
    assert!((moved.x - 0.15).abs() < 2e-3, "{moved}");
    // Without friction it stays where it is.
    let moved = middle_after(carried(Vec3::new(0.15, 0.0, 0.0), 0.0)) - start;
    assert!(moved.x.abs() < 1e-4, "{moved}");
    let moved = middle_after(carried(Vec3::new(0.0, 0.1, 0.0), 0.4)) - start;
    assert!((moved.y - 0.1).abs() < 1e-3, "{moved}");
}

#[test]
fn led_vertices_are_where_their_motion_has_them() {
    let sheet = sheets::sheet([6, 6], [0.1; 2], |x, z| Vec3::new(x, 0.0, z));
    let motion = Motion {
        pivot: Vec3::new(0.0, 0.0, 0.05),
        keys: vec![
            key(0.0, Vec3::zeros()),
            MotionKey {
                rotation: Vec3::new(7.0, 0.0, 0.0),
                ..key(0.5, Vec3::new(-0.05, 0.1, 0.0))
            },
        ],
    };
    let vertices: Vec<u32> = (0..7).map(|j| 7 * j).collect();
    let scene = Scene {
        duration: 0.4,
        method: MethodKind::Xpbd.into(),
        objects: vec![object("sheet", deformable(), sheet.clone())],
        grips: vec![SceneGrip {
            object: 0,
            vertices: vertices.clone(),
            motion: motion.clone(),
        }],
        ..Scene::default()
    };
    let mut run = SceneRun::new(&scene, MethodSettings::build).unwrap();
    while !run.finished() {
        run.advance().unwrap();
        let pose = motion.pose(run.state.time);
        for &v in &vertices {
            let expected = pose.apply(sheet.positions[v as usize]);
            let off = (run.state.positions[v as usize] - expected).norm();
            assert!(off < 1e-6, "{off}");
        }
    }
}

#[test]
fn cloth_tied_to_a_moving_solid_goes_with_it() {
    // The plate lifts the sheet's corner by 0.2 m within 0.4 s and holds it there.
    let mut scene = carried(Vec3::new(0.0, 0.2, 0.0), 0.4);
    scene.duration = 0.8;
    let corner = scene.objects[1].mesh.positions[0];
    let nearest = |a: &&Vec3, b: &&Vec3| {
        let from = |p: &Vec3| (p - corner).norm();
        from(a).total_cmp(&from(b))
    };
    let start = *scene.objects[0]
        .mesh
        .positions
        .iter()
        .min_by(nearest)
        .unwrap();
    let index = scene.objects[0]
        .mesh
        .positions
        .iter()
        .position(|p| *p == start);
    let vertex = index.unwrap() as u32;
    scene.contact.offset = 0.0;
    scene.elastics.push(SceneElastic {
        from: SceneEnd::Vertex { object: 0, vertex },
        to: SceneEnd::Vertex {
            object: 1,
            vertex: 0,
        },
        stiffness: 5000.0,
        merge_within: None,
    });
    let mut run = SceneRun::new(&scene, MethodSettings::build).unwrap();
    while !run.finished() {
        run.advance().unwrap();
    }
    let ends = [
        run.meshes()[0].positions[vertex as usize],
        run.meshes()[1].positions[0],
    ];
    assert!(
        (ends[1] - corner).norm() > 0.19,
        "the solid stands still: {ends:?}"
    );
    assert!((ends[0] - ends[1]).norm() < 2e-3, "{ends:?}");
    // A method that knows no moving solids refuses it by name.
    scene.method = MethodKind::ImplicitEuler.into();
    let said = SceneRun::new(&scene, MethodSettings::build)
        .err()
        .unwrap()
        .to_string();
    assert!(said.contains("moving objects"), "{said}");
}

#[test]
fn motions_that_cannot_be_followed_are_refused() {
    let refused = |change: &dyn Fn(&mut Scene)| {
        let mut scene = carried(Vec3::zeros(), 0.4);
        change(&mut scene);
        SceneRun::new(&scene, MethodSettings::build)
            .err()
            .unwrap()
            .to_string()
    };
    let said = refused(&|scene| scene.method = MethodKind::ImplicitEuler.into());
    assert!(said.contains("xpbd") && said.contains("plate"), "{said}");
    let said = refused(&|scene| {
        scene.objects[1].kind = ObjectKind::moving(Motion::default());
    });
    assert!(said.contains("no key"), "{said}");
    for (object, vertices, word) in [
        (1, vec![0], "not deformable"),
        (0, vec![999], "no vertex 999"),
        (7, vec![0], "no object 7"),
        (0, vec![1, 2, 1], "vertex 1 of"),
    ] {
        let said = refused(&|scene| {
            scene.grips.push(SceneGrip {
                object,
                vertices: vertices.clone(),
                motion: Motion {
                    pivot: Vec3::zeros(),
                    keys: vec![key(0.0, Vec3::zeros())],
                },
            });
        });
        assert!(said.contains(word), "{said}");
    }
}
