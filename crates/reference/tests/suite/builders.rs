//! What makes methods: this crate every one of the list, `drape` those of garments and scenes, and it refuses the rest
//! by name.

use toile_drape::{DrapeError, MethodBuilder, MethodKind, MethodSettings, Scene, SceneRun};

/// The methods that garments and scenes use.
const OWN: [&str; 7] = [
    "velocity-verlet",
    "semi-implicit-euler",
    "implicit-euler",
    "bdf2",
    "implicit-midpoint",
    "rest",
    "xpbd",
];

#[test]
fn every_method_of_the_list_is_made() {
    let builder: MethodBuilder = toile_reference::build;
    for (name, kind) in MethodKind::ALL {
        if let Err(error) = builder(&kind.into()) {
            panic!("{name}: {error}");
        }
    }
}

#[test]
fn drape_makes_its_own_methods_and_refuses_the_others_by_name() {
    for (name, kind) in MethodKind::ALL {
        let made = MethodSettings::from(kind).build();
        assert_eq!(made.is_ok(), OWN.contains(&name), "{name}");
        let Err(error) = made else { continue };
        let DrapeError::Scene {
            place,
            what,
            remedy,
        } = error
        else {
            panic!("{name}: {error}");
        };
        assert_eq!(place, "method");
        assert!(what.contains(name), "{what}");
        assert!(remedy.ends_with(&OWN.join(", ")), "{remedy}");
    }
}

#[test]
fn most_iterations_are_those_of_the_solver_or_as_given() {
    let most = |kind: MethodKind, iterations: Option<usize>| {
        let settings = MethodSettings {
            iterations,
            ..kind.into()
        };
        let method = toile_reference::build(&settings);
        method.expect("made").most_iterations()
    };
    for (kind, expected) in [
        (MethodKind::ImplicitEuler, Some(40)),
        (MethodKind::SemiImplicitEuler, Some(1)),
        (MethodKind::ProjectiveDynamics, Some(30)),
        (MethodKind::Lbfgs, Some(60)),
        (MethodKind::ChebyshevBlockDescent, Some(100)),
        (MethodKind::Xpbd, Some(1)),
        (MethodKind::VelocityVerlet, None),
        (MethodKind::PatchVerlet, None),
        (MethodKind::Rest, None),
        (MethodKind::DynamicRelaxation, None),
    ] {
        assert_eq!(most(kind, None), expected, "{kind:?}");
        let given = expected.map(|_| 7);
        assert_eq!(most(kind, Some(7)), given, "{kind:?}");
    }
}

#[test]
fn a_run_says_that_its_builder_lacks_the_method() {
    let mesh = toile_geometry::TriangleMesh {
        positions: [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]]
            .map(|[x, z]| toile_geometry::Vec3::new(x, 0.0, z))
            .to_vec(),
        triangles: vec![[0, 1, 2]],
    };
    let cloth = toile_drape::SceneObject {
        name: "cloth".to_owned(),
        kind: toile_drape::ObjectKind::Deformable {
            material: toile_drape::Material::default(),
            pins: vec![],
        },
        mesh,
        cloth: None,
        layer: 0,
    };
    let scene = Scene {
        objects: vec![cloth],
        method: MethodKind::Lbfgs.into(),
        ..Scene::default()
    };
    assert!(SceneRun::new(&scene, toile_reference::build).is_ok());
    let error = SceneRun::new(&scene, MethodSettings::build).err();
    let error = error.expect("refused").to_string();
    assert!(error.starts_with("method: \"lbfgs\" is"), "{error}");
}
