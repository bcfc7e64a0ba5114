//! Viscosity of XPBD (Kelvin-Voigt) against closed forms, at the default substep and at fine ones.

use crate::strips::{KINDS, Kind, strip};
use toile_drape::{
    Cloth, DrapeError, Material, MethodKind, MethodSettings, State, System, SystemBuilder,
};
use toile_geometry::Vec3;

/// The default substep and its tolerance; and one a quarter as long. In much finer ones single precision loses
/// displacements of constraints beside the size of the strip.
const SUBSTEPS: [(f64, f64); 2] = [(1.0 / 1200.0, 0.05), (1.0 / 4800.0, 0.01)];

fn near(what: &str, got: f64, expected: f64, share: f64) {
    let error = (got / expected - 1.0).abs();
    println!("{what}: {got:.6} for {expected:.6}, {:.3} %", 1e2 * error);
    assert!(error <= share, "{what}: {got} {expected}");
}

fn run(system: &System, state: &mut State, step: f64, time: f64) {
    let mut method =
        toile_reference::build(&MethodKind::Xpbd.into()).expect("a method that there is");
    for _ in 0..(time / step).round() as usize {
        method.advance(system, state, step).unwrap();
    }
}

/// A strip along the first axis, 10 cm wide in eight cells, clamped at its beginning.
fn clamped(kind: Kind, length: f64, material: Material) -> (Cloth, System) {
    let (cloth, pins) = strip(kind, length, 0.1, 8, material);
    let mut builder = SystemBuilder::new("strip", &cloth).unwrap();
    builder.control.gravity = Vec3::zeros();
    for pin in pins {
        builder.pinned[pin as usize] = true;
    }
    (cloth, builder.build())
}

/// Mean along an axis over the vertices at the free end (m).
fn end(cloth: &Cloth, state: &State, axis: usize) -> f64 {
    let far = cloth.positions.iter().map(|x| x.x).fold(0.0, f64::max);
    let at: Vec<_> = (0..cloth.positions.len())
        .filter(|&v| cloth.positions[v].x > far - 1e-9)
        .collect();
    at.iter().map(|&v| state.positions[v][axis]).sum::<f64>() / at.len() as f64
}

/// Logarithm of the ratio of one swing to the next, half a period later, from the tops of a course in time.
fn decrement(course: &[f64]) -> f64 {
    let mut tops = Vec::new();
    for near in course.windows(3) {
        let [before, top, after] = [near[0], near[1], near[2]];
        if top.abs() > before.abs() && top.abs() >= after.abs() {
            // The top of the parabola through three places.
            let bow = after - 2.0 * top + before;
            tops.push((top - (after - before).powi(2) / (8.0 * bow)).abs());
        }
    }
    let count = (tops.len() - 1).min(2);
    (tops[0] / tops[count]).ln() / count as f64
}

/// How far the end is from its rest along an axis one step before the start, at it and after each step (m); the motion
/// before the start is that after it mirrored in time.
fn course(
    (cloth, system): &(Cloth, System),
    mut state: State,
    axis: usize,
    (kind, [step, time]): (MethodKind, [f64; 2]),
) -> Vec<f64> {
    let rest = end(
        cloth,
        &State::at_rest(system, cloth.positions.clone()),
        axis,
    );
    let start = end(cloth, &state, axis) - rest;
    let settings = MethodSettings {
        substeps: (kind == MethodKind::Xpbd).then_some(1),
        ..kind.into()
    };
    let mut method = toile_reference::build(&settings).expect("a method that there is");
    let mut after_step = |_| {
        method.advance(system, &mut state, step).unwrap();
        end(cloth, &state, axis) - rest
    };
    let after: Vec<f64> = (0..(time / step) as usize).map(&mut after_step).collect();
    [&[after[0], start], &after[..]].concat()
}

