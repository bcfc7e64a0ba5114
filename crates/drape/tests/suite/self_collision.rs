//! Cloth against cloth: pairs against brute force, motions that may not pass, scenes that end
//! without a crossing, crossings that are undone.

use crate::support::crumpled::{all_pairs, crumpled};
use crate::support::numbers::Numbers;
use crate::support::sheets::{self, object, sheet};
use toile_drape::collision::{
    ClothSurface, ContactDetector, ContactExemptions, ContactSet, FeaturePair, LinearTrajectories,
    Motions, Nearness, Reach, crossings, nearnesses, truncate_moves,
};
use toile_drape::{
    Cloth, ContactSettings, Material, Measures, MethodKind, MethodSettings,
    PseudoTransientContinuation, RestSettings, Scene, SceneRun, State, SystemBuilder, Workspace,
};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec3, segment_intersects_triangle};

#[test]
fn pairs_are_those_of_brute_force_in_200_crumpled_states() {
    let (mut near_pairs, mut crossed) = (0, 0);
    let mut surface = ClothSurface::of_mesh(&crumpled(0, 8));
    for seed in 0..200 {
        let mesh = crumpled(seed, 8);
        let x = &mesh.positions;
        let reach = 0.01;
        let near = surface.near_leaves(LinearTrajectories::still(x), reach);
        let mut found = surface.features(&near, |pair, _, found| {
            found.extend(Nearness::measure(pair, x, reach));
        });
        found.sort_by_key(|near| near.pair);
        let mut expected: Vec<Nearness> = all_pairs(&mesh)
            .into_iter()
            .filter_map(|pair| Nearness::measure(pair, x, f64::INFINITY))
            .filter(|near| near.distance <= reach)
            .collect();
        expected.sort_by_key(|near| near.pair);
        assert_eq!(found, expected, "state {seed}");
        near_pairs += found.len();
        // What is left out for contact is a neighbour that faces the same way.
        assert!(nearnesses(&surface, &near, x, &Reach::uniform(reach)).len() <= found.len());

        let edges = mesh.topology().edges;
        let mut brute = Vec::new();
        for (e, &[a, b]) in edges.iter().enumerate() {
            for (t, face) in mesh.triangles.iter().enumerate() {
                let ends = [x[a as usize], x[b as usize]];
                if !face.contains(&a)
                    && !face.contains(&b)
                    && segment_intersects_triangle(ends, mesh.corners(t))
                {
                    brute.push([e as u32, t as u32]);
                }
            }
        }
        let got = crossings(&surface, &near, x);
        assert_eq!(got, brute, "state {seed}");
        crossed += got.len();
    }
    assert!(
        near_pairs > 10_000 && crossed > 1_000,
        "{near_pairs} {crossed}"
    );
}

#[test]
fn neighbours_that_face_alike_touch_only_where_they_were_sewn_twisted() {
    // Two rungs of a row of a skirt that had crossed: two triangles with one corner in common.
    let twisted = TriangleMesh {
        positions: [
            [-186.375, 1009.480, -111.535],
            [-212.008, 998.612, -117.375],
            [-198.934, 1008.728, -98.243],
            [-198.431, 1009.574, -122.955],
            [-197.343, 994.883, -97.460],
        ]
        .map(|p| Vec3::from(p) * 1e-3)
        .to_vec(),
        triangles: vec![[0, 1, 2], [3, 4, 0]],
    };
    let found = |mesh: &TriangleMesh| {
        let mut surface = ClothSurface::of_mesh(mesh);
        let near = surface.near_leaves(LinearTrajectories::still(&mesh.positions), 4e-3);
        nearnesses(&surface, &near, &mesh.positions, &Reach::uniform(4e-3))
    };
    let rungs = found(&twisted);
    let crossed = FeaturePair::EdgeEdge([0, 1, 3, 4]);
    assert!(
        rungs.len() == 1 && rungs[0].pair == crossed && rungs[0].neighbours,
        "{rungs:?}"
    );
    assert!(rungs[0].distance < 1e-4);
    let surface = ClothSurface::of_mesh(&twisted);
    let [of_neighbours, of_others] =
        [true, false].map(|neighbours| surface.contact_offset(crossed, neighbours, 1.0));
    assert!((of_others - 5.0 * of_neighbours).abs() < 1e-12 && of_neighbours > 1e-3);
    // Sheared until its triangles have angles of 20 degrees.
    for shear in [0.0, 0.7, 1.8] {
        let flat = sheet([6; 2], [1.0; 2], |u, v| {
            Vec3::new(0.06 * u + 0.06 * shear * v, 0.0, 0.06 * v)
        });
        let found = found(&flat);
        assert!(found.iter().all(|near| !near.neighbours), "{shear}");
    }
}

