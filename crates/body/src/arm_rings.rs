//! Sections of the left arm of a foreign mesh, from the finger tips to the trunk.

use crate::{Loop, Scan};
use toile_geometry::Vec3;

/// A section of the left arm: its centre (m) and girth (m).
pub(crate) type Ring = (Vec3, f64);

/// Tip of the left hand (m): of all points above a third of the height, the one with the largest `x - 0.3 y`,
/// which lies far out sideways and, with less weight, far down.
pub(crate) fn finger_tip(scan: &Scan) -> Vec3 {
    let height = scan.height();
    let reach = |p: &Vec3| p.x - 0.3 * p.y;
    let upper = scan.mesh().positions.iter().filter(|p| p.y > 0.33 * height);
    upper
        .copied()
        .max_by(|a, b| reach(a).total_cmp(&reach(b)))
        .unwrap_or_default()
}

/// Sections of the left arm, from the finger tips at `tip` to where the arm joins the trunk at the height
/// `armpit` (m). Each is square to the line through the centres of the sections before it.
pub(crate) fn arm_rings(scan: &Scan, tip: Vec3, armpit: f64) -> Vec<Ring> {
    let height = scan.height();
    let step = 0.012 * height;
    let beside = scan.trunk(armpit - 0.02 * height);
    let half = beside.map_or(0.1 * height, |l| 0.5 * l.extent()[0]);
    let goal = Vec3::new(half, armpit + 0.02 * height, 0.01 * height);
    let mut along = (goal - tip).normalize();
    let mut rings: Vec<Ring> = Vec::new();
    let mut at = tip;
    for _ in 0..90 {
        let origin = at + along * step;
        let Some((centre, girth)) = ring_at(scan, origin, along, rings.len() < 9) else {
            break;
        };
        // Where the arm joins the trunk, the girth of the section grows suddenly.
        let before = rings.iter().rev().take(4).map(|r| r.1);
        let usual = before.clone().sum::<f64>() / before.count().max(1) as f64;
        let grown = rings.len() > 14 && girth > 1.35 * usual;
        let jumped = (centre - origin).norm() > 0.03 * height && rings.len() > 9;
        if grown || jumped || centre.x < 0.4 * half {
            break;
        }
        at = centre;
        rings.push((centre, girth));
        if rings.len() > 4 {
            let way = (at - rings[rings.len() - 5].0).normalize();
            along = (along * 0.5 + way * 0.5).normalize();
        }
        if (goal - at).norm() < 0.5 * step {
            break;
        }
    }
    rings
}

/// The section of the mesh through `origin`, square to `along`: the loop nearest to `origin`, or, on a hand,
/// all loops near it, since each finger is a loop.
fn ring_at(scan: &Scan, origin: Vec3, along: Vec3, is_hand: bool) -> Option<Ring> {
    let first = along.cross(&Vec3::z()).try_normalize(1e-6)?;
    let second = first.cross(&along);
    let loops = scan.section(origin, [first, second]);
    let far = |l: &Loop| l.centre().norm();
    let near: Vec<&Loop> = match is_hand {
        true => loops
            .iter()
            .filter(|l| far(l) < 0.05 * scan.height())
            .collect(),
        false => loops
            .iter()
            .filter(|l| l.length() > 0.03 * scan.height())
            .min_by(|a, b| far(a).total_cmp(&far(b)))
            .into_iter()
            .collect(),
    };
    let girth: f64 = near.iter().map(|l| l.girth()).sum();
    if girth <= 0.0 {
        return None;
    }
    let centre = near
        .iter()
        .map(|l| l.centre() * (l.girth() / girth))
        .fold(nalgebra::Vector2::zeros(), |a, b| a + b);
    Some((origin + first * centre.x + second * centre.y, girth))
}
