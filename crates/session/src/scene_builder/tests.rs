//! Tests of scenes as they are built: materials, bodies, transforms.

use super::*;
use crate::Silent;
use toile_drape::SceneRun;
use toile_fabric::FIGURES;
use toile_interchange::{read_pattern, read_scene, write_pattern};
use toile_pattern::Fabric;

/// The cloth of a poncho in a scene, with more fields of its object.
fn poncho(more: &str) -> Result<SceneObject, SessionError> {
    let pattern = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../patterns/poncho.toile.json"
    );
    let text = format!(
        r#"{{ "objects": [ {{ "name": "poncho", "kind": "deformable", "pattern": "{pattern}" {more} }} ] }}"#
    );
    let (file, _) = read_scene(&text).unwrap();
    let mut builder = Builder::new(Path::new("./scene.json"), &file, Vec::new());
    builder.object(0, &file.objects[0], &mut Silent)
}

#[test]
fn a_scenes_material_and_scale_change_the_cloth_of_a_pattern() {
    let usual = poncho("").unwrap().cloth.unwrap();
    let more =
        r#", "material": { "density": 0.9, "viscosity": 0.1 }, "transform": { "scale": 1.5 }"#;
    let object = poncho(more).unwrap();
    let changed = object.cloth.unwrap();
    // Fields left out stay those of the pattern.
    let expected = Material {
        density: 0.9,
        viscosity: 0.1,
        ..usual.materials[0].clone()
    };
    assert_eq!(changed.materials, std::slice::from_ref(&expected));
    assert!(matches!(object.kind, ObjectKind::Deformable { material, .. } if material == expected));
    for (a, b) in usual
        .rest
        .iter()
        .flatten()
        .zip(changed.rest.iter().flatten())
    {
        assert!((b - 1.5 * a).norm() < 1e-12);
    }
    assert!(usual.rest[0][1].norm() > 0.0);
}

#[test]
fn a_scenes_body_takes_a_mannequin_file_and_its_material_a_fabric_file() {
    let folder = tempfile::tempdir().unwrap();
    let to = folder.path().join("me.json");
    let source = crate::BodySource::Wearer(&Project::default());
    crate::make_body(source, None, &to).unwrap();
    let fabric = r#"{ "toile": 1, "kind": "fabric", "density": 0.31 }"#;
    std::fs::write(folder.path().join("ponte.json"), fabric).unwrap();
    let mesh = "v 0 1 0\nv 0.1 1 0\nv 0 1 0.1\nf 1 2 3\n";
    std::fs::write(folder.path().join("mesh.obj"), mesh).unwrap();
    let text = r#"{ "objects": [ { "name": "me", "kind": "static", "body": "me.json" },
        { "name": "a", "kind": "deformable", "mesh": "mesh.obj",
          "material": { "fabric": "ponte.json", "thickness": 0.001 } } ] }"#;
    let (file, _) = read_scene(text).unwrap();
    let path = folder.path().join("scene.json");
    let mut builder = Builder::new(&path, &file, Vec::new());
    let scene = builder.scene(&mut Silent).unwrap();
    assert!(scene.objects[0].mesh.positions.len() > 1000);
    let ObjectKind::Deformable { material, .. } = &scene.objects[1].kind else {
        panic!("it is cloth");
    };
    assert_eq!((material.density, material.thickness), (0.31, 0.001));
}

#[test]
fn all_figures_of_a_fabric_file_go_through_a_pattern_into_a_scene() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let figures = r#"{ "toile": 1, "kind": "fabric", "name": "scuba", "density": 0.31,
        "thickness": 0.0011, "stretch": [310.7, 250.3], "shear": 41.3, "poisson": 0.27,
        "hardening": [12.5, 3.25], "strain_limit": [0.07, null],
        "compression": "tension-field", "bend": [1.7e-5, 1.3e-5, 1.1e-5],
        "bend_poisson": 0.125, "viscosity": 0.021, "bend_viscosity": 3.1e-7,
        "stiffness_damping": 0.0013, "kept": [0.05, 0.2], "relaxation_time": 4.5,
        "friction": 0.37, "restitution": 0.3 }"#;
    std::fs::write(path("scuba.json"), figures).unwrap();
    let (fabric, _) = crate::fabrics::fabric_of_file(&path("scuba.json")).unwrap();
    let material = fabric.material.clone();
    // No figure is left at the default: one that is lost on its way shows.
    for figure in &FIGURES {
        assert!(!figure.is_default(&material), "{}", figure.name);
    }

    let text = include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../patterns/poncho.toile.json"
    ));
    let (mut pattern, _) = read_pattern(text).unwrap();
    let id = pattern.fabrics[0].id;
    pattern.fabrics[0] = Arc::new(Fabric {
        id,
        ..(*fabric).clone()
    });
    let written = write_pattern(&pattern).unwrap();
    let (read, notes) = read_pattern(&written).unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    assert_eq!(read.fabrics[0].material, material);
    assert_eq!(write_pattern(&read).unwrap(), written);
    let journal = serde_json::to_string(&*read.fabrics[0]).unwrap();
    let replayed: Fabric = serde_json::from_str(&journal).unwrap();
    assert_eq!(replayed, *read.fabrics[0]);

    std::fs::write(path("poncho.toile.json"), written).unwrap();
    let scene = r#"{ "objects": [ { "name": "poncho", "kind": "deformable", "pattern": "poncho.toile.json" } ] }"#;
    let (file, _) = read_scene(scene).unwrap();
    let scene_path = path("scene.json");
    let mut builder = Builder::new(&scene_path, &file, Vec::new());
    let object = builder.object(0, &file.objects[0], &mut Silent).unwrap();
    let worn = object.cloth.unwrap();
    assert_eq!(worn.materials, [material]);
    // A method in time refuses what it cannot take, as for any scene.
    let error = SceneRun::new(&builder.scene(&mut Silent).unwrap(), toile_reference::build).err();
    let error = error.expect("no method knows all of it").to_string();
    assert!(error.contains("no method knows all"), "{error}");
}

#[test]
fn the_transform_of_a_figure_moves_its_clip_too() {
    let scene = |more: &str| {
        let text = format!(
            r#"{{ "duration": 0.1, "objects": [ {{ "name": "w", "kind": "animated", "body": "woman",
                "motion": {{ "clip": "walk", "strides": 1 }} {more} }} ] }}"#
        );
        let (file, _) = read_scene(&text).unwrap();
        let mut builder = Builder::new(Path::new("./scene.json"), &file, Vec::new());
        let object = builder.object(0, &file.objects[0], &mut Silent).unwrap();
        let ObjectKind::Animated {
            track: Some(track), ..
        } = object.kind
        else {
            panic!("it moves");
        };
        (file.objects[0].transform.clone(), track)
    };
    let (_, plain) = scene("");
    let (transform, moved) = scene(
        r#", "transform": { "translation": [5, 0, 1], "rotation": [0, 1, 0], "scale": 1.1 }"#,
    );
    assert_ne!(plain.digest(), moved.digest());
    for time in [0.0, 0.1] {
        let [plain, moved] = [&plain, &moved].map(|track| track.positions(time));
        for (p, q) in plain.iter().zip(&moved) {
            assert!((transform.apply(*p) - q).norm() < 1e-12);
        }
    }
}
