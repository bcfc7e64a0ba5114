//! The first rings of the arm under the shoulder, drawn even where a large chest and a thick arm
//! would run into each other.

use std::collections::BTreeMap;
use toile_geometry::{TriangleMesh, Vec3};

/// Passes of drawing every vertex to the middle of its neighbours.
const PASSES: usize = 10;

/// Least distance of the arm from the side of the trunk: so much [1/m of stature] and so much for
/// each metre below the armpit [1].
const CLEAR: [f64; 2] = [0.0016, 0.1];

/// Half the depth of the trunk at the armpits, over stature: less than any body's.
const DEPTH: f64 = 0.05;

/// Vertices under the left arm.
pub(crate) struct Underarm {
    rows: Vec<Row>,
    /// Those of the arm that may come near the trunk.
    near: Vec<u32>,
    /// Up the side of the trunk to the armpit.
    side: Vec<u32>,
}

/// A vertex with how far it is drawn and its neighbours.
struct Row {
    vertex: u32,
    share: f64,
    neighbours: Vec<u32>,
}

impl Underarm {
    /// Finds them on a template: of the arm's first rings, which follow the arm in part, what lies
    /// lower than the shoulder, less and less towards it [m].
    pub(crate) fn of(mesh: &TriangleMesh, arm: &[f64], side: Vec<u32>, shoulder: f64) -> Self {
        /// Shares of following of the rings meant: the border and the trunk follow less.
        const FOLLOW: [f64; 2] = [0.5, 0.999];
        /// How far below the armpit an arm may lie against the trunk [m].
        const BELOW: f64 = 0.12;
        let armpit = side.last().map_or(0.0, |&v| mesh.positions[v as usize].y);
        let top = armpit + 0.6 * (shoulder - armpit);
        let (mut rows, mut near) = (Vec::new(), Vec::new());
        for (v, p) in mesh.positions.iter().enumerate() {
            if p.x <= 0.0 || arm[v] <= FOLLOW[0] || p.y >= top {
                continue;
            }
            if p.y > armpit - BELOW {
                near.push(v as u32);
            }
            if arm[v] < FOLLOW[1] {
                rows.push(Row {
                    vertex: v as u32,
                    share: 0.5 * ((top - p.y) / (0.6 * (top - armpit))).min(1.0),
                    neighbours: Vec::new(),
                });
            }
        }
        let place: BTreeMap<u32, usize> = rows
            .iter()
            .enumerate()
            .map(|(k, row): (usize, &Row)| (row.vertex, k))
            .collect();
        // On a closed oriented mesh every neighbour ends exactly one edge that starts here.
        for triangle in &mesh.triangles {
            for k in 0..3 {
                if let Some(&row) = place.get(&triangle[k]) {
                    rows[row].neighbours.push(triangle[(k + 1) % 3]);
                }
            }
        }
        Self { rows, near, side }
    }

    /// Draws them even on a body of a stature [m], clear of the trunk.
    pub(crate) fn draw(&self, positions: &mut [Vec3], stature: f64) {
        let mut moved = vec![Vec3::zeros(); self.rows.len()];
        for _ in 0..PASSES {
            for (row, to) in self.rows.iter().zip(&mut moved) {
                let sum: Vec3 = row.neighbours.iter().map(|&v| positions[v as usize]).sum();
                let middle = sum / row.neighbours.len().max(1) as f64;
                let p = positions[row.vertex as usize];
                *to = p + (middle - p) * row.share;
            }
            for (row, &to) in self.rows.iter().zip(&moved) {
                positions[row.vertex as usize] = to;
            }
            self.clear(positions, stature);
        }
    }

    /// Moves what lies below the armpit out of the trunk's side.
    fn clear(&self, positions: &mut [Vec3], stature: f64) {
        let side: Vec<Vec3> = self.side.iter().map(|&v| positions[v as usize]).collect();
        let Some(armpit) = side.last() else { return };
        for &v in &self.near {
            let p = positions[v as usize];
            let below = armpit.y - p.y;
            if below <= 0.0 {
                continue;
            }
            let trunk = side
                .windows(2)
                .find(|w| w[0].y <= p.y && p.y < w[1].y)
                .map(|w| w[0] + (w[1] - w[0]) * ((p.y - w[0].y) / (w[1].y - w[0].y)));
            if let Some(trunk) = trunk {
                // Round before and behind the side.
                let beside = (p.z - trunk.z) / (DEPTH * stature);
                let surface = trunk.x * (1.0 - 0.5 * beside * beside);
                let least = surface + CLEAR[0] * stature + CLEAR[1] * below;
                positions[v as usize].x = p.x.max(least);
            }
        }
    }
}
