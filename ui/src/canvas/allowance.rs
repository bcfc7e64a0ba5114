//! Cut lines of panels, as drafted.

use std::sync::Arc;
use toile_cut::{CutOptions, CutPiece};
use toile_geometry::Vec2;
use toile_pattern::{Draft, PanelId, Pattern, Piece};

/// Cut lines of panels, cached: each is kept until its piece changes.
#[derive(Clone, Debug, Default)]
pub struct CutLines {
    known: Vec<CutLine>,
}

/// The cut line of a panel.
#[derive(Clone, Debug)]
struct CutLine {
    piece: Piece,
    /// Closed lines in the panel's plane (m).
    rings: Arc<[Vec<Vec2>]>,
}

impl CutLines {
    /// Updates the cut lines to a draft; returns how many were computed anew.
    pub fn follow(&mut self, pattern: &Pattern, draft: &Draft) -> u64 {
        let mut old = std::mem::take(&mut self.known);
        let mut made = 0;
        for (number, piece) in draft.pieces.iter().enumerate() {
            if piece.id.copy != 0 {
                continue;
            }
            let same = old.iter().position(|line| line.piece == *piece);
            self.known.push(match same {
                Some(k) => old.swap_remove(k),
                None => {
                    made += 1;
                    let cut =
                        CutPiece::new((pattern, draft), number, (None, &CutOptions::default()));
                    // A piece that cannot be cut gets no cut line here; the findings report it.
                    let rings = cut.map_or_else(|_| Vec::new(), |cut| closed(&cut));
                    CutLine {
                        piece: piece.clone(),
                        rings: rings.into(),
                    }
                }
            });
        }
        made
    }

    /// The closed cut lines of a panel, in its plane (m).
    pub fn of(&self, panel: PanelId) -> &[Vec<Vec2>] {
        let found = self.known.iter().find(|line| line.piece.id.panel == panel);
        found.map_or(&[], |line| &line.rings)
    }
}

fn closed(cut: &CutPiece) -> Vec<Vec<Vec2>> {
    let rings = cut.cut.iter().map(|ring| {
        let mut points = ring.points.clone();
        points.extend(ring.points.first());
        points
    });
    rings.collect()
}
