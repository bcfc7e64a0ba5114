//! Recovery from entanglement: forces that undo crossings along the contour gradient, and forces that move vertices
//! back to the right side of a layer.

use super::cloth_contact::ClothContact;
use super::entanglement::Entanglement;
use super::intersections::{EdgeFaceIntersection, edge_face_intersections};
use super::layers::{LayerViolation, layer_crossings};
use super::memory::RecoveryDirection;
use super::surface::ClothSurface;
use crate::Model;
use crate::laws::contact::ContactPlane;
use nalgebra::Matrix3;
use toile_geometry::Vec3;

/// The recovery forces on entangled cloth. Each detection makes them anew; they derive from no potential.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recovery {
    /// The forces, as contacts without friction and without a pair of features.
    pub pulls: Vec<ClothContact>,
    /// Recovery direction of each vertex at a crossing, in order of vertices; the state stores them.
    pub directions: Vec<RecoveryDirection>,
}

/// Depth of a recovery contact of a crossing, in contact offsets: with less a fold caught in a seam stays caught.
const PULL_DEPTH: f64 = 2.0;

impl Recovery {
    /// Removes all forces and directions.
    pub(super) fn clear(&mut self) {
        self.pulls.clear();
        self.directions.clear();
    }

    /// Makes the forces for an entanglement at positions `x`; `before` are the directions of the last detection.
    pub(super) fn plan(
        &mut self,
        surface: &ClothSurface,
        model: &Model,
        entangled: &Entanglement,
        (x, before): (&[Vec3], &[RecoveryDirection]),
    ) {
        let mut crossings = edge_face_intersections(surface, &entangled.within, x);
        self.directions = align_with_previous(&mut crossings, before);
        crossings.extend(layer_crossings(surface, &entangled.of_layers, x));
        let puller = Puller { surface, model, x };
        self.pulls.clear();
        let of_crossings = crossings.iter().filter_map(|c| puller.crossing_pull(c));
        self.pulls.extend(of_crossings);
        let of_violations = entangled.violations.iter();
        let of_violations = of_violations.filter_map(|v| puller.violation_pull(v));
        self.pulls.extend(of_violations);
    }
}

/// Detections after which a vertex's recovery direction is dropped unless it was used again.
const MAX_AGE: u32 = 8;

/// Length of the sum of a crossing's earlier directions below which they count as cancelled.
const MIN_SUM: f64 = 0.1;

/// Replaces the direction of a crossing by the mean of its vertices' earlier directions `before` (sorted by vertex)
/// where the two are opposed; returns the directions that the state stores. Without this, two edges at one corner that
/// cross a face in turn would pull the cloth to and fro without end.
fn align_with_previous(
    crossings: &mut [EdgeFaceIntersection],
    before: &[RecoveryDirection],
) -> Vec<RecoveryDirection> {
    let previous = |v: &u32| {
        let at = before.binary_search_by_key(v, |entry| entry.vertex);
        at.ok().map(|at| before[at])
    };
    let aged = |entry: &RecoveryDirection| RecoveryDirection {
        detections: entry.detections + 1,
        ..*entry
    };
    let mut after: Vec<RecoveryDirection> = Vec::new();
    for crossing in crossings {
        let signed = crossing
            .vertices
            .into_iter()
            .zip([1.0, 1.0, -1.0, -1.0, -1.0]);
        let previous_signed = || {
            signed
                .clone()
                .filter_map(|(v, sign)| Some((previous(&v)?, sign)))
        };
        let sum: Vec3 = previous_signed()
            .map(|(entry, sign)| entry.direction * sign)
            .sum();
        let mean = sum.try_normalize(MIN_SUM);
        let opposed = mean.filter(|direction| direction.dot(&crossing.direction) < 0.0);
        let mut detections = 0;
        if let Some(direction) = opposed {
            crossing.direction = direction;
            let ages = previous_signed().map(|(entry, _)| entry.detections);
            detections = 1 + ages.min().unwrap_or(0);
        }
        after.extend(signed.map(|(vertex, sign)| RecoveryDirection {
            vertex,
            direction: crossing.direction * sign,
            detections,
        }));
    }
    after.extend(before.iter().map(aged));
    after.retain(|entry| entry.detections <= MAX_AGE);
    // One direction for each vertex: the latest, and among those of one detection that of the first crossing.
    after.sort_by_key(|entry| (entry.vertex, entry.detections));
    after.dedup_by_key(|entry| entry.vertex);
    after
}

/// Makes recovery forces at the positions `x`.
struct Puller<'a> {
    surface: &'a ClothSurface,
    model: &'a Model,
    x: &'a [Vec3],
}

