//! Clothes in real time on a woman who walks and runs.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use toile_body::{Clip, Figure, Mannequin};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec3};
use toile_realtime::{Ellipsoids, Field, Garment, GarmentSettings};

const FRAME: f32 = 1.0 / 60.0;

fn woman() -> Ellipsoids {
    let body = Mannequin::new(&Figure::Woman.average(), Figure::Woman).unwrap();
    let skeleton = body.skeleton();
    let clips = [Clip::walk(skeleton), Clip::run(skeleton)];
    let named = [("walk", &clips[0]), ("run", &clips[1])];
    Ellipsoids::new(&body.character(&named).unwrap()).unwrap()
}

type Mesh = (Vec<[f32; 3]>, Vec<[u32; 3]>);

/// A tube round the trunk between two heights, `gap` off the ellipsoids enlarged by an offset.
fn tube(ellipsoids: &Ellipsoids, offset: f32, [top, bottom]: [f32; 2]) -> Mesh {
    let field = Field::new(ellipsoids, offset).unwrap();
    let (round, along) = (40u32, 18u32);
    let mut positions = Vec::new();
    for i in 0..=along {
        for j in 0..round {
            let height = top + (bottom - top) * i as f32 / along as f32;
            let angle = std::f32::consts::TAU * j as f32 / round as f32;
            let at = |r: f32| [r * angle.sin(), height, r * angle.cos()];
            let radii = (1..220).map(|k| 0.001 * k as f32);
            positions.push(at(
                radii.filter(|&r| field.contains(at(r))).last().unwrap() + 0.002
            ));
        }
    }
    let at = |i: u32, j: u32| i * round + j % round;
    let triangles = (0..along).flat_map(|i| {
        (0..round).flat_map(move |j| {
            let (a, b, c, d) = (at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1));
            [[a, c, b], [b, c, d]]
        })
    });
    (positions, triangles.collect())
}

fn garment(ellipsoids: &Ellipsoids, offset: f32, heights: [f32; 2]) -> (Garment, Mesh) {
    let mesh = tube(ellipsoids, offset, heights);
    let settings = GarmentSettings {
        offset,
        ..GarmentSettings::default()
    };
    let made = Garment::new(ellipsoids, &mesh.0, &mesh.1, settings).unwrap();
    (made, mesh)
}

/// Vertices of the inner garment that lie on the outer side of the outer one, farther than a
/// millimetre.
fn beyond(inner: &Garment, outer: &Garment, triangles: &[[u32; 3]]) -> usize {
    let place = |p: [f32; 3]| Vec3::from(p.map(f64::from));
    let mesh = TriangleMesh {
        positions: outer.positions().map(place).collect(),
        triangles: triangles.to_vec(),
    };
    let tree = SurfaceTree::new(mesh.clone());
    let is_beyond = |p: &Vec3| {
        let closest = tree.closest_point(*p, f64::INFINITY).unwrap();
        let [a, b, c] = mesh.corners(closest.triangle as usize);
        let normal = (b - a).cross(&(c - a)).normalize();
        (p - closest.point).dot(&normal) > 1e-3
    };
    inner.positions().map(place).filter(is_beyond).count()
}

#[test]
fn layers_stay_in_their_order_by_their_offsets() {
    let mut ellipsoids = woman();
    let (mut inner, _) = garment(&ellipsoids, 0.004, [1.20, 0.92]);
    let (mut outer, (_, triangles)) = garment(&ellipsoids, 0.024, [1.24, 0.86]);
    let (mut hanging, _) = garment(&ellipsoids, 0.004, [1.20, 0.92]);
    ellipsoids.start("walk", 0.5).unwrap();
    let (mut closely, mut both_hang, mut looks) = (0, 0, 0);
    for frame in 0..600 {
        if frame == 300 {
            ellipsoids.start("run", 0.5).unwrap();
        }
        ellipsoids.advance(FRAME);
        inner.adjust_by_shape(&ellipsoids, FRAME);
        hanging.adjust_by_gravity(&ellipsoids, FRAME);
        outer.adjust_by_gravity(&ellipsoids, FRAME);
        if frame % 20 == 0 {
            closely += beyond(&inner, &outer, &triangles);
            both_hang += beyond(&hanging, &outer, &triangles);
            looks += inner.len();
        }
    }
    let share = both_hang as f64 / looks as f64;
    println!(
        "beyond the outer: fitted {closely}, hanging {:.2} %",
        100.0 * share
    );
    assert_eq!(closely, 0);
    assert!(share <= 0.01, "{share}");
}

#[test]
fn clothes_keep_their_bounds_and_stay_out_of_the_body_by_both_adjustments() {
    let mut ellipsoids = woman();
    let (mut worn, _) = garment(&ellipsoids, 0.006, [1.24, 0.86]);
    ellipsoids.start("walk", 0.4).unwrap();
    let mut edges = [1.0f32; 2];
    for frame in 0..600 {
        if frame == 300 {
            ellipsoids.start("run", 0.4).unwrap();
        }
        ellipsoids.advance(FRAME);
        match frame / 100 % 2 {
            0 => worn.adjust_by_gravity(&ellipsoids, FRAME),
            _ => worn.adjust_by_shape(&ellipsoids, FRAME),
        }
        assert_eq!(worn.inside_count(), 0, "frame {frame}");
        let [low, high] = worn.edge_extremes();
        edges = [edges[0].min(low), edges[1].max(high)];
    }
    println!("edges {edges:?}, {} rounds a frame", worn.rounds() / 600);
    assert!(edges[0] >= 0.9 && edges[1] <= 1.1, "{edges:?}");
}

#[test]
fn the_same_calls_give_the_same_bytes_and_showing_costs_no_adjustment() {
    let run = || {
        let mut ellipsoids = woman();
        let (mut worn, _) = garment(&ellipsoids, 0.006, [1.24, 0.86]);
        ellipsoids.start("run", 0.2).unwrap();
        for _ in 0..60 {
            ellipsoids.advance(FRAME);
            worn.adjust_by_gravity(&ellipsoids, FRAME);
        }
        // Shown to two eyes.
        let eyes = [0, 1].map(|_| worn.positions().collect::<Vec<_>>());
        assert_eq!(eyes[0], eyes[1]);
        assert_eq!(worn.adjustments(), 60);
        eyes[0].clone()
    };
    assert_eq!(run(), run());
}
