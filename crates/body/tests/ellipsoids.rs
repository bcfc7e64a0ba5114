//! The ellipsoid hierarchy against the ellipsoids one by one.
#![allow(clippy::unwrap_used)]

use nalgebra::UnitQuaternion;
use toile_body::{
    Clip, EllipsoidTree, Figure, Joint, Mannequin, Part, Pose, Primitive, VISIBLE_RATIO, adjacent,
};
use toile_geometry::{Ellipsoid, Vec3};

fn woman() -> Mannequin {
    Mannequin::new(&Figure::Woman.average(), Figure::Woman).unwrap()
}

fn ellipsoid(p: &Primitive, scale: f64) -> Ellipsoid {
    let axes = Vec3::from(p.radii) * (VISIBLE_RATIO * scale);
    Ellipsoid::new(Vec3::from(p.centre), axes, p.rotation()).unwrap()
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
fn inside_and_nearest_agree_with_one_by_one() {
    let body = woman();
    let mut tree = EllipsoidTree::new(&body, 1.1);
    assert_eq!(tree.len(), body.primitives().len());
    let run = Clip::run(body.skeleton());
    for time in [0.0, 0.21] {
        let pose = run.pose_for(body.skeleton(), time);
        tree.pose(&pose);
        let single: Vec<Ellipsoid> = body
            .posed_ellipsoids(&pose)
            .iter()
            .map(|p| ellipsoid(p, 1.1))
            .collect();
        let places = places(&body);
        for (p, inside) in places.iter().zip(tree.inside(&places)) {
            let least = single
                .iter()
                .map(|e| e.to_unit(*p).norm())
                .fold(f64::INFINITY, f64::min);
            assert_eq!(inside, least < 1.0, "{p:?} {least}");
            let contact = tree.nearest(*p).unwrap();
            assert!((contact.ratio - least).abs() < 1e-9);
            let on = single[contact.ellipsoid].radial_point(*p);
            assert!((contact.point - on).norm() < 1e-9);
        }
    }
    assert!(tree.nearest(Vec3::new(f64::NAN, 0.0, 0.0)).is_none());
}

#[test]
fn only_what_moved_is_made_anew() {
    let body = woman();
    let mut tree = EllipsoidTree::new(&body, 1.0);
    assert_eq!(tree.pose(&Pose::rest()), 0);
    let bend = UnitQuaternion::new(Vec3::x() * -0.7);
    let bent = Pose::rest().with(Joint::LElbow, bend);
    let below = body
        .primitives()
        .iter()
        .filter(|p| p.joint.follows(Joint::LElbow))
        .count();
    assert!(below > 0 && tree.pose(&bent) == below);
    assert_eq!(tree.pose(&bent), 0);
    let mut shifted = bent.clone();
    shifted.shift = Vec3::x() * 0.1;
    assert_eq!(tree.pose(&shifted), tree.len());
}

#[test]
fn a_parent_is_sought_in_its_part_and_those_beside_it() {
    let body = woman();
    let tree = EllipsoidTree::new(&body, 1.0);
    let parts: Vec<Part> = body.primitives().iter().map(|p| p.local.part).collect();
    let on_leg = parts.iter().position(|&p| p == Part::LeftLeg).unwrap();
    for p in places(&body) {
        let next = tree.reparented(on_leg, p).unwrap();
        assert!(adjacent(Part::LeftLeg).contains(&parts[next.ellipsoid]));
        assert!(next.ratio >= tree.nearest(p).unwrap().ratio - 1e-12);
    }
    assert!(tree.reparented(usize::MAX, Vec3::zeros()).is_none());
    for part in Part::ALL {
        assert!(adjacent(part).contains(&part));
        for &other in adjacent(part) {
            assert!(adjacent(other).contains(&part));
        }
    }
}
