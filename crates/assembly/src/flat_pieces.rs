//! Pieces laid flat, seen from the right side of the cloth, and the stitches between them.

use crate::Stitch;
use crate::mesh::PieceMeshes;
use toile_geometry::Vec2;

/// A piece seen from its right side, with its offsets in the plane in which rows are arranged.
#[derive(Clone, Debug)]
pub(crate) struct FlatPiece {
    /// Points of the piece seen from the right side of the cloth (m).
    pub points: Vec<Vec2>,
    /// Bounding box of the points (m).
    pub low: Vec2,
    pub high: Vec2,
    /// Offset of the second coordinate: height in the frame of the body part (m).
    pub rise: f64,
    /// Offset of the first coordinate: distance round the body part from its first direction (m).
    pub shift: f64,
    /// Increase of the piece's length round the body per metre below its inner edge, which lies at height 0
    /// of the points. It is the angle of the ring sector that the piece is (rad); 0 for a piece that is not
    /// flared.
    pub turn: f64,
}

impl FlatPiece {
    /// Width (m).
    pub fn width(&self) -> f64 {
        self.high.x - self.low.x
    }

    /// Lowest and highest coordinate in the frame of the body part (m).
    pub fn span(&self) -> [f64; 2] {
        [self.low.y + self.rise, self.high.y + self.rise]
    }
}

/// Turns every piece to its right side and measures it.
pub(crate) fn flat_pieces(meshes: &PieceMeshes, counter_clockwise: &[bool]) -> Vec<FlatPiece> {
    meshes
        .pieces
        .iter()
        .zip(counter_clockwise)
        .map(|(mesh, &turned)| {
            let side = if turned { 1.0 } else { -1.0 };
            let points: Vec<Vec2> = mesh
                .points
                .iter()
                .map(|p| Vec2::new(side * p.x, p.y))
                .collect();
            let first = points.first().copied().unwrap_or_default();
            let (low, high) = points
                .iter()
                .fold((first, first), |(l, h), p| (l.inf(p), h.sup(p)));
            FlatPiece {
                points,
                low,
                high,
                rise: 0.0,
                shift: 0.0,
                turn: 0.0,
            }
        })
        .collect()
}

/// A stitch: two pieces and a point in each.
pub(crate) struct Tie {
    pub pieces: [usize; 2],
    pub points: [Vec2; 2],
}

/// The stitches between different pieces.
pub(crate) fn ties(meshes: &PieceMeshes, laid: &[FlatPiece]) -> Vec<Tie> {
    let mut starts = vec![0];
    for piece in laid {
        starts.push(starts.last().copied().unwrap_or(0) + piece.points.len());
    }
    let find = |v: u32| {
        let piece = starts.partition_point(|&s| s <= v as usize) - 1;
        (piece, laid[piece].points[v as usize - starts[piece]])
    };
    meshes
        .stitches
        .iter()
        .filter_map(|s: &Stitch| {
            let [(a, p), (b, q)] = s.vertices.map(find);
            (a != b).then_some(Tie {
                pieces: [a, b],
                points: [p, q],
            })
        })
        .collect()
}
