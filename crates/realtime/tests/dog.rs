//! A figure that is no human, from a file written by hand.
#![allow(clippy::unwrap_used)]

use toile_realtime::{Character, Ellipsoids, Garment, GarmentSettings};

const DOG: &str = include_str!("dog.character.json");

fn dog() -> Character {
    serde_json::from_str(DOG).unwrap()
}

/// A coat: a tube round the trunk, open below and clear of the legs, `cells` round it and along it.
fn coat(cells: u32) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let mut positions = Vec::new();
    for i in 0..=cells {
        for j in 0..=cells {
            let along = -0.22 + 0.44 * i as f32 / cells as f32;
            let angle = 0.55 * std::f32::consts::PI * (2.0 * j as f32 / cells as f32 - 1.0);
            let (sine, cosine) = angle.sin_cos();
            positions.push([0.15 * sine, 0.5 + 0.16 * cosine, along]);
        }
    }
    let mut triangles = Vec::new();
    for i in 0..cells {
        for j in 0..cells {
            let a = i * (cells + 1) + j;
            let (b, c, d) = (a + 1, a + cells + 1, a + cells + 2);
            triangles.extend([[a, c, b], [b, c, d]]);
        }
    }
    (positions, triangles)
}

#[test]
fn a_dog_trots_in_a_coat() {
    let mut ellipsoids = Ellipsoids::new(&dog()).unwrap();
    let (positions, triangles) = coat(24);
    let mut garment = Garment::new(
        &ellipsoids,
        &positions,
        &triangles,
        GarmentSettings::default(),
    )
    .unwrap();
    ellipsoids.start("stand", 0.0).unwrap();
    for frame in 0..900 {
        if frame == 60 {
            ellipsoids.start("trot", 0.3).unwrap();
        }
        ellipsoids.advance(1.0 / 60.0);
        match frame < 600 {
            true => garment.adjust_by_gravity(&ellipsoids, 1.0 / 60.0),
            false => garment.adjust_by_shape(&ellipsoids, 1.0 / 60.0),
        }
        assert_eq!(garment.inside_count(), 0, "frame {frame}");
        let [shortest, longest] = garment.edge_extremes();
        assert!(
            shortest > 0.9 && longest < 1.1,
            "frame {frame}: {shortest} {longest}"
        );
    }
    // It is still on the dog.
    let mean = garment.positions().map(|p| p[1]).sum::<f32>() / positions.len() as f32;
    assert!((0.4..0.6).contains(&mean), "mean height {mean}");
}
