//! The distance cloth keeps from surfaces and from cloth: as far as the scene says and the cloth is thick.

use crate::sheets::{object, sheet};
use crate::solids;
use toile_drape::{
    ContactSettings, Material, MethodKind, ObjectKind, Scene, SceneObject, SceneRun,
};
use toile_geometry::Vec3;

/// A cloth that lies at a height over a plate whose top is at 0, for as long as it takes to come to rest.
fn lying(heights: &[f64], thickness: f64, contact: ContactSettings) -> Scene {
    let plate = solids::block(Vec3::new(-0.3, -0.1, -0.3), Vec3::new(0.4, 0.0, 0.4));
    let mut objects = vec![SceneObject {
        name: "plate".to_owned(),
        kind: ObjectKind::Static,
        mesh: plate,
        cloth: None,
        layer: 0,
    }];
    for (k, &height) in heights.iter().enumerate() {
        let mesh = sheet([2, 2], [0.2, 0.2], |x, z| Vec3::new(x, height, z));
        let mut cloth = object(&format!("cloth {k}"), mesh, vec![]);
        cloth.kind = ObjectKind::Deformable {
            material: Material {
                thickness,
                ..Material::default()
            },
            pins: vec![],
        };
        objects.push(cloth);
    }
    Scene {
        objects,
        contact,
        duration: 0.5,
        air: toile_drape::Air {
            drag: 10.0,
            ..toile_drape::Air::default()
        },
        ..Scene::default()
    }
}

/// Least and largest height of the `which`th object when it lies.
fn heights(mut scene: Scene, kind: MethodKind, which: usize) -> [f64; 2] {
    scene.method = kind.into();
    let mut run = SceneRun::new(&scene, toile_reference::build).unwrap();
    while !run.finished() {
        run.advance().unwrap();
    }
    let mesh = &run.meshes()[which];
    let each = || mesh.positions.iter().map(|p| p.y);
    [
        each().fold(f64::INFINITY, f64::min),
        each().fold(f64::NEG_INFINITY, f64::max),
    ]
}

const METHODS: [MethodKind; 4] = [
    MethodKind::Xpbd,
    MethodKind::ImplicitEuler,
    MethodKind::Rest,
    MethodKind::PatchVerlet,
];

#[test]
fn thick_cloth_lies_with_its_middle_at_half_its_thickness() {
    for kind in METHODS {
        for (thickness, expected) in [(0.03, 0.015), (0.002, 0.004)] {
            let scene = lying(&[expected + 0.001], thickness, ContactSettings::default());
            let [low, high] = heights(scene, kind, 1);
            // It sinks in by weight over stiffness, 2 um; the plate's corners are rounded by less.
            assert!(low > expected - 5e-5, "{kind:?} {thickness}: {low}");
            assert!(high < expected + 5e-5, "{kind:?} {thickness}: {high}");
        }
    }
}

#[test]
fn thick_cloths_lie_their_thickness_apart() {
    let contact = ContactSettings {
        cloth_offset: 0.002,
        ..ContactSettings::default()
    };
    for kind in [MethodKind::Xpbd, MethodKind::ImplicitEuler] {
        let scene = lying(&[0.0101, 0.0302], 0.02, contact);
        let [low, high] = heights(scene, kind, 2);
        assert!(low > 0.0298 && high < 0.0303, "{kind:?}: {low} {high}");
    }
}

#[test]
fn a_distance_is_kept_as_far_as_surfaces_are_felt_and_refused_beyond() {
    let offset = |offset| ContactSettings {
        offset,
        ..ContactSettings::default()
    };
    for kind in METHODS {
        let [low, high] = heights(lying(&[0.0205], 0.0, offset(0.02)), kind, 1);
        assert!(low > 0.0199 && high < 0.0201, "{kind:?}: {low} {high}");
    }
    for scene in [
        lying(&[0.1], 0.0, offset(0.04)),
        lying(&[0.1], 0.08, ContactSettings::default()),
    ] {
        let error = SceneRun::new(&scene, toile_reference::build)
            .err()
            .map(|e| e.to_string());
        let error = error.unwrap_or_default();
        assert!(
            error.contains("0.04") && error.contains("at most"),
            "{error}"
        );
    }
}
