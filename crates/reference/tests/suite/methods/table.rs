//! One table over every method: what all of them promise.

use crate::methods::fixtures::{ball, cloth, hanging_square, method, shake, sheet};
use toile_drape::{
    DrapeError, Material, MethodKind, MethodSettings, State, System, Workspace, residual,
};
use toile_geometry::Vec3;

/// Substeps that keep the explicit methods stable on the small cloths at 1/60 s.
const SUBSTEPS: u32 = 40;

fn substeps(kind: MethodKind) -> u32 {
    match kind.stability_limit() {
        // Forward Euler grows by h w^2 / 2 a second: over these short runs this many hold it.
        Some(0.0) => 10 * SUBSTEPS,
        Some(_) => SUBSTEPS,
        None => 1,
    }
}

fn by_vertex(kind: MethodKind) -> bool {
    matches!(
        kind,
        MethodKind::VertexBlockDescent | MethodKind::ChebyshevBlockDescent
    )
}

fn in_time() -> impl Iterator<Item = (&'static str, MethodKind)> {
    MethodKind::ALL
        .into_iter()
        .filter(|(_, kind)| !kind.is_equilibrium())
}

/// That two states are equal to the last bit, naming the first vertex that is not.
fn assert_same(name: &str, a: &State, b: &State) {
    let moved = a
        .positions
        .iter()
        .zip(&b.positions)
        .position(|(a, b)| a != b);
    assert_eq!(moved, None, "{name}: first vertex elsewhere");
    assert!(a == b, "{name}: states differ in more than place");
}

fn momentum(system: &System, state: &State) -> Vec3 {
    let pairs = state.velocities.iter().zip(&system.rest.mass);
    pairs.map(|(v, m)| v * *m).sum()
}

/// Height fallen after `n` steps of `h` from rest.
fn fallen(kind: MethodKind, h: f64, n: u32) -> f64 {
    let n = f64::from(n);
    let unit = 9.81 * h * h / 2.0;
    match kind {
        MethodKind::ForwardEuler => unit * n * (n - 1.0),
        MethodKind::VelocityVerlet
        | MethodKind::PatchVerlet
        | MethodKind::RungeKutta4
        | MethodKind::ImplicitMidpoint => unit * n * n,
        // One step of implicit Euler, then the recurrence of the formula itself.
        MethodKind::Bdf2 => {
            let (mut before, mut now) = ([0.0, 0.0], [2.0 * unit, 2.0 * unit / h]);
            for _ in 1..n as u32 {
                let v = (2.0 * h * 9.81 + 4.0 * now[1] - before[1]) / 3.0;
                let x = (2.0 * h * v + 4.0 * now[0] - before[0]) / 3.0;
                before = std::mem::replace(&mut now, [x, v]);
            }
            now[0]
        }
        _ => unit * n * (n + 1.0),
    }
}

#[test]
fn a_free_sheet_falls_as_the_method_says() {
    for (name, kind) in in_time() {
        let mesh = sheet([4, 4], [0.2, 0.2], |u, v| Vec3::new(u, 0.0, v));
        let (system, mut state) = cloth(&mesh, Material::default());
        let steps = 10;
        let mut method = method(kind, substeps(kind));
        for _ in 0..steps {
            method
                .advance(&system, &mut state, 0.005)
                .unwrap_or_else(|error| panic!("{name}: {error}"));
        }
        let h = 0.005 / f64::from(substeps(kind));
        let expected = fallen(kind, h, steps * substeps(kind));
        for x in &state.positions {
            assert!((x.y + expected).abs() < 2e-8, "{name}: {} {expected}", x.y);
        }
        assert!((state.time - 0.05).abs() < 1e-12, "{name}: {}", state.time);
    }
}

#[test]
fn momentum_is_kept_in_free_flight() {
    for (name, kind) in in_time() {
        let mesh = sheet([5, 5], [0.2, 0.2], |u, v| Vec3::new(u, 0.0, v));
        let (mut system, mut state) = cloth(&mesh, Material::default());
        system.control.gravity = Vec3::zeros();
        shake(&system, &mut state, 2e-3);
        for (v, velocity) in state.velocities.iter_mut().enumerate() {
            *velocity = Vec3::new(0.3, 0.1, -0.2) + Vec3::y() * (0.05 * v as f64).sin();
        }
        let before = momentum(&system, &state);
        // Vertex by vertex, momentum is kept only as far as the sweeps have converged.
        let settings = MethodSettings {
            substeps: Some(substeps(kind)),
            iterations: by_vertex(kind).then_some(5000),
            tolerance: by_vertex(kind).then_some(1e-8),
            ..kind.into()
        };
        let mut method = toile_reference::build(&settings).expect("a method that there is");
        for _ in 0..20 {
            method
                .advance(&system, &mut state, 0.004)
                .unwrap_or_else(|error| panic!("{name}: {error}"));
        }
        let off = (momentum(&system, &state) - before).norm() / before.norm();
        // Iterative methods keep it to their tolerance of 1e-8 N over 80 ms, XPBD to the rounding
        // of single precision.
        let most = if kind == MethodKind::Xpbd { 1e-5 } else { 1e-6 };
        assert!(off < most, "{name}: {off}");
    }
}

