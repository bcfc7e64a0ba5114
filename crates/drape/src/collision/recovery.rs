//! How crossed cloth is drawn apart: pulls along the contour gradient of crossings, and out of layers
//! that cloth lies on the wrong side of.

use super::cloth_contact::ClothContact;
use super::entanglement::Entanglement;
use super::intersections::{EdgeFaceIntersection, edge_face_intersections};
use super::layers::{LayerViolation, layer_crossings};
use super::memory::RecoveryDirection;
use super::surface::ClothSurface;
use crate::Model;
use crate::laws::contact::{ContactLaw, ContactPlane};
use nalgebra::Matrix3;
use toile_geometry::Vec3;

/// The pulls on cloth that is entangled, found anew by each detection. They belong to no potential.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recovery {
    /// The pulls, as contacts without friction and without a pair of features.
    pub pulls: Vec<ClothContact>,
    /// Directions in which vertices at crossings are drawn, in order of vertices: to be remembered.
    pub directions: Vec<RecoveryDirection>,
}

/// How far an edge that crosses a face is pulled at a time, in offsets: by less, a fold caught in a seam
/// stays there.
const PULL: f64 = 2.0;

impl Recovery {
    /// Pulls nothing.
    pub(super) fn clear(&mut self) {
        self.pulls.clear();
        self.directions.clear();
    }

    /// Plans the pulls on what is entangled at positions `x`; `before` are the directions of the last
    /// detection.
    pub(super) fn plan(
        &mut self,
        surface: &ClothSurface,
        model: &Model,
        entangled: &Entanglement,
        (x, before): (&[Vec3], &[RecoveryDirection]),
    ) {
        let mut crossings = edge_face_intersections(surface, &entangled.within, x);
        self.directions = keep_direction(&mut crossings, before);
        crossings.extend(layer_crossings(surface, &entangled.of_layers, x));
        let puller = Puller { surface, model, x };
        self.pulls.clear();
        let of_crossings = crossings.iter().filter_map(|c| puller.out_of_crossing(c));
        self.pulls.extend(of_crossings);
        let of_violations = entangled.violations.iter();
        let of_violations = of_violations.filter_map(|v| puller.out_of_layer(v));
        self.pulls.extend(of_violations);
    }
}

/// Detections after which the direction in which a vertex was pulled is forgotten, unless it was pulled in that
/// direction again since.
const MEMORY: u32 = 8;

/// Directions whose sum over the vertices of a crossing is this long or less cancel.
const CANCELLED: f64 = 0.1;

/// Where the direction of a crossing is opposed to the mean direction in which its vertices were pulled `before`
/// (sorted by vertex), replaces it by that mean; returns the directions to be remembered. Otherwise two edges at
/// one corner that cross a face in turn would pull the cloth to and fro without end.
fn keep_direction(
    crossings: &mut [EdgeFaceIntersection],
    before: &[RecoveryDirection],
) -> Vec<RecoveryDirection> {
    let remembered = |v: &u32| {
        let at = before.binary_search_by_key(v, |one| one.vertex);
        at.ok().map(|at| before[at])
    };
    let older = |one: &RecoveryDirection| RecoveryDirection {
        detections: one.detections + 1,
        ..*one
    };
    let mut after: Vec<RecoveryDirection> = Vec::new();
    for crossing in crossings {
        let signed = crossing
            .vertices
            .into_iter()
            .zip([1.0, 1.0, -1.0, -1.0, -1.0]);
        let known = || {
            signed
                .clone()
                .filter_map(|(v, sign)| Some((remembered(&v)?, sign)))
        };
        let sum: Vec3 = known().map(|(one, sign)| one.direction * sign).sum();
        let before = sum.try_normalize(CANCELLED);
        let opposed = before.filter(|direction| direction.dot(&crossing.direction) < 0.0);
        let mut detections = 0;
        if let Some(direction) = opposed {
            crossing.direction = direction;
            detections = 1 + known().map(|(one, _)| one.detections).min().unwrap_or(0);
        }
        after.extend(signed.map(|(vertex, sign)| RecoveryDirection {
            vertex,
            direction: crossing.direction * sign,
            detections,
        }));
    }
    after.extend(before.iter().map(older));
    after.retain(|one| one.detections <= MEMORY);
    // The latest of a vertex; of one detection, that of its first crossing.
    after.sort_by_key(|one| (one.vertex, one.detections));
    after.dedup_by_key(|one| one.vertex);
    after
}

