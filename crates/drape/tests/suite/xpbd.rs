//! XPBD held to closed forms, to the implicit solver, and to inputs where methods fail.

use crate::support::sheets::{cloth, sheet};
use std::sync::Arc;
use toile_drape::{
    Collider, DrapeError, Elastic, ElasticEnd, Inertia, LinearSolver, Material, MethodKind,
    NewtonSettings, PcgLimits, PseudoTransientContinuation, RestSettings, State, System, Workspace,
    Xpbd, XpbdSettings, laws::elastic::ElasticLaw, laws::membrane::Curvature,
};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec3};

/// A sheet of n x m cells of some size.
fn grid(n: usize, m: usize, cell: f64, place: impl Fn(f64, f64) -> Vec3) -> TriangleMesh {
    sheet([n, m], [cell * n as f64, cell * m as f64], place)
}

/// A flat floor of two triangles, its normal turned by `angle` about z.
fn slope(angle: f64) -> Collider {
    let turn = |x: f64, z: f64| Vec3::new(x * angle.cos(), x * angle.sin(), z);
    let mesh = TriangleMesh {
        positions: vec![
            turn(-2.0, -2.0),
            turn(-2.0, 2.0),
            turn(2.0, 2.0),
            turn(2.0, -2.0),
        ],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    };
    Collider::new(Arc::new(SurfaceTree::new(mesh)))
}

#[test]
fn a_free_sheet_falls_and_keeps_its_momentum() {
    let (mut system, mut state) = cloth(
        &grid(12, 12, 0.02, |u, v| Vec3::new(u, 1.0, v)),
        Material::default(),
    );
    // Crumpled by its velocities, under no gravity.
    system.control.gravity = Vec3::zeros();
    for (i, v) in state.velocities.iter_mut().enumerate() {
        let s = i as f64;
        *v = Vec3::new((s * 1.7).sin(), (s * 0.9).cos(), (s * 2.3).sin()) * 0.3;
    }
    let momentum = |state: &State| -> Vec3 {
        let parts = state.velocities.iter().zip(&system.rest.mass);
        parts.map(|(v, m)| v * *m).sum()
    };
    let scale: f64 = (state.velocities.iter().zip(&system.rest.mass))
        .map(|(v, m)| v.norm() * m)
        .sum();
    let before = momentum(&state);
    let mut solver = Xpbd::new(&system);
    for _ in 0..30 {
        solver
            .advance(&system, &mut state, 1.0 / 1200.0, 20, 0.0)
            .expect("sound");
    }
    // 600 substeps; each rounds velocities by 1e-8 m / h at worst and at random.
    assert!((momentum(&state) - before).norm() < 1e-4 * scale);

    // Alone under gravity: v is exact to single precision, and so is the fall.
    let (system, mut state) = cloth(
        &grid(6, 6, 0.02, |u, v| Vec3::new(u, 1.0, v)),
        Material::default(),
    );
    let mut solver = Xpbd::new(&system);
    let (h, n) = (1.0 / 1200.0, 1200.0);
    for _ in 0..60 {
        solver
            .advance(&system, &mut state, h, 20, 0.0)
            .expect("sound");
    }
    let fallen = 0.5 * 9.81 * h * h * n * (n + 1.0);
    for p in &state.positions {
        assert!((1.0 - p.y - fallen).abs() < 1e-4, "{} {fallen}", 1.0 - p.y);
    }
    assert!((state.time - 1.0).abs() < 1e-12);
}

