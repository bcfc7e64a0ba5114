//! The outcome of a dialog.

use super::ToileApp;
use crate::theme::Palette;
use egui::{Button, RichText, Ui};

/// The outcome of a dialog.
pub enum Answer {
    /// It stays open.
    Stay,
    /// It is closed.
    Leave,
    /// It is closed, and this is performed.
    Do(Box<dyn FnOnce(&mut ToileApp)>),
}

/// The button that Enter presses.
pub fn main_button(ui: &mut Ui, words: &str) -> bool {
    let palette = Palette::of(ui.ctx());
    let words = RichText::new(words).color(palette.on_accent);
    ui.add(Button::new(words).fill(palette.accent)).clicked()
}