/// Makes pulls at some positions.
struct Puller<'a> {
    surface: &'a ClothSurface,
    model: &'a Model,
    x: &'a [Vec3],
}

impl Puller<'_> {
    /// A pull on the ends of an edge that crosses a face and on the two corners of the face nearest to it;
    /// none where all four are held.
    fn out_of_crossing(&self, crossing: &EdgeFaceIntersection) -> Option<ClothContact> {
        let (v, w) = (crossing.vertices, crossing.weights);
        let least = (2..5).fold(2, |least, k| if w[k] > w[least] { k } else { least });
        let mut corners = (2..5).filter(|&k| k != least);
        let [c, d] = [corners.next()?, corners.next()?];
        let total = w[c] + w[d];
        let vertices = [v[0], v[1], v[c], v[d]];
        let weights = [w[0], w[1], -w[c] / total, -w[d] / total];
        let area: f64 = vertices
            .iter()
            .map(|&v| self.surface.area[v as usize])
            .sum();
        let depth = PULL * self.model.contact.cloth_offset;
        self.pull((vertices, weights), crossing.direction, depth, area)
    }

    /// A pull on a vertex that is on the wrong side of a layer, and on the face that it belongs beyond; none
    /// where all are held.
    fn out_of_layer(&self, violation: &LayerViolation) -> Option<ClothContact> {
        let ([a, b, c], w) = (violation.face, violation.weights);
        let vertices = [violation.vertex, a, b, c];
        let weights = [1.0, -w[0], -w[1], -w[2]];
        let areas = vertices.iter().zip(weights);
        let area: f64 = areas
            .map(|(&v, w)| self.surface.area[v as usize] * w.abs())
            .sum();
        let offset = self.model.contact.cloth_offset;
        let depth = (offset + violation.depth).min(PULL * offset);
        self.pull((vertices, weights), violation.direction, depth, area)
    }

    /// A contact that pulls the first feature against the second in a unit `direction`, `depth` [m] far, as
    /// stiff as contact of a quarter of the `area` [m2]; none where all its vertices are held.
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
        let stiffness = 0.25 * self.model.contact.stiffness * area;
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
            law: ContactLaw {
                normal: stiffness,
                tangential: stiffness,
                friction: 0.0,
                hard_from: f64::INFINITY,
            },
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
    fn two_edges_at_one_corner_are_drawn_in_one_direction() {
        let mut first = [crossing([7, 1, 2, 3, 4], Vec3::x())];
        let drawn = keep_direction(&mut first, &[]);
        assert_eq!(first[0].direction, Vec3::x());
        assert_eq!(drawn.len(), 5);
        // The other edge would turn back, its neighbour in another corner of the cloth goes its own way.
        let back = Vec3::new(-0.8, 0.6, 0.0);
        let mut second = [
            crossing([7, 8, 2, 5, 6], back),
            crossing([20, 21, 22, 23, 24], back),
        ];
        let drawn = keep_direction(&mut second, &drawn);
        assert_eq!(second[0].direction, Vec3::x());
        assert_eq!(second[1].direction, back);
        // A direction that turns by less than a right angle is followed.
        let turned = Vec3::new(0.6, 0.8, 0.0);
        let mut third = [crossing([8, 7, 2, 5, 6], turned)];
        let mut drawn = keep_direction(&mut third, &drawn);
        assert_eq!(third[0].direction, turned);
        assert!(drawn.windows(2).all(|pair| pair[0].vertex < pair[1].vertex));
        for _ in 0..=MEMORY {
            drawn = keep_direction(&mut [], &drawn);
        }
        assert_eq!(drawn, []);
    }
}
