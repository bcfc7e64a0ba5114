//! Scenes in motion: known laws, and inputs where methods fail.

use crate::support::sheets::{object, sheet};
use toile_drape::{
    Cloth, DrapeError, Material, MethodKind, MethodSettings, ObjectKind, Scene, SceneElastic,
    SceneEnd, SceneObject, SceneRun,
};
use toile_geometry::{TriangleMesh, Vec3};

/// A square sheet of n x n cells.
fn square(n: usize, size: f64, place: impl Fn(f64, f64) -> Vec3) -> TriangleMesh {
    sheet([n, n], [size, size], place)
}

fn cloth_object(mesh: TriangleMesh, pins: Vec<u32>) -> SceneObject {
    object("cloth", mesh, pins)
}

fn finish(mut run: SceneRun) -> SceneRun {
    while !run.finished() {
        run.advance().expect("a sound scene");
    }
    run
}

#[test]
fn a_free_sheet_falls_as_implicit_euler_falls() {
    let scene = Scene {
        objects: vec![cloth_object(
            square(6, 0.3, |u, v| Vec3::new(u, 1.0, v)),
            vec![],
        )],
        duration: 0.5,
        step: 0.01,
        ..Scene::default()
    };
    let run = finish(SceneRun::new(&scene, MethodSettings::build).expect("sound"));
    // Implicit Euler after n steps: fallen g h^2 n (n + 1) / 2.
    let expected = 1.0 - 9.81 * 0.01 * 0.01 * 50.0 * 51.0 / 2.0;
    for p in &run.state.positions {
        // Newton stops at 1e-8 N; h^2 / m of that is 3e-9 m.
        assert!((p.y - expected).abs() < 1e-8, "{} {expected}", p.y);
    }
}

#[test]
fn a_hanging_strip_stretches_by_its_weight() {
    // At height s above the tip the strip carries rho g s = Y l (l^2 - 1) / 2 per width at
    // stretch l (Saint Venant-Kirchhoff): the tip hangs lower by the integral of l - 1.
    let material = Material {
        poisson: 0.0,
        stretch: [50.0, 50.0],
        ..Material::default()
    };
    let mut object = cloth_object(
        square(20, 0.5, |u, v| Vec3::new(u, -v, 0.0)),
        (0..=20).collect(),
    );
    object.kind = ObjectKind::Deformable {
        material: material.clone(),
        pins: (0..=20).collect(),
    };
    let scene = Scene {
        objects: vec![object],
        method: MethodKind::Rest.into(),
        ..Scene::default()
    };
    let mut run = finish(SceneRun::new(&scene, MethodSettings::build).expect("sound"));
    let tip = run.state.positions.last().expect("has vertices").y;
    let pieces = 1000;
    let expected: f64 = (0..pieces)
        .map(|k| {
            let load =
                material.density * 9.81 * 0.5 * (f64::from(k) + 0.5) / f64::from(pieces) / 50.0;
            let mut stretch = 1.0f64;
            for _ in 0..30 {
                let excess = stretch * (stretch * stretch - 1.0) / 2.0 - load;
                stretch -= excess / ((3.0 * stretch * stretch - 1.0) / 2.0);
            }
            (stretch - 1.0) * 0.5 / f64::from(pieces)
        })
        .sum();
    let got = -0.5 - tip;
    assert!((got - expected).abs() < 1e-3 * expected, "{got} {expected}");
    assert!(run.measure().residual < 1e-3);
}

#[test]
fn elastics_merge_what_they_draw_together_and_keep_momentum() {
    let mesh = square(4, 0.2, |u, v| Vec3::new(u, v, 0.0));
    let mut other = cloth_object(square(4, 0.2, |u, v| Vec3::new(u + 0.21, v, 0.0)), vec![]);
    other.name = "other".to_owned();
    let elastics = (0..5u32)
        .map(|j| SceneElastic {
            from: SceneEnd::Vertex {
                object: 0,
                vertex: j * 5 + 4,
            },
            to: SceneEnd::Vertex {
                object: 1,
                vertex: j * 5,
            },
            stiffness: 50.0,
            merge_within: Some(2e-3),
        })
        .collect();
    let scene = Scene {
        gravity: Vec3::zeros(),
        objects: vec![cloth_object(mesh, vec![]), other],
        elastics,
        duration: 1.0,
        air: toile_drape::Air {
            drag: 5.0,
            ..toile_drape::Air::default()
        },
        ..Scene::default()
    };
    let run = finish(SceneRun::new(&scene, MethodSettings::build).expect("sound"));
    assert_eq!(run.state.positions.len(), 45);
    assert_eq!(run.system.mesh(&run.state.positions).component_count(), 1);
    let momentum: Vec3 = run
        .state
        .velocities
        .iter()
        .zip(&run.system.rest.mass)
        .map(|(v, m)| v * *m)
        .sum();
    assert!(momentum.norm() < 1e-6, "{momentum:?}");
    assert_eq!(run.meshes()[1].positions[0], run.meshes()[0].positions[4]);
}

