//! Where methods fail: each stays sound or stops with an error that names the place.

use crate::methods::fixtures::{ball, ball_mesh, cloth, hanging_square, shake, sheet};
use std::sync::Arc;
use toile_drape::{
    Cloth, Collider, DrapeError, Material, MethodKind, MethodSettings, State, System,
    SystemBuilder, Workspace, largest_frequency, whole_energy,
};
use toile_geometry::{SurfaceTree, Vec3};

/// Five steps of 1/60 s with each method's own settings. Afterwards no vertex may be farther than
/// `reach` (m) from where it was, and a failed step must leave the state alone.
fn check(case: &str, make: impl Fn() -> (System, State), reach: f64) {
    for (name, kind) in MethodKind::ALL {
        let (system, start) = make();
        let mut state = start.clone();
        let mut method = toile_reference::build(&kind.into()).expect("a method that there is");
        for _ in 0..5 {
            let before = state.clone();
            if let Err(error) = method.advance(&system, &mut state, 1.0 / 60.0) {
                assert!(state == before, "{case}, {name}: {error}");
                let named = match &error {
                    DrapeError::NotFinite { stage, vertex }
                    | DrapeError::BlownUp { stage, vertex, .. }
                    | DrapeError::EnergyGrew { stage, vertex, .. }
                    | DrapeError::TooStiff { stage, vertex, .. } => {
                        !stage.is_empty() && *vertex < system.vertex_count()
                    }
                    DrapeError::NoProgress { stage, .. } => !stage.is_empty(),
                    _ => false,
                };
                assert!(named, "{case}, {name}: {error}");
                break;
            }
            assert_eq!(state.first_not_finite(), None, "{case}, {name}");
        }
        let pairs = state.positions.iter().zip(&start.positions);
        let far = pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(far < reach, "{case}, {name}: {far} m away");
    }
}

fn stretched(by: f64, material: Material) -> (System, State) {
    let mesh = sheet([6, 6], [0.3, 0.3], |u, v| Vec3::new(u, 1.0 - v, 0.0));
    let (mut system, mut state) = cloth(&mesh, material);
    system = system.with(|builder| {
        builder.pinned[..7].fill(true);
    });
    for x in &mut state.positions {
        x.y = 1.0 - (1.0 - x.y) * by;
    }
    (system, state)
}

#[test]
fn stiff_cloth_under_compression() {
    let material = Material {
        stretch: [1e8, 1e8],
        shear: 1e7,
        ..Material::default()
    };
    let make = || {
        let (system, mut state) = stretched(0.98, material.clone());
        shake(&system, &mut state, 1e-5);
        (system, state)
    };
    // 2 % of compression holds Y/8 (1 - 0.98^2)^2 = 2e4 J/m2: 440 m/s at 0.2 kg/m2.
    check("compression at 1e8 N/m", make, 40.0);
}

#[test]
fn cloth_stretched_to_four_times_its_length() {
    // Y/8 (16 - 1)^2 = 1.7e4 J/m2: 410 m/s at 0.2 kg/m2.
    let make = || stretched(4.0, Material::default());
    check("300 % of stretch", make, 40.0);
}

#[test]
fn meshes_with_slivers() {
    let make = || {
        let mut mesh = sheet([6, 6], [0.3, 0.3], |u, v| Vec3::new(u, 1.0 - v, 0.0));
        // A vertex drawn to a thousandth of an edge from its neighbour's edge.
        let (a, b) = (mesh.positions[24], mesh.positions[25]);
        mesh.positions[24] = a + (b - a) * 0.999;
        let (mut system, state) = cloth(&mesh, Material::default());
        system = system.with(|builder| {
            builder.pinned[..7].fill(true);
        });
        (system, state)
    };
    check("slivers", make, 1.0);
}

#[test]
fn contrasts_of_stiffness_and_mass() {
    let make = |stiff: f64, heavy: f64| {
        let mesh = sheet([6, 6], [0.3, 0.3], |u, v| Vec3::new(u, 1.0 - v, 0.0));
        let soft = Material {
            stretch: [20.0, 20.0],
            shear: 5.0,
            ..Material::default()
        };
        let mut cloth = Cloth::from_mesh("cloth", &mesh, soft.clone()).expect("sound");
        cloth.materials.push(Material {
            stretch: [20.0 * stiff, 20.0 * stiff],
            shear: 5.0 * stiff,
            density: soft.density * heavy,
            ..soft
        });
        for material in cloth.material.iter_mut().skip(36) {
            *material = 1;
        }
        let mut builder = SystemBuilder::new("cloth", &cloth).expect("sound");
        builder.pinned[..7].fill(true);
        let system = builder.build();
        let state = State::at_rest(&system, mesh.positions.clone());
        (system, state)
    };
    check("stiffness 1 to 1e4", || make(1e4, 1.0), 1.0);
    check("mass 1 to 1e3", || make(1.0, 1e3), 1.0);
}

