//! Pieces dropped on the marker: laid against their neighbours, or returned to their place.

use super::ToileApp;
use super::notice::Notice;
use crate::views::marker::LetGoAs;
use toile_geometry::Vec2;
use toile_pattern::plan;
use toile_pattern::{Edit, EditError, MarkerId, OrderedPiece, PiecePlacement};
use toile_session::{LetGo, Obstacle};

impl ToileApp {
    /// Ends a drag of pieces by the vector `way` (m): makes it one step of the history, or none if the
    /// pieces go back.
    pub(super) fn drop_pieces(
        &mut self,
        (id, pieces): (MarkerId, &[OrderedPiece]),
        way: Vec2,
        how: LetGoAs,
    ) {
        let moved =
            |app: &Self, by: Vec2| plan::move_pieces(&app.base, (id, pieces), (way + by).into());
        self.let_go((id, pieces), ("Move pieces", how), moved);
    }

    /// Lays a waiting piece at a place (m).
    pub(super) fn lay_piece(
        &mut self,
        (id, piece): (MarkerId, OrderedPiece),
        at: Vec2,
        how: LetGoAs,
    ) {
        let roll = self.marker_view.roll as u16;
        let laid = |app: &Self, by: Vec2| {
            let laid = PiecePlacement {
                piece,
                at: (at + by).into(),
                turn: 0.0,
                flipped: false,
                locked: false,
                roll,
            };
            plan::place_pieces(&app.base, id, &[laid])
        };
        self.let_go((id, &[piece]), ("Lay piece", how), laid);
    }

    /// Ends the move of pieces: lays them, or puts them back if they overlap something. `edits` gives the
    /// edits that lay the pieces at an offset from the place of the drop (m).
    fn let_go(
        &mut self,
        (id, pieces): (MarkerId, &[OrderedPiece]),
        (label, how): (&str, LetGoAs),
        edits: impl Fn(&Self, Vec2) -> Result<Vec<Edit>, EditError>,
    ) {
        match edits(self, Vec2::zeros()) {
            Ok(edits) => self.preview(&edits),
            Err(error) => {
                self.session.cancel();
                self.refresh();
                self.say_fault(error.to_string());
                return self.follow_marker();
            }
        }
        let lies = self.session.marker_on_roll(id, self.marker_view.roll);
        let rest = match (how, lies) {
            (LetGoAs::Butted(reach), Ok(laid)) => laid.let_go(pieces, reach),
            _ => LetGo::Apart(Vec2::zeros()),
        };
        match rest {
            LetGo::Apart(by) => {
                if by != Vec2::zeros()
                    && let Ok(edits) = edits(self, by)
                {
                    self.preview(&edits);
                }
                self.commit(label);
            }
            LetGo::Over(obstacle) => {
                self.session.cancel();
                self.refresh();
                let words = match obstacle {
                    Obstacle::Piece(other) => self.base.pattern().piece_words(other),
                    Obstacle::Flaw => "a flaw of the fabric".to_owned(),
                };
                self.notice = Notice::warning(format!(
                    "It went back, as it lay over {words}: hold Alt to leave it there"
                ));
            }
        }
        self.follow_marker();
    }
}