#[test]
fn bad_scenes_are_refused_with_place_and_remedy() {
    let good = || Scene {
        objects: vec![cloth_object(
            square(2, 0.1, |u, v| Vec3::new(u, v, 0.0)),
            vec![],
        )],
        ..Scene::default()
    };
    let message = |scene: Scene| {
        SceneRun::new(&scene, MethodSettings::build)
            .err()
            .expect("must be refused")
            .to_string()
    };
    assert!(
        message(Scene {
            step: 0.0,
            ..good()
        })
        .contains("step")
    );
    assert!(
        message(Scene {
            step: f64::NAN,
            ..good()
        })
        .contains("step")
    );
    assert!(
        message(Scene {
            duration: 1e9,
            ..good()
        })
        .contains("1e7 steps")
    );
    assert!(message(Scene::default()).contains("deformable"));
    let mut pinned = good();
    pinned.objects[0].kind = ObjectKind::Deformable {
        material: Material::default(),
        pins: vec![99],
    };
    assert!(message(pinned).contains("no vertex 99"));
    let mut heavy = good();
    heavy.objects[0].kind = ObjectKind::Deformable {
        material: Material {
            density: -1.0,
            ..Material::default()
        },
        pins: vec![],
    };
    assert!(message(heavy).contains("density"));
    let mut broken = good();
    broken.objects[0].mesh.positions[1].x = f64::NAN;
    assert!(matches!(
        SceneRun::new(&broken, MethodSettings::build),
        Err(DrapeError::Mesh { .. })
    ));
    let mut empty = good();
    empty.objects[0].mesh.positions[1] = empty.objects[0].mesh.positions[0];
    assert!(matches!(
        SceneRun::new(&empty, MethodSettings::build),
        Err(DrapeError::EmptyTriangle { .. })
    ));
}

#[test]
fn huge_steps_and_stiff_crushed_cloth_end_finite_or_say_so() {
    let crushed = square(8, 0.3, |u, v| Vec3::new(u, v, 0.0));
    let flat = crushed.clone();
    for (stretch, step) in [(600.0, 1.0), (1e8, 1.0 / 60.0), (1e8, 10.0)] {
        let material = Material {
            stretch: [stretch; 2],
            shear: stretch * 0.1,
            ..Material::default()
        };
        let mut cloth = Cloth::from_mesh("cloth", &flat, material.clone()).expect("sound");
        for (k, p) in cloth.positions.iter_mut().enumerate() {
            *p = Vec3::new(p.x * 0.3, p.y * 0.5, 1e-3 * ((k * 7 % 11) as f64));
        }
        let mut object = cloth_object(
            TriangleMesh {
                positions: cloth.positions.clone(),
                ..crushed.clone()
            },
            vec![0, 8],
        );
        object.kind = ObjectKind::Deformable {
            material,
            pins: vec![0, 8],
        };
        object.cloth = Some(cloth);
        let scene = Scene {
            objects: vec![object],
            duration: 5.0 * step,
            step,
            ..Scene::default()
        };
        let mut run = SceneRun::new(&scene, MethodSettings::build).expect("sound");
        while !run.finished() {
            match run.advance() {
                Ok(()) => assert_eq!(run.state.first_not_finite(), None, "{stretch} {step}"),
                Err(DrapeError::NoProgress { .. } | DrapeError::NotFinite { .. }) => {
                    assert_eq!(
                        run.state.first_not_finite(),
                        None,
                        "the last good state is kept"
                    );
                    break;
                }
                Err(other) => panic!("{other}"),
            }
        }
    }
}
