//! A mannequin's character against its own ellipsoids, one by one.

use toile_body::{Clip, Figure, Mannequin, Part, Primitive, VISIBLE_RATIO};
use toile_geometry::{Ellipsoid, Vec3};
use toile_realtime::{Ellipsoids, Field};

fn woman() -> Mannequin {
    Mannequin::new(&Figure::Woman.average(), Figure::Woman).unwrap()
}

fn ellipsoid(p: &Primitive, semi_axes: [f32; 3], offset: f64) -> Ellipsoid {
    let axes = Vec3::from(semi_axes.map(f64::from)).add_scalar(offset);
    let grown = axes - Vec3::from(p.radii) * VISIBLE_RATIO;
    assert!(grown.min() > offset - 1e-6 && grown.max() < offset + 0.03 + 1e-6);
    Ellipsoid::new(Vec3::from(p.centre), axes, p.rotation()).unwrap()
}

fn single(p: Vec3) -> [f32; 3] {
    [p.x as f32, p.y as f32, p.z as f32]
}

/// Places in and round the body.
fn places(body: &Mannequin) -> Vec<Vec3> {
    let skin = &body.skin().positions;
    skin.iter()
        .step_by(97)
        .flat_map(|&p| [p, p * 0.97 + Vec3::y() * 0.02, p * 1.2])
        .collect()
}

#[test]
fn a_character_in_motion_has_the_ellipsoids_of_the_posed_body() {
    let body = woman();
    let run = Clip::run(body.skeleton());
    let character = body.character(&[("run", &run)]).unwrap();
    let mut ellipsoids = Ellipsoids::new(&character).unwrap();
    assert_eq!(ellipsoids.len(), body.primitives().len());
    let mut field = Field::new(&ellipsoids, 0.01).unwrap();
    ellipsoids.start("run", 0.0).unwrap();
    for step in [0.0, 0.21] {
        ellipsoids.advance(step);
        field.follow(&ellipsoids);
        let pose = run.pose_for(body.skeleton(), f64::from(step));
        let own = body.posed_ellipsoids(&pose);
        let single_ones: Vec<Ellipsoid> = own
            .iter()
            .enumerate()
            .map(|(k, p)| ellipsoid(p, ellipsoids.semi_axes(k).unwrap(), 0.01))
            .collect();
        for (k, p) in own.iter().enumerate() {
            let at = ellipsoids.transform(k).unwrap().at.map(f64::from);
            assert!((Vec3::from(at) - Vec3::from(p.centre)).norm() < 2e-6, "{k}");
        }
        for p in places(&body) {
            let radial = |e: &Ellipsoid| {
                let distance = (p - e.radial_point(p)).norm();
                if e.contains(p) { -distance } else { distance }
            };
            let least = single_ones.iter().map(radial).fold(f64::INFINITY, f64::min);
            let found = field.nearest(single(p)).unwrap();
            assert!((f64::from(found.distance) - least).abs() < 2e-5, "{p:?}");
            if least.abs() > 1e-5 {
                assert_eq!(field.contains(single(p)), least < 0.0, "{p:?} {least}");
            }
        }
    }
    assert!(field.nearest([f32::NAN, 0.0, 0.0]).is_none());
}

#[test]
fn a_parent_is_sought_in_its_part_and_those_beside_it() {
    let body = woman();
    let ellipsoids = Ellipsoids::new(&body.character(&[]).unwrap()).unwrap();
    let field = Field::new(&ellipsoids, 0.0).unwrap();
    let parts: Vec<Part> = body.primitives().iter().map(|p| p.local.part).collect();
    let on_leg = parts.iter().position(|&p| p == Part::LeftLeg).unwrap();
    for p in places(&body).into_iter().map(single) {
        let next = field.reparented(on_leg, p).unwrap();
        assert!([Part::LeftLeg, Part::Trunk].contains(&parts[next.ellipsoid]));
        assert!(next.distance >= field.nearest(p).unwrap().distance - 1e-6);
    }
    assert!(field.reparented(usize::MAX, [0.0; 3]).is_none());
}

#[test]
fn only_what_moved_is_made_anew() {
    let body = woman();
    let walk = Clip::walk(body.skeleton());
    let mut ellipsoids = Ellipsoids::new(&body.character(&[("walk", &walk)]).unwrap()).unwrap();
    assert_eq!(ellipsoids.advance(0.1), 0);
    ellipsoids.start("walk", 0.0).unwrap();
    assert!(ellipsoids.advance(0.1) > 0);
    ellipsoids.stop();
    assert_eq!(ellipsoids.advance(0.1), 0);
    ellipsoids.set_place([0.1, 0.0, 0.0], 0.0);
    assert_eq!(ellipsoids.advance(0.0), ellipsoids.len());
}
