//! Paints the tags of sheets.

use super::paint::Picture;
use super::scene::SheetScene;
use super::selection::Item;
use super::sheet_tag::{CROSS, ground};
use crate::theme;
use egui::{CornerRadius, Stroke, vec2};
use toile_geometry::Vec2;

impl Picture<'_> {
    /// Paints the tag of a sheet.
    pub(super) fn sheet_tag(&self, sheet: &SheetScene) {
        let origin = self.seen(self.table_layout.sheet(sheet.id), Vec2::zeros());
        let lit = self.is_lit(Item::Sheet(sheet.id));
        let (fill, ink) = match lit {
            true => (self.palette.accent, self.palette.on_accent),
            false => (self.palette.panel, self.palette.ink_soft),
        };
        let line = if lit {
            self.palette.accent
        } else {
            self.palette.ink_soft
        };
        let stroke = Stroke::new(1.4, line);
        for way in [vec2(CROSS, 0.0), vec2(0.0, CROSS)] {
            self.painter
                .line_segment([origin - way, origin + way], stroke);
        }
        let ground = ground(sheet).translate(origin.to_vec2());
        self.painter.rect(
            ground,
            CornerRadius::same(4),
            fill,
            Stroke::new(1.0, line),
            egui::StrokeKind::Middle,
        );
        let text = self
            .painter
            .layout_no_wrap(sheet.name.clone(), theme::font(12.0), ink);
        let place = ground.center() - text.size() * 0.5;
        self.painter
            .with_clip_rect(ground.intersect(self.painter.clip_rect()))
            .galley(place, text, ink);
    }
}
