//! What is said in the middle of the window: no pattern, and closing with unsaved changes.

use crate::app::ToileApp;
use crate::theme;
use egui::{Align2, Button, Color32, Rect, RichText, Ui, ViewportCommand, vec2};

/// Width of a card [logical pixels].
const CARD: f32 = 460.0;

impl ToileApp {
    /// Says why no pattern is shown.
    pub(crate) fn no_pattern(&self, ui: &mut Ui, view: Rect) {
        let size = vec2(CARD.min(view.width() - 40.0), 190.0);
        let card = Align2::CENTER_CENTER.align_size_within_rect(size, view);
        ui.painter().rect_filled(card, 8.0, theme::BAR);
        let inside = card.shrink(20.0);
        ui.scope_builder(egui::UiBuilder::new().max_rect(inside), |ui| {
            let (title, words) = match &self.refusal {
                Some(words) => ("This pattern cannot be opened", words.as_str()),
                None if self.session.revision() > 0 => (
                    "Nothing can be drawn",
                    "The pattern has no panel whose outline can be drawn. The status line says why.",
                ),
                None => ("No pattern is open", ""),
            };
            ui.heading(title);
            ui.add_space(4.0);
            if !words.is_empty() {
                ui.label(RichText::new(words).color(theme::FAULT));
                ui.add_space(4.0);
            }
            ui.label(
                RichText::new("Drop a pattern file here, or start the window with: toile-ui FILE")
                    .color(theme::INK_SOFT),
            );
        });
    }

    /// Asks before changes are lost.
    pub(crate) fn guard_closing(&mut self, context: &egui::Context) {
        let closing = context.input(|input| input.viewport().close_requested());
        if closing && !self.closes && self.is_unsaved() {
            context.send_viewport_cmd(ViewportCommand::CancelClose);
            self.asks_to_close = true;
        }
        if !self.asks_to_close {
            return;
        }
        let asked = egui::Modal::new(egui::Id::unique("closing")).show(context, |ui| {
            ui.set_width(CARD * 0.8);
            ui.heading("Save the changes?");
            ui.add_space(4.0);
            ui.label("The pattern has changes that are in no file.");
            ui.add_space(12.0);
            ui.horizontal(|ui| {
                let save = RichText::new("Save and close").color(Color32::WHITE);
                if ui.add(Button::new(save).fill(theme::ACCENT)).clicked() {
                    self.save();
                    self.closes = !self.is_unsaved();
                    self.asks_to_close = false;
                }
                if ui.button("Close without saving").clicked() {
                    self.closes = true;
                }
                if ui.button("Keep working").clicked() {
                    self.asks_to_close = false;
                }
            });
        });
        if asked.should_close() {
            self.asks_to_close = false;
        }
        if self.closes {
            context.send_viewport_cmd(ViewportCommand::Close);
        }
    }
}
