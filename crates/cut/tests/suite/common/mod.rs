//! Seam lines for tests, and small geometry of their own.

pub mod random;

use toile_cut::{Corner, Dart, SeamEdge, SeamLine};
use toile_geometry::{Curve, Vec2};

pub const KINDS: [Corner; 7] = [
    Corner::Mitre,
    Corner::Bevel,
    Corner::SquareToPrevious,
    Corner::SquareToNext,
    Corner::Extended,
    Corner::MirroredInPrevious,
    Corner::MirroredInNext,
];

pub fn line(start: Vec2, end: Vec2) -> Curve {
    Curve::Line { start, end }
}

/// Straight edges between points, mitred.
pub fn seam_of(points: &[Vec2], widths: &[f64]) -> SeamLine {
    SeamLine {
        outline: loop_of(points, widths),
        ..SeamLine::default()
    }
}

pub fn loop_of(points: &[Vec2], widths: &[f64]) -> Vec<SeamEdge> {
    (0..points.len())
        .map(|k| SeamEdge {
            limit: toile_cut::MITRE_LIMIT,
            curve: line(points[k], points[(k + 1) % points.len()]),
            width: widths[k],
            corner: Corner::Mitre,
        })
        .collect()
}

/// Where two lines, each a point and a direction, meet.
pub fn meet([p, d]: [Vec2; 2], [q, e]: [Vec2; 2]) -> Vec2 {
    p + d * ((q - p).perp(&e) / d.perp(&e))
}

pub fn vertex_near(points: &[Vec2], p: Vec2, tolerance: f64) -> Option<usize> {
    points.iter().position(|q| (q - p).norm() < tolerance)
}

pub fn other_way(corner: Corner) -> Corner {
    match corner {
        Corner::SquareToPrevious => Corner::SquareToNext,
        Corner::SquareToNext => Corner::SquareToPrevious,
        Corner::MirroredInPrevious => Corner::MirroredInNext,
        Corner::MirroredInNext => Corner::MirroredInPrevious,
        same => same,
    }
}

/// The same loop walked the other way: edge k becomes edge n - 1 - k.
pub fn reversed_loop(edges: &[SeamEdge]) -> Vec<SeamEdge> {
    let n = edges.len();
    (0..n)
        .map(|k| SeamEdge {
            limit: toile_cut::MITRE_LIMIT,
            curve: edges[n - 1 - k].curve.reversed(),
            width: edges[n - 1 - k].width,
            corner: other_way(edges[(n - k) % n].corner),
        })
        .collect()
}

pub fn reversed(seam: &SeamLine) -> SeamLine {
    let n = seam.outline.len();
    SeamLine {
        outline: reversed_loop(&seam.outline),
        holes: seam.holes.iter().map(|hole| reversed_loop(hole)).collect(),
        darts: seam
            .darts
            .iter()
            .map(|dart| Dart {
                legs: [n - 1 - dart.legs[1], n - 1 - dart.legs[0]],
                pressed: 1 - dart.pressed,
            })
            .collect(),
    }
}
