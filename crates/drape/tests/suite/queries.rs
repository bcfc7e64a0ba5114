//! Queries that go on from the front of earlier ones, against brute force and against queries that search everything.

use crate::support::crumpled::{all_pairs, crumpled};
use crate::support::numbers::Numbers;
use std::collections::BTreeSet;
use toile_drape::collision::{
    Ahead, Clearance, ClothSurface, FeaturePair, LinearTrajectories, Near, Nearness, Reach,
    crossings,
};
use toile_geometry::{TriangleMesh, Vec3};

/// A clearance by which no region passes the curvature test.
const NEVER_CLEAR: Clearance = Clearance {
    offset: 0.0,
    max_drift: -1.0,
};

/// Pairs of features within a distance of each other (m), where vertices are marked only those with one of them; and
/// their distance (m).
fn within(
    surface: &ClothSurface,
    x: &[Vec3],
    reach: f64,
    marks: Option<&[bool]>,
) -> Vec<(FeaturePair, f64)> {
    let marked = |v: &u32| marks.is_none_or(|marks| marks[*v as usize]);
    let mut found = surface.features(Near::Listed, |pair, _, found| {
        let distance = Nearness::distance(pair, x);
        if distance <= reach && pair.vertices().iter().any(marked) {
            found.push((pair, distance));
        }
    });
    found.sort_by_key(|found| found.0);
    found
}

#[test]
fn queries_find_the_pairs_of_brute_force_while_the_cloth_moves() {
    let (reach, mut pair_count, mut crossed, mut opened) = (4e-3, 0, 0, 0);
    let of_contacts = Reach::uniform(reach);
    for seed in 0..12 {
        let mesh = crumpled(seed, 12);
        let pairs = all_pairs(&mesh);
        let mut surface = ClothSurface::of_mesh(&mesh);
        let mut fresh = ClothSurface::of_mesh(&mesh);
        let mut numbers = Numbers(seed + 77);
        let turn = numbers.vector(0.02);
        let goal = crumpled(seed + 1, 12).positions;
        let (mut share, mut from) = (0.0, mesh.positions.clone());
        for step in 0..60 {
            // Slowly, then fast, then slowly again.
            share += if (25..30).contains(&step) { 0.01 } else { 5e-4 };
            let turned = nalgebra::Rotation3::from_scaled_axis(turn * f64::from(step));
            let both = mesh.positions.iter().zip(&goal);
            let x: Vec<Vec3> = both.map(|(a, b)| turned * (a + (b - a) * share)).collect();
            if step % 7 > 0 {
                surface.query(
                    LinearTrajectories::together(&from, &x),
                    &Reach::uniform(5e-4),
                    NEVER_CLEAR,
                );
            }
            surface.query(LinearTrajectories::still(&x), &of_contacts, NEVER_CLEAR);
            opened += surface.region_counts()[0];
            let found = within(&surface, &x, reach, None);
            let expected = pairs
                .iter()
                .map(|&pair| (pair, Nearness::distance(pair, &x)));
            let mut expected: Vec<_> = expected
                .filter(|(_, distance)| *distance <= reach)
                .collect();
            expected.sort_by_key(|found| found.0);
            assert_eq!(found, expected, "state {seed}, step {step}");
            pair_count += found.len();
            let crossing = crossings(&surface, Near::Listed, &x);
            let near = fresh.near_leaves(LinearTrajectories::still(&x), 0.0);
            let expected = crossings(&fresh, &near, &x);
            assert_eq!(crossing, expected, "state {seed}, step {step}");
            crossed += crossing.len();
            from = x;
        }
    }
    assert!(
        pair_count > 10_000 && crossed > 10_000,
        "{pair_count} {crossed}"
    );
    assert!(opened < 20_000, "{opened} regions opened");
}

#[test]
fn a_marked_query_finds_all_pairs_of_vertices_on_new_trajectories() {
    let (reach, mut pair_count) = (2e-3, 0);
    for seed in 0..40 {
        let mesh = crumpled(seed, 16);
        let (x, count) = (&mesh.positions, mesh.positions.len());
        let mut ends: Vec<Vec3> = x
            .iter()
            .map(|p| p + Vec3::new(p.z, 0.0, -p.x) * 0.1)
            .collect();
        let mut surface = ClothSurface::of_mesh(&mesh);
        surface.query(
            LinearTrajectories::together(x, &ends),
            &Reach::uniform(reach),
            NEVER_CLEAR,
        );
        // Round after round, as impulses change trajectories.
        for round in 0..3 {
            let mut marks = vec![false; count];
            for k in 0..3 {
                let v = (seed as usize * 31 + 97 * k + 41 * round) % count;
                marks[v] = true;
                ends[v] += Vec3::new(0.02, -0.01 * k as f64, 0.03);
            }
            let trajectories = LinearTrajectories::together(x, &ends);
            let all = Reach::uniform(reach);
            surface.query_marked(trajectories, &all, NEVER_CLEAR, Some(&marks));
            let mut anew = ClothSurface::of_mesh(&mesh);
            anew.query(trajectories, &all, NEVER_CLEAR);
            for time in [0.0, 0.5, 1.0] {
                let both = x.iter().zip(&ends);
                let positions: Vec<Vec3> = both.map(|(a, b)| a + (b - a) * time).collect();
                let found = within(&surface, &positions, reach, Some(&marks));
                let expected = within(&anew, &positions, reach, Some(&marks));
                assert_eq!(found, expected, "state {seed}");
                pair_count += found.len();
            }
        }
    }
    assert!(pair_count > 1_000, "{pair_count}");
}

