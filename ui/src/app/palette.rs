//! Finding a command by its name.

use super::ToileApp;
use super::answer::Answer;
use super::command::UiCommand;
use super::command_table::commands;
use super::dialogs::Dialog;
use egui::{Key, ScrollArea, Ui};

/// Most commands that are listed.
const MOST: usize = 12;

impl ToileApp {
    pub(crate) fn ask_command(&mut self) {
        self.dialog = Some(Dialog::Find(String::new(), 0));
    }

    pub(super) fn ask_find(&self, ui: &mut Ui, text: &mut String, chosen: &mut usize) -> Answer {
        let label = ui.label("Find command").id;
        let field = egui::TextEdit::singleline(text).desired_width(f32::INFINITY);
        let field = ui.add(field).labelled_by(label);
        field.request_focus();
        if field.changed() {
            *chosen = 0;
        }
        let found = found(text);
        let last = found.len().saturating_sub(1);
        let (up, down, entered) = ui.input(|input| {
            (
                input.key_pressed(Key::ArrowUp),
                input.key_pressed(Key::ArrowDown),
                input.key_pressed(Key::Enter),
            )
        });
        *chosen = match (up, down) {
            (true, false) => chosen.saturating_sub(1),
            (false, true) => (*chosen + 1).min(last),
            _ => (*chosen).min(last),
        };
        let mut taken = found.get(*chosen).copied().filter(|_| entered);
        ScrollArea::vertical().max_height(320.0).show(ui, |ui| {
            for (k, command) in found.iter().enumerate() {
                let key = command.key.map(|key| ui.ctx().format_shortcut(&key));
                let words = format!("{}   {}", command.name, key.unwrap_or_default());
                let enabled = (command.when)(self);
                ui.add_enabled_ui(enabled, |ui| {
                    let label = ui.selectable_label(k == *chosen, words);
                    if label.on_hover_text(command.tip).clicked() {
                        taken = Some(*command);
                    }
                });
            }
        });
        match taken.filter(|command| (command.when)(self)) {
            Some(command) => Answer::Do(Box::new(command.does)),
            None => Answer::Stay,
        }
    }
}

/// Commands whose name or explanation has all words that are typed; those whose name begins so
/// come first.
fn found(text: &str) -> Vec<&'static UiCommand> {
    let words: Vec<String> = text.split_whitespace().map(str::to_lowercase).collect();
    let mut found: Vec<(u8, &UiCommand)> = commands()
        .filter_map(|command| {
            let name = command.name.to_lowercase();
            let all = format!("{name} {}", command.tip.to_lowercase());
            if !words.iter().all(|word| all.contains(word)) {
                return None;
            }
            let (typed, first) = (words.join(" "), words.first().map_or("", String::as_str));
            let rank = match () {
                () if name.starts_with(&typed) => 0,
                () if name.contains(first) => 1,
                () => 2,
            };
            Some((rank, command))
        })
        .collect();
    found.sort_by_key(|(rank, _)| *rank);
    found.into_iter().take(MOST).map(|(_, c)| c).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_found_by_the_beginning_of_their_name_first() {
        let names =
            |text: &str| -> Vec<&str> { found(text).iter().map(|command| command.name).collect() };
        assert_eq!(names("dart")[0], "Dart");
        assert_eq!(names("save a")[0], "Save as");
        assert!(names("warp").contains(&"Grain"));
        assert!(names("no such thing").is_empty());
        assert_eq!(names("").len(), MOST);
    }
}
