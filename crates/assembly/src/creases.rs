//! Internal lines of a piece, as constraints of its mesh.

use crate::Diagnostic;
use crate::boundary::Boundary;
use crate::size_field::SizeField;
use toile_geometry::{Vec2, segments_cross};
use toile_pattern::Piece;

/// A place on an internal line of a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LinePlace {
    /// Index into the piece's internal lines.
    pub line: usize,
    /// Index into the line's curves.
    pub curve: usize,
    /// Arc-length fraction of the curve.
    pub fraction: f64,
}

impl LinePlace {
    /// Where it is on a piece (m); none where the piece has no such curve.
    pub fn point(&self, piece: &Piece) -> Option<Vec2> {
        let curve = piece
            .internal_lines
            .get(self.line)?
            .curves
            .get(self.curve)?;
        let point = curve
            .sample(self.fraction, self.fraction, 0)
            .first()
            .copied()?;
        (curve.is_finite() && point.iter().all(|x| x.is_finite())).then_some(point)
    }
}

/// Constraints of the mesh of a piece inside its outline.
#[derive(Clone, Debug, Default)]
pub(crate) struct Creases {
    /// Pairs of vertices, numbered after the boundary's.
    pub segments: Vec<[usize; 2]>,
    /// Their points (m).
    pub points: Vec<Vec2>,
    /// Where on a line each point is.
    pub places: Vec<LinePlace>,
    /// Points and segments left out because they meet others.
    pub left_out: usize,
}

impl Creases {
    /// Samples the internal lines of a piece, clear of its boundary and of each other.
    pub fn new(piece: &Piece, boundary: &Boundary, edge_length: f64) -> Self {
        let walls: Vec<[Vec2; 2]> = boundary
            .segments()
            .map(|s| s.map(|v| boundary.points[v]))
            .collect();
        let field = SizeField::new(boundary, &[], edge_length);
        let base = boundary.points.len();
        let mut creases = Self::default();
        for (line_index, line) in piece.internal_lines.iter().enumerate() {
            let mut previous: Option<usize> = None;
            for (curve_index, curve) in line.curves.iter().enumerate() {
                if !curve.is_finite() {
                    continue;
                }
                let count = (curve.length() / edge_length).round().clamp(1.0, 1e5) as usize;
                for (k, p) in curve.sample(0.0, 1.0, count).into_iter().enumerate() {
                    if previous.is_some_and(|v| (creases.points[v] - p).norm() < 1e-6) {
                        continue;
                    }
                    let clear = creases
                        .points
                        .iter()
                        .all(|q| (q - p).norm() > 0.4 * edge_length);
                    if field.boundary_distance(p) < 0.5 * edge_length
                        || !clear
                        || !boundary.contains(p)
                    {
                        previous = None;
                        creases.left_out += usize::from(!clear);
                        continue;
                    }
                    creases.points.push(p);
                    creases.places.push(LinePlace {
                        line: line_index,
                        curve: curve_index,
                        fraction: k as f64 / count as f64,
                    });
                    let here = creases.points.len() - 1;
                    if let Some(before) = previous {
                        creases.join([before, here], base, &walls);
                    }
                    previous = Some(here);
                }
            }
        }
        creases
    }

    /// Adds the segment between two points where it crosses neither the boundary nor another.
    fn join(&mut self, ends: [usize; 2], base: usize, walls: &[[Vec2; 2]]) {
        let segment = ends.map(|v| self.points[v]);
        let free = walls.iter().all(|w| !segments_cross(*w, segment))
            && self.segments.iter().all(|s| {
                s.contains(&(ends[0] + base))
                    || !segments_cross(s.map(|v| self.points[v - base]), segment)
            });
        if free {
            self.segments.push(ends.map(|v| v + base));
        } else {
            self.left_out += 1;
        }
    }

    /// A note on lines that were left out, if any.
    pub fn note(&self, piece: &Piece) -> Option<Diagnostic> {
        left_out_note(piece, self.left_out)
    }
}

/// Tells how many points of internal lines the mesh does not follow.
pub(crate) fn left_out_note(piece: &Piece, left_out: usize) -> Option<Diagnostic> {
    (left_out > 0).then(|| {
        Diagnostic::note(
            &piece.name,
            format!("{left_out} points of internal lines cross others and are not meshed exactly"),
            "keep internal lines apart",
        )
    })
}
