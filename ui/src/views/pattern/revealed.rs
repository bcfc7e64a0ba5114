//! Scrolls the view to a requested part.

use super::PatternView;
use crate::canvas::selection::Item;
use egui::Rect;
use toile_geometry::{Bounds2, Vec2};

/// The part or area to scroll to when the view is next drawn.
#[derive(Clone, Copy, Debug)]
pub(super) enum Revealed {
    /// A part.
    Part(Item),
    /// A whole rectangle of the table (m).
    Room(Bounds2),
}

impl PatternView {
    /// Centres the view on a part when it is next drawn, unless the part is visible already.
    pub fn reveal(&mut self, item: Item) {
        self.revealed = Some(Revealed::Part(item));
    }

    /// Shows a whole rectangle of the table (m) when the view is next drawn.
    pub fn reveal_room(&mut self, bounds: Bounds2) {
        self.revealed = Some(Revealed::Room(bounds));
    }

    /// Moves the table so that the requested part or area is visible.
    pub(super) fn follow_revealed(&mut self, view: Rect) {
        let camera = self.camera;
        match self.revealed.take() {
            Some(Revealed::Part(item)) => {
                let found = self
                    .parts()
                    .into_iter()
                    .find(|(_, known, _)| *known == item);
                if let Some((.., at)) = found
                    && !view.contains(self.screen(view, Vec2::zeros(), at))
                {
                    self.camera.centre = at;
                }
            }
            Some(Revealed::Room(bounds)) => self.camera.reveal(view, &bounds),
            None => {}
        }
        if self.camera != camera {
            self.fitted = None;
        }
    }
}
