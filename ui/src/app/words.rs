//! The glossary as a dialog: words of the trade with their meanings, and a search.

use super::ToileApp;
use super::answer::{Answer, main_button};
use super::dialogs::Dialog;
use crate::glossary::found;
use crate::theme::{Palette, title};
use egui::{RichText, ScrollArea, TextEdit, Ui};

/// Height of the list (pixels).
const LIST: f32 = 380.0;

impl ToileApp {
    pub(crate) fn ask_words(&mut self) {
        self.dialog = Some(Dialog::Words(String::new()));
    }

    /// Shows the words that match the search, with their meanings.
    pub(super) fn show_words(ui: &mut Ui, text: &mut String) -> Answer {
        ui.heading("Words");
        let label = ui.label("Find a word").id;
        let field = TextEdit::singleline(text).desired_width(f32::INFINITY);
        let field = ui.add(field).labelled_by(label);
        field.request_focus();
        let soft = Palette::of(ui.ctx()).ink_soft;
        ui.add_space(4.0);
        let list = ScrollArea::vertical()
            .max_height(LIST)
            .auto_shrink([false, false]);
        list.show(ui, |ui| {
            let found = found(text);
            if found.is_empty() {
                ui.label(RichText::new("No word has this in its name or meaning.").color(soft));
            }
            let mut subject = "";
            for word in found {
                // Headings appear only while nothing is searched.
                if text.trim().is_empty() && word.subject != subject {
                    subject = word.subject;
                    ui.add_space(8.0);
                    ui.label(RichText::new(subject).small().color(soft));
                }
                title(ui, word.word);
                ui.label(word.meaning.replace('`', ""));
                ui.add_space(4.0);
            }
        });
        match main_button(ui, "Close") {
            true => Answer::Leave,
            false => Answer::Stay,
        }
    }
}
