//! Nothing is allocated once character and garment are made.

use crate::coat::{coat, dog};
use toile_realtime::{Ellipsoids, Garment, GarmentSettings};

#[test]
fn ten_thousand_frames_allocate_nothing() {
    let mut ellipsoids = Ellipsoids::new(&dog()).unwrap();
    let (positions, triangles) = coat(10);
    let settings = GarmentSettings::default();
    let mut worn = Garment::new(&ellipsoids, &positions, &triangles, settings).unwrap();
    let mut shown = 0.0;
    let counted = allocation_counter::measure(|| {
        for frame in 0..10_000 {
            match frame % 1000 {
                0 => ellipsoids.start("trot", 0.3).unwrap(),
                700 => ellipsoids.start("stand", 0.3).unwrap(),
                _ => {}
            }
            ellipsoids.advance(1.0 / 60.0);
            match frame % 1500 < 900 {
                true => worn.adjust_by_gravity(&ellipsoids, 1.0 / 60.0),
                false => worn.adjust_by_shape(&ellipsoids, 1.0 / 60.0),
            }
            shown += worn.positions().map(|p| p[1]).sum::<f32>();
        }
    });
    assert_eq!(counted.count_total, 0);
    assert!(shown.is_finite());
}
