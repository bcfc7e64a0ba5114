//! Clothes in real time on a woman who walks and runs.

use toile_body::{Clip, Figure, Mannequin};
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
            let mut radii = (1..220).map(|k| 0.001 * k as f32);
            positions.push(at(radii.rfind(|&r| field.contains(at(r))).unwrap() + 0.002));
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
