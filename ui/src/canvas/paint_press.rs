//! Paints the pressing directions of darts and pleats.

use super::paint::Picture;
use super::scene::PanelScene;
use super::selection::Item;
use egui::{Shape, Stroke, vec2};

/// Half the length of an arrow (pixels).
const HALF: f32 = 14.0;
/// Length and half the width of the head of an arrow (pixels).
const HEAD: [f32; 2] = [8.0, 4.0];

impl Picture<'_> {
    /// Paints arrows across darts and pleats, towards the side to which the folded cloth is pressed.
    pub(super) fn press_arrows(&self, panel: &PanelScene) {
        let origin = self.table_layout.panel(panel.id);
        for arrow in &panel.pressed {
            let colour = match self.is_lit(Item::Operation(panel.id, arrow.by)) {
                true => self.palette.accent,
                false => self.palette.ink_soft,
            };
            let middle = self.seen(origin, arrow.at);
            let way = vec2(arrow.way.x as f32, -arrow.way.y as f32);
            let [tail, tip] = [middle - way * HALF, middle + way * HALF];
            let back = tip - way * HEAD[0];
            let across = way.rot90() * HEAD[1];
            self.painter
                .line_segment([tail, back], Stroke::new(1.8, colour));
            let head = vec![tip, back + across, back - across];
            self.painter
                .add(Shape::convex_polygon(head, colour, Stroke::NONE));
        }
    }
}
