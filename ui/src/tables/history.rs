//! The history of the pattern as a table.

use crate::app::ToileApp;
use crate::theme::Palette;
use egui::{RichText, ScrollArea, Ui};
use toile_session::Command;

impl ToileApp {
    /// Shows the steps of the history; a click goes to the state after a step.
    pub(super) fn history_table(&mut self, ui: &mut Ui) {
        let past: Vec<String> = self.session.past().into_iter().map(str::to_owned).collect();
        let future: Vec<String> = self
            .session
            .future()
            .into_iter()
            .map(str::to_owned)
            .collect();
        let mut steps: Vec<Command> = Vec::new();
        let rows = ScrollArea::both()
            .id_salt("history")
            .auto_shrink([false, false]);
        rows.show(ui, |ui| {
            if ui
                .selectable_label(past.is_empty(), "as it was opened")
                .clicked()
            {
                steps = vec![Command::Undo; past.len()];
            }
            for (k, label) in past.iter().enumerate() {
                let is_now = k + 1 == past.len();
                let words = format!("{}  {label}", k + 1);
                if ui.selectable_label(is_now, words).clicked() {
                    steps = vec![Command::Undo; past.len() - k - 1];
                }
            }
            let soft = Palette::of(ui.ctx()).ink_soft;
            for (k, label) in future.iter().enumerate() {
                let words = format!("{}  {label}", past.len() + k + 1);
                let words = RichText::new(words).color(soft);
                if ui.selectable_label(false, words).clicked() {
                    steps = vec![Command::Redo; k + 1];
                }
            }
        });
        for step in steps {
            self.execute(step);
        }
    }
}
