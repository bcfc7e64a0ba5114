//! The page shown while no pattern is open: a new pattern, a file, samples.

use super::ToileApp;
use super::answer::{Answer, filled_button, main_button};
use super::pattern_cards::CARD;
use crate::theme::Palette;
use egui::{RichText, Ui, vec2};
use std::path::{Path, PathBuf};
use toile_session::{Command, SAMPLES};

/// Width of the page (pixels).
const WIDTH: f32 = 780.0;
/// Initial guess of the width of the two buttons side by side (pixels).
const BUTTONS: f32 = 204.0;

impl ToileApp {
    /// Shows the first page: a new pattern, a file, or a pattern from its card.
    pub(crate) fn welcome(&mut self, ui: &mut Ui) {
        let palette = Palette::of(ui.ctx());
        let mut open: Option<PathBuf> = None;
        egui::ScrollArea::vertical().show(ui, |ui| {
            ui.vertical_centered(|ui| {
                ui.set_max_width(WIDTH);
                ui.add_space(40.0);
                ui.heading("Toile");
                ui.label(
                    RichText::new("Draft panels, lay them on fabric, see the garment hang")
                        .color(palette.ink_soft),
                );
                ui.add_space(16.0);
                if let Some(words) = &self.refusal {
                    ui.heading("This pattern cannot be opened");
                    ui.label(RichText::new(words).color(palette.fault));
                    ui.add_space(12.0);
                }
                // Centred by the width that the buttons had in the last frame.
                let buttons = egui::Id::unique("welcome buttons");
                let known: Option<f32> = ui.data(|data| data.get_temp(buttons));
                ui.horizontal(|ui| {
                    let width = known.unwrap_or(BUTTONS);
                    ui.add_space((ui.available_width() - width).max(0.0) * 0.5);
                    let left = ui.next_widget_position().x;
                    if filled_button(ui, "New pattern") {
                        self.ask_new();
                    }
                    if ui.button("Open a file\u{2026}").clicked() {
                        self.ask_open();
                    }
                    let width = ui.min_rect().right() - left;
                    ui.data_mut(|data| data.insert_temp(buttons, width));
                });
                ui.add_space(20.0);
                let recent = self.preferences.recent.iter();
                let recent: Vec<(PathBuf, String)> =
                    recent.map(|path| (path.clone(), name_of(path))).collect();
                let shipped: Vec<(PathBuf, String)> = SAMPLES
                    .iter()
                    .map(|(path, name)| (PathBuf::from(path), (*name).to_owned()))
                    .collect();
                for (title, patterns) in [
                    ("Recent", recent),
                    ("Patterns that come with the program", shipped),
                ] {
                    if let Some(path) = self.cards(ui, title, &patterns) {
                        open = Some(path);
                    }
                }
                ui.label(
                    RichText::new("A pattern file can be dropped anywhere on this window")
                        .color(palette.ink_soft),
                );
            });
        });
        if let Some(path) = open {
            // Files may have changed when the page is shown again.
            self.pattern_cards.clear();
            self.open(&path);
        }
    }

    /// Shows cards of patterns in rows under a title; returns the file of a clicked card.
    fn cards(
        &mut self,
        ui: &mut Ui,
        title: &str,
        patterns: &[(PathBuf, String)],
    ) -> Option<PathBuf> {
        if patterns.is_empty() {
            return None;
        }
        let mut open = None;
        ui.label(RichText::new(title).strong());
        ui.add_space(4.0);
        let gap = ui.spacing().item_spacing.x;
        let fit = ((ui.available_width() + gap) / (CARD.x + gap)).floor();
        for row in patterns.chunks((fit as usize).max(1)) {
            ui.horizontal(|ui| {
                let width = row.len() as f32 * (CARD.x + gap) - gap;
                ui.add_space((ui.available_width() - width).max(0.0) * 0.5);
                for (path, name) in row {
                    let folder = self.preferences.folder();
                    if self.pattern_cards.card(ui, (path, name), folder) {
                        open = Some(path.clone());
                    }
                }
            });
        }
        ui.add_space(16.0);
        open
    }

    /// Offers the documents left by a crash.
    pub(super) fn ask_recover(&mut self, ui: &mut Ui) -> Answer {
        let palette = Palette::of(ui.ctx());
        ui.heading("Recover unsaved work?");
        ui.label("The program ended before these were saved:");
        let mut taken = None;
        let mut dropped = None;
        for (k, document) in self.abandoned.iter().enumerate() {
            ui.horizontal(|ui| {
                ui.set_min_size(vec2(0.0, 28.0));
                ui.label(RichText::new(&document.name).strong());
                let age = document.kept.and_then(|kept| kept.elapsed().ok());
                if let Some(age) = age {
                    let words = match age.as_secs() / 60 {
                        0 => "just now".to_owned(),
                        1 => "a minute ago".to_owned(),
                        minutes => format!("{minutes} minutes ago"),
                    };
                    ui.label(RichText::new(words).color(palette.ink_soft));
                }
                // Enter recovers the first.
                let recovers = match k {
                    0 => main_button(ui, "Recover"),
                    _ => filled_button(ui, "Recover"),
                };
                if recovers {
                    taken = Some(k);
                }
                if ui.button("Discard").clicked() {
                    dropped = Some(k);
                }
            });
        }
        if let Some(k) = dropped {
            let document = self.abandoned.remove(k);
            if let Err(error) = document.discard() {
                self.notice = super::notice::Notice::warning(error.to_string());
            }
        }
        if let Some(k) = taken {
            return Answer::Do(Box::new(move |app| app.recover(k)));
        }
        match self.abandoned.is_empty() || ui.button("Later").clicked() {
            true => Answer::Leave,
            false => Answer::Stay,
        }
    }

    /// Opens a document left by a crash. The recovery files of the document are removed once its state is
    /// stored anew.
    fn recover(&mut self, k: usize) {
        let document = self.abandoned.remove(k);
        let restore = Command::RestorePattern {
            text: document.text.clone(),
            source: document.source.clone(),
            past: document.past.clone(),
        };
        if self.execute(restore)
            && let Err(error) = document.discard()
        {
            self.notice = super::notice::Notice::warning(error.to_string());
        }
    }
}

/// Name of a pattern file without `.json` and `.toile`.
fn name_of(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let stem = name.trim_end_matches(".json").trim_end_matches(".toile");
    stem.to_owned()
}