#[test]
fn iterated_to_the_end_it_is_implicit_euler() {
    let material = Material {
        stretch: [80.0, 60.0],
        shear: 20.0,
        ..Material::default()
    };
    let (mut system, state) = cloth(
        &grid(5, 5, 0.03, |u, v| Vec3::new(u, 0.02 * (30.0 * u).sin(), v)),
        material,
    );
    system = system.with(|builder| {
        builder.pinned[0] = true;
    });
    system.control.air_drag = 0.7;
    let law = ElasticLaw {
        stiffness: 5.0,
        largest_force: 0.02,
    };
    system = system.with(|builder| {
        builder.elastics = vec![
            Elastic {
                from: 35,
                to: ElasticEnd::Point(Vec3::new(0.2, 0.1, 0.2)),
                law,
            },
            Elastic {
                from: 5,
                to: ElasticEnd::Vertex(30),
                law,
            },
        ];
    });
    let h = 0.001;
    let mut reference = state.clone();
    let weight: Vec<f64> = (system.rest.mass.iter())
        .map(|m| m * (1.0 + system.control.air_drag * h) / (h * h))
        .collect();
    let mut workspace = Workspace::default();
    let newton = NewtonSettings {
        iterations: 60,
        tolerance: 1e-12,
        longest_move: 0.05,
        linear: LinearSolver::Iterative(PcgLimits {
            tolerance: 1e-10,
            iterations: 2000,
        }),
        curvature: Curvature::CONVEX,
    };
    let target = reference.positions.clone();
    let inertia = Inertia {
        weight: &weight,
        target: &target,
    };
    workspace.solve(&system, &mut reference, &inertia, &newton);
    let mut got = state.clone();
    let settings = XpbdSettings {
        iterations: 2000,
        ..XpbdSettings::default()
    };
    Xpbd::with_settings(&system, settings)
        .advance(&system, &mut got, h, 1, system.control.air_drag)
        .expect("sound");
    let moved = |s: &State| {
        let moves = s.positions.iter().zip(&state.positions);
        moves.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
    };
    let gap = (got.positions.iter().zip(&reference.positions))
        .map(|(a, b)| (a - b).norm())
        .fold(0.0, f64::max);
    // XPBD keeps each iteration's direction of force (its first equation is left out, section 4
    // of the paper): the error is the turn of the triangles in the step, a hundredth here.
    assert!(moved(&reference) > 1e-4);
    assert!(
        gap < 1e-2 * moved(&reference),
        "{gap:e} {:e}",
        moved(&reference)
    );
}

#[test]
fn a_hanging_strip_stretches_by_its_weight() {
    // Elastic hang: at height s above the tip rho g s = Y l (l^2 - 1) / 2 per width.
    let material = Material {
        poisson: 0.0,
        stretch: [50.0, 50.0],
        bend: [0.0; 3],
        ..Material::default()
    };
    let (cells, length) = (20, 0.5);
    let (mut system, mut state) = cloth(
        &grid(cells, 2, length / 20.0, |u, v| Vec3::new(0.0, -u, v)),
        material.clone(),
    );
    for row in 0..3 {
        system = system.with(|builder| {
            builder.pinned[row * (cells + 1)] = true;
        });
    }
    let settings = XpbdSettings {
        iterations: 400,
        ..XpbdSettings::default()
    };
    let mut solver = Xpbd::with_settings(&system, settings);
    for _ in 0..200 {
        solver
            .advance(&system, &mut state, 1.0 / 60.0, 1, 10.0)
            .expect("sound");
    }
    let mut expected = 0.0;
    for k in 0..10_000 {
        let s = length * (k as f64 + 0.5) / 10_000.0;
        let load = material.density * 9.81 * s;
        let mut l: f64 = 1.0;
        for _ in 0..50 {
            l -= (50.0 * l * (l * l - 1.0) / 2.0 - load) / (50.0 * (3.0 * l * l - 1.0) / 2.0);
        }
        expected += (l - 1.0) * length / 10_000.0;
    }
    let got = -state.positions[cells].y - length;
    assert!((got - expected).abs() < 0.01 * expected, "{got} {expected}");
}

