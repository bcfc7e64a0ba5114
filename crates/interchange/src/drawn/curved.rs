//! A line as corners with straight lines and curves between them.

use super::corners::{corners, is_straight};
use super::cubics::{Cubics, cubics};
use super::piece::{DrawnLine, Span};
use super::spline::Tangents;

/// Corners of a line, and the cubics of each edge that is no straight line.
#[derive(Clone, Debug)]
pub(crate) struct Curved {
    /// Indices of the corners among the vertices.
    pub corners: Vec<usize>,
    /// The cubics from each corner to the next; of an open line none start at the last.
    pub curves: Vec<Option<Cubics>>,
}

impl Curved {
    /// Corners and curves of a line in some number of sizes; `fold` are the vertices at the ends of a straight edge of
    /// it.
    pub fn new(line: &DrawnLine, fold: Option<[usize; 2]>, sizes: usize) -> Self {
        let corners = corners(line, fold.as_ref().map_or(&[], |ends| ends));
        let mut curved = Self {
            curves: vec![None; corners.len() - usize::from(!line.is_closed)],
            corners,
        };
        for edge in 0..curved.curves.len() {
            let (from, to) = curved.vertices(edge, line.len());
            let is_fold = fold == Some([from, to % line.len()]);
            let is_curve = || {
                let is_cubic = |k: usize| matches!(line.span(k % line.len()), Span::Cubic(_));
                let lies_straight = |size| is_straight(&line.stretch(size, (from, to)).0);
                (from..to).any(is_cubic) || !(0..sizes).all(lies_straight)
            };
            if !is_fold && is_curve() {
                curved.curves[edge] = Some(cubics(line, (from, to), (sizes, &[])));
            }
        }
        curved
    }

    /// The curves with other tangents at the ends of some edges, one a size; curves that the file gives denser than by
    /// vertices stay.
    #[must_use]
    pub fn with_tangents(&self, line: &DrawnLine, ends: &[Vec<Tangents>]) -> Self {
        let mut curved = self.clone();
        for (edge, ends) in ends.iter().enumerate() {
            let is_known = ends.iter().flatten().any(Option::is_some);
            if is_known && self.is_spline(edge) {
                let vertices = self.vertices(edge, line.len());
                curved.curves[edge] = Some(cubics(line, vertices, (ends.len(), ends)));
            }
        }
        curved
    }

    /// Whether an edge is a spline through its vertices alone.
    pub fn is_spline(&self, edge: usize) -> bool {
        self.curves[edge]
            .as_ref()
            .is_some_and(|curve| curve.is_spline)
    }

    /// Number of curves that keep straight chords, as a smooth one would turn back.
    pub fn chords(&self) -> usize {
        let curves = self.curves.iter().flatten();
        curves.filter(|curve| curve.has_chords).count()
    }

    /// The vertices at the ends of an edge of a line of `count` vertices; the second may lie beyond the last.
    fn vertices(&self, edge: usize, count: usize) -> (usize, usize) {
        let from = self.corners[edge];
        let to = self.corners[(edge + 1) % self.corners.len()];
        (from, if to > from { to } else { to + count })
    }
}
