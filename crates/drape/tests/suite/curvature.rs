//! Regions left out by the curvature test: no contact or crossing is missed while the cloth moves, and the search of
//! smooth cloth costs next to nothing.

use crate::support::numbers::Numbers;
use crate::support::sheets::{grid, sheet};
use std::collections::BTreeSet;
use toile_drape::collision::{
    Clearance, ClothSurface, FeaturePair, LinearTrajectories, Near, Nearness, Reach, crossings,
};
use toile_geometry::{TriangleMesh, Vec3};

/// Cloth of 20 mm cells in waves, from nearly flat to crumpled; a ring now and then.
fn waved(seed: u64) -> (TriangleMesh, Vec<Vec3>) {
    const CELLS: usize = 16;
    let alternate = seed.is_multiple_of(2);
    let flat = grid([CELLS; 2], [0.32; 2], alternate, |u, v| {
        Vec3::new(u, 0.0, v)
    });
    let mut numbers = Numbers(seed + 1);
    let size = 0.06 * numbers.next();
    let waves: Vec<(Vec3, [f64; 3])> = (0..4)
        .map(|_| {
            let wave = [0, 1, 2].map(|_| numbers.next());
            (
                numbers.vector(size),
                [9.0 * wave[0], 9.0 * wave[1], 6.3 * wave[2]],
            )
        })
        .collect();
    let turns = if seed.is_multiple_of(3) { 1.2 } else { 0.0 };
    let places = flat.positions.iter().map(|p| {
        let (u, v) = (p.x / 0.32, p.z / 0.32);
        let base = match turns > 0.0 {
            true => {
                // A roll whose ends overlap.
                let (angle, radius) = (turns * std::f64::consts::TAU * u, 0.05 + 0.006 * u);
                Vec3::new(radius * angle.cos(), radius * angle.sin(), p.z)
            }
            false => *p,
        };
        let wave = |(size, [a, b, c]): &(Vec3, [f64; 3])| size * (a * u + b * v + c).sin();
        base + waves.iter().map(wave).sum::<Vec3>()
    });
    let places = places.collect();
    (flat, places)
}

fn features(surface: &ClothSurface, near: &[[u32; 2]]) -> BTreeSet<FeaturePair> {
    let all = surface.features(near, |pair, _, all| all.push(pair));
    all.into_iter().collect()
}

/// Pairs of features in the leaves `all` that are not in the leaves `found`.
fn left_out_of(surface: &ClothSurface, [all, found]: [&[[u32; 2]]; 2]) -> Vec<FeaturePair> {
    let found = features(surface, found);
    features(surface, all).difference(&found).copied().collect()
}

/// Asserts that pairs left out keep their clearance at positions `x`, and that no crossing was left out.
fn assert_keeps_apart(
    surface: &ClothSurface,
    [all, found]: [&[[u32; 2]]; 2],
    left_out: &[FeaturePair],
    (x, clearance): (&[Vec3], Clearance),
    state: &str,
) {
    for &pair in left_out {
        let distance = Nearness::distance(pair, x);
        let offsets = pair.vertices().map(|v| surface.max_offset(v));
        let offset = offsets.into_iter().fold(clearance.offset, f64::min);
        assert!(distance >= offset, "{state}: {pair:?} at {distance}");
    }
    let [all, found] = [all, found].map(|near| crossings(surface, near, x));
    assert_eq!(all, found, "{state}");
}

#[test]
fn pairs_left_out_keep_their_distance_within_the_drift() {
    let clearance = Clearance {
        offset: 2e-3,
        max_drift: 1e-3,
    };
    let (mut left_out, mut crossed) = (0, 0);
    for seed in 0..200 {
        let (flat, mut x) = waved(seed);
        let mut surface = ClothSurface::of_mesh(&flat);
        // A reach within which lies every pair that the drift can bring near.
        let all = surface.near_leaves(LinearTrajectories::still(&x), 0.02);
        let found =
            surface.near_leaves_unless_clear(LinearTrajectories::still(&x), 0.02, clearance);
        assert_eq!(
            crossings(&surface, &all, &x),
            crossings(&surface, &found, &x),
            "state {seed}"
        );
        crossed += crossings(&surface, &all, &x).len();
        let pairs = left_out_of(&surface, [&all, &found]);
        left_out += pairs.len();
        let mut numbers = Numbers(seed + 1000);
        let shift = numbers.vector(0.1);
        for round in 0..4 {
            let state = format!("state {seed}, round {round}");
            assert_keeps_apart(&surface, [&all, &found], &pairs, (&x, clearance), &state);
            let start = waved(seed).1;
            x = start
                .iter()
                .map(|p| {
                    let direction = numbers.vector(1.0);
                    p + shift + direction * (0.999e-3 / direction.norm())
                })
                .collect();
        }
    }
    assert!(
        left_out > 1_000_000 && crossed > 1_000,
        "{left_out} {crossed}"
    );
}

