//! Ties as constraints: a point within a triangle of cloth is to coincide with a point of cloth or of a solid.

use super::moving_solids::MovingSolids;
use super::vertex_partition::VertexPartition;
use crate::lanes::Point;
use crate::tie::{Tie, TieEnd, TrianglePoint};
use crate::{Control, System};
use toile_geometry::Vec3;

/// The constraint sum a_i x_i = target, three rows solved at once, with the compliance of the tie's spring. Weights of a
/// point of cloth at the other end are negative, and its target is zero.
#[derive(Clone, Debug)]
pub struct TieConstraint {
    /// Vertices, as indices into the points of the region, and their weights.
    terms: Vec<(u32, f32)>,
    /// The target relative to the origin of the points (m); zero between two points of cloth.
    target: [f32; 3],
    /// Index among the control's ties.
    number: u32,
    /// Stiffness k (N/m).
    stiffness: f32,
    /// Largest force (N).
    largest_force: f32,
    /// XPBD multiplier of the three rows over the substep: force times h^2 (N s2).
    pub lambda: [f32; 3],
}

impl TieConstraint {
    /// The constraint of a tie of a control; indices of vertices count from the slot `start`.
    pub fn new(tie: &Tie, number: u32, numbering: &VertexPartition, start: u32) -> Self {
        let mut terms: Vec<(u32, f32)> = Vec::new();
        let mut add = |point: &TrianglePoint, sign: f64| {
            for (&vertex, weight) in point.vertices.iter().zip(point.weights) {
                let slot = numbering.slot_of[vertex as usize] - start;
                let weight = (sign * weight) as f32;
                match terms.iter_mut().find(|(other, _)| *other == slot) {
                    Some((_, sum)) => *sum += weight,
                    None => terms.push((slot, weight)),
                }
            }
        };
        add(&tie.from, 1.0);
        if let TieEnd::Cloth(to) = &tie.to {
            add(to, -1.0);
        }
        Self {
            terms,
            target: [0.0; 3],
            number,
            stiffness: tie.law.stiffness as f32,
            largest_force: tie.law.largest_force.min(1e30) as f32,
            lambda: [0.0; 3],
        }
    }

    /// Moves the target to where it is at a time (s), the given share of the step of moving solids; coordinates are
    /// relative to `origin` (m).
    pub fn follow(
        &mut self,
        (control, moving): (&Control, &MovingSolids),
        origin: Vec3,
        [time, share]: [f64; 2],
    ) {
        let place = match &control.ties[self.number as usize].to {
            TieEnd::Place(place) => Some(*place),
            TieEnd::Frame { point, motion } => Some(motion.pose(time).apply(*point)),
            TieEnd::Surface { solid, point } => moving.surface(*solid).map(|surface| {
                let terms = point.vertices.iter().zip(point.weights);
                terms.map(|(&v, w)| surface.vertex(v, share) * w).sum()
            }),
            TieEnd::TrackFrame {
                solid,
                frame,
                point,
            } => moving.in_frame(*solid, (*frame, *point), share),
            TieEnd::Cloth(_) => None,
        };
        if let Some(place) = place {
            self.target = [0, 1, 2].map(|k| (place[k] - origin[k]) as f32);
        }
    }
}

/// The ties of a region's control as constraints: those whose spring has a stiffness.
pub fn stiff_ties(system: &System) -> impl Iterator<Item = (u32, &Tie)> {
    (0..)
        .zip(&system.control.ties)
        .filter(|(_, tie)| tie.law.stiffness > 0.0)
}

/// Solves ties one after the other; `kappa` is (1 + drag h) / h^2 (1/s2).
pub fn solve_ties(ties: &mut [TieConstraint], points: &mut [Point], kappa: f32) {
    for tie in ties {
        let compliance = kappa / tie.stiffness;
        let mut weight = compliance;
        let mut gap = tie.target.map(|target| -target);
        for &(v, a) in &tie.terms {
            let point = points[v as usize];
            weight += a * a * point[3];
            for k in 0..3 {
                gap[k] += a * point[k];
            }
        }
        let old = tie.lambda;
        let free = [0, 1, 2].map(|k| old[k] - (gap[k] + compliance * old[k]) / weight);
        let length = (free[0] * free[0] + free[1] * free[1] + free[2] * free[2]).sqrt();
        let limit = tie.largest_force / kappa;
        let share = if length > limit { limit / length } else { 1.0 };
        for k in 0..3 {
            let lambda = free[k] * share;
            let change = lambda - old[k];
            tie.lambda[k] = lambda;
            for &(v, a) in &tie.terms {
                let point = &mut points[v as usize];
                point[k] += a * point[3] * change;
            }
        }
    }
}
