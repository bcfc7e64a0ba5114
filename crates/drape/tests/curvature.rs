//! Regions left out because they cannot touch themselves: nothing that meets is missed, whatever the
//! cloth does meanwhile, and smooth cloth costs next to nothing.

#![allow(clippy::unwrap_used)]

#[path = "support/numbers.rs"]
mod numbers;
#[path = "support/sheets.rs"]
mod sheets;

use numbers::Numbers;
use sheets::{grid, sheet};
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
                // Rolled up, the ends over each other.
                let (angle, radius) = (turns * std::f64::consts::TAU * u, 0.05 + 0.006 * u);
                Vec3::new(radius * angle.cos(), radius * angle.sin(), p.z)
            }
            false => *p,
        };
        let way = |(way, [a, b, c]): &(Vec3, [f64; 3])| way * (a * u + b * v + c).sin();
        base + waves.iter().map(way).sum::<Vec3>()
    });
    let places = places.collect();
    (flat, places)
}

fn features(surface: &ClothSurface, near: &[[u32; 2]]) -> BTreeSet<FeaturePair> {
    let all = surface.features(near, |pair, _, all| all.push(pair));
    all.into_iter().collect()
}

/// Pairs of features among all that are not among those found.
fn left_out_of(surface: &ClothSurface, [all, found]: [&[[u32; 2]]; 2]) -> Vec<FeaturePair> {
    let found = features(surface, found);
    features(surface, all).difference(&found).copied().collect()
}

/// Holds what was left out to its clearance at some places, and what was found to all crossings.
fn assert_keeps_apart(
    surface: &ClothSurface,
    [all, found]: [&[[u32; 2]]; 2],
    rest: &[FeaturePair],
    (x, clearance): (&[Vec3], Clearance),
    told: &str,
) {
    for &pair in rest {
        let distance = Nearness::distance(pair, x);
        let kept = pair.vertices().map(|v| surface.max_offset(v));
        let kept = kept.into_iter().fold(clearance.offset, f64::min);
        assert!(distance >= kept, "{told}: {pair:?} at {distance}");
    }
    let [all, found] = [all, found].map(|near| crossings(surface, near, x));
    assert_eq!(all, found, "{told}");
}

