//! Fields above a table that hold no value of the document: a search text, or the name of a new row.

use crate::fields::choose_all;
use egui::{Id, Key, Response, TextEdit, Ui};

/// Shows a field of one line, named by a label; the hint is shown while the field is empty. Text typed into
/// a field that was just entered replaces the old text.
pub fn line_field(
    ui: &mut Ui,
    label: Id,
    text: &mut String,
    (hint, width): (&str, f32),
) -> Response {
    let field = TextEdit::singleline(text)
        .hint_text(hint)
        .desired_width(width);
    let response = ui.add(field).labelled_by(label);
    if response.gained_focus() {
        choose_all(ui, response.id, text);
    }
    if response.has_focus() && text.is_empty() {
        let frame = ui.ctx().cumulative_frame_nr();
        ui.data_mut(|data| data.insert_temp(emptied(), frame));
    }
    response
}

/// Whether Enter was pressed in a field, which ends its typing.
pub fn is_entered(ui: &Ui, response: &Response) -> bool {
    response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter))
}

/// Whether the focus is on an empty field shown by [`line_field`]: it has no text that Undo could change.
pub fn is_empty_field(context: &egui::Context) -> bool {
    let frame: Option<u64> = context.data(|data| data.get_temp(emptied()));
    frame.is_some_and(|frame| frame + 1 >= context.cumulative_frame_nr())
}

fn emptied() -> Id {
    Id::unique("emptied line field")
}