impl Puller<'_> {
    /// A force between the ends of an edge that crosses a face and the two corners of the face with the largest
    /// weights; none where all four vertices are pinned.
    fn crossing_pull(&self, crossing: &EdgeFaceIntersection) -> Option<ClothContact> {
        let (v, w) = (crossing.vertices, crossing.weights);
        // Weights of the face are negative: the largest is that of the corner farthest from the intersection.
        let farthest = (2..5).fold(2, |far, k| if w[k] > w[far] { k } else { far });
        let mut corners = (2..5).filter(|&k| k != farthest);
        let [c, d] = [corners.next()?, corners.next()?];
        let total = w[c] + w[d];
        let vertices = [v[0], v[1], v[c], v[d]];
        let weights = [w[0], w[1], -w[c] / total, -w[d] / total];
        let area: f64 = vertices
            .iter()
            .map(|&v| self.surface.area[v as usize])
            .sum();
        let depth = PULL_DEPTH * self.model.contact.cloth_offset;
        self.pull((vertices, weights), crossing.direction, depth, area)
    }

    /// A force between a vertex on the wrong side of a layer and the closest face of that layer; none where all four
    /// vertices are pinned.
    fn violation_pull(&self, violation: &LayerViolation) -> Option<ClothContact> {
        let ([a, b, c], w) = (violation.face, violation.weights);
        let vertices = [violation.vertex, a, b, c];
        let weights = [1.0, -w[0], -w[1], -w[2]];
        let areas = vertices.iter().zip(weights);
        let area: f64 = areas
            .map(|(&v, w)| self.surface.area[v as usize] * w.abs())
            .sum();
        let offset = self.model.contact.cloth_offset;
        let depth = (offset + violation.depth).min(PULL_DEPTH * offset);
        self.pull((vertices, weights), violation.direction, depth, area)
    }

    /// A contact of depth `depth` (m) that pulls the first feature along the unit `direction` and the second against
    /// it, with the stiffness of a contact of a quarter of `area` (m2); none where all four vertices are pinned.
    fn pull(
        &self,
        (vertices, weights): ([u32; 4], [f64; 4]),
        direction: Vec3,
        depth: f64,
        area: f64,
    ) -> Option<ClothContact> {
        let pinned = &self.model.prescribed.pinned;
        if vertices.iter().all(|&v| pinned[v as usize]) {
            return None;
        }
        let four = vertices.into_iter().zip(weights);
        let point = four.map(|(v, w)| self.x[v as usize] * w).sum();
        Some(ClothContact {
            vertices,
            weights,
            plane: ContactPlane {
                point,
                depth,
                gradient: direction,
                normal: direction,
                hollow: Matrix3::zeros(),
                bulge: Matrix3::zeros(),
                anchor: point,
                lagged_normal_force: 0.0,
                returning: false,
                landing: false,
            },
            law: self.model.contact.law(0.25 * area, 0.0),
            restitution: None,
            pair: None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crossing(vertices: [u32; 5], direction: Vec3) -> EdgeFaceIntersection {
        EdgeFaceIntersection {
            vertices,
            weights: [0.5, 0.5, -0.4, -0.3, -0.3],
            direction,
        }
    }

    #[test]
    fn two_edges_at_one_corner_are_pulled_in_one_direction() {
        let mut first = [crossing([7, 1, 2, 3, 4], Vec3::x())];
        let directions = align_with_previous(&mut first, &[]);
        assert_eq!(first[0].direction, Vec3::x());
        assert_eq!(directions.len(), 5);
        // The second edge at the corner is opposed to the first; an edge elsewhere in the cloth has its own direction.
        let back = Vec3::new(-0.8, 0.6, 0.0);
        let mut second = [
            crossing([7, 8, 2, 5, 6], back),
            crossing([20, 21, 22, 23, 24], back),
        ];
        let directions = align_with_previous(&mut second, &directions);
        assert_eq!(second[0].direction, Vec3::x());
        assert_eq!(second[1].direction, back);
        // A direction within a right angle of the earlier one is taken as it is.
        let turned = Vec3::new(0.6, 0.8, 0.0);
        let mut third = [crossing([8, 7, 2, 5, 6], turned)];
        let mut directions = align_with_previous(&mut third, &directions);
        assert_eq!(third[0].direction, turned);
        assert!(
            directions
                .windows(2)
                .all(|pair| pair[0].vertex < pair[1].vertex)
        );
        for _ in 0..=MAX_AGE {
            directions = align_with_previous(&mut [], &directions);
        }
        assert_eq!(directions, []);
    }
}
