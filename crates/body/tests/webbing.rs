//! Nothing grows between parts that come near one another.
#![allow(clippy::unwrap_used)]

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

/// Least distance of the left arm from the rest of the body, away from the shoulder [m].
fn beside(body: &Mannequin, arm: &[Joint]) -> f64 {
    let mesh = body.skin();
    let far = body.landmarks().shoulder_tips[0].y - 0.2;
    let of_arm = |v: u32| share(body, v, arm) > 0.98;
    let mut rest = mesh.clone();
    rest.triangles.retain(|t| {
        t.iter()
            .all(|&v| !of_arm(v) && mesh.positions[v as usize].x > 0.0)
    });
    let tree = SurfaceTree::new(rest);
    (0..mesh.positions.len() as u32)
        .filter(|&v| of_arm(v) && mesh.positions[v as usize].y < far)
        .filter_map(|v| tree.closest_point(mesh.positions[v as usize], 0.1))
        .map(|closest| closest.signed_distance.abs())
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn no_triangle_joins_an_arm_to_the_trunk_or_thigh_to_thigh() {
    let mut table = Figure::Woman.average();
    // Thighs as thick as they are far apart.
    let thighs = 1.25 * table.get("leg_circ").unwrap();
    table.set("leg_circ", thighs, Origin::Asked).unwrap();
    let arm = [Joint::LShoulder, Joint::LElbow, Joint::LWrist];
    let trunk = [Joint::Sacroiliac, Joint::Vl5, Joint::Vt6];
    // As steep as arms may be asked for: the hand a centimetre from hip and thigh.
    table.set("arm_pose_angle", 1.34, Origin::Asked).unwrap();
    let body = Mannequin::new(&table, Figure::Woman).unwrap();
    let gap = beside(&body, &arm);
    assert!((0.005..0.012).contains(&gap), "{gap}");
    let crotch = body.landmarks().crotch.y;
    let mesh = body.skin();
    for triangle in &mesh.triangles {
        let of_arm = triangle.iter().any(|&v| share(&body, v, &arm) > 0.98);
        let of_trunk = triangle.iter().any(|&v| share(&body, v, &trunk) > 0.98);
        assert!(!(of_arm && of_trunk), "a web under the arm");
        let corners = triangle.map(|v| mesh.positions[v as usize]);
        let left = corners.iter().any(|p| p.x > 1e-9);
        let right = corners.iter().any(|p| p.x < -1e-9);
        let below = corners.iter().all(|p| p.y < crotch - 1e-6);
        assert!(!(left && right && below), "a web between the thighs");
    }
    // Thighs all but touch.
    let near = mesh.positions.iter().filter(|p| {
        let below = crotch - p.y;
        (0.02..0.1).contains(&below)
    });
    let gap = near.map(|p| 2.0 * p.x.abs()).fold(f64::INFINITY, f64::min);
    assert!(gap < 0.02, "{gap}");
}