#[test]
fn features_that_came_nearer_since_detection_do_not_pass() {
    let lower = sheet([3; 2], [1.0; 2], |u, v| Vec3::new(0.09 * u, 0.0, 0.09 * v));
    let upper = sheet([3; 2], [1.0; 2], |u, v| {
        Vec3::new(0.09 * u + 0.01, 0.3e-3, 0.09 * v + 0.007)
    });
    let (mut mesh, half) = (lower, upper.positions.len());
    mesh.positions.extend(upper.positions);
    let shifted = upper.triangles.iter().map(|t| t.map(|v| v + half as u32));
    mesh.triangles.extend(shifted);
    let cloth = Cloth::from_mesh("two", &mesh, Material::default()).unwrap();
    let mut builder = SystemBuilder::new("two", &cloth).unwrap();
    builder.contact.cloth_offset = 2e-3;
    let system = builder.build();
    let inverse_mass: Vec<f64> = system.rest.mass.iter().map(|m| 1.0 / m).collect();
    let state = State::at_rest(&system, mesh.positions.clone());
    let mut contacts = ContactSet::default();
    let mut detector = ContactDetector::default();
    detector.refresh(&system, &state.cloth, &state.positions, &mut contacts);
    let towards = |way: f64| -> Vec<Vec3> {
        let sign = |v: usize| if v < half { 1.0 } else { -1.0 };
        (0..2 * half).map(|v| Vec3::y() * (sign(v) * way)).collect()
    };
    // What the last look found still serves: nothing has strayed by a quarter of a millimetre.
    let drift = towards(0.1e-3);
    let x: Vec<Vec3> = mesh
        .positions
        .iter()
        .zip(&drift)
        .map(|(x, d)| x + d)
        .collect();
    let mut moves = towards(0.1e-3);
    let mut velocities = moves.clone();
    let mut motion = Motions {
        x: &x,
        moves: &mut moves,
        velocities: &mut velocities,
        inverse_mass: &inverse_mass,
        span: 1.0,
    };
    let kept = detector.resolve_impacts(&system, &contacts.exemptions, &mut motion);
    assert!(kept.impulses > 0, "{kept:?}");
    // A tenth of a millimetre apart when the motion began, of which nine tenths are kept.
    let ends: Vec<Vec3> = x.iter().zip(&moves).map(|(x, d)| x + d).collect();
    let mut surface = ClothSurface::of_mesh(&mesh);
    let near = surface.near_leaves(LinearTrajectories::still(&ends), 1e-3);
    let distances = surface.features(&near, |pair, _, found| {
        found.push(Nearness::distance(pair, &ends));
    });
    let least = distances.into_iter().fold(f64::INFINITY, f64::min);
    assert!(least > 0.899e-4 && least < 1e-3, "{least}");
    assert!(crossings(&surface, &near, &ends).is_empty());
}

#[test]
fn bounded_moves_never_cross() {
    let mut held = 0;
    for seed in 0..60 {
        let mut numbers = Numbers(seed);
        let mut mesh = TriangleMesh::default();
        for layer in 0..4 {
            let part = sheet([6; 2], [1.0; 2], |u, v| {
                Vec3::new(
                    0.1 * u,
                    0.003 * f64::from(layer) + 0.01 * (9.0 * u).sin(),
                    0.1 * v,
                )
            });
            mesh.append(&part);
        }
        let mut surface = ClothSurface::of_mesh(&mesh);
        for _ in 0..5 {
            let mut moves: Vec<Vec3> = mesh
                .positions
                .iter()
                .map(|_| numbers.vector(0.02))
                .collect();
            let none = ContactExemptions::default();
            held += truncate_moves(&mut surface, &none, &mesh.positions, &mut moves);
            for (x, d) in mesh.positions.iter_mut().zip(&moves) {
                *x += d;
            }
            let near = surface.near_leaves(LinearTrajectories::still(&mesh.positions), 0.0);
            assert!(
                crossings(&surface, &near, &mesh.positions).is_empty(),
                "seed {seed}"
            );
        }
    }
    assert!(held > 1000, "{held}");
}

