//! The lines of a piece in all sizes, in metres: those of each block with as many vertices, and the points of curves
//! between the vertices.

use super::block_piece::{BlockLine, BlockPiece};
use crate::drawn::piece::DrawnLine;
use crate::drawn::twin::between;
use std::collections::BTreeMap;
use toile_geometry::Vec2;

/// Vertices that lie nearer to the one before in every size are repeats (m).
const REPEAT: f64 = 1e-6;
/// Length of an edge that has none in the file in some size (m).
const SHORT: f64 = 1e-5;

/// Leaves out repeated vertices of a line, and gives an edge that vanishes in some sizes alone a length there: its end
/// moves on towards the next vertex.
pub(super) fn tell_apart(line: &mut DrawnLine) {
    line.drop_repeats(REPEAT);
    for points in line.by_size.iter_mut().filter(|_| line.is_closed) {
        let own = points.clone();
        let count = own.len();
        let is_apart = |a: usize, b: usize| (own[a % count] - own[b % count]).norm() > REPEAT;
        let Some(first) = (0..count).find(|&k| is_apart(k, k + count - 1)) else {
            continue;
        };
        for k in first + 1..first + count {
            let next = (k + 1..k + count).find(|&next| is_apart(next, k));
            if let (false, Some(next)) = (is_apart(k, k - 1), next) {
                let way = own[next % count] - own[k % count];
                points[k % count] = points[(k - 1) % count] + way * (SHORT / way.norm());
            }
        }
    }
}

/// A piece in its sizes, whose lines are taken.
#[derive(Clone, Copy)]
pub(super) struct SizedPiece<'a> {
    /// The block of the base size.
    pub own: &'a BlockPiece,
    /// The blocks by the index of the size.
    pub sized: &'a BTreeMap<usize, BlockPiece>,
    /// Number of sizes, at least 1.
    pub count: usize,
    /// Length of a unit of the file (m).
    pub unit: f64,
}

/// A line in all sizes.
#[derive(Clone, Debug, Default)]
pub(super) struct FoundLine {
    pub line: DrawnLine,
    /// Number of sizes whose blocks have no such line, which take that of the base size.
    pub unlike: usize,
    /// Whether the file has a dense twin of it that does not run along it in every size.
    pub is_twin_off: bool,
}

impl SizedPiece<'_> {
    /// A line in all sizes, with the points of its twin, which stands on the layer of this number; `None` if the base
    /// size has no such line.
    pub fn line(
        &self,
        of: impl Fn(&BlockPiece) -> Option<&BlockLine>,
        twin_layer: u16,
    ) -> Option<FoundLine> {
        let usual = of(self.own)?;
        let metres =
            |points: &[Vec2]| -> Vec<Vec2> { points.iter().map(|p| p * self.unit).collect() };
        let mut found = FoundLine {
            line: DrawnLine {
                is_closed: usual.is_closed,
                ..DrawnLine::default()
            },
            ..FoundLine::default()
        };
        let mut curved = Vec::with_capacity(self.count);
        let mut with_twin = 0;
        for size in 0..self.count {
            let block = self.sized.get(&size);
            let line = block.and_then(&of);
            let fits = line.filter(|line| {
                line.points.len() == usual.points.len() && line.is_closed == usual.is_closed
            });
            found.unlike += usize::from(block.is_some() && fits.is_none());
            // The twin of the block that the line comes from.
            let (line, block) = match (fits, block) {
                (Some(line), Some(block)) => (line, block),
                _ => (usual, self.own),
            };
            let points = metres(&line.points);
            let mut twins = block.twins.iter().filter(|(layer, _)| *layer == twin_layer);
            with_twin += usize::from(twins.clone().next().is_some());
            let stretches = match line.between.is_empty() {
                false => Some(line.between.iter().map(|points| metres(points)).collect()),
                true => twins.find_map(|(_, twin)| {
                    let is_alike = twin.is_closed == line.is_closed;
                    is_alike.then(|| between(&points, line.is_closed, &metres(&twin.points)))?
                }),
            };
            curved.extend(stretches);
            found.line.by_size.push(points);
        }
        let has_points =
            |stretches: &Vec<Vec<Vec2>>| stretches.iter().any(|points| !points.is_empty());
        if curved.len() == self.count && curved.iter().all(has_points) {
            found.line.between = curved;
        } else {
            found.is_twin_off = with_twin > 0 && curved.len() < self.count;
        }
        Some(found)
    }
}
