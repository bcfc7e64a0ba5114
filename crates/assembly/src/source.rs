//! The shape that the mesh of a piece was made from, so that its triangles can follow a later shape.

use crate::creases::{Creases, LinePlace};
use crate::edges::contours;
use crate::harmonic::SharedWeights;
use crate::sampling::Sampling;
use std::ops::Range;
use toile_geometry::{Curve, Vec2};
use toile_pattern::{EdgeOrigin, Piece, PieceEdge, PieceLine};

/// One edge of a piece as it was sampled.
#[derive(Clone, Debug)]
pub(crate) struct EdgeSource {
    /// The edge of the panel that it comes from.
    pub origin: EdgeOrigin,
    /// Whether it has the opposite direction to the edge as drawn.
    pub reversed: bool,
    /// Index of the closed loop of the piece: 0 the outline, then the holes.
    pub contour: usize,
    /// Curve of the edge (m).
    pub curve: Curve,
    /// Arc-length fractions of the samples, both ends included.
    pub fractions: Vec<f64>,
    /// Indices of the samples that are nodes, the ends included.
    pub nodes: Vec<usize>,
}

/// The shape a piece had when it was meshed.
#[derive(Clone, Debug, Default)]
pub(crate) struct MeshSource {
    /// Vertices (m): boundary, points of internal lines, then free vertices.
    pub points: Vec<Vec2>,
    /// Edges of the piece: outline first, then each hole.
    pub edges: Vec<EdgeSource>,
    /// Internal lines of the piece.
    pub lines: Vec<PieceLine>,
    /// Position on an internal line of each vertex that follows those of the boundary.
    pub line_places: Vec<LinePlace>,
    /// Number of points of internal lines that the mesh does not follow.
    pub left_out: usize,
    /// Weights by which the free vertices follow the others.
    pub weights: SharedWeights,
}

/// The edges of a piece, each with the index of its loop.
fn edges(piece: &Piece) -> impl Iterator<Item = (usize, &PieceEdge)> {
    let loops = contours(piece).enumerate();
    loops.flat_map(|(contour, edges)| edges.iter().map(move |edge| (contour, edge)))
}

impl EdgeSource {
    /// The edges of a piece, which have the indices `range` among the sampled ones.
    pub fn of_piece(piece: &Piece, range: Range<usize>, sampling: &Sampling) -> Vec<Self> {
        let sampled = range.zip(edges(piece));
        sampled
            .map(|(edge, (contour, drawn))| Self {
                origin: drawn.origin,
                reversed: drawn.reversed,
                contour,
                curve: drawn.curve,
                fractions: sampling.fractions[edge].clone(),
                nodes: sampling.nodes[edge].clone(),
            })
            .collect()
    }
}

impl MeshSource {
    /// The source of a mesh with these points.
    pub fn new(piece: &Piece, points: Vec<Vec2>, edges: Vec<EdgeSource>, creases: Creases) -> Self {
        Self {
            points,
            edges,
            lines: piece.internal_lines.clone(),
            line_places: creases.places,
            left_out: creases.left_out,
            weights: SharedWeights::default(),
        }
    }

    /// Whether a piece has the same edges and internal lines, regardless of their shape.
    pub fn is_of(&self, piece: &Piece) -> bool {
        let own = self.edges.iter().map(|e| (e.origin, e.reversed, e.contour));
        let named = |line: &PieceLine| (line.name, line.curves.len());
        own.eq(edges(piece).map(|(contour, e)| (e.origin, e.reversed, contour)))
            && (self.lines.iter().map(named)).eq(piece.internal_lines.iter().map(named))
    }

    /// Whether a piece with the same edges and lines has them in the same shape, with samples at the same
    /// fractions.
    pub fn has_shape_of(&self, piece: &Piece, fractions: &[Vec<f64>]) -> bool {
        let own = self.edges.iter().map(|e| (e.curve, &e.fractions));
        own.eq(edges(piece).map(|(_, e)| e.curve).zip(fractions))
            && self.lines == piece.internal_lines
    }
}