#[test]
fn impulses_keep_layers_apart_and_keep_their_momentum() {
    let mut mesh = TriangleMesh::default();
    for layer in 0..4 {
        let part = sheet([6; 2], [1.0; 2], |u, v| {
            Vec3::new(0.1 * u, 0.003 * f64::from(layer), 0.1 * v)
        });
        mesh.append(&part);
    }
    let cloth = Cloth::from_mesh("layers", &mesh, Material::default()).unwrap();
    let mut builder = SystemBuilder::new("layers", &cloth).unwrap();
    builder.contact.cloth_offset = 2e-3;
    let system = builder.build();
    let inverse_mass: Vec<f64> = system.rest.mass.iter().map(|m| 1.0 / m).collect();
    let (mut uncut, mut impulses) = (0, 0);
    for seed in 0..40 {
        let mut numbers = Numbers(seed);
        let state = State::at_rest(&system, mesh.positions.clone());
        let mut contacts = ContactSet::default();
        let mut detector = ContactDetector::default();
        detector.refresh(&system, &state.cloth, &state.positions, &mut contacts);
        // All fly along; every second run is wilder than impulses may undo.
        let wild = if seed % 2 == 0 { 2e-2 } else { 0.2 };
        let along = Vec3::new(0.01, -0.02, 0.005);
        let mut moves: Vec<Vec3> = (mesh.positions.iter())
            .map(|_| along + numbers.vector(wild))
            .collect();
        let momentum = |moves: &[Vec3]| {
            let each = moves.iter().zip(&system.rest.mass);
            each.map(|(d, m)| d * *m).sum::<Vec3>()
        };
        let before = momentum(&moves);
        let mut velocities = moves.clone();
        let mut motion = Motions {
            x: &mesh.positions,
            moves: &mut moves,
            velocities: &mut velocities,
            inverse_mass: &inverse_mass,
            span: 1.0,
        };
        let kept = detector.resolve_impacts(&system, &contacts.exemptions, &mut motion);
        impulses += kept.impulses;
        let end: Vec<Vec3> = mesh
            .positions
            .iter()
            .zip(&moves)
            .map(|(x, d)| x + d)
            .collect();
        let mut surface = ClothSurface::of_mesh(&mesh);
        let near = surface.near_leaves(LinearTrajectories::still(&end), 0.0);
        assert!(crossings(&surface, &near, &end).is_empty(), "seed {seed}");
        if kept.cut == 0 {
            uncut += 1;
            for after in [momentum(&moves), momentum(&velocities)] {
                assert!(
                    (after - before).norm() < 1e-12 * before.norm(),
                    "seed {seed}"
                );
            }
        }
    }
    assert!(uncut >= 20 && impulses > 1000, "{uncut} {impulses}");
}

/// A sheet that falls on another, which hangs by its corners.
fn fall(method: MethodKind, cloth_offset: f64) -> (bool, Measures) {
    let n = 10;
    let low = sheet([n; 2], [1.0; 2], |u, v| Vec3::new(0.2 * u, 0.0, 0.2 * v));
    let high = sheet([n; 2], [1.0; 2], |u, v| {
        Vec3::new(0.03 + 0.13 * u, 0.02, 0.04 + 0.13 * v)
    });
    let n = n as u32;
    let corners = vec![0, n, n * (n + 1), n * (n + 1) + n];
    let scene = Scene {
        duration: 0.35,
        step: 1.0 / 120.0,
        method: method.into(),
        contact: ContactSettings {
            cloth_offset,
            ..ContactSettings::default()
        },
        objects: vec![object("low", low, corners), object("high", high, vec![])],
        ..Scene::default()
    };
    let mut run = SceneRun::new(&scene, MethodSettings::build).unwrap();
    while !run.finished() {
        run.advance().unwrap();
    }
    let measures = run.measure();
    let [low, high] = [0, 1].map(|k| run.meshes()[k].clone());
    let middle = |mesh: &TriangleMesh| mesh.positions[mesh.positions.len() / 2].y;
    (middle(&high) > middle(&low), measures)
}

