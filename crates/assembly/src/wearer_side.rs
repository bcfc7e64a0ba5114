//! The side of the wearer for each copy of a pair, derived from the seams.

use crate::flat_pieces::{FlatPiece, Tie};
use crate::mesh::PieceMeshes;
use toile_pattern::Facing;

/// For each meshed piece, whether it goes on the wearer's left, if the seams tell.
///
/// A stitch to a piece across the middle of the body tells the side by its position on that piece. A stitch
/// between both copies of a pair lies at the middle and tells it by its position on the copy. A stitch to a
/// piece with a known side tells that side. `facing` and `known` come from names and the document.
pub(crate) fn wearer_sides(
    (meshes, laid): (&PieceMeshes, &[FlatPiece]),
    ties: &[Tie],
    facing: &[Option<Facing>],
    known: &[Option<bool>],
) -> Vec<Option<bool>> {
    let twins = twins(meshes);
    let mut left: Vec<Option<bool>> = known.to_vec();
    // The piece with the strongest evidence is decided first, and becomes evidence for its neighbours.
    loop {
        let mut scores = vec![0.0; laid.len()];
        for tie in ties {
            for (own, other) in [(0, 1), (1, 0)] {
                let [k, j] = [tie.pieces[own], tie.pieces[other]];
                let Some(twin) = twins[k] else {
                    continue;
                };
                scores[k] += if j == twin {
                    // The middle of the body lies to the right of a piece on the left.
                    -side_of(&laid[k], tie.points[own].x, facing[k])
                } else if twins[j].is_none() {
                    side_of(&laid[j], tie.points[other].x, facing[j])
                } else {
                    left[j].map_or(0.0, sign)
                };
            }
        }
        let open = (0..laid.len()).filter(|&k| left[k].is_none() && scores[k].abs() > 0.5);
        let best = open.max_by(|&a, &b| {
            let order = scores[a].abs().total_cmp(&scores[b].abs());
            order.then(b.cmp(&a))
        });
        let Some(best) = best else {
            return left;
        };
        left[best] = Some(scores[best] > 0.0);
        if let Some(twin) = twins[best].filter(|&twin| left[twin].is_none()) {
            left[twin] = Some(scores[best] < 0.0);
        }
    }
}

/// For each piece, the other copy of its pair among the meshed pieces.
fn twins(meshes: &PieceMeshes) -> Vec<Option<usize>> {
    let ids = meshes.pieces.iter().map(|mesh| mesh.piece);
    let twin = |id: toile_pattern::PieceId| {
        let other = toile_pattern::PieceId {
            copy: id.copy ^ 1,
            ..id
        };
        meshes.pieces.iter().position(|mesh| mesh.piece == other)
    };
    ids.map(twin).collect()
}

/// 1 for the wearer's left, -1 for the right.
fn sign(left: bool) -> f64 {
    if left { 1.0 } else { -1.0 }
}

/// The side of the wearer on which a position on a piece across the middle lies, as a sign; zero if the
/// facing does not tell. Seen from outside, the wearer's left is on the right in front and on the left
/// behind.
fn side_of(piece: &FlatPiece, x: f64, facing: Option<Facing>) -> f64 {
    let from_middle = x - 0.5 * (piece.low.x + piece.high.x);
    match facing {
        Some(Facing::Front) => sign(from_middle > 0.0),
        Some(Facing::Back) => sign(from_middle < 0.0),
        _ => 0.0,
    }
}
