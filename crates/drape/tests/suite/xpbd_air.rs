//! The air on triangles of XPBD against closed forms, at the default substep and at fine ones.

use crate::support::strips::{KINDS, Kind, strip};
use toile_drape::{Air, Material, MethodKind, MethodSettings, State, System, SystemBuilder};
use toile_geometry::Vec3;

/// A frame of the default method, cut into twenty substeps, and its tolerance; and steps a tenth as long.
const STEPS: [(f64, f64); 2] = [(1.0 / 60.0, 0.05), (1.0 / 600.0, 0.01)];

/// A flat strip 0.2 x 0.05 m in the plane y = 0, free, without gravity, in some air.
fn sheet(kind: Kind, density: f64, air: Air) -> (System, State) {
    let material = Material {
        density,
        ..Material::default()
    };
    let (cloth, _) = strip(kind, 0.2, 0.05, 8, material);
    let mut builder = SystemBuilder::new("strip", &cloth).unwrap();
    builder.control.gravity = Vec3::zeros();
    builder.control.air = air;
    let system = builder.build();
    let state = State::at_rest(&system, cloth.positions);
    (system, state)
}

fn run(system: &System, state: &mut State, step: f64, time: f64) {
    let mut method = MethodSettings::from(MethodKind::Xpbd)
        .build()
        .expect("a method that there is");
    for _ in 0..(time / step).round() as usize {
        method.advance(system, state, step).unwrap();
    }
}

fn momentum(system: &System, state: &State) -> Vec3 {
    let terms = state.velocities.iter().zip(&system.rest.mass);
    terms.map(|(v, m)| v * *m).sum()
}

/// Mean velocity (m/s).
fn velocity(system: &System, state: &State) -> Vec3 {
    momentum(system, state) / system.rest.mass.iter().sum::<f64>()
}

fn near(what: &str, got: f64, expected: f64, share: f64) {
    let error = (got / expected - 1.0).abs();
    println!("{what}: {got:.6} for {expected:.6}, {:.3} %", 1e2 * error);
    assert!(error <= share, "{what}: {got} {expected}");
}

#[test]
fn a_sheet_that_falls_reaches_the_terminal_velocity_across_and_along_in_wind_and_without() {
    let wind = Vec3::new(0.7, 1.1, -0.4);
    for (step, share) in STEPS {
        for wind in [Vec3::zeros(), wind] {
            for (direction, gravity) in [("across", Vec3::y()), ("along", Vec3::x())] {
                let air = Air {
                    density: Air::SEA_LEVEL,
                    tangential: 0.5,
                    wind,
                    ..Air::default()
                };
                let (mut system, mut state) = sheet(Kind::Delaunay, 0.1, air);
                system.control.gravity = gravity * -9.81;
                let coefficient = if gravity.y > 0.0 {
                    air.normal
                } else {
                    air.tangential
                };
                let fall = (2.0 * 0.1 * 9.81 / (air.density * coefficient)).sqrt();
                run(&system, &mut state, step, 2.0);
                // Relative to the wind it falls as in still air; the wind across or along has carried it.
                let relative = (velocity(&system, &state) - wind).dot(&gravity);
                near(
                    &format!("{direction}, step {step:.4} s"),
                    -relative,
                    fall,
                    share,
                );
            }
        }
    }
}

#[test]
fn a_sheet_at_rest_is_carried_by_the_wind_in_the_time_of_the_law() {
    for (step, share) in STEPS {
        for (wind, coefficient) in [(Vec3::y() * 3.0, 1.2), (Vec3::x() * 3.0, 0.5)] {
            let air = Air {
                density: Air::SEA_LEVEL,
                tangential: 0.5,
                wind,
                ..Air::default()
            };
            let (system, mut state) = sheet(Kind::Alternating, 0.2, air);
            run(&system, &mut state, step, 0.2);
            // dw/dt = -a w^2 for the velocity w relative to the wind, a = rho C / (2 density).
            let a = Air::SEA_LEVEL * coefficient / (2.0 * 0.2);
            let expected = 3.0 - 3.0 / (1.0 + 3.0 * a * 0.2);
            let got = velocity(&system, &state).dot(&wind) / 3.0;
            near(
                &format!("C {coefficient}, step {step:.4} s"),
                got,
                expected,
                share,
            );
        }
    }
}

/// Force of the air on all triangles by the law (N).
fn force(system: &System, state: &State) -> Vec3 {
    let mut sum = Vec3::zeros();
    for triangle in &system.topology.triangles {
        let [a, b, c] = triangle.map(|v| state.positions[v as usize]);
        let normal = (b - a).cross(&(c - a));
        let pull = system
            .control
            .air
            .on(0.5 * normal.norm(), normal.normalize());
        let velocity: Vec3 = triangle.iter().map(|&v| state.velocities[v as usize]).sum();
        sum -= pull.gradient(velocity / 3.0 - system.control.air.wind);
    }
    sum
}

