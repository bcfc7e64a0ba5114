//! The moving skin against brute force: the closest point of a posed skin within a step, and its side.

use nalgebra::UnitQuaternion;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::f64::consts::PI;
use toile_body::{Clip, Figure, Joint, Mannequin, Pose};
use toile_geometry::{MovingSurface, SurfaceTree, TriangleMesh, Vec3, closest_point_on_triangle};
use toile_measure::Measurements;

/// Places asked about in each pose.
const PLACES: usize = 200;

/// Numbers from 0 to 1 by seed.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::from_fn(|_, _| 2.0 * self.next() - 1.0)
    }
}

/// A moment of a gait with every joint turned a little further.
fn pose(gaits: &[Clip; 2], body: &Mannequin, numbers: &mut Numbers) -> [Pose; 2] {
    let gait = &gaits[usize::from(numbers.next() < 0.5)];
    let time = numbers.next() * gait.duration();
    let turns: Vec<Vec3> = Joint::ALL.iter().map(|_| numbers.vector() * 0.1).collect();
    [time, time + 1.0 / 60.0].map(|time| {
        let mut pose = gait.pose_for(body.skeleton(), time);
        for (joint, turn) in Joint::ALL.into_iter().zip(&turns) {
            pose.set(joint, UnitQuaternion::new(*turn) * pose.rotation(joint));
        }
        pose
    })
}

/// How often a closed surface goes round a point, by the solid angles of its triangles (Van Oosterom and
/// Strackee 1983).
fn winding(mesh: &TriangleMesh, point: Vec3) -> f64 {
    let angle = |t: usize| {
        let [a, b, c] = mesh.corners(t).map(|p| p - point);
        let [x, y, z] = [a, b, c].map(|p| p.norm());
        let under = x * y * z + a.dot(&b) * z + b.dot(&c) * x + c.dot(&a) * y;
        2.0 * a.dot(&b.cross(&c)).atan2(under)
    };
    (0..mesh.triangles.len()).map(angle).sum::<f64>() / (4.0 * PI)
}

#[test]
fn the_closest_point_of_the_posed_skin_is_that_of_brute_force() {
    // 500 poses of each with TOILE_ALL set; 50 else.
    let count: u64 = match std::env::var("TOILE_ALL") {
        Ok(_) => 500,
        Err(_) => 50,
    };
    for (figure, table) in [
        (Figure::Woman, Measurements::adult_woman()),
        (Figure::Man, Measurements::adult_man()),
    ] {
        let body = Mannequin::new(&table, figure).unwrap();
        let gaits = [Clip::walk(body.skeleton()), Clip::run(body.skeleton())];
        let at_rest = MovingSurface::new(body.skin());
        assert!(at_rest.is_closed());
        let sides: Vec<usize> = (0..count)
            .into_par_iter()
            .map(|seed| asked_in_a_pose(&body, &gaits, at_rest.clone(), seed))
            .collect();
        let sides: usize = sides.iter().sum();
        println!("{figure:?}: {count} poses, {sides} sides");
        assert!(sides as u64 > 5 * count);
    }
}

/// Asks about places round the skin in a pose; how many sides were told where the skin does not cross itself.
fn asked_in_a_pose(
    body: &Mannequin,
    gaits: &[Clip; 2],
    mut surface: MovingSurface,
    seed: u64,
) -> usize {
    let mut numbers =
        Numbers(0x9e37_79b9_7f4a_7c15 ^ (seed + 1).wrapping_mul(0x2545_f491_4f6c_dd1d));
    let ends = pose(gaits, body, &mut numbers).map(|pose| body.posed_skin(&pose).positions);
    surface.set_step(&ends[0], &ends[1]);
    let time = [0.0, 0.25, 0.6, 1.0][(4.0 * numbers.next()) as usize];
    let now = TriangleMesh {
        positions: (0..ends[0].len() as u32)
            .map(|v| surface.vertex(v, time))
            .collect(),
        triangles: surface.triangles().to_vec(),
    };
    let crossed: BTreeSet<u32> = SurfaceTree::new(now.clone())
        .self_intersections()
        .into_iter()
        .flatten()
        .collect();
    let mut sides = 0;
    for k in 0..PLACES {
        let triangle = (numbers.next() * now.triangles.len() as f64) as usize;
        let corners = now.corners(triangle);
        let off = numbers.vector() * 0.03;
        let point = corners.iter().sum::<Vec3>() / 3.0 + off;
        let distance = |t: usize| {
            let corners = now.corners(t);
            let (w, _) = closest_point_on_triangle(point, corners);
            (corners[0] * w[0] + corners[1] * w[1] + corners[2] * w[2] - point).norm()
        };
        let all: Vec<f64> = (0..now.triangles.len()).map(distance).collect();
        let brute = all.iter().copied().fold(f64::INFINITY, f64::min);
        let found = surface
            .closest_point(point, time, f64::INFINITY, None)
            .unwrap();
        let own = found.signed_distance;
        assert!(
            (own.abs() - brute).abs() < 1e-9,
            "{seed} {k}: {own} {brute}"
        );
        // Twice as far about, the skin does not cross itself.
        let is_clean = crossed
            .iter()
            .all(|&t| all[t as usize] > 2.0 * brute + 1e-3);
        if k % 20 == 0 && is_clean {
            let round = winding(&now, point);
            if (round - round.round()).abs() < 1e-6 && (0.0..=1.0).contains(&round.round()) {
                assert_eq!(own < 0.0, round > 0.5, "{seed} {k}: {own} {round}");
                sides += 1;
            }
        }
    }
    sides
}
