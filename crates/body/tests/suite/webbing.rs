//! Nothing grows between parts that come near one another.

use crate::common::is_sound;
use toile_body::{Field, Figure, Joint, Mannequin, Part, Primitive};
use toile_geometry::{SurfaceTree, Vec3};
use toile_measure::Origin;

fn ellipsoid(part: Part, x: f64, radii: [f64; 3]) -> Primitive {
    Primitive::new(part, [x, 1.0, 0.0], radii)
}

#[test]
fn an_arm_five_millimetres_from_the_trunk_grows_no_web() {
    let (trunk, arm) = ([0.28, 0.5, 0.2], [0.09, 0.5, 0.09]);
    let gap = 0.005;
    let side = toile_body::VISIBLE_RATIO * (trunk[0] + arm[0]) + gap;
    let between = Vec3::new(toile_body::VISIBLE_RATIO * trunk[0] + 0.5 * gap, 1.0, 0.0);
    let own = ellipsoid(Part::Trunk, 0.0, trunk);
    let apart = Field::new(&[own, ellipsoid(Part::LeftArm, side, arm)]);
    assert!(!apart.contains(between));
    // In one part they would be one.
    let joined = Field::new(&[own, ellipsoid(Part::Trunk, side, arm)]);
    assert!(joined.contains(between));
    // The trunk is the same, bit by bit, with an arm beside it and without.
    let alone = Field::new(&[own]);
    for k in 0..100 {
        let p = Vec3::new(0.003 * f64::from(k), 1.0 + 0.002 * f64::from(k), 0.01);
        assert_eq!(apart.density(Part::Trunk, p), alone.density(Part::Trunk, p));
    }
}

/// Share of a vertex that goes with some joints.
fn share(body: &Mannequin, vertex: u32, joints: &[Joint]) -> f64 {
    let shares = body.shares(vertex as usize).iter();
    shares.filter(|s| joints.contains(&s.0)).map(|s| s.1).sum()
}

const ARM: [Joint; 3] = [Joint::LShoulder, Joint::LElbow, Joint::LWrist];

/// Places of the left arm below the waist that lie near the rest of the left half, each
/// with the closest place there and their distance (m).
fn beside(body: &Mannequin) -> Vec<(Vec3, Vec3, f64)> {
    let mesh = body.skin();
    let far = body.levels().waist;
    let of_arm = |v: u32| share(body, v, &ARM) > 0.98;
    let mut rest = mesh.clone();
    rest.triangles.retain(|t| {
        t.iter()
            .all(|&v| !of_arm(v) && mesh.positions[v as usize].x > 0.0)
    });
    let tree = SurfaceTree::new(rest);
    (0..mesh.positions.len() as u32)
        .filter(|&v| of_arm(v) && mesh.positions[v as usize].y < far)
        .filter_map(|v| {
            let p = mesh.positions[v as usize];
            let closest = tree.closest_point(p, 0.1)?;
            Some((p, closest.point, closest.signed_distance.abs()))
        })
        .collect()
}

fn least(near: &[(Vec3, Vec3, f64)]) -> f64 {
    near.iter().map(|row| row.2).fold(f64::INFINITY, f64::min)
}

/// A woman with arms as steep as they may be asked for, and hips and thighs so many times the
/// average.
fn close(hips: f64, thighs: f64) -> Mannequin {
    let mut table = Figure::Woman.average();
    for (name, share) in [("leg_circ", thighs), ("hips", hips)] {
        let value = share * table.get(name).unwrap();
        table.set(name, value, Origin::Asked).unwrap();
    }
    table.set("arm_pose_angle", 1.34, Origin::Asked).unwrap();
    Mannequin::new(&table, Figure::Woman).unwrap()
}

#[test]
fn no_web_grows_under_an_arm_five_millimetres_from_the_hip() {
    // Hips so broad that the arm hangs five millimetres from the body.
    let gap = 0.005;
    let (mut low, mut high) = (1.0, 1.5);
    for _ in 0..14 {
        let middle = 0.5 * (low + high);
        match least(&beside(&close(middle, 1.25))) > gap {
            true => low = middle,
            false => high = middle,
        }
    }
    let body = close(low, 1.25);
    let near = beside(&body);
    assert!((least(&near) - gap).abs() < 2e-4, "{}", least(&near));
    assert!(is_sound(&body));
    let close = near.iter().filter(|row| row.2 < 2.0 * gap);
    assert!(close.clone().count() > 4);
    for &(arm, rest, _) in close {
        assert!(!body.contains(0.5 * (arm + rest)), "a web at {arm:?}");
    }
    let trunk = [Joint::Sacroiliac, Joint::Vl5, Joint::Vt6];
    for triangle in &body.skin().triangles {
        let of_arm = triangle.iter().any(|&v| share(&body, v, &ARM) > 0.98);
        let of_trunk = triangle.iter().any(|&v| share(&body, v, &trunk) > 0.98);
        assert!(!(of_arm && of_trunk), "a web under the arm");
    }
}

#[test]
fn no_web_grows_between_thighs_that_touch() {
    // Thicker than they are far apart.
    let body = close(1.0, 1.4);
    let crotch = body.landmarks().crotch.y;
    let mesh = body.skin();
    for triangle in &mesh.triangles {
        let corners = triangle.map(|v| mesh.positions[v as usize]);
        let left = corners.iter().any(|p| p.x > 1e-9);
        let right = corners.iter().any(|p| p.x < -1e-9);
        let below = corners.iter().all(|p| p.y < crotch - 1e-6);
        assert!(!(left && right && below), "a web between the thighs");
    }
    // Thighs touch but for the gap that is kept for cloth, and nothing fills it.
    let thighs = mesh.positions.iter().filter(|p| {
        let below = crotch - p.y;
        p.x > 0.0 && (0.02..0.1).contains(&below)
    });
    let nearest = thighs.min_by(|a, b| a.x.total_cmp(&b.x)).unwrap();
    assert!(2.0 * nearest.x < 0.0065, "{nearest:?}");
    assert!(is_sound(&body));
    let between = Vec3::new(0.0, nearest.y, nearest.z);
    assert!(!body.contains(between), "a web between the thighs");
}

#[test]
fn steep_arms_do_not_fold_into_the_armpit() {
    for (figure, steepest) in [
        (Figure::Woman, 77.0),
        (Figure::Man, 77.0),
        (Figure::Child8, 77.0),
        (Figure::Mean, 70.0),
    ] {
        let angles = [61.0_f64, 66.0, 70.0, 75.0, 77.0];
        for degrees in angles.into_iter().filter(|&angle| angle <= steepest) {
            let mut table = figure.average();
            table
                .set("arm_pose_angle", degrees.to_radians(), Origin::Asked)
                .unwrap();
            let body = Mannequin::new(&table, figure).unwrap();
            let pairs = body.skin_tree().self_intersections().len();
            assert_eq!(pairs, 0, "{figure:?} {degrees}");
        }
    }
}
