//! The part of a dialog in which a file is picked: folder, name, buttons.

use super::answer::main_button;
use super::file_choice::FileChoice;
use crate::fields::text_field;
use crate::theme::Palette;
use egui::{RichText, ScrollArea, Ui};
use std::path::PathBuf;

/// Height of the list of the folder (pixels).
const LIST: f32 = 240.0;

/// What was done in a dialog in which a file is chosen.
pub enum Picked {
    /// Nothing yet.
    Nothing,
    /// It was left.
    Cancel,
    /// A file was chosen.
    File(PathBuf),
}

/// Shows the folder, the field with the file's name, then `more`, and the buttons.
pub fn pick_file(
    ui: &mut Ui,
    choice: &mut FileChoice,
    title: &str,
    verb: &'static str,
    more: impl FnOnce(&mut Ui),
) -> Picked {
    ui.heading(title);
    ui.label(RichText::new(choice.folder.display().to_string()).small());
    let mut taken = false;
    let mut folder = None;
    ScrollArea::vertical()
        .max_height(LIST)
        .auto_shrink([false, false])
        .show(ui, |ui| {
            if let Some(above) = choice.folder.parent()
                && ui.selectable_label(false, ".. (folder above)").clicked()
            {
                folder = Some(above.to_owned());
            }
            for entry in &choice.entries {
                let words = match entry.is_file {
                    true => entry.name.clone(),
                    false => format!("{}/", entry.name),
                };
                let response = ui.selectable_label(choice.path == entry.name, words);
                match entry.is_file {
                    true if response.double_clicked() => {
                        choice.path.clone_from(&entry.name);
                        taken = true;
                    }
                    true if response.clicked() => choice.path.clone_from(&entry.name),
                    false if response.clicked() => folder = Some(choice.folder.join(&entry.name)),
                    _ => {}
                }
            }
        });
    if let Some(folder) = folder {
        choice.list(folder);
    }
    if !choice.fault.is_empty() {
        let colour = Palette::of(ui.ctx()).fault;
        ui.label(RichText::new(&choice.fault).color(colour));
    }
    let label = ui.label("File").id;
    let field = text_field(ui, egui::Id::unique("file name"), &mut choice.path).labelled_by(label);
    if ui.memory(|memory| memory.focused().is_none()) {
        field.request_focus();
    }
    more(ui);
    let mut picked = Picked::Nothing;
    ui.horizontal(|ui| {
        let named = !choice.path.trim().is_empty();
        if ui.add_enabled_ui(named, |ui| main_button(ui, verb)).inner || taken && named {
            let path = choice.chosen();
            if path.is_dir() {
                choice.path.clear();
                choice.list(path);
                return;
            }
            picked = Picked::File(path);
        } else if ui.button("Cancel").clicked() {
            picked = Picked::Cancel;
        }
    });
    picked
}
