//! Internal lines of a piece as constraints of its mesh.

use crate::Diagnostic;
use crate::boundary::Boundary;
use crate::size_field::SizeField;
use toile_geometry::{Vec2, segments_cross};
use toile_pattern::Piece;

/// A position on an internal line of a piece.
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
    /// The point on a piece (m); `None` if the piece has no such curve.
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

/// Constraints inside the outline of a piece for its mesh.
#[derive(Clone, Debug, Default)]
pub(crate) struct Creases {
    /// Segments as pairs of vertices, numbered after those of the boundary.
    pub segments: Vec<[usize; 2]>,
    /// Positions of the vertices (m).
    pub points: Vec<Vec2>,
    /// Position of each vertex on its internal line.
    pub places: Vec<LinePlace>,
    /// Number of points and segments left out because they are too near to others or cross them.
    pub left_out: usize,
}

impl Creases {
    /// Samples the internal lines of a piece, at a distance from its boundary and from each other.
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

    /// Adds the segment between two points unless it crosses the boundary or another segment.
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

/// A note on points of internal lines that the mesh does not follow, if there are any.
pub(crate) fn left_out_note(piece: &Piece, left_out: usize) -> Option<Diagnostic> {
    (left_out > 0).then(|| {
        Diagnostic::note(
            &piece.name,
            format!("{left_out} points of internal lines cross others and are not meshed exactly"),
            "keep internal lines apart",
        )
    })
}
