//! A plane triangulation for smoothing: triangles with their neighbours, edge flips and vertex stars.

use std::collections::HashSet;
use toile_geometry::{TriangulationError, Vec2, delaunay_triangles, orient2d};

/// Marks a missing triangle on the other side of an edge.
pub(crate) const NONE: usize = usize::MAX;

/// The fixed part of a triangulation: boundary, creases and fixed vertices.
#[derive(Clone, Debug, Default)]
pub(crate) struct Frame {
    /// Boundary segments with the inside of the piece on their left.
    pub walls: Vec<[usize; 2]>,
    /// Segments inside the piece that must be edges of triangles.
    pub creases: Vec<[usize; 2]>,
    /// Number of fixed vertices; later ones may be moved or removed.
    pub fixed: usize,
}

/// Triangles over points in the plane, counter-clockwise.
#[derive(Clone, Debug, Default)]
pub(crate) struct Planar {
    pub points: Vec<Vec2>,
    pub triangles: Vec<[usize; 3]>,
    /// Neighbouring triangle across the edge opposite each corner.
    pub neighbours: Vec<[usize; 3]>,
    /// Whether the edge opposite each corner must not be flipped.
    pub locked: Vec<[bool; 3]>,
}

impl Planar {
    /// Constrained Delaunay triangulation of the inside of a frame.
    pub fn new(points: Vec<Vec2>, frame: &Frame) -> Result<Self, TriangulationError> {
        let segments = frame.walls.iter().chain(&frame.creases).copied().collect();
        let all = delaunay_triangles(&points, segments)?;
        let mut planar = Self {
            points,
            triangles: all,
            ..Self::default()
        };
        planar.connect();
        planar.keep_inside(frame);
        planar.connect();
        planar.lock(frame);
        Ok(planar)
    }

    /// The Delaunay triangulation of a mesh's points inside its boundary, made from its counter-clockwise
    /// triangles by edge flips.
    pub fn delaunay(points: Vec<Vec2>, triangles: Vec<[usize; 3]>) -> Self {
        let mut planar = Self {
            points,
            triangles,
            ..Self::default()
        };
        planar.connect();
        planar.lock(&Frame::default());
        planar.make_delaunay();
        planar
    }

    /// Rebuilds the neighbours from the triangles.
    fn connect(&mut self) {
        let mut edges: Vec<([usize; 2], usize, usize)> = Vec::new();
        for (t, corners) in self.triangles.iter().enumerate() {
            for k in 0..3 {
                let (a, b) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
                edges.push(([a.min(b), a.max(b)], t, k));
            }
        }
        edges.sort_unstable();
        self.neighbours = vec![[NONE; 3]; self.triangles.len()];
        for pair in edges.windows(2) {
            if pair[0].0 == pair[1].0 {
                self.neighbours[pair[0].1][pair[0].2] = pair[1].1;
                self.neighbours[pair[1].1][pair[1].2] = pair[0].1;
            }
        }
        self.locked = vec![[false; 3]; self.triangles.len()];
    }

    /// Removes the triangles reached by a flood fill from outside the boundary.
    fn keep_inside(&mut self, frame: &Frame) {
        let walls: HashSet<[usize; 2]> = frame.walls.iter().copied().collect();
        let mut state = vec![0u8; self.triangles.len()];
        let mut queue = Vec::new();
        for (t, corners) in self.triangles.iter().enumerate() {
            for k in 0..3 {
                if walls.contains(&[corners[k], corners[(k + 1) % 3]]) && state[t] == 0 {
                    state[t] = 1;
                    queue.push(t);
                }
            }
        }
        while let Some(t) = queue.pop() {
            let corners = self.triangles[t];
            for k in 0..3 {
                let (a, b) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
                let next = self.neighbours[t][k];
                let wall = walls.contains(&[a, b]) || walls.contains(&[b, a]);
                if next != NONE && !wall && state[next] == 0 {
                    state[next] = 1;
                    queue.push(next);
                }
            }
        }
        let mut at = 0;
        self.triangles.retain(|_| {
            at += 1;
            state[at - 1] == 1
        });
    }

    fn lock(&mut self, frame: &Frame) {
        let creases: HashSet<[usize; 2]> = frame
            .creases
            .iter()
            .map(|&[a, b]| [a.min(b), a.max(b)])
            .collect();
        for t in 0..self.triangles.len() {
            for k in 0..3 {
                let (a, b) = (
                    self.triangles[t][(k + 1) % 3],
                    self.triangles[t][(k + 2) % 3],
                );
                self.locked[t][k] =
                    self.neighbours[t][k] == NONE || creases.contains(&[a.min(b), a.max(b)]);
            }
        }
    }

