//! Vertices between several solids: their contacts are solved together.
//!
//! Two surfaces that press on a vertex from both sides counteract each other. Solved one after the other, each would be
//! found deeper than it is at rest, and the multipliers of a single sweep would sum to less than the force of the pinch,
//! and with them the friction that it can bear.

use super::contact::{ContactConstraint, ContactStep};
use super::contact_block::ContactBlock;
use crate::lanes::{LANES, Point};
use nalgebra::{Matrix3, Vector3};
use std::ops::Range;

/// Most changes of the set of surfaces that press; more solids than three seldom meet at a point.
const MAX_CHANGES: usize = 8;

/// Solves the contacts of the vertices of some lanes with all solids, a block of contacts each; moves the points.
pub fn solve_several(
    blocks: &mut [ContactBlock],
    points: &mut [Point; LANES],
    starts: &[Point; LANES],
    step: &ContactStep,
    lanes: Range<usize>,
) {
    for lane in lanes {
        let [x, y, z, weight] = points[lane];
        let [x0, y0, z0, _] = starts[lane];
        if weight <= 0.0 {
            continue;
        }
        let contacts = blocks.iter().map(|block| block.get(lane));
        let mut contacts: Vec<(usize, ContactConstraint)> = contacts.enumerate().collect();
        contacts.retain(|(_, contact)| touches(contact, [x, y, z]));
        let change = match &mut contacts[..] {
            [] => continue,
            [(_, contact)] => contact.solve(weight, [x, y, z], [x0, y0, z0], step),
            _ => {
                let contacts = contacts.iter_mut().map(|(_, contact)| contact);
                let mut contacts: Vec<&mut ContactConstraint> = contacts.collect();
                solve_together(&mut contacts, weight, [[x, y, z], [x0, y0, z0]], step)
            }
        };
        for k in 0..3 {
            points[lane][k] += weight * change[k];
        }
        for (solid, contact) in contacts {
            blocks[solid].set(lane, &contact);
        }
    }
}

fn touches(contact: &ContactConstraint, point: [f32; 3]) -> bool {
    depth(contact, Vector3::from(point)) > 0.0 || contact.lambda_normal > 0.0
}

/// Depth of a point below the offset surface (m).
fn depth(contact: &ContactConstraint, point: Vector3<f32>) -> f32 {
    contact.level - Vector3::from(contact.normal).dot(&point)
}

/// Solves the contacts of a point of inverse mass `weight` (1/kg); `[point, start]` are its present position and that at
/// the start of the substep. Returns the change of the sum of the multipliers.
///
/// Normal multipliers: those with which the displacement u from the point without contact minimises
/// u^2 / 2w + sum max(0, d_i - n_i . u)^2 / 2 c_i, by Newton's method on the set of surfaces that press. Friction
/// follows, one surface after the other.
fn solve_together(
    contacts: &mut [&mut ContactConstraint],
    weight: f32,
    [point, start]: [[f32; 3]; 2],
    step: &ContactStep,
) -> [f32; 3] {
    let [mut point, start] = [Vector3::from(point), Vector3::from(start)];
    let normals: Vec<Vector3<f32>> = contacts.iter().map(|c| c.normal.into()).collect();
    let pushed = |contacts: &[&mut ContactConstraint]| -> Vector3<f32> {
        let pushes = contacts.iter().zip(&normals);
        pushes.map(|(c, n)| n * c.lambda_normal).sum()
    };
    let before = pushed(contacts);
    let free = point - before * weight;
    let depths: Vec<f32> = contacts.iter().map(|c| depth(c, free)).collect();
    let softness: Vec<f32> = (contacts.iter().map(|c| c.compliance * step.kappa)).collect();
    let mut pressing: Vec<bool> = depths.iter().map(|&d| d > 0.0).collect();
    let mut displacement = Vector3::zeros();
    for _ in 0..MAX_CHANGES {
        let mut matrix = Matrix3::from_diagonal_element(1.0 / weight);
        let mut push = Vector3::zeros();
        for k in (0..contacts.len()).filter(|&k| pressing[k]) {
            let n = normals[k];
            matrix += n * n.transpose() / softness[k];
            push += n * (depths[k] / softness[k]);
        }
        displacement = matrix.cholesky().map_or(push * weight, |m| m.solve(&push));
        let now = (0..contacts.len()).map(|k| depths[k] > normals[k].dot(&displacement));
        let now: Vec<bool> = now.collect();
        if now == pressing {
            break;
        }
        pressing = now;
    }
    // The share of the multipliers with which no surface pushes the point out faster than contacts may.
    let mut share = 1.0f32;
    for (contact, n) in contacts.iter().zip(&normals) {
        let moved = free - start - Vector3::from(contact.surface_displacement);
        let [most, out] = [step.outward - n.dot(&moved), n.dot(&displacement)];
        if out > most {
            share = share.min((most / out).max(0.0));
        }
    }
    for (k, contact) in contacts.iter_mut().enumerate() {
        let left = depths[k] - normals[k].dot(&displacement);
        contact.lambda_normal = share * left.max(0.0) / softness[k];
    }
    let mut change = pushed(contacts) - before;
    point += change * weight;
    for contact in contacts.iter_mut() {
        let moved = point - start - Vector3::from(contact.surface_displacement);
        let tangent = Vector3::from(contact.rub(weight, moved.into(), step));
        change += tangent;
        point += tangent * weight;
    }
    change.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pinched_point_stays_in_the_middle_under_the_whole_force_of_both_sides() {
        let side = |x: f32| ContactConstraint {
            normal: [x, 0.0, 0.0],
            level: 5e-4,
            compliance: 0.01,
            tangential_compliance: 0.02,
            friction: 0.5,
            ..ContactConstraint::none()
        };
        let (mut left, mut right) = (side(1.0), side(-1.0));
        let step = ContactStep::new(5.76e6, 1.0 / 2400.0);
        // Light cloth, which one sweep over both contacts would hardly press.
        let [weight, fall] = [1e6, -1.7e-6];
        let point = [[0.0, fall, 0.0], [0.0; 3]];
        let change = solve_together(&mut [&mut left, &mut right], weight, point, &step);
        for contact in [left, right] {
            let force = contact.lambda_normal * step.kappa;
            assert!((force - 5e-4 / 0.01).abs() < 1e-5, "{force}");
        }
        assert!(change[0].abs() * weight < 1e-9, "{change:?}");
        assert!(change[1] > 0.0 && (change[1] * weight + fall).abs() < 0.2 * -fall);
    }
}
