//! A pattern drafted for programs: pieces, edges, notches and seams, lengths in metres.

use crate::piece_facts::{edge_name, notch_facts};
use crate::report::{piece_area, span_length};
use crate::tools::sound_draft;
use crate::{Project, SessionError};
use std::sync::Arc;
use toile_cut::{CutOptions, CutPiece, PieceRing};
use toile_geometry::Vec2;
use toile_pattern::{Draft, DraftSpan, Pattern, Piece, PieceEdge};

/// A pattern drafted in a size or for a wearer.
#[derive(Clone, Debug)]
pub struct DraftedPattern {
    pattern: Arc<Pattern>,
    draft: Draft,
    size: Option<String>,
}

/// A piece of a drafted pattern. Positions are in the plane of the piece, seen from the right side of the
/// cloth.
#[derive(Clone, Debug, PartialEq)]
pub struct DraftedPiece {
    /// Name of the piece; no other has it.
    pub name: String,
    /// The panel that it is a copy of.
    pub panel: String,
    /// Number of the copy, from 0.
    pub copy: u32,
    /// Name of the fabric.
    pub fabric: String,
    /// Direction of the warp, counter-clockwise from +x (rad).
    pub grain: f64,
    /// Whether it is sewn to others, or is the only panel; else it is cut only.
    pub sewn: bool,
    /// Area within the sewing lines, holes taken out (m2).
    pub area: f64,
    /// Area within the cut lines, holes taken out (m2).
    pub cut_area: f64,
    /// The edges of the outline, then those of holes.
    pub edges: Vec<DraftedEdge>,
    /// Notches of the piece.
    pub notches: Vec<DraftedNotch>,
    piece: Piece,
    cut: Vec<PieceRing>,
}

/// An edge of a drafted piece. A spline is several edges of one name.
#[derive(Clone, Debug, PartialEq)]
pub struct DraftedEdge {
    /// Name of the edge, or of the operation that made it.
    pub name: String,
    /// Length along the sewing line (m).
    pub length: f64,
    /// Width of the seam allowance (m).
    pub allowance: f64,
}

/// A notch of a drafted piece.
#[derive(Clone, Debug, PartialEq)]
pub struct DraftedNotch {
    /// Name of the notch.
    pub name: String,
    /// Name of the edge that it is on.
    pub edge: String,
    /// Kind: slit, v, castle, t or check.
    pub kind: &'static str,
    /// Place on the sewing line (m).
    pub at: [f64; 2],
    /// Depth of the cut (m); 0 if the notch is drawn on the sewing line.
    pub depth: f64,
}

/// A seam of a drafted pattern.
#[derive(Clone, Debug, PartialEq)]
pub struct DraftedSeam {
    /// Name of the seam.
    pub name: String,
    /// Lengths of both sides (m).
    pub lengths: [f64; 2],
    /// Whether the longer side is gathered or eased on purpose.
    pub gathered: bool,
    /// Both sides: the piece and the edge of each stretch, by name, as they are walked.
    pub sides: [Vec<(String, String)>; 2],
}

impl Project {
    /// The pattern drafted in the project's size, or for its wearer.
    ///
    /// # Errors
    /// A size that the pattern does not have; faults that keep the garment from being made.
    pub fn drafted(&self) -> Result<DraftedPattern, SessionError> {
        self.check_size()?;
        Ok(DraftedPattern {
            draft: sound_draft(self)?,
            pattern: self.pattern.clone(),
            size: self.size_name().map(str::to_owned),
        })
    }
}

impl DraftedPattern {
    /// The size that it is drafted to, if that is one of the pattern's.
    pub fn size(&self) -> Option<&str> {
        self.size.as_deref()
    }

    /// The pieces.
    ///
    /// # Errors
    /// A piece that no cut line can be made for.
    pub fn pieces(&self) -> Result<Vec<DraftedPiece>, SessionError> {
        let pieces = 0..self.draft.pieces.len();
        pieces.map(|number| self.piece(number)).collect()
    }

    fn piece(&self, number: usize) -> Result<DraftedPiece, SessionError> {
        let how = (self.size(), &CutOptions::default());
        let cut = CutPiece::new((&self.pattern, &self.draft), number, how).map_err(|error| {
            SessionError::Faults {
                source_name: self.pattern.name.clone(),
                faults: vec![error.to_string()],
            }
        })?;
        let piece = self.draft.pieces[number].clone();
        let panel = self.pattern.panel(piece.id.panel);
        let fabric = self.draft.fabrics.get(piece.fabric);
        let notches = panel.map_or_else(Vec::new, |panel| {
            let facts = notch_facts((&self.pattern, panel), &cut);
            let each = facts.into_iter().zip(&cut.notches);
            each.map(|(facts, notch)| DraftedNotch {
                name: facts.name,
                edge: facts.edge,
                kind: facts.kind,
                at: notch.point.into(),
                depth: notch.depth,
            })
            .collect()
        });
        let edges = edges_of(&piece).map(|edge| DraftedEdge {
            name: self.edge_name(&piece, edge),
            length: edge.curve.length(),
            allowance: edge.seam_allowance,
        });
        Ok(DraftedPiece {
            name: piece.name.clone(),
            panel: panel.map_or_else(String::new, |panel| panel.name.clone()),
            copy: piece.id.copy,
            fabric: fabric.map_or_else(String::new, |fabric| fabric.name.clone()),
            grain: cut.grain,
            sewn: piece.sewn,
            area: piece_area(&piece),
            cut_area: cut.polygon().area(),
            edges: edges.collect(),
            notches,
            piece,
            cut: cut.cut,
        })
    }

