//! Viscosity, kept strain and air against closed forms, through the methods in time.

use crate::strips::{KINDS, Kind, strip};
use toile_drape::{Air, Cloth, Material, MethodKind, MethodSettings, State, System, SystemBuilder};
use toile_geometry::Vec3;

const IN_TIME: [MethodKind; 7] = [
    MethodKind::SymplecticEuler,
    MethodKind::VelocityVerlet,
    MethodKind::RungeKutta4,
    MethodKind::SemiImplicitEuler,
    MethodKind::ImplicitEuler,
    MethodKind::Bdf2,
    MethodKind::ImplicitMidpoint,
];

/// A strip 0.2 x 0.05 m without gravity, nothing pinned.
fn free_strip(material: Material) -> (Cloth, System, State) {
    let (cloth, _) = strip(Kind::Alternating, 0.2, 0.05, 8, material);
    let mut builder = SystemBuilder::new("strip", &cloth).unwrap();
    builder.control.gravity = Vec3::zeros();
    let system = builder.build();
    let state = State::at_rest(&system, cloth.positions.clone());
    (cloth, system, state)
}

fn run(system: &System, state: &mut State, kind: MethodKind, step: f64, time: f64) {
    let mut method = toile_reference::build(&kind.into()).expect("a method that there is");
    for _ in 0..(time / step).round() as usize {
        method.advance(system, state, step).unwrap();
    }
}

#[test]
fn a_falling_sheet_reaches_the_terminal_velocity_of_quadratic_drag() {
    let material = Material {
        density: 0.1,
        ..Material::default()
    };
    for kind in IN_TIME {
        let (_, mut system, mut state) = free_strip(material.clone());
        system.control.gravity = Vec3::new(0.0, -9.81, 0.0);
        system.control.air = Air {
            density: Air::SEA_LEVEL,
            ..Air::default()
        };
        // Past three time constants v/g of 0.12 s; v = v_e tanh(g t / v_e).
        let (time, step) = (0.3, 1e-3);
        run(&system, &mut state, kind, step, time);
        let end = (2.0 * 0.1 * 9.81 / (Air::SEA_LEVEL * 1.2)).sqrt();
        let expected = end * (9.81 * time / end).tanh();
        for v in &state.velocities {
            assert!(
                (v.y + expected).abs() < 4e-3 * end,
                "{kind:?}: {} {expected}",
                v.y
            );
        }
    }
}

#[test]
fn wind_carries_a_free_sheet_along() {
    for kind in [MethodKind::SymplecticEuler, MethodKind::ImplicitEuler] {
        let (_, mut system, mut state) = free_strip(Material::default());
        system.control.air = Air {
            density: Air::SEA_LEVEL,
            wind: Vec3::new(0.0, 3.0, 0.0),
            ..Air::default()
        };
        run(&system, &mut state, kind, 1e-3, 0.2);
        // dw/dt = -a w^2 for the velocity w relative to the wind, a = rho C / (2 density).
        let a = Air::SEA_LEVEL * 1.2 / (2.0 * 0.2);
        let expected = 3.0 - 3.0 / (1.0 + 3.0 * a * 0.2);
        for v in &state.velocities {
            assert!(
                (v.y - expected).abs() < 0.01,
                "{kind:?}: {} {expected}",
                v.y
            );
        }
    }
}

/// Length of the strip's first side over its length at rest, less one.
fn stretch(cloth: &Cloth, x: &[Vec3]) -> f64 {
    let rest = &cloth.positions;
    let side = |v: &usize| (rest[*v].z - rest[0].z).abs() < 1e-9;
    let end = (0..rest.len())
        .filter(side)
        .max_by(|&a, &b| rest[a].x.total_cmp(&rest[b].x))
        .unwrap();
    (x[end] - x[0]).norm() / (rest[end] - rest[0]).norm() - 1.0
}

#[test]
fn a_stretched_strip_keeps_its_share_and_lets_go_of_the_rest() {
    let material = Material {
        relaxed_fraction: [0.4, 0.0],
        relaxation_time: 0.5,
        poisson: 0.0,
        ..Material::default()
    };
    let (cloth, mut system, mut state) = free_strip(material);
    for x in &mut state.positions {
        x.x *= 1.02;
    }
    system = system.with(|builder| {
        builder.pinned.fill(true);
    });
    run(&system, &mut state, MethodKind::ImplicitEuler, 0.01, 1.0);
    let held = 1.02f64.powi(2) / 2.0 - 0.5;
    let settled = held * (1.0 - (-1.0f64 / 0.5).exp());
    for triangle in &state.internal_strain {
        assert!((triangle.stretch[0] - settled).abs() < 1e-12);
    }
    // Let go: at rest at once with 0.4 of what settled, as rest does not run in time.
    system = system.with(|builder| {
        builder.pinned.fill(false);
        builder.pinned[0] = true;
    });
    let mut rest = MethodSettings {
        tolerance: Some(1e-6),
        ..MethodKind::Rest.into()
    }
    .build()
    .unwrap();
    while !rest.finished() {
        rest.advance(&system, &mut state, 0.0).unwrap();
    }
    let kept = (1.0f64 + 2.0 * 0.4 * settled).sqrt() - 1.0;
    let got = stretch(&cloth, &state.positions);
    assert!((got - kept).abs() < 1e-6, "{got} {kept}");
}

