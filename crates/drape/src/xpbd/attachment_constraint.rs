//! Elastics and attachments as constraints: the two ends are to coincide.

use crate::lanes::Point;
use crate::laws::elastic::ElasticLaw;

/// The constraint x_from - x_to = 0, three rows solved at once, with the compliance 1/k of an elastic and
/// its largest force as a bound on the multiplier.
#[derive(Clone, Copy, Debug)]
pub struct AttachmentConstraint {
    /// The vertex at its first end, as an index into the points of the region.
    from: u32,
    /// Its other end.
    pub to: AttachmentEnd,
    /// Stiffness k (N/m).
    stiffness: f32,
    /// Largest force (N).
    largest_force: f32,
    /// XPBD multiplier of the three rows over the substep: force times h^2 (N s2).
    pub lambda: [f32; 3],
}

/// The other end of an elastic or attachment.
#[derive(Clone, Copy, Debug)]
pub enum AttachmentEnd {
    /// A vertex, as an index into the points of the region.
    Vertex(u32),
    /// A prescribed position, relative to the origin of the points (m).
    Fixed([f32; 3]),
}

impl AttachmentConstraint {
    /// The constraint of an elastic with a law.
    pub fn new(from: u32, to: AttachmentEnd, law: &ElasticLaw) -> Self {
        Self {
            from,
            to,
            stiffness: law.stiffness as f32,
            largest_force: law.largest_force.min(1e30) as f32,
            lambda: [0.0; 3],
        }
    }
}

/// Solves constraints one after the other; `kappa` is (1 + drag h) / h^2 (1/s2).
pub fn solve_attachments(
    constraints: &mut [AttachmentConstraint],
    points: &mut [Point],
    kappa: f32,
) {
    for constraint in constraints {
        let a = points[constraint.from as usize];
        let b = match constraint.to {
            AttachmentEnd::Vertex(to) => points[to as usize],
            AttachmentEnd::Fixed([x, y, z]) => [x, y, z, 0.0],
        };
        let compliance = kappa / constraint.stiffness;
        let weight = a[3] + b[3] + compliance;
        let old = constraint.lambda;
        let free = [0, 1, 2].map(|k| old[k] - (a[k] - b[k] + compliance * old[k]) / weight);
        let length = (free[0] * free[0] + free[1] * free[1] + free[2] * free[2]).sqrt();
        let limit = constraint.largest_force / kappa;
        let share = if length > limit { limit / length } else { 1.0 };
        for k in 0..3 {
            let lambda = free[k] * share;
            let change = lambda - old[k];
            constraint.lambda[k] = lambda;
            points[constraint.from as usize][k] += a[3] * change;
            if let AttachmentEnd::Vertex(to) = constraint.to {
                points[to as usize][k] -= b[3] * change;
            }
        }
    }
}