#[test]
fn it_rests_where_newton_rests() {
    // A cantilever of Gamma = rho g L^3 / D = 2.3, clamped by its first two rows.
    let material = Material {
        bend: [1.5e-3; 3],
        ..Material::default()
    };
    let (mut system, state) = cloth(&grid(9, 2, 0.015, |u, v| Vec3::new(u, 0.0, v)), material);
    for row in 0..3 {
        system = system.with(|builder| {
            builder.pinned[10 * row] = true;
            builder.pinned[10 * row + 1] = true;
        });
    }
    let mut reference = state.clone();
    let mut rest = PseudoTransientContinuation::new(RestSettings {
        residual: 1e-7,
        ..RestSettings::default()
    });
    let mut workspace = Workspace::default();
    while !rest.finished() {
        rest.advance(&system, &mut reference, &mut workspace)
            .expect("sound");
    }
    let sunk = -reference.positions[9].y;
    assert!(sunk > 0.02, "{sunk}");
    // As a force, as a filtered force in steps ten times too large for that, and as constraints.
    let runs = [
        (1.0 / 12_000.0, 1, 2e-3),
        (1.0 / 1200.0, 1, 2e-2),
        (1.0 / 600.0, 40, 2e-2),
    ];
    for (substep, iterations, tolerance) in runs {
        let mut got = state.clone();
        let settings = XpbdSettings {
            iterations,
            ..XpbdSettings::default()
        };
        let mut solver = Xpbd::with_settings(&system, settings);
        // Long after everything that moves has been damped.
        let count = (4.0 / substep) as u32;
        let report = solver
            .advance(&system, &mut got, substep, count, 10.0)
            .expect("sound");
        assert!(report.kinetic_energy < 1e-8, "{report:?}");
        let gap = (got.positions.iter().zip(&reference.positions))
            .map(|(a, b)| (a - b).norm())
            .fold(0.0, f64::max);
        assert!(gap < tolerance * sunk, "{substep}: {gap} of {sunk}");
    }
}

#[test]
fn friction_holds_below_its_angle_and_slides_as_coulomb_says_above() {
    let friction = 0.4f64;
    for (tangent, slides) in [(0.99 * friction, false), (1.5 * friction, true)] {
        let angle = tangent.atan();
        let along = Vec3::new(angle.cos(), angle.sin(), 0.0);
        let up = Vec3::new(-angle.sin(), angle.cos(), 0.0);
        let mesh = grid(4, 4, 0.02, |u, v| along * u + up * 4e-3 + Vec3::z() * v);
        let (mut system, mut state) = cloth(
            &mesh,
            Material {
                friction,
                ..Material::default()
            },
        );
        system = system.with(|builder| {
            builder.colliders.push(slope(angle));
        });
        let start = state.positions.clone();
        let mut solver = Xpbd::new(&system);
        let (h, steps) = (1.0 / 1200.0, 240.0);
        for _ in 0..12 {
            solver
                .advance(&system, &mut state, h, 20, 0.0)
                .expect("sound");
        }
        let moved = -(state.positions[12] - start[12]).dot(&along);
        if slides {
            let a = 9.81 * (angle.sin() - friction * angle.cos());
            let expected = 0.5 * a * h * h * steps * (steps + 1.0);
            assert!(
                (moved - expected).abs() < 0.01 * expected,
                "{moved} {expected}"
            );
        } else {
            assert!(moved.abs() < 1e-5, "{moved}");
        }
        assert!(
            state
                .solid_friction
                .iter()
                .map(|one| one.force)
                .sum::<f64>()
                > 0.0
        );
    }
}

/// A sheet falling onto a floor, with pins, an elastic and samples within triangles.
fn busy_scene(n: usize) -> (System, State) {
    let (mut system, mut state) = cloth(
        &grid(n, n, 0.01, |u, v| {
            Vec3::new(u, 0.03 + 0.01 * (40.0 * u).sin(), v)
        }),
        Material::default(),
    );
    system = system.with(|builder| {
        builder.pinned[0] = true;
    });
    let law = ElasticLaw {
        stiffness: 20.0,
        largest_force: f64::INFINITY,
    };
    system = system.with(|builder| {
        builder.elastics = vec![Elastic {
            from: n as u32,
            to: ElasticEnd::Vertex((n * (n + 1)) as u32),
            law,
        }];
        builder.colliders.push(slope(0.1));
    });
    for t in [5, 70, system.topology.triangles.len() as u32 / 2] {
        state.refine_contact(&system, t);
    }
    (system, state)
}

#[test]
fn the_same_bytes_at_any_number_of_threads_and_from_a_saved_state() {
    let run = |threads: usize, cut: bool| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        pool.install(|| {
            let (system, mut state) = busy_scene(110);
            let mut solver = Xpbd::new(&system);
            for _ in 0..4 {
                if cut {
                    state = state.clone();
                    solver = Xpbd::new(&system);
                }
                solver
                    .advance(&system, &mut state, 1.0 / 1200.0, 10, 0.1)
                    .expect("sound");
            }
            state
        })
    };
    let one = run(1, false);
    for other in [run(2, false), run(3, false), run(2, true)] {
        assert_eq!(one, other);
    }
}

