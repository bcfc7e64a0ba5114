//! What a scene may ask for, for every method: it acts, or the scene is refused by name.

use crate::sheets::{object, sheet};
use crate::solids;
use toile_drape::{
    Air, Compression, DrapeError, Feature, Material, MethodKind, Motion, MotionKey, ObjectKind,
    Scene, SceneGrip, SceneObject, SceneRun, World,
};
use toile_geometry::{TriangleMesh, Vec3};

/// A sheet of soft cloth 10 cm wide, held at two corners: even forward Euler lasts for some steps.
fn hung() -> Scene {
    let mesh = sheet([3, 3], [0.1, 0.1], |x, z| Vec3::new(x, 0.0, z));
    let scene = Scene {
        step: 1e-4,
        objects: vec![object("cloth", mesh, vec![0, 3])],
        ..Scene::default()
    };
    of(scene, |material| {
        material.stretch = [20.0; 2];
        material.shear = 2.0;
    })
}

/// The same, pulled and squeezed by a tenth.
fn strained() -> Scene {
    let mut scene = hung();
    let material = Scene::materials_of(&scene.objects[0])[0].clone();
    let cloth = &mut scene.objects[0];
    let made = toile_drape::Cloth::from_mesh("cloth", &cloth.mesh, material).unwrap();
    cloth.cloth = Some(made);
    let moved = |p: &Vec3| Vec3::new(1.1 * p.x, 0.3 * p.z * p.z, 0.95 * p.z);
    let own = cloth.cloth.iter_mut().flat_map(|c| &mut c.positions);
    for place in cloth.mesh.positions.iter_mut().chain(own) {
        *place = moved(place);
    }
    scene
}

/// The same above a plate, nothing holding it.
fn lying(height: f64) -> Scene {
    let mut scene = hung();
    let mesh = sheet([3, 3], [0.1, 0.1], |x, z| Vec3::new(x + 0.2 * z, height, z));
    let ObjectKind::Deformable { pins, .. } = &mut scene.objects[0].kind else {
        panic!("cloth first");
    };
    pins.clear();
    scene.objects[0].mesh = mesh;
    scene.objects.push(plate(ObjectKind::Static));
    scene
}

fn plate(kind: ObjectKind) -> SceneObject {
    SceneObject {
        name: "plate".to_owned(),
        kind,
        mesh: solids::block(Vec3::new(-0.2, -0.1, -0.2), Vec3::new(0.3, 0.0, 0.3)),
        cloth: None,
        layer: 0,
    }
}

/// Two sheets, one a millimetre under the other.
fn two() -> Scene {
    let mut scene = hung();
    let mesh = sheet([3, 3], [0.1, 0.1], |x, z| {
        Vec3::new(x + 0.01, -0.001, z + 0.005)
    });
    scene.objects.push(object("other", mesh, vec![0, 3]));
    scene
}

fn motion(way: Vec3) -> Motion {
    let key = |time, translation| MotionKey {
        time,
        translation,
        rotation: Vec3::zeros(),
    };
    Motion {
        pivot: Vec3::zeros(),
        keys: vec![key(0.0, Vec3::zeros()), key(0.01, way)],
    }
}

fn with(mut scene: Scene, change: impl Fn(&mut Scene)) -> Scene {
    change(&mut scene);
    scene
}

fn of(mut scene: Scene, change: impl Fn(&mut Material)) -> Scene {
    let cloth = &mut scene.objects[0];
    let ObjectKind::Deformable { material, .. } = &mut cloth.kind else {
        panic!("cloth first");
    };
    change(material);
    if let Some(own) = &mut cloth.cloth {
        change(&mut own.materials[0]);
    }
    scene
}

/// Scenes that ask for a feature: without it and with it.
fn cases(feature: Feature) -> Vec<[Scene; 2]> {
    let inside = || lying(0.003);
    let way = motion(Vec3::new(0.0, 0.002, 0.0));
    let change = |scene: Scene, change: fn(&mut Scene)| [scene.clone(), with(scene, change)];
    let matter = |change: fn(&mut Material)| [strained(), of(strained(), change)];
    let near = || with(two(), |s| s.contact.cloth_offset = 5e-4);
    match feature {
        Feature::MovingObjects => {
            let moving = plate(ObjectKind::moving(way));
            vec![[inside(), with(inside(), |s| s.objects[1] = moving.clone())]]
        }
        Feature::Grips => {
            let grip = SceneGrip {
                object: 0,
                vertices: vec![12],
                motion: way,
            };
            vec![[hung(), with(hung(), |s| s.grips = vec![grip.clone()])]]
        }
        Feature::Restitution => vec![[inside(), of(inside(), |m| m.restitution = Some(0.5))]],
        Feature::ClothContact => vec![change(two(), |s| s.contact.cloth_offset = 0.004)],
        Feature::Layers => vec![change(near(), |s| s.objects[0].layer = 1)],
        Feature::MassDrag => vec![
            change(hung(), |s| s.air.drag = 5.0),
            change(hung(), |s| s.damping.mass = 5.0),
        ],
        Feature::TriangleDrag => vec![change(hung(), |s| {
            s.air = Air {
                density: 1.2,
                wind: Vec3::new(1.0, 5.0, 0.0),
                ..Air::default()
            };
        })],
        Feature::Viscosity => vec![
            change(strained(), |s| s.damping.stiffness = 1e-4),
            matter(|m| m.stiffness_damping = 1e-4),
            matter(|m| m.viscosity = 0.002),
            matter(|m| m.bend_viscosity = 1e-7),
        ],
        Feature::KeptStrain => vec![
            matter(|m| (m.relaxed_fraction, m.relaxation_time) = ([0.5, 0.0], 0.01)),
            matter(|m| (m.relaxed_fraction, m.relaxation_time) = ([0.0, 0.5], 0.01)),
        ],
        Feature::Hardening => vec![matter(|m| m.hardening = [100.0; 2])],
        Feature::StrainLimit => vec![matter(|m| m.strain_limit = [0.08; 2])],
        Feature::TensionField => vec![matter(|m| m.compression = Compression::TensionField)],
    }
}

