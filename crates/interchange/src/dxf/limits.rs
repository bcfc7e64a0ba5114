//! How many points of a drawing are read.

use super::block_piece::{BlockLine, BlockPiece};
use crate::FormatError;

/// Most vertices of the outlines and lines of a pattern in its base size.
const MAX_POINTS: usize = 200_000;
/// Most vertices of the outlines and lines of a pattern in all sizes.
const MAX_SIZED_POINTS: usize = 1_000_000;

/// Refuses pieces of more points than a document can hold in a number of sizes.
///
/// # Errors
/// There are more.
pub(super) fn check_points<'a>(
    pieces: impl Iterator<Item = &'a BlockPiece>,
    sizes: usize,
) -> Result<(), FormatError> {
    let points = |piece: &BlockPiece| -> usize {
        let lines = [&piece.cut, &piece.sew, &piece.internal, &piece.cutouts];
        let lines = lines.into_iter().flatten();
        let between = |line: &BlockLine| line.between.iter().map(Vec::len).sum::<usize>();
        lines.map(|line| line.points.len() + between(line)).sum()
    };
    let base: usize = pieces.map(points).sum();
    match base > MAX_POINTS || base.saturating_mul(sizes) > MAX_SIZED_POINTS {
        false => Ok(()),
        true => Err(FormatError::new(
            "the whole file",
            format!("its lines have {base} vertices in {sizes} sizes"),
            format!(
                "at most {MAX_POINTS} are read, in all sizes {MAX_SIZED_POINTS}: save fewer pieces or sizes in one file"
            ),
        )),
    }
}