#[test]
fn what_is_no_number_is_an_error_and_the_state_stays() {
    let (system, mut state) = busy_scene(20);
    state.velocities[17].y = f64::NAN;
    let mut solver = Xpbd::new(&system);
    let found = solver.advance(&system, &mut state, 1e-3, 5, 0.0);
    assert!(matches!(
        found,
        Err(DrapeError::NotFinite { vertex: 17, .. })
    ));
    // Numbers beyond single precision.
    let (system, mut state) = busy_scene(20);
    state.velocities[40].x = 1e300;
    let before = state.clone();
    let found = solver.advance(&system, &mut state, 1e-3, 5, 0.0);
    assert!(
        matches!(found, Err(DrapeError::NotFinite { .. })),
        "{found:?}"
    );
    assert_eq!(state.positions, before.positions);
    assert_eq!(state.velocities, before.velocities);
}

#[test]
fn slivers_stiff_cloth_huge_steps_and_collapse_stay_sound() {
    let stiff = Material {
        stretch: [1e6, 1e6],
        shear: 1e5,
        bend: [1e-2; 3],
        ..Material::default()
    };
    let sliver = |u: f64, v: f64| Vec3::new(u, 0.05, if v > 0.019 && v < 0.021 { 1e-4 } else { v });
    let flat = |u: f64, v: f64| Vec3::new(u, 0.05, v);
    let crushed = |_: f64, _: f64| Vec3::new(0.1, 0.05, 0.1);
    type Shape<'a> = &'a dyn Fn(f64, f64) -> Vec3;
    let cases: [(Material, Shape, f64, bool); 4] = [
        (stiff.clone(), &flat, 1.0 / 1200.0, false),
        (stiff.clone(), &sliver, 1.0 / 1200.0, false),
        (Material::default(), &sliver, 1.0 / 60.0, false),
        (stiff, &flat, 1.0 / 600.0, true),
    ];
    for (case, (material, turn, substep, crush)) in cases.into_iter().enumerate() {
        let (mut system, mut state) = cloth(&grid(10, 10, 0.02, turn), material);
        system = system.with(|builder| {
            builder.pinned[0] = true;
            builder.colliders.push(slope(0.0));
        });
        if crush {
            for p in &mut state.positions[1..] {
                *p = crushed(0.0, 0.0);
            }
        }
        let mut solver = Xpbd::new(&system);
        for _ in 0..50 {
            solver
                .advance(&system, &mut state, substep, 10, 0.5)
                .expect("sound");
        }
        let far = state.positions.iter().map(|p| p.norm()).fold(0.0, f64::max);
        assert!(far < 1.0, "case {case}: {far}");
        let low = state.positions.iter().map(|p| p.y).fold(1.0, f64::min);
        // What springs open from a point at 100 m/s passes the floor between two looks.
        assert!(crush || low > 0.0, "case {case}: {low}");
    }
}

#[test]
fn a_step_far_too_large_is_cut_or_refused() {
    for step in [0.3, 1e3] {
        let (mut system, mut state) = cloth(
            &grid(8, 8, 0.02, |u, v| Vec3::new(u, 0.0, v)),
            Material::default(),
        );
        system = system.with(|builder| {
            builder.pinned[0] = true;
        });
        let before = state.clone();
        match Xpbd::new(&system).advance(&system, &mut state, step, 3, 0.0) {
            Ok(report) => assert!(step < 1.0 && report.fastest < 100.0, "{report:?}"),
            Err(error) => {
                assert!(matches!(error, DrapeError::NotFinite { .. }));
                assert_eq!(state.positions, before.positions);
            }
        }
    }
}

#[test]
fn it_is_a_method_by_name() {
    let (_, kind) = MethodKind::ALL
        .iter()
        .find(|(name, _)| *name == "xpbd")
        .expect("listed");
    let (system, mut state) = busy_scene(10);
    let mut method = toile_drape::MethodSettings::from(*kind)
        .build()
        .expect("a method that there is");
    let report = method
        .advance(&system, &mut state, 1.0 / 60.0)
        .expect("sound");
    assert_eq!((report.pieces, report.iterations), (1, 20));
}
