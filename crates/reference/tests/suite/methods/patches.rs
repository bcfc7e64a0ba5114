//! Patch Verlet beyond what it shares with the other methods.

use crate::methods::fixtures::{ball, cloth, hanging_square, method, shake, sheet};
use toile_drape::{Material, MethodKind, State, System, residual};
use toile_geometry::Vec3;

/// A soft cloth falling onto a ball.
fn onto_a_ball(cells: usize) -> (System, State) {
    let mesh = sheet([cells, cells], [0.24, 0.24], |u, v| {
        Vec3::new(u - 0.12, 0.1045, v - 0.12)
    });
    let material = Material {
        stretch: [40.0, 30.0],
        shear: 8.0,
        friction: 0.4,
        ..Material::default()
    };
    let (mut system, state) = cloth(&mesh, material);
    system = system.with(|builder| {
        builder.colliders = vec![ball(0.1)];
    });
    system.control.air_drag = 1.0;
    (system, state)
}

fn after(kind: MethodKind, substeps: u32, (system, mut state): (System, State)) -> State {
    let mut method = method(kind, substeps);
    for _ in 0..6 {
        let step = method.advance(&system, &mut state, 0.01);
        let report = step.unwrap_or_else(|error| panic!("{}: {error}", kind.name()));
        assert_eq!(report.iterations, substeps as usize, "as many as asked for");
    }
    state
}

fn farthest(a: &State, b: &State) -> f64 {
    let pairs = a.positions.iter().zip(&b.positions);
    pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
}

#[test]
fn it_goes_where_velocity_verlet_goes() {
    let shaken = || {
        let (system, mut state) = hanging_square();
        shake(&system, &mut state, 1e-3);
        (system, state)
    };
    let exact = after(MethodKind::VelocityVerlet, 1600, shaken());
    let [coarse, fine] =
        [100, 200].map(|n| farthest(&after(MethodKind::PatchVerlet, n, shaken()), &exact));
    assert!(fine < 2e-5 && coarse > 3.0 * fine, "{coarse:e} {fine:e}");
}

#[test]
fn contact_and_friction_are_velocity_verlets() {
    let exact = after(MethodKind::VelocityVerlet, 1600, onto_a_ball(24));
    let got = after(MethodKind::PatchVerlet, 1600, onto_a_ball(24));
    let touching = exact.solid_friction.len();
    assert!(touching > 8, "{touching}");
    // Planes are a quarter of a millimetre old at the most, and friction knows the force of now.
    let off = farthest(&got, &exact);
    assert!(off < 5e-5, "{off:e}");
}

#[test]
fn a_cut_cloth_gives_the_same_bytes_on_any_number_of_threads() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads can be made");
        pool.install(|| {
            let (system, mut state) = onto_a_ball(60);
            let mut method = toile_reference::build(&MethodKind::PatchVerlet.into())
                .expect("a method that there is");
            for _ in 0..3 {
                method
                    .advance(&system, &mut state, 1.0 / 60.0)
                    .unwrap_or_else(|error| panic!("{error}"));
            }
            state
        })
    };
    let one = run(1);
    assert!(one == run(2));
    assert!(one == run(3));
}

#[test]
fn what_it_does_not_treat_is_left_to_velocity_verlet() {
    let viscous = || {
        let mesh = sheet([6, 6], [0.3, 0.3], |u, v| Vec3::new(u, 1.0 - v, 0.0));
        let material = Material {
            stretch: [60.0, 50.0],
            shear: 15.0,
            viscosity: 0.05,
            ..Material::default()
        };
        let (mut system, mut state) = cloth(&mesh, material);
        system = system.with(|builder| {
            builder.pinned[..7].fill(true);
        });
        shake(&system, &mut state, 1e-3);
        (system, state)
    };
    let [a, b] = [MethodKind::PatchVerlet, MethodKind::VelocityVerlet]
        .map(|kind| after(kind, 60, viscous()));
    assert!(a == b);
}

#[test]
fn cloth_comes_to_rest_on_a_ball() {
    let (mut system, mut state) = onto_a_ball(24);
    system.control.air_drag = 12.0;
    let mut method =
        toile_reference::build(&MethodKind::PatchVerlet.into()).expect("a method that there is");
    for _ in 0..240 {
        method
            .advance(&system, &mut state, 1.0 / 60.0)
            .unwrap_or_else(|error| panic!("{error}"));
    }
    let left = residual(&system, &state, &mut toile_drape::Workspace::default());
    assert!(left < 2e-2, "{left}");
}

#[test]
fn a_pull_that_stiffens_the_cloth_gets_more_substeps() {
    let (system, mut state) = hanging_square();
    let mut method =
        toile_reference::build(&MethodKind::PatchVerlet.into()).expect("a method that there is");
    let mut still = state.clone();
    let few = method
        .advance(&system, &mut still, 1.0 / 60.0)
        .expect("stable");
    // A throw that draws the cloth out by half.
    for v in &mut state.velocities[7..] {
        *v = Vec3::new(0.0, -6.0, 0.0);
    }
    let mut most = 0;
    for _ in 0..10 {
        let step = method.advance(&system, &mut state, 1.0 / 60.0);
        most = most.max(step.expect("stable").iterations);
    }
    assert!(most as f64 > 1.2 * few.iterations as f64, "{most} {few:?}");
}