#[test]
fn two_plies_a_slit_and_a_touching_corner_are_told_apart() {
    let clearance = Clearance {
        offset: 1e-3,
        max_drift: 1e-4,
    };
    // Two plies that face the same way, 1 mm apart: every pair of the two must stay.
    let mut plies = sheet([12; 2], [1.0; 2], |u, v| Vec3::new(0.2 * u, 0.0, 0.2 * v));
    let upper = sheet([12; 2], [1.0; 2], |u, v| Vec3::new(0.2 * u, 1e-3, 0.2 * v));
    let count = plies.positions.len() as u32;
    plies.positions.extend(upper.positions);
    plies
        .triangles
        .extend(upper.triangles.iter().map(|t| t.map(|v| v + count)));
    let mut surface = ClothSurface::of_mesh(&plies);
    let x = plies.positions.clone();
    let all = surface.near_leaves(LinearTrajectories::still(&x), 2e-3);
    let found = surface.near_leaves_unless_clear(LinearTrajectories::still(&x), 2e-3, clearance);
    let split = |near: &[[u32; 2]]| -> [BTreeSet<FeaturePair>; 2] {
        let across = |pair: &FeaturePair| {
            let v = pair.vertices();
            (v[0] < count) != (v[3] < count)
        };
        let (across, own) = features(&surface, near).into_iter().partition(across);
        [across, own]
    };
    let ([all, own], [found, own_found]) = (split(&all), split(&found));
    assert!(all.len() > 288 && found == all);
    assert!(own.len() > 1000 && own_found.is_empty());

    // A spiral ramp faces upwards everywhere and lies over itself.
    let ramp = sheet([24; 2], [1.0; 2], |u, v| {
        let angle = 9.0 * u;
        let radius = 0.05 + 0.1 * v;
        Vec3::new(radius * angle.cos(), 0.0005 * angle, -radius * angle.sin())
    });
    let mut surface = ClothSurface::of_mesh(&ramp);
    let x = ramp.positions.clone();
    let close = |near: &[[u32; 2]], surface: &ClothSurface| {
        let all = features(surface, near).into_iter();
        all.filter(|pair| Nearness::distance(*pair, &x) < 5e-4 * 6.3)
            .collect::<Vec<_>>()
    };
    let all = surface.near_leaves(LinearTrajectories::still(&x), 5e-3);
    let found = surface.near_leaves_unless_clear(LinearTrajectories::still(&x), 5e-3, clearance);
    assert!(close(&all, &surface).len() > 100);
    assert_eq!(close(&all, &surface), close(&found, &surface));
}

#[test]
fn a_clearance_or_position_that_is_not_finite_leaves_nothing_out() {
    let mesh = sheet([8; 2], [1.0; 2], |u, v| Vec3::new(u, 0.0, v));
    for clearance in [
        Clearance {
            offset: 0.0,
            max_drift: f64::NAN,
        },
        Clearance {
            offset: 0.0,
            max_drift: f64::INFINITY,
        },
        Clearance {
            offset: f64::INFINITY,
            max_drift: 0.0,
        },
    ] {
        let mut surface = ClothSurface::of_mesh(&mesh);
        let x = &mesh.positions;
        let all = surface.near_leaves(LinearTrajectories::still(x), 0.01);
        let found = surface.near_leaves_unless_clear(LinearTrajectories::still(x), 0.01, clearance);
        match clearance.offset.is_finite() {
            true => assert_eq!(all, found),
            // The offset is limited by the shortest edge, and regions may pass.
            false => assert!(found.len() <= all.len()),
        }
    }
    let mut x = mesh.positions.clone();
    x[40] = Vec3::repeat(f64::NAN);
    let mut surface = ClothSurface::of_mesh(&mesh);
    let clearance = Clearance {
        offset: 0.0,
        max_drift: 0.0,
    };
    let found = surface.near_leaves_unless_clear(LinearTrajectories::still(&x), 0.01, clearance);
    let all = surface.near_leaves(LinearTrajectories::still(&x), 0.01);
    assert!(found.len() <= all.len());
}

#[test]
fn a_smooth_sheet_costs_the_same_few_regions_however_fine() {
    let opened = [22, 71, 224, 708].map(|n| {
        let dome = sheet([n; 2], [1.0; 2], |u, v| {
            Vec3::new(u, 0.1 * (3.0 * u).sin() * (3.0 * v).sin(), v)
        });
        let mut surface = ClothSurface::of_mesh(&dome);
        let clearance = Clearance {
            offset: 1e-4,
            max_drift: 1e-5,
        };
        let x = &dome.positions;
        let found = surface.near_leaves_unless_clear(LinearTrajectories::still(x), 2e-4, clearance);
        assert!(
            found.is_empty(),
            "{} pairs of a sheet of {n} cells",
            found.len()
        );
        surface.region_counts()[0]
    });
    assert!(opened.iter().all(|&count| count == opened[0]), "{opened:?}");
}

