//! The strip by which the tables are dragged beside the pattern or below it.

use crate::app::ToileApp;
use crate::theme::Palette;
use egui::{
    CursorIcon, LayerId, Order, Rangef, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2,
};

impl ToileApp {
    /// Shows the rest of the row of tabs as a strip that the user drags, to move the tables beside or below
    /// the pattern.
    pub(super) fn tables_handle(&mut self, ui: &mut Ui) {
        let size = vec2(
            ui.available_size_before_wrap().x.max(0.0),
            ui.spacing().interact_size.y,
        );
        let (rect, handle) = ui.allocate_exact_size(size, Sense::drag());
        let handle = handle.on_hover_cursor(CursorIcon::Grab);
        handle.widget_info(|| WidgetInfo::labeled(Role::Button, true, "Move tables"));
        let palette = Palette::of(ui.ctx());
        for row in [-3.0, 0.0, 3.0] {
            let across = Rangef::new(rect.right() - 22.0, rect.right() - 6.0);
            let stroke = Stroke::new(1.0, palette.pencil);
            ui.painter().hline(across, rect.center().y + row, stroke);
        }
        let Some(at) = handle.interact_pointer_pos() else {
            handle.on_hover_text("Drag the tables beside the pattern or below it (Shift+F8)");
            return;
        };
        let window = ui.ctx().content_rect();
        // Beside the pattern, if the pointer is right of the line from the middle of the upper edge to
        // the lower right corner of the window.
        let share = (at - window.min) / window.size();
        let beside = share.x - 0.5 > 0.5 * share.y;
        let target = match beside {
            true => Rect::from_min_max(
                pos2(window.left() + 0.67 * window.width(), window.top()),
                window.max,
            ),
            false => Rect::from_min_max(
                pos2(window.left(), window.top() + 0.7 * window.height()),
                window.max,
            ),
        };
        let layer = LayerId::new(Order::Foreground, handle.id);
        let shade = palette.accent.gamma_multiply(0.25);
        ui.ctx()
            .layer_painter(layer)
            .rect_filled(target, 6.0, shade);
        ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        if handle.drag_stopped() {
            self.panes.tables_beside = Some(beside);
        }
    }
}
