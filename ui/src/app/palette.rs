//! Finding a command, a part of the pattern, a variable or a measurement by its name.

use super::ToileApp;
use super::answer::Answer;
use super::command::{UiCommand, shortcut_words};
use super::command_table::commands;
use super::dialogs::Dialog;
use super::tab::Tab;
use crate::canvas::selection::{Item, Selection};
use crate::theme::Palette;
use crate::tools::Tool;
use egui::{Button, Key, RichText, ScrollArea, Ui, vec2};
use toile_measure::definition;
use toile_pattern::{Pattern, VariableId};

/// Largest number of results in the list.
const MOST: usize = 12;

/// A search result.
#[derive(Clone)]
enum Found {
    Command(&'static UiCommand),
    Part(Item, String),
    Variable(VariableId, String),
    /// A measurement of some size: the name used in formulas, and the description.
    Measurement(String, String),
}

impl ToileApp {
    pub(crate) fn ask_command(&mut self) {
        self.dialog = Some(Dialog::Find(String::new(), 0));
    }

    pub(super) fn ask_find(&self, ui: &mut Ui, text: &mut String, chosen: &mut usize) -> Answer {
        let label = ui
            .label("Find a command, a part, a variable or a measurement")
            .id;
        let field = egui::TextEdit::singleline(text).desired_width(f32::INFINITY);
        let field = ui.add(field).labelled_by(label);
        field.request_focus();
        if field.changed() {
            *chosen = 0;
        }
        let found = found(text, self.base.pattern());
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
        let mut taken = found.get(*chosen).cloned().filter(|_| entered);
        ScrollArea::vertical().max_height(320.0).show(ui, |ui| {
            if found.is_empty() {
                let soft = Palette::of(ui.ctx()).ink_soft;
                ui.label(RichText::new("Nothing has this in its name.").color(soft));
            }
            for (k, one) in found.iter().enumerate() {
                let (words, key, tip, enabled) = match one {
                    Found::Command(command) => {
                        (command.name, command.key, command.tip, (command.when)(self))
                    }
                    Found::Part(_, words) => (words.as_str(), None, "Select it and show it", true),
                    Found::Variable(_, words) | Found::Measurement(_, words) => {
                        (words.as_str(), None, "Change its value", true)
                    }
                };
                let mut button = Button::selectable(k == *chosen, words);
                if let Some(key) = key {
                    button = button.shortcut_text(shortcut_words(ui.ctx(), &key));
                }
                let button = button.min_size(vec2(ui.available_width(), 0.0));
                let button = ui.add_enabled(enabled, button);
                button.widget_info(|| {
                    egui::WidgetInfo::selected(egui::Role::Button, enabled, k == *chosen, words)
                });
                if button.on_hover_text(tip).clicked() {
                    taken = Some(one.clone());
                }
            }
        });
        match taken {
            Some(Found::Command(command)) if (command.when)(self) => {
                Answer::Do(Box::new(command.does))
            }
            Some(Found::Part(item, _)) => Answer::Do(Box::new(move |app| app.show_part(item))),
            Some(Found::Variable(id, _)) => Answer::Do(Box::new(move |app| {
                app.show_table(Tab::Variables);
                app.tables.entered_variable = Some(id);
            })),
            Some(Found::Measurement(name, _)) => Answer::Do(Box::new(move |app| {
                app.show_table(Tab::Measurements);
                app.tables.entered_measurement = Some(name);
            })),
            _ => Answer::Stay,
        }
    }

    /// Shows or hides the table of fabrics.
    pub(crate) fn toggle_fabrics(&mut self) {
        match self.panes.tables && self.tables.tab == Tab::Fabric {
            true => self.panes.tables = false,
            false => self.show_table(Tab::Fabric),
        }
    }

    pub(super) fn show_table(&mut self, tab: Tab) {
        self.panes.tables = true;
        self.tables.tab = tab;
    }

