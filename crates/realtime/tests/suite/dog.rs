//! A figure that is no human, from a file written by hand.

use crate::coat::{coat, dog};
use toile_realtime::{Ellipsoids, Garment, GarmentSettings};

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
    assert_eq!([garment.rounds(), garment.adjustments()], [0, 0]);
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