#[test]
fn a_sheet_that_falls_on_a_sheet_stays_on_it() {
    for method in [MethodKind::ImplicitEuler, MethodKind::Xpbd] {
        assert!(
            !fall(method, 0.0).0,
            "{method:?}: without contact it falls through"
        );
        let (above, measures) = fall(method, 2e-3);
        assert!(above, "{method:?}");
        assert_eq!(measures.self_intersections, 0, "{method:?}");
    }
}

/// A sheet and one that lies on it, kept `offset` (m) apart by a contact that bears a `share` of its weight, edges
/// against edges not counted: they bear several times as much.
fn pressed(offset: f64, share: f64) -> ([TriangleMesh; 2], ContactSettings) {
    let low = sheet([4, 4], [0.12; 2], |u, v| Vec3::new(u, 0.0, v));
    let high = sheet([5, 5], [0.1; 2], |u, v| {
        Vec3::new(0.011 + u, 0.9 * offset, 0.008 + v)
    });
    let weight = Material::default().density * Scene::default().gravity.norm();
    let contact = ContactSettings {
        cloth_offset: offset,
        stiffness: share * weight / offset,
        ..ContactSettings::default()
    };
    ([low, high], contact)
}

/// The way of the two to rest: the net force it ends with, the steps it takes, and how near the sheets come
/// at the least (m).
fn pressed_to_rest() -> (f64, usize, f64) {
    let ([mut mesh, high], contact) = pressed(2e-3, 0.5);
    let pinned = mesh.positions.len();
    let shifted = |t: &[u32; 3]| t.map(|v| v + pinned as u32);
    mesh.triangles.extend(high.triangles.iter().map(shifted));
    mesh.positions.extend(high.positions);
    let (mut system, mut state) = sheets::cloth(&mesh, Material::default());
    system = system.with(|builder| {
        builder.pinned[..pinned].fill(true);
        builder.contact = contact;
    });
    let mut rest = PseudoTransientContinuation::near(RestSettings {
        steps: 100,
        ..RestSettings::default()
    });
    let mut workspace = Workspace::default();
    while !rest.finished() {
        rest.advance(&system, &mut state, &mut workspace).unwrap();
    }
    let heights = state.positions[pinned..].iter().map(|x| x.y);
    let nearest = heights.fold(f64::INFINITY, f64::min);
    (rest.residual(), rest.steps(), nearest)
}

#[test]
fn cloth_pressed_harder_than_its_contact_bears_still_comes_to_rest_apart() {
    let (residual, steps, nearest) = pressed_to_rest();
    assert!(residual < 5e-3, "{residual} after {steps}");
    assert!(nearest > 1e-4 && nearest < 5e-4, "{nearest}");
}

/// How far the upper of two pressed sheets slides on the lower by substeps, and how high it lies at the least and
/// the most, after so many seconds on so steep a slope (m).
fn pressed_by_substeps(slope: f64, duration: f64) -> (f64, [f64; 2]) {
    let ([low, high], contact) = pressed(2e-3, 0.1);
    let every = (0..low.positions.len() as u32).collect();
    let start = high.clone();
    let scene = Scene {
        duration,
        gravity: Vec3::new(slope, -1.0, 0.0) * (Scene::default().gravity.norm()),
        damping: toile_drape::Damping {
            mass: 10.0,
            ..Default::default()
        },
        method: MethodKind::Xpbd.into(),
        contact,
        objects: vec![object("low", low, every), object("high", high, vec![])],
        ..Scene::default()
    };
    let mut run = SceneRun::new(&scene, MethodSettings::build).unwrap();
    while !run.finished() {
        run.advance().unwrap();
    }
    let high = run.meshes()[1].clone();
    let ways = high.positions.iter().zip(&start.positions);
    let slid = ways.map(|(x, from)| (x - from).x).sum::<f64>() / high.positions.len() as f64;
    let heights = high.positions.iter().map(|x| x.y);
    let ends = [f64::INFINITY, f64::NEG_INFINITY];
    (slid, heights.fold(ends, |[a, b], y| [y.min(a), y.max(b)]))
}

