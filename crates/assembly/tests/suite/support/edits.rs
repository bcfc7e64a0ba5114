//! Edits of drafts: points moved, lines and notches added.

use toile_geometry::{Curve, Vec2};
use toile_pattern::{Draft, LineId, Name, NotchId, NotchKind, PieceLine, PieceNotch};

/// The curve with all its points mapped.
pub fn mapped(curve: Curve, map: &dyn Fn(Vec2) -> Vec2) -> Curve {
    match curve {
        Curve::Line { start, end } => Curve::Line {
            start: map(start),
            end: map(end),
        },
        Curve::Arc { start, end, bulge } => Curve::Arc {
            start: map(start),
            end: map(end),
            bulge,
        },
        Curve::Quadratic {
            start,
            control,
            end,
        } => Curve::Quadratic {
            start: map(start),
            control: map(control),
            end: map(end),
        },
        Curve::Cubic {
            start,
            controls,
            end,
        } => Curve::Cubic {
            start: map(start),
            controls: controls.map(map),
            end: map(end),
        },
    }
}

/// Maps all points of a piece; notches are on the outline and go with it as the test says.
pub fn map_piece(draft: &mut Draft, piece: usize, map: &dyn Fn(Vec2) -> Vec2) {
    let piece = &mut draft.pieces[piece];
    for edge in piece
        .outline
        .iter_mut()
        .chain(piece.holes.iter_mut().flatten())
    {
        edge.curve = mapped(edge.curve, map);
    }
    for curve in piece.internal_lines.iter_mut().flat_map(|l| &mut l.curves) {
        *curve = mapped(*curve, map);
    }
}

/// Moves one point of a piece, wherever curves have it.
pub fn move_point(draft: &mut Draft, piece: usize, point: Vec2, by: Vec2) {
    map_piece(draft, piece, &|p| {
        if (p - point).norm() < 1e-9 { p + by } else { p }
    });
}

pub fn corner(draft: &Draft, piece: usize, edge: usize) -> Vec2 {
    draft.pieces[piece].outline[edge].curve.start()
}

pub fn lined(draft: &mut Draft, piece: usize, ends: [[f64; 2]; 2]) {
    let number = draft.pieces[piece].internal_lines.len() as u32;
    draft.pieces[piece].internal_lines.push(PieceLine {
        name: Name::Drawn(LineId(number)),
        curves: vec![Curve::Line {
            start: ends[0].into(),
            end: ends[1].into(),
        }],
    });
}

pub fn notched(draft: &mut Draft, piece: usize, edge: usize, fraction: f64) {
    let piece = &mut draft.pieces[piece];
    piece.notches.push(PieceNotch {
        id: NotchId(piece.notches.len() as u32),
        edge: piece.outline[edge].origin,
        kind: NotchKind::default(),
        point: piece.outline[edge].curve.sample(fraction, fraction, 0)[0],
        inward: Vec2::x(),
    });
}