    /// Selects a part and brings it into view: for a seam its first panel is shown, for a curve the panel
    /// that is traced along it.
    fn show_part(&mut self, item: Item) {
        self.take(Tool::Select);
        self.view.select(Selection::one(item));
        let pattern = self.base.pattern();
        let shown = match item {
            Item::Seam(id) => {
                let seam = pattern.seams.iter().find(|seam| seam.id == id);
                let first = seam.and_then(|seam| seam.sides[0].first());
                first.map(|span| Item::Panel(span.panel))
            }
            Item::Curve(id) => pattern.panels.iter().find_map(|panel| {
                let edge = panel.edges().find(|edge| edge.curve == id)?;
                Some(Item::Edge(panel.id, edge.id))
            }),
            _ => None,
        };
        let shown = shown.unwrap_or(item);
        self.panes.guides |= matches!(shown, Item::Guide(_));
        let is_hidden =
            |panel| !self.view.isolated.is_empty() && !self.view.isolated.contains(&panel);
        if shown.panel().is_some_and(is_hidden) {
            self.isolate();
        }
        self.view.reveal(shown);
    }
}

/// Search results: commands whose name or tip contains all typed words, and parts, variables and
/// measurements whose name does; matches at the beginning come first. An empty search finds commands only.
fn found(text: &str, pattern: &Pattern) -> Vec<Found> {
    let words: Vec<String> = text.split_whitespace().map(str::to_lowercase).collect();
    let (typed, first) = (words.join(" "), words.first().map_or("", String::as_str));
    let has_all = |text: &str| words.iter().all(|word| text.contains(word));
    let of_commands = commands().filter_map(|command| {
        let name = command.name.to_lowercase();
        let rank = match () {
            () if !has_all(&format!("{name} {}", command.tip.to_lowercase())) => return None,
            () if name == typed => 0,
            () if name.starts_with(&typed) => 1,
            () if name.contains(first) => 3,
            () => 5,
        };
        Some((rank, Found::Command(command)))
    });
    let others = match words.is_empty() {
        true => Vec::new(),
        false => others(pattern),
    };
    let of_others = others.into_iter().filter_map(|(words, found)| {
        let low = words.to_lowercase();
        // Parts and other named things match by their description ("Panel front") or by the name in it
        // ("front").
        let own = low.split_once(' ').map_or("", |found| found.1);
        let name = own.split_once(" (").map_or(own, |found| found.0);
        let rank = match () {
            () if !has_all(&low) => return None,
            () if name == typed => 0,
            () if low.starts_with(&typed) || own.starts_with(&typed) => 2,
            () => 4,
        };
        Some((rank, found))
    });
    let mut found: Vec<(u8, Found)> = of_commands.chain(of_others).collect();
    found.sort_by_key(|(rank, _)| *rank);
    found.into_iter().take(MOST).map(|(_, one)| one).collect()
}

/// Everything in a pattern that has a name, with its description.
fn others(pattern: &Pattern) -> Vec<(String, Found)> {
    let parts = Item::all(pattern).into_iter().filter_map(|item| {
        let words = item.words(pattern)?;
        Some((words.clone(), Found::Part(item, words)))
    });
    let variables = pattern.variables.iter().map(|variable| {
        let words = format!("Variable {}", variable.name);
        (words.clone(), Found::Variable(variable.id, words))
    });
    let mut measured: Vec<&str> = Vec::new();
    for (name, _) in pattern
        .sizes
        .iter()
        .flat_map(|size| size.measurements.iter())
    {
        if !measured.contains(&name) {
            measured.push(name);
        }
    }
    let measurements = measured.into_iter().map(|name| {
        let label = definition(name).map_or("", |known| known.label);
        let words = match label.is_empty() || label.eq_ignore_ascii_case(name) {
            true => format!("Measurement {name}"),
            false => format!("Measurement {name} ({label})"),
        };
        (words.clone(), Found::Measurement(name.to_owned(), words))
    });
    parts.chain(variables).chain(measurements).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(text: &str) -> Vec<String> {
        let found = found(text, &Pattern::new("none")).into_iter();
        let names = found.map(|one| match one {
            Found::Command(command) => command.name.to_owned(),
            Found::Part(_, words) | Found::Variable(_, words) | Found::Measurement(_, words) => {
                words
            }
        });
        names.collect()
    }

    #[test]
    fn commands_are_found_by_the_beginning_of_their_name_first() {
        assert_eq!(names("dart")[0], "Dart");
        assert_eq!(names("save a")[0], "Save as");
        assert!(names("warp").iter().any(|name| name == "Grain"));
        assert!(names("no such thing").is_empty());
        assert_eq!(names("").len(), MOST);
    }
}