#[test]
fn substeps_bear_cloth_that_presses_harder_than_its_contact() {
    // The hard contact begins at a quarter of the offset and bears the rest just below it.
    let (_, [least, most]) = pressed_by_substeps(0.0, 1.0);
    assert!(least > 0.4e-3 && most < 0.54e-3, "{least} {most}");
}

#[test]
fn cloth_pressed_hard_slides_where_the_slope_exceeds_its_friction() {
    // From the tenth of a second on, when the sheet has settled on the other.
    let slid = |share: f64| {
        let after =
            |duration| pressed_by_substeps(share * Material::default().friction, duration).0;
        after(0.3) - after(0.1)
    };
    let [held, let_go] = [0.75, 1.25].map(slid);
    assert!(held.abs() < 1e-4, "{held}");
    // With a = g (0.5 - 0.4) and drag c: a / c (t - (1 - exp(-c t)) / c).
    let way = |t: f64| 0.0981 * (t - (1.0 - (-10.0 * t).exp()) / 10.0);
    let free = way(0.3) - way(0.1);
    assert!((let_go - free).abs() < 0.1 * free, "{let_go} {free}");
}

#[test]
fn a_planted_crossing_is_undone() {
    let n = 8;
    let low = sheet([n; 2], [1.0; 2], |u, v| Vec3::new(0.15 * u, 0.0, 0.15 * v));
    // One border dips through the sheet below.
    let high = sheet([n; 2], [1.0; 2], |u, v| {
        Vec3::new(
            0.05 + 0.15 * u,
            0.004 - 0.02 * (1.0 - 5.0 * u).max(0.0),
            0.02 + 0.12 * v,
        )
    });
    let n = n as u32;
    let scene = Scene {
        duration: 0.5,
        gravity: Vec3::zeros(),
        damping: toile_drape::Damping {
            mass: 5.0,
            ..Default::default()
        },
        method: MethodKind::Xpbd.into(),
        contact: ContactSettings {
            cloth_offset: 2e-3,
            ..ContactSettings::default()
        },
        objects: vec![
            object("low", low, vec![0, n, n * (n + 1), n * (n + 1) + n]),
            object("high", high, vec![]),
        ],
        ..Scene::default()
    };
    let mut run = SceneRun::new(&scene, MethodSettings::build).unwrap();
    assert!(run.measure().self_intersections > 4);
    while !run.finished() {
        run.advance().unwrap();
    }
    assert_eq!(run.measure().self_intersections, 0);
}

#[test]
fn contacts_do_not_depend_on_threads_and_push_both_ways_alike() {
    let mesh = crumpled(3, 12);
    let cloth = Cloth::from_mesh("sheet", &mesh, Material::default()).unwrap();
    let mut builder = SystemBuilder::new("sheet", &cloth).unwrap();
    builder.contact.cloth_offset = 4e-3;
    let system = builder.build();
    let state = State::at_rest(&system, mesh.positions.clone());
    let found = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let (mut detector, mut contacts) = (ContactDetector::default(), ContactSet::default());
        let (memory, x, reach) = (&state.cloth, &state.positions, Reach::uniform(8e-3));
        pool.install(|| detector.detect(&system, memory, x, &reach, &mut contacts));
        contacts
    };
    let one = found(1);
    assert!(!one.is_empty());
    for contact in one.all() {
        assert!(
            contact.weights.iter().sum::<f64>().abs() < 1e-12,
            "momentum is kept"
        );
    }
    for threads in [2, 5] {
        let other = found(threads);
        assert!(one.all().eq(other.all()));
        assert_eq!(one.crossings, other.crossings);
    }
    let crossing = SurfaceTree::new(mesh).self_intersections().len();
    assert_eq!(crossing > 0, one.crossings > 0);
}
