//! Cloth that friction holds stays where it is: between two blocks, on a body that moves, and from the first step on.

use crate::support::sheets::{cloth, sheet};
use crate::support::solids;
use std::sync::Arc;
use toile_drape::{
    Collider, Material, MethodKind, MethodSettings, Motion, MotionKey, State, System,
};
use toile_geometry::{SurfaceTree, Vec3};

/// A step (s).
const STEP: f64 = 1.0 / 120.0;

fn collider(low: [f64; 3], high: [f64; 3]) -> Collider {
    let mesh = solids::block(Vec3::from(low), Vec3::from(high));
    Collider::new(Arc::new(SurfaceTree::new(mesh)))
}

/// A strip of 10 x 40 cm hanging from a pinch of its upper 10 cm, the gap so many metres wide.
fn pinched(gap: f64, friction: f64) -> (System, State) {
    let mesh = sheet([4, 16], [0.1, 0.4], |x, y| Vec3::new(x, y, 0.0));
    let material = Material {
        density: 0.2,
        friction,
        ..Material::default()
    };
    let (system, state) = cloth(&mesh, material);
    let half = 0.5 * gap;
    let system = system.with(|builder| {
        builder.colliders = vec![
            collider([-0.05, 0.29, -half - 0.03], [0.15, 0.45, -half]),
            collider([-0.05, 0.29, half], [0.15, 0.45, half + 0.03]),
        ];
    });
    (system, state)
}

/// Mean height of the upper border, five vertices: below the pinch the strip still swings up and down.
fn border(state: &State) -> f64 {
    let border = &state.positions[state.positions.len() - 5..];
    border.iter().map(|x| x.y).sum::<f64>() / 5.0
}

/// The height of the border after 1/3 s and after as long again.
fn before_and_after(kind: MethodKind, (system, mut state): (System, State)) -> [f64; 2] {
    let mut method = MethodSettings::from(kind)
        .build()
        .expect("a method that there is");
    [0, 1].map(|_| {
        for _ in 0..40 {
            method.advance(&system, &mut state, STEP).unwrap();
        }
        border(&state)
    })
}

#[test]
fn a_pinch_holds_what_both_sides_can_bear_and_lets_the_rest_slide() {
    let area = 0.01;
    let weight = 0.2 * 0.04 * 9.81;
    for gap in [7.99e-3, 7.95e-3, 7.9e-3, 7.5e-3, 7e-3, 6e-3] {
        for friction in [0.1, 0.4] {
            let held = 2.0 * friction * (4e-3 - 0.5 * gap) * 1e6 * area / weight;
            let [before, after] = before_and_after(MethodKind::Xpbd, pinched(gap, friction));
            let speed = (after - before) * 3.0;
            if held >= 1.5 {
                assert!(speed.abs() < 1e-6, "{gap} {friction}: {speed:e}");
            } else if held < 0.7 {
                assert!(speed < -0.2, "{gap} {friction}: {speed:e}");
            }
        }
    }
}

#[test]
fn a_pinch_is_smooth_for_implicit_euler() {
    let [before, after] = before_and_after(MethodKind::ImplicitEuler, pinched(7e-3, 0.4));
    assert!((after - before).abs() < 3e-7, "{before} {after}");
}

#[test]
fn cloth_keeps_its_place_on_a_plate_that_creeps_and_turns() {
    let mesh = sheet([4, 4], [0.08; 2], |x, z| Vec3::new(x, 0.004, z));
    let (system, state) = cloth(&mesh, Material::default());
    let plate = solids::block(Vec3::new(-0.3, -0.1, -0.3), Vec3::new(0.3, 0.0, 0.3));
    let key = |time, x, turn| MotionKey {
        time,
        translation: Vec3::new(x, 0.0, 0.0),
        rotation: Vec3::new(0.0, turn, 0.0),
    };
    let motion = Motion {
        pivot: Vec3::zeros(),
        keys: vec![key(0.0, 0.0, 0.0), key(2.0, 2e-3, 0.2)],
    };
    let plate = Collider::moving(Arc::new(SurfaceTree::new(plate)), motion);
    let system = system.with(|builder| builder.colliders = vec![plate.clone()]);
    let on_plate = |state: &State| {
        let pose = plate.pose(state.time).unwrap();
        let places = state.positions.iter().map(|&x| pose.undo(x));
        places.collect::<Vec<Vec3>>()
    };
    let mut method = MethodSettings::from(MethodKind::Xpbd)
        .build()
        .expect("a method that there is");
    let mut state = state;
    let mut at = Vec::new();
    for step in 0..120 {
        if step == 60 {
            at = on_plate(&state);
        }
        method.advance(&system, &mut state, STEP).unwrap();
    }
    let now = on_plate(&state);
    let moved = now.iter().zip(&at).map(|(a, b)| (a - b).norm());
    let moved = moved.fold(0.0, f64::max);
    assert!(moved < 1e-6, "{moved:e}");
}