    /// Positions of a triangle's corners (m).
    pub fn corners(&self, t: usize) -> [Vec2; 3] {
        self.triangles[t].map(|v| self.points[v])
    }

    /// Triangles round every vertex, in ascending order.
    pub fn stars(&self) -> Vec<Vec<usize>> {
        let mut stars = vec![Vec::new(); self.points.len()];
        for (t, corners) in self.triangles.iter().enumerate() {
            for &v in corners {
                stars[v].push(t);
            }
        }
        stars
    }

    /// The four vertices round the edge opposite corner `k` of `t`: the corner, the ends of the edge, the
    /// opposite corner of the neighbour.
    pub fn quad(&self, t: usize, k: usize) -> Option<([usize; 4], usize)> {
        let other = self.neighbours[t][k];
        if other == NONE {
            return None;
        }
        let corners = self.triangles[t];
        let across = (0..3).find(|&j| self.neighbours[other][j] == t)?;
        Some((
            [
                corners[k],
                corners[(k + 1) % 3],
                corners[(k + 2) % 3],
                self.triangles[other][across],
            ],
            across,
        ))
    }

    /// Whether the edge opposite corner `k` of `t` can be flipped: both new triangles would be
    /// counter-clockwise.
    pub fn can_flip(&self, t: usize, k: usize) -> bool {
        if self.locked[t][k] {
            return false;
        }
        self.quad(t, k).is_some_and(|([a, b, c, d], _)| {
            let p = |v: usize| self.points[v];
            orient2d(p(a), p(b), p(d)) > 0.0 && orient2d(p(a), p(d), p(c)) > 0.0
        })
    }

    /// Flips the edge opposite corner `k` of `t`.
    pub fn flip(&mut self, t: usize, k: usize) {
        let Some(([a, b, c, d], across)) = self.quad(t, k) else {
            return;
        };
        let other = self.neighbours[t][k];
        // Before: t = (a, b, c), other = (d, c, b). After: t = (a, b, d), other = (a, d, c).
        let at = |planar: &Self, t: usize, j: usize| (planar.neighbours[t][j], planar.locked[t][j]);
        let (ca, ab) = (at(self, t, (k + 1) % 3), at(self, t, (k + 2) % 3));
        let (bd, dc) = (
            at(self, other, (across + 1) % 3),
            at(self, other, (across + 2) % 3),
        );
        self.triangles[t] = [a, b, d];
        self.neighbours[t] = [bd.0, other, ab.0];
        self.locked[t] = [bd.1, false, ab.1];
        self.triangles[other] = [a, d, c];
        self.neighbours[other] = [dc.0, ca.0, t];
        self.locked[other] = [dc.1, ca.1, false];
        for (outer, old, new) in [(bd.0, other, t), (ca.0, t, other)] {
            if outer != NONE
                && let Some(j) = (0..3).find(|&j| self.neighbours[outer][j] == old)
            {
                self.neighbours[outer][j] = new;
            }
        }
    }

    /// Flips edges until the triangulation is constrained Delaunay (Lawson 1977): an edge is flipped if the
    /// angles opposite it add up to more than half a turn.
    pub fn make_delaunay(&mut self) {
        let mut queue: Vec<usize> = (0..self.triangles.len()).collect();
        let mut budget = 20 * self.triangles.len() + 100;
        while let Some(t) = queue.pop() {
            for k in 0..3 {
                if budget == 0 {
                    return;
                }
                let other = self.neighbours[t][k];
                if self.wants_flip(t, k) && self.can_flip(t, k) {
                    self.flip(t, k);
                    budget -= 1;
                    queue.push(t);
                    queue.push(other);
                    break;
                }
            }
        }
    }

    fn wants_flip(&self, t: usize, k: usize) -> bool {
        if self.locked[t][k] {
            return false;
        }
        self.quad(t, k).is_some_and(|([a, b, c, d], _)| {
            let p = |v: usize| self.points[v];
            sine_of_sum(p(b) - p(a), p(c) - p(a), p(c) - p(d), p(b) - p(d)) < -1e-12
        })
    }
}

/// Sine of the sum of the angle from `u` to `v` and the angle from `w` to `x`.
fn sine_of_sum(u: Vec2, v: Vec2, w: Vec2, x: Vec2) -> f64 {
    let sum = u.perp(&v) * w.dot(&x) + u.dot(&v) * w.perp(&x);
    sum / (u.norm() * v.norm() * w.norm() * x.norm()).max(f64::MIN_POSITIVE)
}