#[test]
fn what_is_left_out_keeps_its_distance_wherever_vertices_stray() {
    let clearance = Clearance {
        offset: 2e-3,
        max_drift: 1e-3,
    };
    let (mut left_out, mut crossed) = (0, 0);
    for seed in 0..200 {
        let (flat, mut x) = waved(seed);
        let mut surface = ClothSurface::of_mesh(&flat);
        // Far enough that every pair that could come near in the time is among these.
        let all = surface.near_leaves(LinearTrajectories::still(&x), 0.02);
        let found =
            surface.near_leaves_unless_clear(LinearTrajectories::still(&x), 0.02, clearance);
        assert_eq!(
            crossings(&surface, &all, &x),
            crossings(&surface, &found, &x),
            "state {seed}"
        );
        crossed += crossings(&surface, &all, &x).len();
        let rest = left_out_of(&surface, [&all, &found]);
        left_out += rest.len();
        let mut numbers = Numbers(seed + 1000);
        let drift = numbers.vector(0.1);
        for round in 0..4 {
            let told = format!("state {seed}, round {round}");
            assert_keeps_apart(&surface, [&all, &found], &rest, (&x, clearance), &told);
            let strays = waved(seed).1;
            x = strays
                .iter()
                .map(|p| {
                    let way = numbers.vector(1.0);
                    p + drift + way * (0.999e-3 / way.norm())
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
fn numbers_that_are_none_leave_nothing_out() {
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
            // The room at a vertex is less than without end: here there is room for it.
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
    let looked = [22, 71, 224, 708].map(|n| {
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
    assert!(looked.iter().all(|&count| count == looked[0]), "{looked:?}");
}

#[test]
fn what_was_found_serves_while_the_cloth_moves() {
    let clearance = Clearance {
        offset: 2e-3,
        max_drift: 1e-3,
    };
    let reach = 0.01;
    let (mut left_out, mut listed, mut crossed, mut told, mut told_anew) = (0, 0, 0, 0, 0);
    for seed in 0..60 {
        // From one crumpled state towards another, slowly or fast, the whole carried along, turned and shaken.
        let (flat, start) = waved(seed);
        let goal = waved(seed + 3).1;
        let mut surface = ClothSurface::of_mesh(&flat);
        let mut fresh = ClothSurface::of_mesh(&flat);
        let mut numbers = Numbers(seed + 500);
        let drift = numbers.vector(0.02);
        let turn = numbers.vector(0.05);
        let share = 0.02 * numbers.next().powi(4);
        let shake = if seed % 2 == 0 { 0.249e-3 } else { 2e-5 };
        let mut shaken = Numbers(seed + 900);
        let mut place = |k: usize| -> Vec<Vec3> {
            let share = share * k as f64;
            let turned = nalgebra::Rotation3::from_scaled_axis(turn * k as f64);
            let both = start.iter().zip(&goal);
            both.map(|(a, b)| {
                let way = shaken.vector(1.0);
                turned * (a + (b - a) * share) + drift * k as f64 + way * (shake / way.norm())
            })
            .collect()
        };
        let mut from = place(0);
        for step in 1..16 {
            let to = place(step);
            // Now and then all is elsewhere at once.
            let leap = Vec3::repeat(if step == 9 { 0.4 } else { 0.0 });
            let told_of = format!("state {seed}, step {step}");
            for ways in [
                LinearTrajectories::together(&from, &to),
                LinearTrajectories::still(&to),
            ] {
                let all = fresh.near_leaves(ways, reach);
                let all = features(&fresh, &all);
                surface.query(ways, &Reach::uniform(reach), clearance);
                told += surface.region_counts()[1];
                let found = surface.features(Near::Listed, |pair, _, all| all.push(pair));
                let found: BTreeSet<FeaturePair> = found.into_iter().collect();
                let crossing = crossings(&surface, Near::Listed, ways.from);
                fresh.forget();
                fresh.query(ways, &Reach::uniform(reach), clearance);
                told_anew += fresh.region_counts()[1];
                let exact = fresh.near_leaves(LinearTrajectories::still(ways.from), 0.0);
                assert_eq!(crossing, crossings(&fresh, &exact, ways.from), "{told_of}");
                crossed += crossing.len();
                listed += found.len();
                for &pair in all.difference(&found) {
                    left_out += 1;
                    for part in [0.0, 0.37, 1.0] {
                        let kept = pair.vertices().map(|v| surface.max_offset(v));
                        let kept = kept.into_iter().fold(clearance.offset, f64::min);
                        let x = |v: usize| ways.from[v] + (ways.to[v] - ways.from[v]) * part;
                        let four = pair.vertices().map(|v| x(v as usize));
                        let pair = match pair {
                            FeaturePair::VertexFace(_) => FeaturePair::VertexFace([0, 1, 2, 3]),
                            FeaturePair::EdgeEdge(_) => FeaturePair::EdgeEdge([0, 1, 2, 3]),
                        };
                        let distance = Nearness::distance(pair, &four);
                        assert!(distance >= kept, "{told_of}: {four:?} at {distance}");
                    }
                }
            }
            // Impulses leave the cloth a little off the way it was looked for on.
            from = (to.iter().map(|x| x + leap + numbers.vector(1e-4))).collect();
        }
    }
    assert!(left_out > 1_000_000, "{left_out}");
    assert!(listed > 1_000_000, "{listed}");
    assert!(crossed > 10_000, "{crossed}");
    assert!(3 * told < 2 * told_anew, "{told} of {told_anew}");
}

#[test]
fn a_vertex_lost_on_the_way_leaves_no_region_out() {
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
