//! Explicit methods: the largest frequency, the limit of stability, blowing up.

use crate::methods::fixtures::{cloth, hanging_square, method, shake, sheet};
use nalgebra::DMatrix;
use toile_drape::{DrapeError, Material, MethodKind, Workspace, largest_frequency};
use toile_geometry::Vec3;

#[test]
fn the_largest_frequency_is_that_of_the_dense_matrix() {
    let mesh = sheet([4, 3], [0.08, 0.06], |u, v| Vec3::new(u, 0.0, v));
    let (mut system, state) = cloth(&mesh, Material::default());
    system = system.with(|builder| {
        builder.pinned[0] = true;
        builder.pinned[4] = true;
    });
    // K by central differences of the net force.
    let n = system.vertex_count();
    let mut workspace = Workspace::default();
    let mut dense = DMatrix::<f64>::zeros(3 * n, 3 * n);
    let step = 1e-7;
    for column in 0..3 * n {
        let (v, axis) = (column / 3, column % 3);
        let mut force = |by: f64| {
            let mut moved = state.clone();
            moved.positions[v][axis] += by;
            workspace.net_force(&system, &moved).to_vec()
        };
        let (up, down) = (force(step), force(-step));
        for row in 0..3 * n {
            let slope = (down[row / 3][row % 3] - up[row / 3][row % 3]) / (2.0 * step);
            let mass = (system.rest.mass[v] * system.rest.mass[row / 3]).sqrt();
            dense[(row, column)] = if system.prescribed.pinned[v] {
                0.0
            } else {
                slope / mass
            };
        }
    }
    let expected = (0.5 * (&dense + dense.transpose()))
        .symmetric_eigenvalues()
        .max()
        .sqrt();
    let got = largest_frequency(&system, &state);
    assert!((got - expected).abs() < 1e-5 * expected, "{got} {expected}");
}

/// Steps of 200 substeps at a share of the method's limit until failure, 20 at the most.
fn steps_survived(kind: MethodKind, share: f64) -> (usize, Option<DrapeError>) {
    let (mut system, mut state) = hanging_square();
    system.control.gravity = Vec3::zeros();
    shake(&system, &mut state, 1e-7);
    let limit = match kind.stability_limit() {
        Some(limit) if limit > 0.0 => limit,
        _ => 2.0,
    };
    let h = share * limit / largest_frequency(&system, &state);
    let mut method = method(kind, 200);
    for step in 0..20 {
        let before = state.clone();
        if let Err(error) = method.advance(&system, &mut state, 200.0 * h) {
            assert!(state == before, "the state is restored");
            return (step, Some(error));
        }
    }
    (20, None)
}

#[test]
fn explicit_methods_blow_up_within_two_per_cent_of_their_limit() {
    for (name, kind) in MethodKind::ALL {
        if kind.stability_limit().is_none_or(|limit| limit == 0.0) {
            continue;
        }
        let (steps, error) = steps_survived(kind, 0.98);
        assert_eq!(steps, 20, "{name} below its limit: {error:?}");
        let (steps, error) = steps_survived(kind, 1.02);
        assert!(steps < 20, "{name} above its limit");
        assert!(
            matches!(
                error,
                Some(DrapeError::BlownUp { .. } | DrapeError::NotFinite { .. })
            ),
            "{name}: {error:?}"
        );
    }
}

#[test]
fn forward_euler_fails_undamped_far_below_the_others_limit() {
    let (steps, error) = steps_survived(MethodKind::ForwardEuler, 0.2);
    assert!(steps < 20, "{error:?}");
}

#[test]
fn automatic_substeps_hold_a_stiff_cloth() {
    for kind in [
        MethodKind::SymplecticEuler,
        MethodKind::VelocityVerlet,
        MethodKind::RungeKutta4,
    ] {
        let (system, mut state) = hanging_square();
        let mut method = toile_reference::build(&kind.into()).expect("a method that there is");
        let expected = largest_frequency(&system, &state)
            / 60.0
            / (0.9 * kind.stability_limit().expect("explicit"));
        let report = method
            .advance(&system, &mut state, 1.0 / 60.0)
            .expect("stable");
        assert!(
            (report.iterations as f64 - expected).abs() < 2.0 + 0.01 * expected,
            "{} {expected}",
            report.iterations
        );
        for _ in 0..60 {
            method
                .advance(&system, &mut state, 1.0 / 60.0)
                .expect("stable");
        }
    }
}