#[test]
fn numbers_that_are_none_are_refused_by_vertex() {
    for (name, kind) in MethodKind::ALL {
        for (bad, value) in [(17usize, f64::NAN), (30, f64::INFINITY)] {
            let (system, mut state) = hanging_square();
            state.velocities[bad].y = value;
            let mut method = method(kind, 2);
            let error = method.advance(&system, &mut state, 0.01);
            assert!(
                matches!(error, Err(DrapeError::NotFinite { vertex, .. }) if vertex == bad),
                "{name}: {error:?}"
            );
            // Nothing is left behind in the method.
            state.velocities[bad].y = 0.0;
            method
                .advance(&system, &mut state, 1e-4)
                .unwrap_or_else(|error| panic!("{name}: {error}"));
        }
    }
}

#[test]
fn steps_far_too_large_end_sound_or_say_so() {
    for (name, kind) in MethodKind::ALL {
        for step in [0.3, 1e3] {
            let (system, mut state) = hanging_square();
            shake(&system, &mut state, 0.02);
            let mut method = method(kind, 1);
            for _ in 0..10 {
                let before = state.clone();
                match method.advance(&system, &mut state, step) {
                    Ok(_) => {
                        assert_eq!(state.first_not_finite(), None, "{name}");
                        let longest = state.positions.iter().map(Vec3::norm).fold(0.0, f64::max);
                        assert!(longest < 100.0, "{name}: {longest} m away");
                    }
                    Err(error) => {
                        assert_same(name, &state, &before);
                        let text = error.to_string();
                        assert!(text.len() > 20, "{name}: {text}");
                        break;
                    }
                }
            }
        }
    }
}

/// A cloth with everything in it: pins, elastics, a ball with friction, drag.
fn busy() -> (System, State) {
    let mesh = sheet([20, 20], [0.24, 0.24], |u, v| {
        Vec3::new(u - 0.12, 0.1035 + 0.02 * u, v - 0.1)
    });
    let material = Material {
        stretch: [40.0, 30.0],
        shear: 8.0,
        ..Material::default()
    };
    let (mut system, mut state) = cloth(&mesh, material);
    system = system.with(|builder| {
        builder.colliders = vec![ball(0.1)];
    });
    system.control.air_drag = 1.0;
    system = system.with(|builder| {
        builder.pinned[0] = true;
    });
    let law = toile_drape::laws::elastic::ElasticLaw {
        stiffness: 5.0,
        largest_force: 0.05,
    };
    system = system.with(|builder| {
        builder.elastics = vec![
            toile_drape::Elastic {
                from: 20,
                to: toile_drape::ElasticEnd::Point(Vec3::new(0.2, 0.2, -0.1)),
                law,
            },
            toile_drape::Elastic {
                from: 420,
                to: toile_drape::ElasticEnd::Vertex(440),
                law,
            },
        ];
    });
    shake(&system, &mut state, 1e-4);
    (system, state)
}

/// Cloth folded over itself, a layer and a half thick, pressed down by its weight.
fn folded() -> (System, State) {
    let mesh = sheet([16, 16], [0.16, 0.16], |u, v| Vec3::new(u, 0.0, v));
    let (mut system, mut state) = cloth(&mesh, Material::default());
    system = system.with(|builder| {
        builder.colliders = vec![ball(0.1)];
        builder.contact.cloth_offset = 2e-3;
    });
    for place in &mut state.positions {
        let over = place.z > 0.085;
        place.z = if over { 0.17 - place.z } else { place.z } - 0.06;
        place.y = if over { 0.1055 } else { 0.103 };
        place.x -= 0.08;
    }
    shake(&system, &mut state, 1e-4);
    (system, state)
}