#[test]
fn queries_that_go_on_from_a_front_miss_nothing_while_the_cloth_moves() {
    let clearance = Clearance {
        offset: 2e-3,
        max_drift: 1e-3,
    };
    let reach = 0.01;
    let (mut left_out, mut listed, mut crossed, mut tested, mut tested_afresh) = (0, 0, 0, 0, 0);
    for seed in 0..60 {
        // From one crumpled state towards another, slowly or fast, the whole carried along, turned and shaken.
        let (flat, start) = waved(seed);
        let goal = waved(seed + 3).1;
        let mut surface = ClothSurface::of_mesh(&flat);
        let mut fresh = ClothSurface::of_mesh(&flat);
        let mut numbers = Numbers(seed + 500);
        let shift = numbers.vector(0.02);
        let turn = numbers.vector(0.05);
        let share = 0.02 * numbers.next().powi(4);
        let shake = if seed % 2 == 0 { 0.249e-3 } else { 2e-5 };
        let mut shaken = Numbers(seed + 900);
        let mut place = |k: usize| -> Vec<Vec3> {
            let share = share * k as f64;
            let turned = nalgebra::Rotation3::from_scaled_axis(turn * k as f64);
            let both = start.iter().zip(&goal);
            both.map(|(a, b)| {
                let direction = shaken.vector(1.0);
                let noise = direction * (shake / direction.norm());
                turned * (a + (b - a) * share) + shift * k as f64 + noise
            })
            .collect()
        };
        let mut from = place(0);
        for step in 1..16 {
            let to = place(step);
            // Once the whole cloth jumps.
            let leap = Vec3::repeat(if step == 9 { 0.4 } else { 0.0 });
            let state = format!("state {seed}, step {step}");
            for trajectories in [
                LinearTrajectories::together(&from, &to),
                LinearTrajectories::still(&to),
            ] {
                let all = fresh.near_leaves(trajectories, reach);
                let all = features(&fresh, &all);
                surface.query(trajectories, &Reach::uniform(reach), clearance);
                tested += surface.region_counts()[1];
                let found = surface.features(Near::Listed, |pair, _, all| all.push(pair));
                let found: BTreeSet<FeaturePair> = found.into_iter().collect();
                let crossing = crossings(&surface, Near::Listed, trajectories.from);
                fresh.forget();
                fresh.query(trajectories, &Reach::uniform(reach), clearance);
                tested_afresh += fresh.region_counts()[1];
                let exact = fresh.near_leaves(LinearTrajectories::still(trajectories.from), 0.0);
                assert_eq!(
                    crossing,
                    crossings(&fresh, &exact, trajectories.from),
                    "{state}"
                );
                crossed += crossing.len();
                listed += found.len();
                for &pair in all.difference(&found) {
                    left_out += 1;
                    for time in [0.0, 0.37, 1.0] {
                        let offsets = pair.vertices().map(|v| surface.max_offset(v));
                        let offset = offsets.into_iter().fold(clearance.offset, f64::min);
                        let x = |v: usize| {
                            trajectories.from[v]
                                + (trajectories.to[v] - trajectories.from[v]) * time
                        };
                        let four = pair.vertices().map(|v| x(v as usize));
                        let pair = match pair {
                            FeaturePair::VertexFace(_) => FeaturePair::VertexFace([0, 1, 2, 3]),
                            FeaturePair::EdgeEdge(_) => FeaturePair::EdgeEdge([0, 1, 2, 3]),
                        };
                        let distance = Nearness::distance(pair, &four);
                        assert!(distance >= offset, "{state}: {four:?} at {distance}");
                    }
                }
            }
            // As after impulses, the cloth is a little off the trajectories of the query.
            from = (to.iter().map(|x| x + leap + numbers.vector(1e-4))).collect();
        }
    }
    assert!(left_out > 1_000_000, "{left_out}");
    assert!(listed > 1_000_000, "{listed}");
    assert!(crossed > 10_000, "{crossed}");
    assert!(
        3 * tested < 2 * tested_afresh,
        "{tested} of {tested_afresh}"
    );
}

#[test]
fn a_trajectory_that_is_not_finite_leaves_no_region_of_its_vertex_out() {
    let mesh = sheet([16; 2], [1.0; 2], |u, v| Vec3::new(0.3 * u, 0.0, 0.3 * v));
    let clearance = Clearance {
        offset: 1e-3,
        max_drift: 1e-3,
    };
    let mut surface = ClothSurface::of_mesh(&mesh);
    let x = &mesh.positions;
    assert!(
        surface
            .near_leaves_unless_clear(LinearTrajectories::still(x), 0.01, clearance)
            .is_empty()
    );
    for lost in [f64::NAN, f64::INFINITY] {
        let mut to = x.clone();
        to[100] = Vec3::repeat(lost);
        let found =
            surface.near_leaves_unless_clear(LinearTrajectories::together(x, &to), 0.01, clearance);
        let pairs = features(&surface, &found).into_iter();
        let with = pairs.filter(|pair| pair.vertices().contains(&100)).count();
        assert!(with > 10, "{with} pairs at a vertex that is {lost}");
    }
}
