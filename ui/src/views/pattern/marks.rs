//! Signs of findings over the table: told where the pointer rests, and a click selects the part.

use super::PatternView;
use crate::canvas::finding_marks::FindingMark;
use crate::canvas::selection::Item;
use crate::theme::Palette;
use egui::{Rect, Role, Sense, Ui, Vec2, WidgetInfo};
use toile_geometry::Vec2 as Place;

impl PatternView {
    /// Draws them; says which part was clicked at its sign. While a tool is under way they are drawn alone.
    pub(super) fn show_finding_marks(&mut self, ui: &Ui, view: Rect) -> Option<Item> {
        let palette = Palette::of(ui.ctx());
        let (painter, parts) = (ui.painter_at(view), self.parts());
        let mut chosen = None;
        let mut taken = std::mem::take(&mut self.labels);
        for mark in &self.finding_marks {
            let part = parts.iter().find(|(_, item, _)| *item == mark.item);
            let Some((.., at)) = part else {
                continue;
            };
            let mut place = FindingMark::place(self.screen(view, Place::zeros(), *at));
            // Beside other labels, and signs of the same place beside each other.
            while let Some(other) = taken.iter().find(|other| other.intersects(place)) {
                place = place.translate(Vec2::new(other.right() - place.left() + 1.0, 0.0));
            }
            taken.push(place);
            if !view.contains_rect(place) {
                continue;
            }
            mark.paint(&painter, place, palette);
            if self.is_busy() {
                continue;
            }
            let id = Self::id().with(("finding", mark.item));
            let sign = ui.interact(place, id, Sense::click());
            sign.widget_info(|| WidgetInfo::labeled(Role::Button, true, &mark.words));
            if sign.on_hover_text(&mark.words).clicked() {
                chosen = Some(mark.item);
            }
        }
        self.labels = taken;
        chosen
    }
}
