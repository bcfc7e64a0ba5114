//! The outcome of a dialog.

use super::ToileApp;
use crate::theme::Palette;
use egui::{Button, Key, Popup, RichText, Ui};

/// Result of showing a dialog for one frame.
pub enum Answer {
    /// The dialog stays open.
    Stay,
    /// The dialog closes.
    Leave,
    /// The dialog closes, and this action is performed.
    Do(Box<dyn FnOnce(&mut ToileApp)>),
}

/// Shows a filled button of a page or a dialog; returns whether it was clicked.
pub fn filled_button(ui: &mut Ui, words: &str) -> bool {
    let palette = Palette::of(ui.ctx());
    let words = RichText::new(words).color(palette.on_accent);
    ui.add(Button::new(words).fill(palette.accent)).clicked()
}

/// Shows the filled button of a dialog, for the choice that loses nothing; returns whether it was clicked
/// or Enter was pressed. A button with the keyboard focus, or an open list, takes Enter first.
pub fn main_button(ui: &mut Ui, words: &str) -> bool {
    let pressed = filled_button(ui, words);
    let focused = ui.memory(|memory| memory.focused());
    let focused = focused.and_then(|id| ui.ctx().read_response(id));
    let is_here = focused.is_some_and(|widget| widget.layer_id == ui.layer_id());
    let is_free = !is_here || ui.ctx().text_edit_focused();
    let is_free = is_free && !Popup::is_any_open(ui.ctx());
    let entered = ui.input(|input| input.key_pressed(Key::Enter));
    pressed || ui.is_enabled() && is_free && entered
}
