//! Text fields: what is typed into one that was just entered takes the place of what stands there.

use egui::text::{CCursor, CCursorRange};
use egui::{Response, TextEdit, Ui};

/// A field for a line of text as wide as there is room.
pub fn text_field(ui: &mut Ui, id: egui::Id, text: &mut String) -> Response {
    let field = TextEdit::singleline(text)
        .id(id)
        .desired_width(f32::INFINITY);
    let output = field.show(ui);
    let response = output.response.response;
    let memory = id.with("had focus");
    let has_focus = response.has_focus();
    let had_focus = ui.data_mut(|data| {
        let before: bool = data.get_temp(memory).unwrap_or_default();
        data.insert_temp(memory, has_focus);
        before
    });
    if has_focus && !had_focus {
        let all = CCursorRange::two(CCursor::new(0), CCursor::new(text.chars().count()));
        let mut state = output.state;
        state.cursor.set_char_range(Some(all));
        state.store(ui.ctx(), id);
    }
    response
}
