//! Parts of seam sides that lie opposite each other, and whether both show the same side of the cloth.

use crate::{Draft, DraftSpan, Piece, PieceEdge};

/// Least share of a seam along which two spans must lie opposite each other to count as sewn together (1). A
/// smaller share comes from sides that differ in length, not from the design.
const BESIDE: f64 = 0.02;

/// Two spans that lie opposite each other in a seam.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Meeting {
    /// Indices of the span of the first side and of the span of the second side.
    pub spans: [usize; 2],
    /// Whether both spans run the same way round their cloth, so that one of the two pieces shows its wrong
    /// side.
    pub turns: bool,
}

/// A part of one side of a seam: consecutive spans on one piece.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SidePart {
    /// Total length of the spans (m).
    pub length: f64,
    /// Whether the part runs in the direction of the outline: counter-clockwise seen from the right side.
    pub along_outline: bool,
}

impl SidePart {
    /// The part that consists of these spans. `None`: the spans have no length.
    pub fn of(draft: &Draft, spans: &[DraftSpan]) -> Option<Self> {
        let mut part = Self {
            length: 0.0,
            along_outline: true,
        };
        let mut along = 0.0;
        for span in spans {
            let edge = edges(draft.pieces.get(span.piece)?).nth(span.edge)?;
            let way = edge.curve.length() * (span.to - span.from);
            part.length += way.abs();
            along += way;
        }
        part.along_outline = along > 0.0;
        (part.length > 0.0).then_some(part)
    }
}

fn edges(piece: &Piece) -> impl Iterator<Item = &PieceEdge> {
    piece.outline.iter().chain(piece.holes.iter().flatten())
}

/// The pairs of parts that lie opposite each other, when positions are shares from 0 to 1 of the length of
/// each side. The numbers in the result are indices of parts on their sides.
pub(crate) fn meetings(sides: [&[SidePart]; 2]) -> Vec<Meeting> {
    let shares = sides.map(|parts| {
        let total: f64 = parts.iter().map(|part| part.length).sum();
        let mut start = 0.0;
        let share = |part: &SidePart| {
            let from = start;
            start += part.length / total;
            [from, start]
        };
        parts.iter().map(share).collect::<Vec<[f64; 2]>>()
    });
    let mut found = Vec::new();
    for (i, a) in shares[0].iter().enumerate() {
        for (j, b) in shares[1].iter().enumerate() {
            let common = a[1].min(b[1]) - a[0].max(b[0]);
            let least = BESIDE.min(0.5 * (a[1] - a[0]).min(b[1] - b[0]));
            if common > least {
                found.push(Meeting {
                    spans: [i, j],
                    turns: sides[0][i].along_outline == sides[1][j].along_outline,
                });
            }
        }
    }
    found
}
