//! Signs of findings over the table: the text appears on hovering, and a click selects the part.

use super::PatternView;
use crate::canvas::finding_marks::FindingMark;
use crate::canvas::selection::Item;
use crate::theme::Palette;
use egui::{Rect, Role, Sense, Ui, Vec2, WidgetInfo};
use toile_geometry::Vec2 as Place;
use toile_pattern::{PanelId, SeamId};

impl PatternView {
    /// Draws the signs of findings; returns the part whose sign was clicked. While a tool is in progress
    /// the signs are not clickable.
    pub(super) fn show_finding_marks(&mut self, ui: &Ui, view: Rect) -> Option<Item> {
        let palette = Palette::of(ui.ctx());
        let (painter, parts) = (ui.painter_at(view), self.parts());
        let mut chosen = None;
        let mut taken = std::mem::take(&mut self.labels);
        for mark in &self.finding_marks {
            let part = parts.iter().find(|(_, item, _)| *item == mark.item);
            let at = match mark.item {
                Item::Seam(seam) => self.seam_place(seam, mark.end),
                _ => part.map(|(.., at)| *at),
            };
            let Some(at) = at else {
                continue;
            };
            let mut place = FindingMark::place(self.screen(view, Place::zeros(), at));
            // The sign is moved right until it is clear of other labels, and of other signs at the same
            // place.
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
            let id = Self::id().with(("finding", mark.item, mark.end));
            let sign = ui.interact(place, id, Sense::click());
            sign.widget_info(|| WidgetInfo::labeled(Role::Button, true, &mark.words));
            if sign.on_hover_text(&mark.words).clicked() {
                chosen = Some(mark.item);
            }
        }
        self.labels = taken;
        chosen
    }

    /// Place on the table of an end of a seam (m), or of the seam's first stretch if no end is given; on
    /// the first panel of the seam that is visible.
    fn seam_place(&self, id: SeamId, end: Option<usize>) -> Option<Place> {
        let seam = self.scene.seams.iter().find(|seam| seam.id == id)?;
        let is_seen = |panel: PanelId| self.scene.panel_scene(panel).is_some();
        let (panel, at) = match end {
            Some(end) => {
                let mut sides = seam.ends.iter().flatten().map(|ends| ends[end]);
                sides.find(|(panel, _)| is_seen(*panel))?
            }
            None => {
                let mut stretches = seam.stretches.iter();
                let stretch = stretches.find(|stretch| is_seen(stretch.panel))?;
                (stretch.panel, crate::canvas::along(&stretch.line, 0.5)?.0)
            }
        };
        Some(self.table_layout.panel(panel) + at)
    }
}