#[test]
fn what_the_cloth_loses_the_air_gains() {
    let air = Air {
        density: Air::SEA_LEVEL,
        tangential: 0.1,
        wind: Vec3::new(2.0, -3.0, 1.0),
        ..Air::default()
    };
    let (system, mut state) = sheet(Kind::Delaunay, 0.1, air);
    for (x, v) in state.positions.iter_mut().zip(&mut state.velocities) {
        *v = Vec3::new(3.0, 6.0 * (20.0 * x.x).sin(), -8.0 * x.x);
        x.y += 0.01 * (40.0 * x.x).sin();
    }
    let start = momentum(&system, &state);
    let settings = MethodSettings {
        substeps: Some(1),
        ..MethodKind::Xpbd.into()
    };
    let (mut method, step) = (
        settings.build().expect("a method that there is"),
        1.0 / 1200.0,
    );
    let (mut given, mut passed) = (Vec3::zeros(), 0.0);
    for _ in 0..240 {
        let impulse = force(&system, &state) * step;
        (given, passed) = (given + impulse, passed + impulse.norm());
        method.advance(&system, &mut state, step).unwrap();
    }
    let lost = (momentum(&system, &state) - start - given).norm() / passed;
    println!("momentum neither the cloth's nor the air's: {lost:.2e} of what passed");
    assert!(passed > 0.1 * start.norm() && lost < 5e-3, "{lost}");
}

#[test]
fn no_air_however_thick_and_fast_adds_energy_relative_to_it() {
    for coefficient in [1.0, 30.0, 1e3, 1e6] {
        for (density, kind) in KINDS.map(|kind| [(0.02, kind), (0.4, kind)]).concat() {
            let wind = Vec3::new(5.0, 40.0, -12.0);
            let air = Air {
                density: Air::SEA_LEVEL,
                normal: coefficient,
                tangential: 0.3 * coefficient,
                wind,
                ..Air::default()
            };
            let (system, mut state) = sheet(kind, density, air);
            for (k, v) in (0..).map(f64::from).zip(&mut state.velocities) {
                *v = Vec3::new((7.1 * k).sin(), (3.3 * k).cos(), (5.7 * k).sin());
            }
            let energy = |state: &State| {
                let relative = state.velocities.iter().map(|v| (v - wind).norm_squared());
                relative
                    .zip(&system.rest.mass)
                    .map(|(v2, m)| 0.5 * m * v2)
                    .sum::<f64>()
            };
            let start = energy(&state);
            let mut method = MethodSettings::from(MethodKind::Xpbd)
                .build()
                .expect("a method that there is");
            for frame in 0..30 {
                method.advance(&system, &mut state, 1.0 / 60.0).unwrap();
                let now = energy(&state);
                assert!(
                    now < 1.01 * start,
                    "C {coefficient}, frame {frame}: {now} {start}"
                );
            }
            let end = energy(&state);
            assert!(end < 0.5 * start, "C {coefficient}: {end} of {start}");
        }
    }
}

#[test]
fn a_sail_held_in_the_wind_bellies_as_by_an_implicit_method() {
    let air = Air {
        density: Air::SEA_LEVEL,
        wind: Vec3::y() * 4.0,
        ..Air::default()
    };
    let material = Material {
        density: 0.05,
        stretch: [12.0; 2],
        shear: 5.0,
        ..Material::default()
    };
    let (cloth, _) = strip(Kind::Alternating, 0.4, 0.2, 8, material);
    let depth = |kind: MethodKind, step: f64| {
        let mut builder = SystemBuilder::new("sail", &cloth).unwrap();
        builder.control.gravity = Vec3::zeros();
        builder.control.air = air;
        for (pinned, x) in builder.pinned.iter_mut().zip(&cloth.positions) {
            *pinned = x.x < 0.0 || x.x > 0.399;
        }
        let system = builder.build();
        let mut state = State::at_rest(&system, cloth.positions.clone());
        let mut method = MethodSettings::from(kind)
            .build()
            .expect("a method that there is");
        for _ in 0..(3.0 / step) as usize {
            method.advance(&system, &mut state, step).unwrap();
        }
        state.positions.iter().map(|x| x.y).fold(0.0, f64::max)
    };
    let expected = depth(MethodKind::ImplicitEuler, 0.02);
    assert!(expected > 0.02, "{expected}");
    near(
        "frames",
        depth(MethodKind::Xpbd, 1.0 / 60.0),
        expected,
        0.05,
    );
    near(
        "steps of 1/1200 s",
        depth(MethodKind::Xpbd, 1.0 / 1200.0),
        expected,
        0.01,
    );
}