#[test]
fn a_body_that_jumps_into_the_cloth() {
    let make = || {
        let mesh = sheet([8, 8], [0.2, 0.2], |u, v| {
            Vec3::new(u - 0.1, 0.085, v - 0.1)
        });
        let (mut system, mut state) = cloth(&mesh, Material::default());
        system = system.with(|builder| {
            builder.colliders = vec![ball(0.1)];
        });
        state.velocities.fill(Vec3::new(0.0, -3.0, 0.0));
        (system, state)
    };
    // 15 mm deep at 1e6 N/m3: 112 J/m2, 34 m/s at 0.2 kg/m2.
    check("a body jumps", make, 4.0);
}

#[test]
fn no_method_returns_a_step_with_ten_times_the_energy_that_a_body_that_jumped_gave() {
    let mesh = sheet([10, 5], [0.2, 0.1], |u, v| {
        Vec3::new(u - 0.1, 0.055, v - 0.05)
    });
    let mut jumped = ball_mesh(0.05);
    for p in &mut jumped.positions {
        *p += Vec3::new(0.02, 0.03, 0.0);
    }
    let jumped = Collider::new(Arc::new(SurfaceTree::new(jumped)));
    for kind in [
        MethodKind::ImplicitEuler,
        MethodKind::Bdf2,
        MethodKind::ImplicitMidpoint,
    ] {
        let (mut system, mut state) = cloth(&mesh, Material::default());
        system = system.with(|builder| {
            builder.colliders = vec![ball(0.05)];
        });
        let mut method = toile_reference::build(&kind.into()).expect("a method that there is");
        for _ in 0..5 {
            method
                .advance(&system, &mut state, 1.0 / 60.0)
                .expect("sound");
        }
        system = system.with(|builder| {
            builder.colliders = vec![jumped.clone()];
        });
        let mut workspace = Workspace::default();
        let given = whole_energy(&system, &state, &mut workspace);
        for step in 0..20 {
            let before = state.clone();
            if let Err(error) = method.advance(&system, &mut state, 1.0 / 60.0) {
                assert!(matches!(error, DrapeError::EnergyGrew { .. }), "{error}");
                assert!(state == before, "{kind:?}: {error}");
                break;
            }
            let has = whole_energy(&system, &state, &mut workspace);
            assert!(
                has <= 10.0 * given,
                "{kind:?}, step {step}: {given} J given, {has} J"
            );
        }
    }
}

#[test]
fn what_is_too_stiff_to_wait_for_is_refused_by_vertex() {
    let material = Material {
        stretch: [1e15, 1e15],
        shear: 1e14,
        ..Material::default()
    };
    let (system, mut state) = stretched(1.0, material);
    assert!(largest_frequency(&system, &state) > 1e8);
    let mut method =
        toile_reference::build(&MethodKind::VelocityVerlet.into()).expect("a method that there is");
    let error = method.advance(&system, &mut state, 1.0);
    assert!(
        matches!(error, Err(DrapeError::TooStiff { substeps, .. }) if substeps > 1e6),
        "{error:?}"
    );
}

#[test]
fn settings_out_of_the_ordinary_do_no_harm() {
    for (name, kind) in MethodKind::ALL {
        for (substeps, iterations, tolerance) in [
            (Some(0), Some(0), Some(0.0)),
            (Some(1), Some(1), Some(f64::INFINITY)),
            (Some(2), Some(1), Some(0.0)),
        ] {
            let (system, mut state) = hanging_square();
            let settings = MethodSettings {
                kind,
                substeps,
                iterations,
                tolerance,
            };
            let mut method = toile_reference::build(&settings).expect("a method that there is");
            for _ in 0..3 {
                let before = state.clone();
                if method.advance(&system, &mut state, 1e-3).is_err() {
                    assert!(state == before, "{name}");
                }
                assert_eq!(state.first_not_finite(), None, "{name}");
            }
        }
    }
}
