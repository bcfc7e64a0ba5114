//! The edge-edge mollifier: contact of two edges begins and ends without a jump of its force.

use super::cloth_contact::ClothContact;
use super::feature_pair::FeaturePair;
use toile_geometry::Vec3;

/// Least sine of the angle between two edges at which their contact has its full stiffness.
const FULL_SINE: f64 = 0.1;

/// Least distance of the closest points from the ends of their edges, as a share of an edge's length, at which
/// the contact has its full stiffness. The distance is cut to the offset between cloths: near two corners
/// whose faces are not in contact yet, the edges alone carry the force.
const FULL_SHARE: f64 = 0.25;

/// Factor of the stiffness of a contact: 0 to 1 for two edges, 1 for a vertex and a face.
///
/// The closest points of almost parallel edges run from one end to the other over less than a micrometre of
/// motion, and past an end a vertex and a face take the force over. Without the factor the force would jump
/// there, and a method that seeks equilibrium would go back and forth across the jump without end. For
/// parallel edges the factor has the form of Li et al. 2020, section 5; it also falls to 0 towards the ends.
pub(super) fn edge_mollifier(contact: &ClothContact, x: &[Vec3]) -> f64 {
    let Some(FeaturePair::EdgeEdge(ends)) = contact.pair else {
        return 1.0;
    };
    let [a, b, c, d] = ends.map(|v| x[v as usize]);
    let (first, second) = (b - a, d - c);
    let lengths = first.norm_squared() * second.norm_squared();
    let sine = first.cross(&second).norm_squared() / (lengths * FULL_SINE * FULL_SINE);
    let across = if sine < 1.0 { sine * (2.0 - sine) } else { 1.0 };
    let offset = (contact.plane.depth + contact.plane.point.norm()).max(0.0);
    let along = |edge: &Vec3, w: [f64; 2]| {
        let length = edge.norm();
        let far = offset.min(FULL_SHARE * length);
        (length * w[0].abs().min(w[1].abs()) / far).min(1.0)
    };
    let [p, q, r, s] = contact.weights;
    across * along(&first, [p, q]) * along(&second, [r, s])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Cloth, Material, State, SystemBuilder, Workspace};
    use toile_geometry::TriangleMesh;

    /// Two folds whose edges of 20 mm lie `gap` above each other, the upper one turned and moved along.
    fn ridges(gap: f64, turned: f64, along: f64) -> TriangleMesh {
        let mut mesh = TriangleMesh::default();
        for side in [-1.0, 1.0] {
            let first = mesh.positions.len() as u32;
            let corners = [
                [-0.01, 0.0, 0.0],
                [0.01, 0.0, 0.0],
                [0.0, 0.02, 0.01],
                [0.0, 0.02, -0.01],
            ];
            for [x, y, z] in corners {
                let (sine, cosine) = if side > 0.0 {
                    turned.sin_cos()
                } else {
                    (0.0, 1.0)
                };
                let (x, z) = (cosine * x + sine * z, cosine * z - sine * x);
                let shift = if side > 0.0 { along } else { 0.0 };
                mesh.positions
                    .push(Vec3::new(x + shift, side * (0.5 * gap + y), z));
            }
            mesh.triangles.push([first, first + 1, first + 2]);
            mesh.triangles.push([first + 1, first, first + 3]);
        }
        mesh
    }

    /// Largest jump of the forces between steps of 0.2 um over a motion, and the largest force (N).
    fn jump(place: impl Fn(f64) -> TriangleMesh) -> [f64; 2] {
        let cloth = Cloth::from_mesh("ridges", &place(0.0), Material::default()).unwrap();
        let mut builder = SystemBuilder::new("ridges", &cloth).unwrap();
        builder.contact.cloth_offset = 2e-3;
        builder.contact.friction = false;
        let model = builder.build().model;
        let mut workspace = Workspace::default();
        let mut push = |share: f64| -> Vec<Vec3> {
            let state = State::at_rest(&model, place(share).positions);
            workspace.contacts.refresh(&model, &state, &state.positions);
            let mut force = vec![Vec3::zeros(); state.positions.len()];
            for contact in workspace.contacts.cloth.all() {
                let (_, gradient, _) = contact.law.evaluate(&contact.plane, contact.plane.point);
                for (v, w) in contact.vertices.into_iter().zip(contact.weights) {
                    force[v as usize] -= gradient * w;
                }
            }
            force
        };
        let (mut jump, mut most) = (0.0f64, 0.0f64);
        let mut last = push(0.0);
        for k in 1..=2000 {
            let now = push(f64::from(k) / 2000.0);
            for (a, b) in now.iter().zip(&last) {
                (jump, most) = (jump.max((a - b).norm()), most.max(a.norm()));
            }
            last = now;
        }
        [jump, most]
    }

    #[test]
    fn the_push_of_edges_that_turn_along_each_other_or_slide_past_does_not_jump() {
        // 0.04 rad over 10 mm and 0.4 mm along in 2000 steps.
        let turning = jump(|t| ridges(1.9e-3, 0.02 - 0.04 * t, 1e-5));
        let passing = jump(|t| ridges(1.9e-3, 0.5, 9.8e-3 + 4e-4 * t));
        for [jump, most] in [turning, passing] {
            assert!(most > 1e-4 && jump < 0.02 * most, "{jump:e} of {most:e}");
        }
    }

    /// The push between two edges of 30 mm that cross 0.1 mm apart, so far from an end of each (m).
    fn push(from_end: f64) -> f64 {
        let mesh = TriangleMesh {
            positions: vec![
                Vec3::zeros(),
                Vec3::new(0.03, 0.0, 0.0),
                Vec3::new(0.015, -0.02, 0.0),
                Vec3::new(from_end, 1e-4, -from_end),
                Vec3::new(from_end, 1e-4, 0.03 - from_end),
                Vec3::new(from_end, 0.02, 0.015),
            ],
            triangles: vec![[0, 1, 2], [3, 4, 5]],
        };
        let cloth = Cloth::from_mesh("corners", &mesh, Material::default()).unwrap();
        let mut builder = SystemBuilder::new("corners", &cloth).unwrap();
        builder.contact.cloth_offset = 2e-3;
        let model = builder.build().model;
        let state = State::at_rest(&model, mesh.positions);
        let mut workspace = Workspace::default();
        workspace.contacts.refresh(&model, &state, &state.positions);
        let active = workspace.contacts.cloth.all();
        let edges = active.filter(|c| matches!(c.pair, Some(FeaturePair::EdgeEdge(_))));
        let forces = edges.map(|c| c.law.evaluate(&c.plane, c.plane.point).1.norm());
        forces.fold(0.0, f64::max)
    }

    #[test]
    fn corners_a_millimetre_past_each_other_still_push() {
        let [middle, corner] = [0.015, 0.001].map(push);
        assert!(corner > 0.2 * middle, "{corner:e} of {middle:e}");
        assert!(middle > 0.0);
    }
}
