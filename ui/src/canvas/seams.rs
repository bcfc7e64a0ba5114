//! Seams as drawn: coloured stretches beside the outlines they join.

use toile_geometry::{Curve, Vec2};
use toile_pattern::{Draft, EdgeId, EdgeOrigin, Name, PanelId, SeamId, SeamOrigin};

/// One seam as drawn.
#[derive(Clone, Debug)]
pub struct SeamDrawing {
    /// Identity of the seam.
    pub id: SeamId,
    /// Name of the seam.
    pub name: String,
    /// Number that is shown on both sides of the seam.
    pub number: usize,
    /// Length of each side (m).
    pub lengths: [f64; 2],
    /// Start and end of each side, on the first copies of panels, which are drawn; `None` for a side on
    /// another copy.
    pub ends: [Option<[SeamEnd; 2]>; 2],
    /// Stretches of outlines that the seam joins, on the panels as drawn.
    pub stretches: Vec<SeamStretch>,
}

/// A stretch of one panel's outline that a seam joins.
#[derive(Clone, Debug)]
pub struct SeamStretch {
    /// The panel that the stretch is on.
    pub panel: PanelId,
    /// The edge that the stretch is on; `None` on the mirrored half.
    pub edge: Option<EdgeId>,
    /// Side of the seam: 0 the first, 1 the second.
    pub side: usize,
    /// Polyline of the stretch, in the direction of the panel's outline (m).
    pub line: Vec<Vec2>,
}

/// End of a side of a seam: the panel, and the point in the panel's plane (m).
pub type SeamEnd = (PanelId, Vec2);

/// The seams of a draft; curves are flattened to within a tolerance (m).
pub fn draw_seams(draft: &Draft, tolerance: f64) -> Vec<SeamDrawing> {
    let mut seams: Vec<SeamDrawing> = Vec::new();
    for seam in &draft.seams {
        let SeamOrigin::Seam(id) = seam.id else {
            continue;
        };
        let mut drawing = SeamDrawing {
            id,
            name: seam.name.clone(),
            number: seams.len() + 1,
            lengths: [0.0; 2],
            ends: [None; 2],
            stretches: Vec::new(),
        };
        for (side, spans) in seam.sides.iter().enumerate() {
            for span in spans {
                let Some(piece) = draft.pieces.get(span.piece) else {
                    continue;
                };
                let all = piece.outline.iter().chain(piece.holes.iter().flatten());
                let Some(edge) = all.into_iter().nth(span.edge) else {
                    continue;
                };
                drawing.lengths[side] += edge.curve.length() * (span.to - span.from).abs();
                if piece.id.copy == 0 {
                    let [start, end] = [span.from, span.to].map(|share| {
                        let length = edge.curve.length() * share.clamp(0.0, 1.0);
                        let at = edge.curve.point(edge.curve.parameter_at_length(length));
                        (piece.id.panel, at)
                    });
                    let first = drawing.ends[side].map_or(start, |ends| ends[0]);
                    drawing.ends[side] = Some([first, end]);
                    drawing.stretches.push(SeamStretch {
                        panel: piece.id.panel,
                        edge: match edge.origin {
                            EdgeOrigin {
                                name: Name::Drawn(edge),
                                half: 0,
                            } => Some(edge),
                            _ => None,
                        },
                        side,
                        line: stretch(&edge.curve, span.from, span.to, tolerance),
                    });
                }
            }
        }
        seams.push(drawing);
    }
    seams
}

impl SeamDrawing {
    /// Length of the first side minus the length of the second (m).
    pub fn difference(&self) -> f64 {
        self.lengths[0] - self.lengths[1]
    }
}

/// The part of a curve between two shares of its length, in the curve's own direction.
fn stretch(curve: &Curve, from: f64, to: f64, tolerance: f64) -> Vec<Vec2> {
    let length = curve.length();
    let at = |share: f64| curve.parameter_at_length(length * share.clamp(0.0, 1.0));
    let part = curve.between(at(from.min(to)), at(from.max(to)));
    part.flatten(tolerance)
}
