//! Menu bar and status line.

use super::ToileApp;
use super::command::{Menu, UiCommand, shortcut_words};
use super::command_table::commands;
use super::document_commands::{
    ADD_POINT, COPY, CUT, DELETE, DUPLICATE, FIT, ISOLATE, PASTE, REDO, SAVE, UNDO,
};
use super::findings::finding_colour;
use super::notice::Tone;
use super::tool_commands::{
    BEND_EDGE, DART, FLIP_SEAM, FOLD, GRAIN, MATCHED_NOTCHES, MIRROR, NOTCH, PIVOT_DART, SEAM,
    SELECT_SEAM, TURN, WALK_SEAM,
};
use crate::canvas::selection::Item;
use crate::theme::Palette;
use crate::tools::number;
use egui::{Align, Button, Color32, ComboBox, Layout, RichText, Ui};
use toile_pattern::{Severity, Want};
use toile_session::Command;

/// Width of the status line that a message leaves free for the hint beside it (pixels).
const HINT_WIDTH: f32 = 160.0;

impl ToileApp {
    pub(crate) fn menu_bar(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            for menu in Menu::ALL {
                ui.menu_button(menu.name(), |ui| {
                    let entries = commands().filter(|command| command.menu == menu);
                    for (k, command) in entries.enumerate() {
                        if command.begins_group && k > 0 {
                            ui.separator();
                        }
                        self.menu_entry(ui, command);
                    }
                });
            }
            ui.separator();
            for command in [&SAVE, &UNDO, &REDO] {
                self.quick_button(ui, command);
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                self.size_choice(ui);
            });
        });
    }

    /// The context menu of the canvas: commands for the selection.
    pub(crate) fn canvas_menu(&mut self) {
        let Some(canvas) = self.view.canvas.take() else {
            return;
        };
        let selected = self.view.selection.items().first().copied();
        let own: &[&UiCommand] = match selected {
            Some(Item::Panel(_)) => &[&ISOLATE, &GRAIN, &MIRROR, &TURN],
            Some(Item::Edge(..)) => &[
                &ADD_POINT,
                &BEND_EDGE,
                &DART,
                &FOLD,
                &NOTCH,
                &SEAM,
                &SELECT_SEAM,
            ],
            Some(Item::Operation(..)) => &[&PIVOT_DART],
            Some(Item::Seam(_)) => &[&WALK_SEAM, &FLIP_SEAM, &MATCHED_NOTCHES],
            _ => &[],
        };
        canvas.context_menu(|ui| {
            let changes: &[&UiCommand] = &[&CUT, &COPY, &PASTE, &DUPLICATE, &DELETE];
            let groups = [own, changes, &[&UNDO, &FIT]].map(|group| {
                let possible = group.iter().filter(|command| (command.when)(self));
                possible.copied().collect::<Vec<_>>()
            });
            for (k, group) in groups.iter().filter(|group| !group.is_empty()).enumerate() {
                if k > 0 {
                    ui.separator();
                }
                for command in group {
                    self.menu_entry(ui, command);
                }
            }
        });
    }

    fn menu_entry(&mut self, ui: &mut Ui, command: &'static UiCommand) {
        let mut button = Button::new(command.name).selected(command.on.is_some_and(|on| on(self)));
        if let Some(key) = command.key {
            button = button.shortcut_text(shortcut_words(ui.ctx(), &key));
        }
        self.command_widget(ui, command, button, None);
    }

    /// A button of the menu bar; those for undo and redo name the step that they undo or redo.
    fn quick_button(&mut self, ui: &mut Ui, command: &'static UiCommand) {
        let step = match () {
            () if command.name == UNDO.name => self.session.can_undo(),
            () if command.name == REDO.name => self.session.can_redo(),
            () => None,
        };
        let words = step.map(|step| format!("{}: {step}", command.words(ui.ctx())));
        self.command_widget(ui, command, Button::new(command.name), words);
    }

    fn size_choice(&mut self, ui: &mut Ui) {
        let project = self.session.project();
        if project.pattern.sizes.is_empty() {
            return;
        }
        let sizes = project.pattern.sizes.iter();
        let mut names: Vec<Option<String>> = sizes.map(|s| Some(s.name.clone())).collect();
        if !project.body.is_of_pattern() {
            names.insert(0, None);
        }
        let words = |name: &Option<String>| name.clone().unwrap_or_else(|| "the wearer's".into());
        let mut chosen = project.size_name().map(str::to_owned);
        let before = chosen.clone();
        // The row is filled from right to left: the label is added after the list, and so stands left of it.
        let choice = ComboBox::from_id_salt("size")
            .selected_text(words(&chosen))
            .width(70.0)
            .show_ui(ui, |ui| {
                for name in names {
                    let words = words(&name);
                    ui.selectable_value(&mut chosen, name, words);
                }
            })
            .response;
        let label = ui.label("Size").id;
        choice.labelled_by(label);
        if chosen != before {
            self.execute(Command::SetSize { size: chosen });
        }
    }

    pub(crate) fn status(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                self.findings_button(ui);
                self.isolated_button(ui);
                self.export_progress(ui);
                if let Some((sheet, at)) = self.view.pointer {
                    let unit = self.base.pattern().unit;
                    let [x, y] = [at.x, at.y].map(|v| number::show(v, Want::Length, unit));
                    let soft = Palette::of(ui.ctx()).ink_soft;
                    // With several sheets the name of the current one is shown.
                    let pattern = self.base.pattern();
                    let sheet = pattern.sheet(sheet).filter(|_| pattern.sheets.len() > 1);
                    let name = sheet.map_or_else(String::new, |sheet| format!("{}   ", sheet.name));
                    ui.label(RichText::new(format!("{name}x {x}   y {y}")).color(soft));
                }
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    let palette = Palette::of(ui.ctx());
                    let (words, colour) = self.status_words(palette);
                    let hint = match self.is_open() && self.dialog.is_none() {
                        true => self.view.hint(&self.base),
                        false => String::new(),
                    };
                    let hints = !hint.is_empty() && hint != words;
                    if !words.is_empty() {
                        let label = RichText::new(&words).color(colour);
                        // Leaves room for the hint on mouse clicks.
                        let room = if hints { HINT_WIDTH } else { 0.0 };
                        let most = (ui.available_width() - room).max(0.0);
                        let label = ui.scope(|ui| {
                            ui.set_max_width(most);
                            ui.add(egui::Label::new(label).truncate())
                        });
                        label.inner.on_hover_text(words);
                        if hints {
                            ui.add_space(10.0);
                        }
                    }
                    if hints {
                        let label = RichText::new(&hint).color(palette.ink_soft);
                        let label = ui.add(egui::Label::new(label).truncate());
                        label.on_hover_text(hint);
                    }
                });
            });
        });
    }

    /// Button that says how many panels are isolated; a click shows all panels again.
    fn isolated_button(&mut self, ui: &mut Ui) {
        let words = match self.view.isolated.len() {
            0 => return,
            1 => "1 panel shown: show all".to_owned(),
            count => format!("{count} panels shown: show all"),
        };
        if ui.button(words).on_hover_text("Isolate (.)").clicked() {
            self.isolate();
        }
    }

    /// Text of the status line: the latest message; else the request of the tool in hand; else the part
    /// under the pointer; else the worst finding.
    fn status_words(&self, palette: &Palette) -> (String, Color32) {
        if !self.notice.text.is_empty() {
            let colour = match self.notice.tone {
                Tone::Information => palette.ink,
                Tone::Warning => palette.warning,
                Tone::Fault => palette.fault,
            };
            return (self.notice.text.clone(), colour);
        }
        if self.view.tool.takes_keys() {
            return (self.view.hint(&self.base), palette.ink);
        }
        if let Some(words) = self.view.hover.and_then(|hit| self.item_words(hit.item)) {
            return (words, palette.ink);
        }
        // The first finding of the highest severity.
        let worst = self.findings.iter().rev().max_by_key(|f| f.severity);
        match worst {
            Some(found) if found.severity > Severity::Note => {
                (found.to_string(), finding_colour(found, palette))
            }
            _ if self.is_open() => (self.view.hint(&self.base), palette.ink_soft),
            _ => (String::new(), palette.ink),
        }
    }

    /// Description of a part: kind, name, length and seams.
    pub(crate) fn item_words(&self, item: Item) -> Option<String> {
        let pattern = self.base.pattern();
        let mut words = item.words(pattern)?;
        let length = |length: f64| number::show(length, Want::Length, pattern.unit);
        match item {
            Item::Edge(panel, edge) => {
                let scene = &self.view.scene;
                let shape = scene.panel_scene(panel)?.shape.edge_shape(edge)?;
                words = format!(
                    "{words}, {}, {}",
                    length(shape.length),
                    self.seam_words(item)
                );
            }
            Item::Curve(curve) => {
                words = format!("{words}, {}", length(self.base.curve(curve)?.length()));
            }
            _ => {}
        }
        Some(words)
    }

    /// Description of the seams that an edge is part of.
    pub(crate) fn seam_words(&self, item: Item) -> String {
        let Item::Edge(panel, edge) = item else {
            return String::new();
        };
        let seams: Vec<String> = self
            .view
            .scene
            .seams
            .iter()
            .filter(|seam| {
                seam.stretches
                    .iter()
                    .any(|s| s.panel == panel && s.edge == Some(edge))
            })
            .map(|seam| format!("seam {} ({})", seam.number, seam.name))
            .collect();
        match seams.is_empty() {
            true => "not sewn".into(),
            false => format!("sewn by {}", seams.join(", ")),
        }
    }
}

impl ToileApp {
    /// A button for a command, greyed while the command is not available.
    pub(crate) fn command_button(&mut self, ui: &mut egui::Ui, command: &'static UiCommand) {
        let button = egui::Button::new(command.name);
        self.command_widget(ui, command, button, None);
    }

    /// Adds `button` for a command; `words` is the tooltip in place of the command's own.
    pub(crate) fn command_widget(
        &mut self,
        ui: &mut egui::Ui,
        command: &'static UiCommand,
        button: egui::Button<'_>,
        words: Option<String>,
    ) {
        let words = words.unwrap_or_else(|| command.words(ui.ctx()));
        let response = ui
            .add_enabled((command.when)(self), button)
            .on_hover_text(&words)
            .on_disabled_hover_text(&words);
        // The key is shown beside the name, and is no part of the accessible name.
        response.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::Button, response.enabled(), command.name)
        });
        if response.clicked() {
            self.command(command);
        }
    }
}