/// Mean curvature along the strip, from the turn of its ends.
fn turn(state: &State, cloth: &Cloth) -> f64 {
    let column = |u: f64| {
        let near: Vec<usize> = (0..cloth.positions.len())
            .filter(|&v| (cloth.positions[v].x - u).abs() < 1e-6)
            .collect();
        near.iter().map(|&v| state.positions[v]).sum::<Vec3>() / near.len() as f64
    };
    let h = 0.2 / 7.5;
    let (a, b) = (column(-0.5 * h), column(0.5 * h));
    let (c, d) = (column(0.2 - h), column(0.2));
    let angle = |d: Vec3| d.y.atan2(d.x);
    angle(d - c) - angle(b - a)
}

#[test]
fn a_fold_that_was_held_keeps_its_share() {
    for kind in KINDS.into_iter().take(2) {
        let share = kept_fold(kind);
        assert!((share - 0.5).abs() < 0.02, "{kind:?}: {share}");
    }
}

fn kept_fold(kind: Kind) -> f64 {
    let material = Material {
        relaxed_fraction: [0.0, 0.5],
        relaxation_time: 0.1,
        poisson: 0.0,
        ..Material::default()
    };
    let (cloth, _) = strip(kind, 0.2, 0.05, 8, material);
    let mut builder = SystemBuilder::new("strip", &cloth).unwrap();
    builder.control.gravity = Vec3::zeros();
    let mut system = builder.build();
    let mut state = State::at_rest(&system, cloth.positions.clone());
    let k = 5.0;
    for x in &mut state.positions {
        *x = Vec3::new((k * x.x).sin() / k, (1.0 - (k * x.x).cos()) / k, x.z);
    }
    let held = turn(&state, &cloth);
    system = system.with(|builder| {
        builder.pinned.fill(true);
    });
    run(&system, &mut state, MethodKind::ImplicitEuler, 0.01, 1.0);
    system = system.with(|builder| {
        builder.pinned.fill(false);
    });
    let mut rest = MethodSettings {
        tolerance: Some(1e-7),
        ..MethodKind::Rest.into()
    }
    .build()
    .unwrap();
    while !rest.finished() {
        rest.advance(&system, &mut state, 0.0).unwrap();
    }
    turn(&state, &cloth) / held
}

#[test]
fn viscosity_damps_stretching_at_its_rate() {
    // The lowest stretching of a free strip, w = pi/L sqrt(Y / rho); eta damps its amplitude by
    // exp(-eta (pi / L)^2 t / (2 rho)), stiffness damping by exp(-beta w^2 t / 2).
    let wave = std::f64::consts::PI / (0.2 + 0.1 / 7.5);
    let plain = Material {
        poisson: 0.0,
        stretch: [200.0, 200.0],
        ..Material::default()
    };
    let viscous = Material {
        viscosity: 0.0125,
        ..plain.clone()
    };
    let damped = Material {
        stiffness_damping: 6.25e-5,
        ..plain.clone()
    };
    let kept = |material: &Material, kind: MethodKind, step: f64| {
        let (cloth, system, mut state) = free_strip(material.clone());
        let start = cloth.positions[0].x;
        for (x, rest) in state.positions.iter_mut().zip(&cloth.positions) {
            x.x -= 1e-4 * (wave * (rest.x - start)).cos();
        }
        // Ten whole periods: what is left is the amplitude.
        let period = 2.0 * std::f64::consts::PI / (wave * (200.0f64 / 0.2).sqrt());
        let steps = (10.0 * period / step).round();
        run(
            &system,
            &mut state,
            kind,
            10.0 * period / steps,
            10.0 * period,
        );
        (stretch(&cloth, &state.positions), 10.0 * period)
    };
    for (kind, step) in [
        (MethodKind::VelocityVerlet, 1e-4),
        (MethodKind::RungeKutta4, 1e-4),
        (MethodKind::ImplicitMidpoint, 5e-5),
    ] {
        let (free, time) = kept(&plain, kind, step);
        let expected = (-0.0125 * wave * wave * time / (2.0 * 0.2)).exp();
        for material in [&viscous, &damped] {
            let ratio = kept(material, kind, step).0 / free;
            assert!(
                (ratio / expected - 1.0).abs() < 0.03,
                "{kind:?} {ratio} {expected}"
            );
        }
    }
}

#[test]
fn viscous_bending_brings_a_swinging_strip_to_rest_and_no_rigid_turn_is_damped() {
    let material = Material {
        bend_viscosity: 2e-6,
        ..Material::default()
    };
    // A rolled strip, turning rigidly: its speed stays.
    let (_, system, mut state) = free_strip(material.clone());
    for (x, v) in state.positions.iter_mut().zip(&mut state.velocities) {
        *v = Vec3::new(-x.y, x.x - 0.1, 0.0) * 2.0;
    }
    let before = state.kinetic_energy(&system);
    run(&system, &mut state, MethodKind::ImplicitMidpoint, 1e-3, 0.2);
    assert!((state.kinetic_energy(&system) / before - 1.0).abs() < 2e-3);
    // A clamped one swings out.
    let (cloth, pins) = strip(Kind::Right, 0.2, 0.05, 8, material);
    let mut builder = SystemBuilder::new("strip", &cloth).unwrap();
    for pin in pins {
        builder.pinned[pin as usize] = true;
    }
    let system = builder.build();
    let mut energies = Vec::new();
    let mut state = State::at_rest(&system, cloth.positions.clone());
    for _ in 0..2 {
        run(&system, &mut state, MethodKind::ImplicitMidpoint, 2e-3, 1.0);
        energies.push(state.kinetic_energy(&system));
    }
    assert!(energies[1] < 0.5 * energies[0], "{energies:?}");
}
