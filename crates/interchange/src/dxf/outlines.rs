//! Outlines of a block: one piece for each of those that lie in no other.

use super::block_piece::{BlockLine, BlockPiece};
use crate::drawn::allowance::{is_inside, nearest};
use toile_geometry::Vec2;

/// The pieces of a block: one for each closed cut line that lies in no other, with the marks and lines within
/// it; none for a block without a closed cut line. Cut lines within others are cut out.
pub(super) fn split(mut piece: BlockPiece) -> Vec<BlockPiece> {
    let cut = std::mem::take(&mut piece.cut);
    let mut outer: Vec<BlockLine> = Vec::new();
    for line in cut {
        let first = line.points[0];
        match outer.iter().any(|known| is_inside(first, &known.points)) {
            true => piece.cutouts.push(line),
            false => outer.push(line),
        }
    }
    if outer.len() < 2 {
        let Some(line) = outer.pop() else {
            return Vec::new();
        };
        piece.cut = vec![line];
        return vec![piece];
    }
    let of = |(k, line): (usize, BlockLine)| {
        let ring = line.points.clone();
        let on = |p: &Vec2| {
            let gap = 1e-3 * line.length();
            is_inside(*p, &ring) || nearest(*p, &ring).is_some_and(|found| found.distance <= gap)
        };
        let lines = |all: &[BlockLine]| -> Vec<BlockLine> {
            all.iter()
                .filter(|line| on(&line.points[0]))
                .cloned()
                .collect()
        };
        let points =
            |all: &[Vec2]| -> Vec<Vec2> { all.iter().copied().filter(|p| on(p)).collect() };
        let mut own = BlockPiece {
            sew: lines(&piece.sew),
            internal: lines(&piece.internal),
            cutouts: lines(&piece.cutouts),
            mirror: lines(&piece.mirror),
            grain: lines(&piece.grain),
            turn_points: points(&piece.turn_points),
            curve_points: points(&piece.curve_points),
            notches: piece
                .notches
                .iter()
                .copied()
                .filter(|(at, _)| on(at))
                .collect(),
            drills: points(&piece.drills),
            rules: piece
                .rules
                .iter()
                .copied()
                .filter(|(at, _)| on(at))
                .collect(),
            cut: vec![line.clone()],
            ..piece.clone()
        };
        if k > 0 {
            own.labels.add_to_name(&format!(" {}", k + 1));
            own.block = format!("{} {}", own.block, k + 1);
        }
        own
    };
    outer.into_iter().enumerate().map(of).collect()
}