    /// The seams, those of darts too.
    pub fn seams(&self) -> Vec<DraftedSeam> {
        let named = |span: &DraftSpan| {
            let piece = self.draft.pieces.get(span.piece)?;
            let edge = edges_of(piece).nth(span.edge)?;
            Some((piece.name.clone(), self.edge_name(piece, edge)))
        };
        let seams = self.draft.seams.iter().map(|seam| DraftedSeam {
            name: seam.name.clone(),
            lengths: [0, 1].map(|side| {
                let spans = seam.sides[side].iter();
                spans.map(|span| span_length(&self.draft, span)).sum()
            }),
            gathered: seam.gathered,
            sides: [0, 1].map(|side| seam.sides[side].iter().filter_map(named).collect()),
        });
        seams.collect()
    }

    fn edge_name(&self, piece: &Piece, edge: &PieceEdge) -> String {
        edge_name((&self.pattern, piece.id.panel), edge.origin)
    }
}

impl DraftedPiece {
    /// The sewing line in chords that stay within a tolerance (m) of its curves: the outline, counter-clockwise,
    /// then holes. The first point of each is not repeated.
    ///
    /// # Errors
    /// A tolerance that is not above 0.
    pub fn sewing_lines(&self, tolerance: f64) -> Result<Vec<Vec<[f64; 2]>>, SessionError> {
        if !tolerance.is_finite() || tolerance <= 0.0 {
            return Err(SessionError::Number {
                what: "the tolerance (m)",
                value: tolerance,
                hint: "give a length above 0, as 0.0001",
            });
        }
        let ring = |edges: &Vec<PieceEdge>| {
            let mut points: Vec<Vec2> = Vec::new();
            for edge in edges {
                points.extend(edge.curve.flatten(tolerance));
                points.pop();
            }
            arrays(&points)
        };
        let holes = self.piece.holes.iter();
        Ok([&self.piece.outline]
            .into_iter()
            .chain(holes)
            .map(ring)
            .collect())
    }

    /// The lines to cut along (m), curves in chords within 5 um: the outline, counter-clockwise, then holes. The
    /// first point of each is not repeated.
    pub fn cut_lines(&self) -> Vec<Vec<[f64; 2]>> {
        self.cut.iter().map(|ring| arrays(&ring.points)).collect()
    }
}

fn arrays(points: &[Vec2]) -> Vec<[f64; 2]> {
    points.iter().map(|&point| point.into()).collect()
}

fn edges_of(piece: &Piece) -> impl Iterator<Item = &PieceEdge> {
    piece.outline.iter().chain(piece.holes.iter().flatten())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SAMPLE;
    use std::path::Path;

    /// The area within the sewing line by its chords, and by its curves.
    #[test]
    fn chords_of_a_sewing_line_come_nearer_with_the_tolerance() {
        let (project, _) = Project::open(Path::new(SAMPLE)).unwrap();
        let drafted = project.drafted().unwrap();
        let pieces = drafted.pieces().unwrap();
        assert!(!pieces.is_empty() && pieces.iter().any(|piece| !piece.notches.is_empty()));
        for piece in &pieces {
            let off = |tolerance: f64| {
                let lines = piece.sewing_lines(tolerance).unwrap();
                let line = &lines[0];
                let next = line.iter().cycle().skip(1);
                let twice: f64 = line
                    .iter()
                    .zip(next)
                    .map(|(a, b)| a[0] * b[1] - a[1] * b[0])
                    .sum();
                (0.5 * twice - piece.area).abs()
            };
            assert!(off(1e-3) <= 1e-3 * 4.0, "{}", piece.name);
            assert!(off(1e-6) <= 1e-6 * 4.0, "{}", piece.name);
            assert!(piece.cut_area > piece.area);
        }
        assert!(pieces[0].sewing_lines(0.0).is_err() && pieces[0].sewing_lines(f64::NAN).is_err());
        for seam in drafted.seams() {
            assert!(seam.lengths.iter().all(|length| *length > 0.0));
            let names = seam.sides.iter().flatten();
            assert!(
                names
                    .clone()
                    .all(|(piece, _)| pieces.iter().any(|p| p.name == *piece))
            );
        }
    }
}
