//! Smooths the skin under the shoulder, and holds arm and trunk apart.

use std::collections::BTreeMap;
use toile_geometry::{TriangleMesh, Vec3};

/// Number of smoothing passes, in which every vertex moves towards the mean of its neighbours.
const PASSES: usize = 10;
/// Number of passes if the arm presses against the trunk, where rings lie close.
const PRESSED: usize = 80;

/// Least distance of the arm from the side of the trunk: a share of the stature (1), and an increase for each
/// metre below the armpit (1).
const CLEAR: [f64; 2] = [0.0016, 0.1];

/// Vertices under the left arm.
pub(crate) struct Underarm {
    rows: Vec<Row>,
    /// Vertices of the arm that may come near the trunk.
    near: Vec<u32>,
    /// Columns of vertices on the trunk's side under the arm, from front to back, each from the lowest row up
    /// to the arm's border.
    side: Vec<Vec<u32>>,
}

/// A vertex with the share to which it is smoothed, and its neighbours.
struct Row {
    vertex: u32,
    share: f64,
    neighbours: Vec<u32>,
}

impl Underarm {
    /// Selects vertices on a template with the shoulder at a height (m): vertices below the shoulder in the
    /// arm's first rings, which follow the arm only in part. Smoothing decreases towards the shoulder.
    pub(crate) fn of(mesh: &TriangleMesh, arm: &[f64], side: &[Vec<u32>], shoulder: f64) -> Self {
        /// Range of the share with which vertices of these rings follow the arm: those of the border and of
        /// the trunk follow it less.
        const FOLLOW: [f64; 2] = [0.5, 0.999];
        /// Depth below the armpit down to which an arm may press against the trunk (m).
        const BELOW: f64 = 0.12;
        let top_of = |column: &Vec<u32>| column.last().map(|&v| mesh.positions[v as usize].y);
        let armpit = side.iter().filter_map(top_of).fold(0.0, f64::max);
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
        // In a closed oriented mesh every neighbour is the end of exactly one edge that starts here.
        for triangle in &mesh.triangles {
            for k in 0..3 {
                if let Some(&row) = place.get(&triangle[k]) {
                    rows[row].neighbours.push(triangle[(k + 1) % 3]);
                }
            }
        }
        Self {
            rows,
            near,
            side: side.to_vec(),
        }
    }

    /// Smooths the vertices on a body of a stature (m), and keeps them clear of the trunk.
    pub(crate) fn draw(&self, positions: &mut [Vec3], stature: f64) {
        let mut moved = vec![Vec3::zeros(); self.rows.len()];
        let mut presses = true;
        for pass in 0..PRESSED {
            if pass >= PASSES && !presses {
                break;
            }
            for (row, to) in self.rows.iter().zip(&mut moved) {
                let sum: Vec3 = row.neighbours.iter().map(|&v| positions[v as usize]).sum();
                let middle = sum / row.neighbours.len().max(1) as f64;
                let p = positions[row.vertex as usize];
                *to = p + (middle - p) * row.share;
            }
            for (row, &to) in self.rows.iter().zip(&moved) {
                positions[row.vertex as usize] = to;
            }
            presses = self.clear(positions, stature);
        }
    }

    /// Moves vertices below the armpit out of the trunk's side. Returns whether any lay inside.
    fn clear(&self, positions: &mut [Vec3], stature: f64) -> bool {
        let side: Vec<Vec<Vec3>> = self
            .side
            .iter()
            .map(|column| column.iter().map(|&v| positions[v as usize]).collect())
            .collect();
        let tops = side.iter().filter_map(|column| column.last());
        let armpit = tops.map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
        let mut presses = false;
        for &v in &self.near {
            let p = positions[v as usize];
            let below = armpit - p.y;
            if below <= 0.0 {
                continue;
            }
            let mut outline = side.iter().filter_map(|column| at_height(column, p.y));
            let Some(mut before) = outline.next() else {
                continue;
            };
            for behind in outline {
                if behind.z <= p.z && p.z <= before.z {
                    let share = (before.z - p.z) / (before.z - behind.z).max(1e-9);
                    let surface = before.x + (behind.x - before.x) * share;
                    let least = surface + CLEAR[0] * stature + CLEAR[1] * below;
                    presses |= p.x < least;
                    positions[v as usize].x = p.x.max(least);
                    break;
                }
                before = behind;
            }
        }
        presses
    }
}

/// Point of a column at a height; the top of the column if the column ends lower; `None` below the foot of
/// the column.
fn at_height(column: &[Vec3], y: f64) -> Option<Vec3> {
    let next = column.partition_point(|p| p.y <= y);
    match (next.checked_sub(1), column.get(next)) {
        (None, _) => None,
        (Some(k), None) => Some(column[k]),
        (Some(k), Some(b)) => {
            let a = column[k];
            Some(a + (b - a) * ((y - a.y) / (b.y - a.y)))
        }
    }
}
