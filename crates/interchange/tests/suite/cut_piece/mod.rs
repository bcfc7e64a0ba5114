//! A piece to cut for tests of markers.

use std::sync::Arc;
use toile_cut::{CutNotch, CutPiece, InsideLine, PieceRing, PieceSegment};
use toile_geometry::{Polygon, Vec2};
use toile_pattern::{EdgeId, EdgeOrigin, LineId, NotchId, NotchKind};

/// A piece with a line to sew along, a slit on it and a line inside.
pub fn cut_piece(
    name: &str,
    (cut, sew): (&Polygon, &Polygon),
    (notch, inward): ([f64; 2], [f64; 2]),
) -> Arc<CutPiece> {
    let mut piece = CutPiece::of_outline(name, cut, std::f64::consts::FRAC_PI_2);
    piece.sew = sew
        .rings()
        .map(|points| PieceRing {
            points: points.clone(),
            segments: vec![PieceSegment::Unknown; points.len()],
        })
        .collect();
    piece.notches = vec![CutNotch {
        id: NotchId(0),
        edge: EdgeOrigin::drawn(EdgeId(0)),
        kind: NotchKind::Slit,
        point: Vec2::from(notch),
        inward: Vec2::from(inward),
        on_cut: Vec2::from(notch),
        along: Vec2::new(inward[1], -inward[0]),
        depth: 0.006,
        cut: vec![vec![
            Vec2::from(notch),
            Vec2::from(notch) + Vec2::from(inward) * 0.006,
        ]],
    }];
    piece.inside = vec![InsideLine {
        name: toile_pattern::Name::Drawn(LineId(0)),
        points: vec![Vec2::new(0.1, 0.3), Vec2::new(0.2, 0.3)],
    }];
    Arc::new(piece)
}