#[test]
fn the_first_step_of_a_contact_has_friction() {
    let (friction, speed) = (0.5, 0.3);
    let material = Material {
        friction,
        ..Material::default()
    };
    let weight = 9.81 * material.density;
    let mesh = sheet([4, 4], [0.08; 2], |x, z| {
        Vec3::new(x, 0.004 - weight / 1e6, z)
    });
    let (system, mut state) = cloth(&mesh, material);
    let system = system.with(|builder| {
        builder.colliders = vec![collider([-0.5, -0.1, -0.5], [0.5, 0.0, 0.5])];
    });
    state.velocities.fill(Vec3::new(speed, 0.0, 0.0));
    let mut method = MethodSettings::from(MethodKind::ImplicitEuler)
        .build()
        .unwrap();
    method.advance(&system, &mut state, STEP).unwrap();
    let after = state.velocities.iter().map(|v| v.x).sum::<f64>() / state.velocities.len() as f64;
    let expected = speed - friction * 9.81 * STEP;
    assert!(
        (after - expected).abs() < 1e-3 * expected,
        "{after} {expected}"
    );
}

/// How far a small cloth moves in a fifth of a second on a cloth that is held, under gravity inclined to a share of the
/// tangent of friction, after a tenth (m).
fn moves_on_cloth(kind: MethodKind, share: f64) -> f64 {
    let friction = 0.4;
    let mut mesh = sheet([9, 9], [0.4; 2], |x, z| Vec3::new(x - 0.1, 0.0, z - 0.2));
    let held = mesh.positions.len();
    let above = sheet([4, 4], [0.1; 2], |x, z| Vec3::new(x - 0.05, 2e-3, z - 0.05));
    let corners = above.triangles.iter();
    let corners = corners.map(|t| t.map(|v| v + held as u32));
    mesh.triangles.extend(corners);
    mesh.positions.extend(above.positions);
    let material = Material {
        friction,
        ..Material::default()
    };
    let (system, mut state) = cloth(&mesh, material);
    let mut system = system.with(|builder| {
        builder.contact.cloth_offset = 2e-3;
        builder.pinned[..held].fill(true);
    });
    let angle = (share * friction).atan();
    system.control.gravity = Vec3::new(angle.sin(), -angle.cos(), 0.0) * 9.81;
    let mut method = MethodSettings::from(kind)
        .build()
        .expect("a method that there is");
    let place = |state: &State| {
        let above = &state.positions[held..];
        above.iter().map(|x| x.x).sum::<f64>() / above.len() as f64
    };
    let mut before = 0.0;
    for step in 0..36 {
        if step == 12 {
            before = place(&state);
        }
        method.advance(&system, &mut state, STEP).unwrap();
    }
    place(&state) - before
}

#[test]
fn cloth_sticks_to_cloth_and_slides_on_it_by_coulombs_law() {
    for kind in [MethodKind::ImplicitEuler, MethodKind::Xpbd] {
        let crept = moves_on_cloth(kind, 0.99);
        assert!(crept.abs() < 2e-7, "{}: {crept:e}", kind.name());
    }
    // Between a tenth and three tenths of a second: a (0.3^2 - 0.1^2) / 2.
    let angle = 0.6f64.atan();
    let expected = 9.81 * (angle.sin() - 0.4 * angle.cos()) * 0.04;
    let moved = moves_on_cloth(MethodKind::Xpbd, 1.5);
    assert!(
        (moved - expected).abs() < 0.03 * expected,
        "{moved} {expected}"
    );
}
