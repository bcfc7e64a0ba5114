//! Body contact and friction by every method.

use crate::methods::fixtures::{ball, cloth, sheet};
use std::sync::Arc;
use toile_drape::{Collider, Material, MethodKind, SolidFriction, State, System};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec3};

/// Methods that run, at their own settings: all but the one that is never stable.
fn sound() -> impl Iterator<Item = (&'static str, MethodKind)> {
    MethodKind::ALL
        .into_iter()
        .filter(|(_, kind)| *kind != MethodKind::ForwardEuler)
}

fn run(name: &str, kind: MethodKind, system: &System, state: &mut State, steps: usize) {
    let mut method = toile_reference::build(&kind.into()).expect("a method that there is");
    let steps = if kind.is_equilibrium() { 500 } else { steps };
    for _ in 0..steps {
        method
            .advance(system, state, 1.0 / 60.0)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        if method.finished() {
            break;
        }
    }
}

#[test]
fn cloth_lands_on_a_ball_and_stays_on_it() {
    for (name, kind) in sound() {
        let mesh = sheet([8, 8], [0.2, 0.2], |u, v| {
            Vec3::new(u - 0.1, 0.106, v - 0.1)
        });
        let material = Material {
            stretch: [60.0, 60.0],
            shear: 20.0,
            ..Material::default()
        };
        let (mut system, mut state) = cloth(&mesh, material);
        system = system.with(|builder| {
            builder.colliders = vec![ball(0.1)];
        });
        system.control.air_drag = 3.0;
        run(name, kind, &system, &mut state, 30);
        for x in &state.positions {
            assert!(x.norm() > 0.1, "{name}: {x:?} inside");
            assert!(x.y > -0.2, "{name} slid off: {x:?}");
        }
        // Nothing damps the penalty of an explicit method: its cloth may hop.
        let middle = state.positions[40].norm();
        assert!(middle < 0.12, "{name}: {middle}");
    }
}

/// A patch lying on a plane with friction 0.5; gravity leans by `slope` (rad) instead of it.
fn on_a_slope(slope: f64) -> (System, State) {
    let offset = toile_drape::ContactSettings::default().offset;
    let material = Material {
        friction: 0.5,
        ..Material::default()
    };
    let depth = material.density * 9.81 * slope.cos() / 1e6;
    let mesh = sheet([3, 3], [0.06, 0.06], |u, v| Vec3::new(u, offset - depth, v));
    let (mut system, mut state) = cloth(&mesh, material);
    let plane = TriangleMesh {
        positions: [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)]
            .map(|(x, z)| Vec3::new(x, 0.0, z))
            .to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    };
    system = system.with(|builder| {
        builder.colliders = vec![Collider::new(Arc::new(SurfaceTree::new(plane)))];
    });
    system.control.gravity = Vec3::new(slope.sin(), -slope.cos(), 0.0) * 9.81;
    let pressed = (0..)
        .zip(state.samples.iter())
        .map(|(number, sample)| SolidFriction {
            sample: number,
            solid: 0,
            anchor: sample.position(&state.positions),
            force: depth * 1e6 * sample.area,
        });
    state.solid_friction = pressed.collect();
    (system, state)
}

#[test]
fn a_patch_sticks_below_the_angle_of_friction_and_slides_above_it() {
    let middle = |state: &State| {
        let sum: f64 = state.positions.iter().map(|x| x.x).sum();
        sum / state.positions.len() as f64
    };
    let speed = |state: &State| {
        let sum: f64 = state.velocities.iter().map(|v| v.x).sum();
        sum / state.velocities.len() as f64
    };
    for (name, kind) in sound().filter(|(_, kind)| !kind.is_equilibrium()) {
        let (system, mut state) = on_a_slope(0.45f64.atan());
        let start = middle(&state);
        run(name, kind, &system, &mut state, 18);
        let crept = middle(&state) - start;
        assert!(crept.abs() < 3e-4, "{name} crept {crept} m");

        let slope = 0.8f64.atan();
        let (system, mut state) = on_a_slope(slope);
        // What a method that linearises once a step takes to notice that the patch slides.
        run(name, kind, &system, &mut state, 6);
        let first = speed(&state);
        run(name, kind, &system, &mut state, 12);
        let got = (speed(&state) - first) / 0.2;
        let expected = 9.81 * (slope.sin() - 0.5 * slope.cos());
        assert!(
            (got - expected).abs() < 0.01 * expected,
            "{name}: {got} m/s2 instead of {expected}"
        );
    }
}