#[test]
fn a_query_with_velocities_finds_all_pairs_within_their_reach() {
    let mut pair_count = 0;
    for seed in 0..20 {
        let mesh = crumpled(seed, 12);
        let (x, count) = (&mesh.positions, mesh.positions.len());
        let mut surface = ClothSurface::of_mesh(&mesh);
        let mut numbers = Numbers(seed + 5);
        for time in [0.0, 5e-3, 5e-3] {
            let common = numbers.vector(2.0);
            let velocities: Vec<Vec3> = (0..count).map(|_| common + numbers.vector(0.2)).collect();
            let pinned: Vec<bool> = (0..count).map(|_| numbers.next() < 0.05).collect();
            let ahead = Ahead {
                velocities: &velocities,
                pinned: &pinned,
                offset: 2e-3,
                time,
                min_path: 5e-4,
            };
            let reach = Reach {
                max: 6e-3,
                ahead: Some(ahead),
            };
            surface.query(LinearTrajectories::still(x), &reach, NEVER_CLEAR);
            let found = surface.features(Near::Listed, |pair, _, found| found.push(pair));
            let found: BTreeSet<FeaturePair> = found.into_iter().collect();
            for pair in all_pairs(&mesh) {
                if Nearness::distance(pair, x) <= reach.of(pair) {
                    assert!(found.contains(&pair), "state {seed}: {pair:?}");
                    pair_count += 1;
                }
            }
        }
    }
    assert!(pair_count > 5_000, "{pair_count}");
}

#[test]
fn pairs_of_a_vertex_that_is_not_finite_remain_candidates() {
    let mesh = crumpled(3, 12);
    let all = Reach::uniform(4e-3);
    let mut surface = ClothSurface::of_mesh(&mesh);
    surface.query(
        LinearTrajectories::still(&mesh.positions),
        &all,
        NEVER_CLEAR,
    );
    let whole = within(&surface, &mesh.positions, 4e-3, None);
    for lost in [f64::NAN, f64::INFINITY] {
        let mut x = mesh.positions.clone();
        x[80] = Vec3::repeat(lost);
        surface.query(
            LinearTrajectories::together(&mesh.positions, &x),
            &all,
            NEVER_CLEAR,
        );
        let with = surface.features(Near::Listed, |pair, _, found| {
            found.extend(pair.vertices().contains(&80).then_some(pair));
        });
        let count = with.len();
        assert!(count > 100, "{count} pairs at a vertex that is {lost}");
        surface.query(LinearTrajectories::still(&x), &all, NEVER_CLEAR);
        surface.query(
            LinearTrajectories::still(&mesh.positions),
            &all,
            NEVER_CLEAR,
        );
        let again = within(&surface, &mesh.positions, 4e-3, None);
        assert_eq!(again, whole, "{lost}");
    }
}

#[test]
fn an_edge_through_a_face_that_is_a_line_but_for_rounding_is_found() {
    let mut crossed = 0;
    for seed in 0..4000 {
        let mut numbers = Numbers(seed);
        let from = numbers.vector(0.05);
        let side = numbers.vector(0.03);
        let face = [from, from + side, from + side * (1.0 + numbers.next())];
        // Through a point of the line.
        let point = from + side * (2.0 * numbers.next());
        let half_edge = numbers.vector(0.02);
        let [a, b] = [point - half_edge, point + half_edge];
        let mesh = TriangleMesh {
            positions: vec![face[0], face[1], face[2], a, b, b + numbers.vector(0.02)],
            triangles: vec![[0, 1, 2], [3, 4, 5]],
        };
        let x = &mesh.positions;
        let mut surface = ClothSurface::of_mesh(&mesh);
        let near = surface.near_leaves(LinearTrajectories::still(x), 0.0);
        let expected = crossings(&surface, &near, x);
        surface.query(
            LinearTrajectories::still(x),
            &Reach::uniform(1e-3),
            NEVER_CLEAR,
        );
        assert_eq!(crossings(&surface, Near::Listed, x), expected, "{seed}");
        crossed += expected.len();
    }
    assert!(crossed > 10, "{crossed}");
}