/// The first stretching of a strip held at one end is x'' + 2 z w x' + w^2 x = 0: it swings out with the decrement
/// pi z / sqrt(1 - z^2), or creeps back at the rate w (z - sqrt(z^2 - 1)).
#[test]
fn a_stretched_strip_swings_out_or_creeps_back_by_kelvin_and_voigts_law() {
    let (stretch, density, length, cells): (f64, f64, f64, f64) = (20.0, 0.2, 0.6, 7.0);
    // A quarter of a wave over the cells between the clamp and the end, in linear elements with lumped masses.
    let edge: f64 = length / 7.5;
    let angle = 0.5 * std::f64::consts::FRAC_PI_2 / cells;
    let frequency = 2.0 * (stretch / density).sqrt() / edge * angle.sin();
    // Small strains, by the closed form; larger ones, by the classical Runge-Kutta method in double precision.
    for (ratio, proportional) in [(0.4f64, false), (0.4, true), (1.5, false), (1.5, true)] {
        let time = 2.0 * ratio / frequency;
        let material = Material {
            density,
            stretch: [stretch; 2],
            shear: 10.0,
            poisson: 0.0,
            // Too stiff to buckle where it is pressed.
            bend: [4e-3; 3],
            viscosity: if proportional { 0.0 } else { stretch * time },
            stiffness_damping: if proportional { time } else { 0.0 },
            ..Material::default()
        };
        let strip = clamped(Kind::Right, length, material);
        let measured = |kind: MethodKind, amplitude: f64, step: f64| {
            let mut state = State::at_rest(&strip.1, strip.0.positions.clone());
            for x in &mut state.positions {
                let cell = (x.x / edge - 0.5).max(0.0);
                x.x += amplitude * (2.0 * angle * cell).sin();
            }
            if ratio < 1.0 {
                return decrement(&course(&strip, state, 0, (kind, [step, 0.2])));
            }
            // Between times at which the faster of the two rates has died out.
            let [from, to] = [2.0, 4.0].map(|t| (t / frequency / step) as usize);
            let places = course(&strip, state, 0, (kind, [step, 5.0 / frequency]));
            (places[from] / places[to]).ln() / ((to - from) as f64 * step)
        };
        let root = (1.0 - ratio * ratio).abs().sqrt();
        let small = match ratio < 1.0 {
            true => std::f64::consts::PI * ratio / root,
            false => frequency * (ratio - root),
        };
        let exact = measured(MethodKind::RungeKutta4, 1e-3, 5e-5);
        near(
            &format!("damping ratio {ratio}, Runge-Kutta"),
            exact,
            small,
            0.01,
        );
        let large = measured(MethodKind::RungeKutta4, 0.04, 5e-5);
        for (step, share) in SUBSTEPS {
            let got = measured(MethodKind::Xpbd, 0.04, step);
            near(
                &format!("damping ratio {ratio}, substep {step:.1e} s"),
                got,
                large,
                share,
            );
        }
    }
}

#[test]
fn a_bent_strip_swings_out_at_the_rate_of_its_viscosity() {
    let (length, bend, density): (f64, f64, f64) = (0.3, 2e-2, 0.2);
    // The first mode of a cantilever (Euler and Bernoulli): w = 3.516 sqrt(D / rho) / L^2.
    let frequency = 3.516_015 * (bend / density).sqrt() / (length * length);
    for (step, share) in SUBSTEPS {
        for proportional in [false, true] {
            let time = 0.1 / frequency;
            let strip = clamped(
                Kind::Right,
                length,
                Material {
                    density,
                    stretch: [20.0; 2],
                    shear: 10.0,
                    bend: [bend; 3],
                    poisson: 0.0,
                    bend_viscosity: if proportional { 0.0 } else { bend * time },
                    stiffness_damping: if proportional { time } else { 0.0 },
                    ..Material::default()
                },
            );
            let mut state = State::at_rest(&strip.1, strip.0.positions.clone());
            for (x, v) in state.positions.iter().zip(&mut state.velocities) {
                v.y = 0.02 * (x.x.max(0.0) / length).powi(2);
            }
            let periods = 4.2 * std::f64::consts::TAU / frequency;
            let places = course(&strip, state, 1, (MethodKind::Xpbd, [step, periods]));
            // The first swing has other modes in it.
            let calm = places.len() / 6;
            let ratio = 0.5 * frequency * time;
            let expected = std::f64::consts::PI * ratio / (1.0 - ratio * ratio).sqrt();
            near(
                &format!("bending, step {step:.4} s"),
                decrement(&places[calm..]),
                expected,
                share,
            );
        }
    }
}