/// A model at its start, and what steps it.
type Case = ((System, State), Vec<(&'static str, MethodKind)>);

/// Everything with every method; cloth on cloth with those that have it, `rest` or not.
fn cases(rest: bool) -> [Case; 2] {
    let touching = MethodKind::ALL.into_iter().filter(|(_, kind)| match kind {
        MethodKind::Xpbd | MethodKind::ImplicitEuler | MethodKind::Bdf2 => true,
        MethodKind::Rest => rest,
        _ => false,
    });
    [
        (busy(), MethodKind::ALL.to_vec()),
        (folded(), touching.collect()),
    ]
}

/// Steps a state.
fn go(system: &System, state: &mut State, (name, kind): (&str, MethodKind), steps: usize) {
    let mut method = method(kind, substeps(kind));
    for _ in 0..steps {
        let done = method.advance(system, state, 0.004);
        done.unwrap_or_else(|error| panic!("{name}: {error}"));
    }
    if system.contact.cloth_offset > 0.0 {
        let mut contacts = toile_drape::Contacts::default();
        contacts.refresh(system, state, &state.positions);
        assert!(
            contacts.cloth.contacts.len() > 100,
            "{name}: cloth lies on cloth"
        );
    }
}

#[test]
fn a_saved_state_goes_on_with_a_fresh_method_to_the_same_bytes() {
    // The way to rest keeps the places of pairs that touched once in its matrix: with cloth on cloth
    // it goes on to the same shape, not to the same rounding.
    for ((system, start), methods) in cases(false) {
        for (name, kind) in methods {
            let mut state = start.clone();
            go(&system, &mut state, (name, kind), 4);
            let mut resumed = start.clone();
            for part in 0..2 {
                go(&system, &mut resumed, (name, kind), 2);
                assert!(resumed != start, "{name} moved by part {part}");
            }
            assert_same(name, &state, &resumed);
        }
    }
}

#[test]
fn thread_counts_give_the_same_bytes() {
    for ((system, start), methods) in cases(true) {
        for (name, kind) in methods {
            // On the way to rest the crease springs open before the fold comes down.
            let steps = match kind {
                MethodKind::Rest => 6,
                _ => 3,
            };
            let run = |threads: usize| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
                let pool = pool.build().expect("threads can be made");
                pool.install(|| {
                    let mut state = start.clone();
                    go(&system, &mut state, (name, kind), steps);
                    state
                })
            };
            let one = run(1);
            assert_same(name, &one, &run(2));
            assert_same(name, &one, &run(3));
        }
    }
}

#[test]
fn a_hanging_strip_comes_to_the_same_rest() {
    let strip = || {
        let mesh = sheet([2, 8], [0.04, 0.16], |u, v| Vec3::new(u, -v, 0.0));
        let material = Material {
            stretch: [30.0, 30.0],
            shear: 6.0,
            ..Material::default()
        };
        let (mut system, mut state) = cloth(&mesh, material);
        system = system.with(|builder| {
            builder.pinned[..3].fill(true);
        });
        system.control.air_drag = 8.0;
        shake(&system, &mut state, 1e-4);
        (system, state)
    };
    let run = |name: &str, kind: MethodKind| {
        let (system, mut state) = strip();
        // Midpoint damps a vibration the less the more of it there is in a step: eight substeps.
        let count = match kind {
            MethodKind::ImplicitMidpoint => 8,
            _ => substeps(kind) / 2,
        };
        let mut method = method(kind, count);
        for _ in 0..3000 {
            method
                .advance(&system, &mut state, 1.0 / 120.0)
                .unwrap_or_else(|error| panic!("{name}: {error}"));
            let quiet = state.kinetic_energy(&system) < 1e-14;
            if method.finished() || quiet && state.time > 1.0 {
                break;
            }
        }
        let left = residual(&system, &state, &mut Workspace::default());
        assert!(left < 2e-3, "{name}: residual {left}");
        state.positions
    };
    let expected = run("rest", MethodKind::Rest);
    for (name, kind) in MethodKind::ALL {
        // Forward Euler's growth must stay below what drag takes: it needs a finer step.
        // What one sweep of XPBD leaves is no force balance: its own tests hold it to Newton's rest.
        if matches!(kind, MethodKind::ForwardEuler | MethodKind::Xpbd) {
            continue;
        }
        let got = run(name, kind);
        let off = got
            .iter()
            .zip(&expected)
            .map(|(a, b)| (a - b).norm())
            .fold(0.0, f64::max);
        assert!(off < 2e-4, "{name}: {off} m from the rest of Newton");
    }
}
