//! Places in space: how near the edges of placed pieces lie to each other.

use super::edges::SeamEdge;
use crate::{Draft, Worn};
use toile_geometry::{Rigid, Vec2, Vec3};

/// Pieces that lie in one plane within this distance are laid out flat, not placed round a body (m).
const FLAT: f64 = 1e-3;
/// Distance that is added to all distances, so that ratios of small ones say nothing (m).
const LEAST: f64 = 0.02;

/// Edges of pieces that are placed in space.
pub(super) struct Places {
    /// Start, middle and end of each edge in space (m). `None`: its piece is not placed.
    points: Vec<Option<[Vec3; 3]>>,
    /// Distance from each edge to the nearest one of another piece (m).
    nearest: Vec<f64>,
    /// Distance added to all distances before they are compared (m).
    added: f64,
}

/// Relation of two placed edges.
pub(super) struct Apart {
    /// Distance of the ends that would be sewn together, compared with the nearest edges: 0 if no other edge
    /// is nearer, 1 if it is 2.7 times as far (1).
    pub far: f64,
    /// Cosine of the angle between the edges in the direction of sewing (1).
    pub cosine: f64,
}

impl Places {
    pub fn new(edges: &[SeamEdge], draft: &Draft) -> Self {
        let placed: Vec<Option<Rigid>> = draft
            .pieces
            .iter()
            .map(|piece| match &piece.worn {
                Worn::Placed(rigid) => Some(*rigid),
                Worn::Wrapped { .. } | Worn::Automatic => None,
            })
            .collect();
        let is_flat = is_flat(&placed);
        let points: Vec<Option<[Vec3; 3]>> = edges
            .iter()
            .map(|edge| {
                let rigid = placed[edge.piece].filter(|_| !is_flat)?;
                Some(edge.laid.map(|point| in_space(&rigid, point)))
            })
            .collect();
        let mut places = Self {
            nearest: vec![f64::INFINITY; edges.len()],
            points,
            added: LEAST,
        };
        for i in 0..edges.len() {
            for j in i + 1..edges.len() {
                if edges[i].piece == edges[j].piece {
                    continue;
                }
                if let Some((distance, _)) = places.distance(i, j) {
                    places.nearest[i] = places.nearest[i].min(distance);
                    places.nearest[j] = places.nearest[j].min(distance);
                }
            }
        }
        let mut known: Vec<f64> = places
            .nearest
            .iter()
            .copied()
            .filter(|d| d.is_finite())
            .collect();
        known.sort_by(f64::total_cmp);
        places.added += known
            .get(known.len() / 2)
            .map_or(0.0, |median| 0.5 * median);
        places
    }

    /// Distance between the ends that would be sewn together, and the cosine of the angle between the edges.
    fn distance(&self, i: usize, j: usize) -> Option<(f64, f64)> {
        let (a, b) = (self.points[i]?, self.points[j]?);
        let distance = 0.5 * ((a[0] - b[2]).norm() + (a[2] - b[0]).norm());
        let (along, beside) = (a[2] - a[0], b[0] - b[2]);
        let scale = (along.norm() * beside.norm()).max(1e-12);
        Some((distance, along.dot(&beside) / scale))
    }

    /// Relation of two edges. `None`: they are not placed.
    pub fn apart(&self, i: usize, j: usize, is_same_piece: bool) -> Option<Apart> {
        let (distance, cosine) = self.distance(i, j)?;
        let (a, b) = (self.nearest[i], self.nearest[j]);
        let usual = if is_same_piece {
            a.max(b)
        } else {
            (a * b).sqrt()
        };
        let far = match usual.is_finite() {
            true => ((distance + self.added) / (usual + self.added))
                .ln()
                .max(0.0),
            false => 0.0,
        };
        Some(Apart { far, cosine })
    }

    /// Distance of the middle of an edge to the left of the wearer (m). `None`: the edge is not placed.
    pub fn to_the_left(&self, edge: usize) -> Option<f64> {
        Some(self.points[edge]?[1].x)
    }

    /// Distance from the middle of an edge to the mirror image of the middle of another (m). `None`: they are
    /// not placed.
    pub fn image_distance(&self, i: usize, j: usize) -> Option<f64> {
        let (a, b) = (self.points[i]?[1], self.points[j]?[1]);
        Some((a - Vec3::new(-b.x, b.y, b.z)).norm())
    }
}

fn in_space(rigid: &Rigid, point: Vec2) -> Vec3 {
    rigid.rotation * Vec3::new(point.x, point.y, 0.0) + rigid.translation.vector
}

/// Whether all placed pieces lie in one plane.
fn is_flat(placed: &[Option<Rigid>]) -> bool {
    let mut all = placed.iter().flatten();
    let Some(first) = all.next() else {
        return true;
    };
    let normal = first.rotation * Vec3::z();
    all.all(|other| {
        let away = other.translation.vector - first.translation.vector;
        (other.rotation * Vec3::z()).cross(&normal).norm() < FLAT && away.dot(&normal).abs() < FLAT
    })
}
