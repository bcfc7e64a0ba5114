//! Paints guides, and the place of one that is dragged.

use super::paint::Picture;
use super::selection::Item;
use egui::Stroke;
use toile_geometry::Vec2;
use toile_pattern::GuideRun;

impl Picture<'_> {
    /// Paints guides across the whole view.
    pub(super) fn guides(&self) {
        for guide in self.guides {
            let lit = guide.id.is_none_or(|id| self.is_lit(Item::Guide(id)));
            let stroke = match lit {
                true => Stroke::new(2.0, self.palette.accent),
                false => Stroke::new(1.0, self.palette.guide),
            };
            let place = self.seen(Vec2::zeros(), Vec2::new(guide.at, guide.at));
            match guide.runs {
                GuideRun::Horizontal if self.view.y_range().contains(place.y) => {
                    self.painter
                        .hline(self.view.x_range(), place.y.round(), stroke);
                }
                GuideRun::Vertical if self.view.x_range().contains(place.x) => {
                    self.painter
                        .vline(place.x.round(), self.view.y_range(), stroke);
                }
                _ => {}
            }
        }
    }

    /// Paints the label of a guide that is dragged.
    pub(super) fn guide_label(&self) {
        if let Some(label) = self.guide_label {
            self.tag(label.at + egui::vec2(14.0, 22.0), &label.words);
        }
    }
}