/// What every method has to know: a scene without it and with it.
fn common() -> Vec<(&'static str, [Scene; 2])> {
    let inside = || lying(0.003);
    let thick = || lying(0.0149);
    vec![
        (
            "surfaces",
            [with(inside(), |s| s.objects.truncate(1)), inside()],
        ),
        (
            "friction",
            [with(sliding(), |s| s.contact.friction = false), sliding()],
        ),
        ("thickness", [thick(), of(thick(), |m| m.thickness = 0.03)]),
        (
            "bend_poisson",
            [strained(), of(strained(), |m| m.bend_poisson = 0.3)],
        ),
    ]
}

/// A sheet on a plate, drawn aside by gravity.
fn sliding() -> Scene {
    with(lying(0.00399), |s| s.gravity = Vec3::new(6.0, -9.81, 0.0))
}

/// Positions after some steps.
fn after(mut scene: Scene, kind: MethodKind) -> Result<Vec<TriangleMesh>, DrapeError> {
    scene.method = kind.into();
    let mut run = SceneRun::new(&scene, toile_reference::build)?;
    for _ in 0..12 {
        run.advance()?;
    }
    Ok(run.meshes())
}

/// Where the first cloth of two scenes is after some steps.
fn both(scenes: &[Scene; 2], kind: MethodKind) -> [Result<Vec<Vec3>, DrapeError>; 2] {
    let place = |scene: &Scene| {
        let mut meshes = after(scene.clone(), kind)?;
        Ok(meshes.remove(0).positions)
    };
    scenes.each_ref().map(place)
}

#[test]
fn every_method_acts_on_what_a_scene_asks_for_or_refuses_it_by_name_and_rest_knows_no_damping() {
    for (feature_name, feature) in Feature::ALL {
        for (name, kind) in MethodKind::ALL {
            for scenes in cases(feature) {
                let place = feature.asked_by(&World::of_scene(&scenes[1]).unwrap());
                let place = place.unwrap_or_else(|| panic!("not asked for: {feature_name}"));
                let [without, with] = both(&scenes, kind);
                match with {
                    Ok(with) => {
                        assert!(kind.supports(feature), "{name} takes {feature_name}");
                        // Where the scene without it is refused too, something else is asked for.
                        let without = without.unwrap_or_else(|e| panic!("{name}: {e}"));
                        let at_rest = kind.is_equilibrium() && feature.only_damps();
                        let same = with == without;
                        assert_eq!(same, at_rest, "{name}, {feature_name}");
                    }
                    Err(DrapeError::Scene {
                        place: at,
                        what,
                        remedy,
                    }) => {
                        assert!(!kind.supports(feature), "{name}, {feature_name}: {what}");
                        let other = feature == Feature::Layers;
                        assert!(
                            other || (at == place && what.contains(feature_name)),
                            "{at}: {what}"
                        );
                        assert!(what.contains(name), "{what}");
                        assert!(remedy.contains("leave it out"), "{remedy}");
                    }
                    Err(other) => panic!("{name}, {feature_name}: {other}"),
                }
            }
        }
    }
}

#[test]
fn every_method_knows_surfaces_friction_thickness_and_bending() {
    for (what, scenes) in common() {
        for (name, kind) in MethodKind::ALL {
            let [without, with] = both(&scenes, kind).map(|places| places.expect(name));
            assert_ne!(with, without, "{name} ignores {what}");
        }
    }
}

#[test]
fn what_no_method_knows_together_is_said() {
    let [_, moving] = cases(Feature::MovingObjects).remove(0);
    let folded = with(moving, |s| s.method = MethodKind::Xpbd.into());
    let folded = of(folded, |m| m.relaxed_fraction = [0.0, 0.2]);
    let error = SceneRun::new(&folded, toile_reference::build)
        .err()
        .map(|e| e.to_string());
    let error = error.unwrap_or_default();
    for part in [
        "kept share",
        "no method knows all",
        "moving objects",
        "xpbd",
    ] {
        assert!(error.contains(part), "{part}: {error}");
    }
    let [_, folded] = cases(Feature::KeptStrain).remove(1);
    let error = after(folded, MethodKind::Xpbd).err().map(|e| e.to_string());
    let error = error.unwrap_or_default();
    assert!(error.contains("implicit-euler"), "{error}");
    assert!(!error.contains("no method"), "{error}");
}

#[test]
fn the_documentation_says_which_method_knows_what() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../docs/methods/integrators.md"
    );
    let text = std::fs::read_to_string(path).unwrap();
    for (feature_name, feature) in Feature::ALL {
        let names = |known: bool| {
            let all = MethodKind::ALL.iter();
            let some = all.filter(|(_, kind)| kind.supports(feature) == known);
            let quoted = some.map(|(name, _)| format!("`{name}`"));
            quoted.collect::<Vec<_>>()
        };
        let (able, unable) = (names(true), names(false));
        let which = match (able.len(), unable.len()) {
            (_, 0) => "all".to_owned(),
            (able, unable) if unable < able => format!("all but {}", names(false).join(", ")),
            _ => able.join(", "),
        };
        let row = format!("| {feature_name} | {which} |");
        assert!(text.contains(&row), "no row {row}");
    }
}