#[test]
fn viscosity_gives_no_momentum_and_leaves_a_rolled_sheet_turning() {
    let material = Material {
        viscosity: 0.05,
        bend_viscosity: 2e-6,
        ..Material::default()
    };
    let (cloth, _) = strip(Kind::Delaunay, 0.2, 0.1, 8, material);
    let mut builder = SystemBuilder::new("strip", &cloth).unwrap();
    builder.control.gravity = Vec3::zeros();
    let system = builder.build();
    // Rolled to two thirds of a turn of 5 cm, at rest in that shape.
    let rolled = |k: f64| {
        let place = |x: &Vec3| Vec3::new((k * x.x).sin() / k, (1.0 - (k * x.x).cos()) / k, x.z);
        cloth.positions.iter().map(place).collect::<Vec<_>>()
    };
    let mut state = State::at_rest(&system, rolled(20.0));
    let mass: f64 = system.rest.mass.iter().sum();
    let terms = state.positions.iter().zip(&system.rest.mass);
    let middle: Vec3 = terms.map(|(x, m)| x * *m).sum::<Vec3>() / mass;
    let turn = Vec3::new(0.0, 0.0, 3.0);
    for (x, v) in state.positions.iter().zip(&mut state.velocities) {
        *v = Vec3::new(1.0, 0.5, 0.0) + turn.cross(&(x - middle));
    }
    let momentum = |state: &State| {
        let terms = state.velocities.iter().zip(&system.rest.mass);
        terms.map(|(v, m)| v * *m).sum::<Vec3>()
    };
    let spin = |state: &State| {
        let terms = state.positions.iter().zip(&state.velocities);
        let about = terms
            .zip(&system.rest.mass)
            .map(|((x, v), m)| x.cross(v) * *m);
        about.sum::<Vec3>() - middle.cross(&momentum(state))
    };
    let start = (momentum(&state), spin(&state));
    // It uncoils and vibrates out meanwhile; what is left is the motion as a whole.
    run(&system, &mut state, 1.0 / 60.0, 0.5);
    let lost = (momentum(&state) - start.0).norm() / start.0.norm();
    println!("momentum lost: {lost:.2e}");
    assert!(lost < 5e-3, "{lost}");
    let moved = start.0 * 0.5 / mass;
    let spin = spin(&state) - moved.cross(&momentum(&state));
    let lost = (spin - start.1).norm() / start.1.norm();
    println!("spin lost: {lost:.2e}");
    assert!(lost < 0.02, "{lost}");
}

#[test]
fn viscosity_at_any_size_is_stable_or_refused_by_name() {
    let (mut taken, mut refused) = (0, 0);
    for (power, kind) in (-3..7).flat_map(|power| KINDS.map(|kind| (power, kind))) {
        let viscosity = 10f64.powi(power);
        let material = Material {
            viscosity,
            bend_viscosity: 1e-4 * viscosity,
            ..Material::default()
        };
        let (cloth, system) = clamped(kind, 0.3, material);
        let mut state = State::at_rest(&system, cloth.positions.clone());
        for (k, v) in (0..).map(f64::from).zip(&mut state.velocities) {
            *v = Vec3::new((7.1 * k).sin(), (3.3 * k).cos(), (5.7 * k).sin());
        }
        let start = state.kinetic_energy(&system);
        let mut method =
            toile_reference::build(&MethodKind::Xpbd.into()).expect("a method that there is");
        match (0..10).try_for_each(|_| method.advance(&system, &mut state, 1.0 / 60.0).map(drop)) {
            Ok(()) => {
                taken += 1;
                let end = state.kinetic_energy(&system);
                assert!(end < 0.9 * start, "{viscosity}: {end} of {start}");
            }
            Err(DrapeError::Scene { place, remedy, .. }) => {
                refused += 1;
                assert!(
                    place == "viscosity" && remedy.contains("substeps"),
                    "{remedy}"
                );
                assert_eq!(state.time, 0.0);
            }
            Err(other) => panic!("{other}"),
        }
    }
    assert!(taken > 2 && refused > 2, "{taken} {refused}");
}
