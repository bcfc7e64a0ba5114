//! Outlines of a block: one piece for each of those that lie in no other.

use super::block_piece::{BlockLine, BlockPiece};
use crate::drawn::allowance::distance;
use toile_geometry::{Bounds2, Polygon, Vec2};

/// Distance from an outline at which a mark still belongs to it, as a share of the outline's length.
const ON_OUTLINE: f64 = 1e-3;

/// The pieces of a block: one for each closed cut line that lies in no other, with the marks and lines within
/// it; none for a block without a closed cut line. Cut lines within others are cut out.
pub(super) fn split(mut piece: BlockPiece) -> Vec<BlockPiece> {
    let cut = std::mem::take(&mut piece.cut);
    let mut outer: Vec<BlockLine> = Vec::new();
    let mut shapes: Vec<(Bounds2, Polygon)> = Vec::new();
    for line in cut {
        let shape = line.shape();
        let bounds = Bounds2::of(shape.iter().copied());
        let first = line.points[0];
        let holds = |(around, shape): &(Bounds2, Polygon)| {
            around.contains(first) && around.meets(&bounds) && shape.contains(first)
        };
        if shapes.iter().any(holds) {
            piece.cutouts.push(line);
        } else {
            shapes.push((bounds, Polygon::new(shape)));
            outer.push(line);
        }
    }
    if outer.len() < 2 {
        let Some(line) = outer.pop() else {
            return Vec::new();
        };
        piece.cut = vec![line];
        return vec![piece];
    }
    let of = |(k, (line, (bounds, around))): (usize, (BlockLine, (Bounds2, Polygon)))| {
        let gap = ON_OUTLINE * line.length();
        let near = bounds.grown(gap);
        let on = |p: &Vec2| {
            near.contains(*p) && (around.contains(*p) || distance(*p, &around.outer) <= gap)
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
            axes: lines(&piece.axes),
            turn_points: points(&piece.turn_points),
            notches: piece
                .notches
                .iter()
                .copied()
                .filter(|(at, _)| on(at))
                .collect(),
            drills: points(&piece.drills),
            notch_lines: piece
                .notch_lines
                .iter()
                .filter(|(line, _)| line.points.iter().any(on))
                .cloned()
                .collect(),
            twins: piece
                .twins
                .iter()
                .filter(|(_, line)| on(&line.points[0]))
                .cloned()
                .collect(),
            rules: piece
                .rules
                .iter()
                .copied()
                .filter(|(at, _)| on(at))
                .collect(),
            cut: vec![line.clone()],
            block: piece.block.clone(),
            labels: piece.labels.clone(),
            ..BlockPiece::default()
        };
        if k == 0 {
            // Parts of no outline are told with the first.
            own.u_notches = piece.u_notches;
            own.depths = piece.depths;
            own.open_cuts = piece.open_cuts;
            own.flat_cuts = piece.flat_cuts;
            own.references = piece.references;
            own.others = piece.others;
        } else {
            own.labels.add_to_name(&format!(" {}", k + 1));
            own.block = format!("{} {}", own.block, k + 1);
        }
        own
    };
    outer.into_iter().zip(shapes).enumerate().map(of).collect()
}
