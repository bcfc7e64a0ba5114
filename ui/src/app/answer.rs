//! What a dialog comes to.

use super::ToileApp;
use crate::theme::Palette;
use egui::{Button, RichText, Ui};

/// What a dialog came to.
pub enum Answer {
    /// It stays.
    Stay,
    /// It is left.
    Leave,
    /// It is left, and this is done.
    Do(Box<dyn FnOnce(&mut ToileApp)>),
}

/// The button that Enter presses.
pub fn main_button(ui: &mut Ui, words: &str) -> bool {
    let palette = Palette::of(ui.ctx());
    let words = RichText::new(words).color(palette.on_accent);
    ui.add(Button::new(words).fill(palette.accent)).clicked()
}
