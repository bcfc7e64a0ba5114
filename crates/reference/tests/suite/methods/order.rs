//! Orders in time, energy and angular momentum.

use crate::methods::fixtures::{cloth, method, sheet};
use toile_drape::{Air, Material, MethodKind, MethodSettings, State, System};
use toile_geometry::Vec3;

/// A soft strip, bent and moving: everything in it is smooth over the time it runs.
fn smooth() -> (System, State) {
    let mesh = sheet([6, 3], [0.3, 0.15], |u, v| {
        Vec3::new(u, 0.02 * (9.0 * u).sin(), v)
    });
    let material = Material {
        stretch: [8.0, 6.0],
        shear: 3.0,
        ..Material::default()
    };
    let (mut system, mut state) = cloth(&mesh, material);
    system = system.with(|builder| {
        builder.pinned[0] = true;
        builder.pinned[6] = true;
    });
    system.control.air_drag = 0.5;
    for (v, x) in state.velocities.iter_mut().zip(&state.positions) {
        *v = Vec3::new(0.2 * (7.0 * x.z).sin(), 0.5 * x.x, 0.1 * (8.0 * x.x).cos());
    }
    (system, state)
}

/// Where the strip is after 0.1 s in `steps` steps.
fn after(kind: MethodKind, steps: u32) -> Vec<Vec3> {
    let (system, state) = smooth();
    run(kind, steps, &system, state)
}

fn run(kind: MethodKind, steps: u32, system: &System, mut state: State) -> Vec<Vec3> {
    let settings = MethodSettings {
        substeps: Some(1),
        tolerance: Some(1e-11),
        iterations: Some(1000),
        ..kind.into()
    };
    let mut method = toile_reference::build(&settings).expect("a method that there is");
    for _ in 0..steps {
        let name = kind.name();
        let taken = method.advance(system, &mut state, 0.1 / f64::from(steps));
        let report = taken.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(report.pieces <= 1, "{name} cut its step");
    }
    state.positions
}

fn distance(a: &[Vec3], b: &[Vec3]) -> f64 {
    let squares: f64 = a.iter().zip(b).map(|(a, b)| (a - b).norm_squared()).sum();
    (squares / a.len() as f64).sqrt()
}

#[test]
fn methods_converge_at_their_order() {
    let exact = after(MethodKind::RungeKutta4, 4000);
    for (kind, order, steps) in [
        (MethodKind::ForwardEuler, 1.0, 2000),
        (MethodKind::SymplecticEuler, 1.0, 400),
        (MethodKind::VelocityVerlet, 2.0, 400),
        (MethodKind::PatchVerlet, 2.0, 400),
        (MethodKind::RungeKutta4, 4.0, 200),
        (MethodKind::SemiImplicitEuler, 1.0, 200),
        (MethodKind::ImplicitEuler, 1.0, 200),
        (MethodKind::Bdf2, 2.0, 200),
        (MethodKind::ImplicitMidpoint, 2.0, 100),
    ] {
        let coarse = distance(&after(kind, steps), &exact);
        let fine = distance(&after(kind, 2 * steps), &exact);
        let got = (coarse / fine).log2();
        assert!(
            (got - order).abs() < 0.25,
            "{}: order {got:.2} instead of {order}, errors {coarse:.2e} {fine:.2e}",
            kind.name()
        );
    }
}

/// The strip with viscosity in stretch and fold, kept strain and wind.
fn dissipative() -> (System, State) {
    let (plain, state) = smooth();
    let mesh = plain.mesh(&state.positions);
    let material = Material {
        viscosity: 0.05,
        bend_viscosity: 2e-6,
        relaxed_fraction: [0.3, 0.3],
        relaxation_time: 0.05,
        ..plain.materials.list[0].clone()
    };
    let (mut system, mut held) = cloth(&mesh, material);
    system = system.with(|builder| {
        builder.pinned.clone_from(&plain.prescribed.pinned);
    });
    system.control.air_drag = plain.control.air_drag;
    system.control.air = Air {
        density: Air::SEA_LEVEL,
        wind: Vec3::new(1.0, 2.0, 0.5),
        ..Air::default()
    };
    held.velocities = state.velocities;
    (system, held)
}

#[test]
fn methods_on_one_potential_take_the_same_step() {
    for (case, (system, state)) in [("plain", smooth()), ("dissipative", dissipative())] {
        let exact = run(MethodKind::ImplicitEuler, 10, &system, state.clone());
        for kind in [
            MethodKind::ProjectiveDynamics,
            MethodKind::Lbfgs,
            MethodKind::VertexBlockDescent,
            MethodKind::ChebyshevBlockDescent,
        ] {
            let off = distance(&run(kind, 10, &system, state.clone()), &exact);
            assert!(off < 1e-7, "{case}, {}: {off:e} m", kind.name());
        }
    }
}

#[test]
fn automatic_substeps_allow_for_viscosity() {
    for kind in [
        MethodKind::SymplecticEuler,
        MethodKind::VelocityVerlet,
        MethodKind::RungeKutta4,
    ] {
        let (system, mut state) = dissipative();
        let mut method = toile_reference::build(&kind.into()).expect("a method that there is");
        let mut viscous = 0;
        for _ in 0..20 {
            let step = method.advance(&system, &mut state, 0.01);
            viscous = step
                .unwrap_or_else(|error| panic!("{}: {error}", kind.name()))
                .iterations;
        }
        let (system, mut state) = smooth();
        let plain = toile_reference::build(&kind.into())
            .expect("a method that there is")
            .advance(&system, &mut state, 0.01);
        assert!(plain.is_ok_and(|plain| plain.iterations < viscous));
    }
}

#[test]
fn angular_momentum_hardly_drifts_in_free_flight() {
    for (kind, substeps, most) in [
        (MethodKind::SymplecticEuler, 40, 1e-10),
        (MethodKind::VelocityVerlet, 40, 1e-10),
        (MethodKind::PatchVerlet, 40, 1e-10),
        (MethodKind::ImplicitMidpoint, 1, 1e-8),
    ] {
        let mesh = sheet([4, 4], [0.2, 0.2], |u, v| Vec3::new(u - 0.1, 0.0, v - 0.1));
        let (mut system, mut state) = cloth(&mesh, Material::default());
        system.control.gravity = Vec3::zeros();
        let spin = Vec3::new(1.0, 2.0, 0.5);
        for (v, x) in state.velocities.iter_mut().zip(&state.positions) {
            *v = spin.cross(x);
        }
        let angular = |state: &State| -> Vec3 {
            let moving = state.positions.iter().zip(&state.velocities);
            moving
                .zip(&system.rest.mass)
                .map(|((x, v), m)| x.cross(v) * *m)
                .sum()
        };
        let before = angular(&state);
        let mut method = method(kind, substeps);
        for _ in 0..250 {
            let step = method.advance(&system, &mut state, 0.004);
            step.unwrap_or_else(|error| panic!("{}: {error}", kind.name()));
        }
        let off = (angular(&state) - before).norm() / before.norm();
        assert!(off < most, "{}: {off:e}", kind.name());
    }
}
