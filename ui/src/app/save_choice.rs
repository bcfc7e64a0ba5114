//! The dialog that saves: file, format, and what the format leaves out.

use super::ToileApp;
use super::answer::Answer;
use super::file_choice::FileChoice;
use super::pick_file::{Picked, pick_file};
use crate::theme::Palette;
use egui::{ComboBox, RichText, Ui};
use std::path::{Path, PathBuf};
use toile_session::{Choice, Format, Loss, Project, WriteOptions};

/// Largest number of kinds of contents whose loss is listed in the dialog; more are counted.
const LISTED: usize = 6;

/// State of the dialog.
pub struct SaveChoice {
    file: FileChoice,
    format: Format,
    all_sizes: bool,
    /// Contents that a format leaves out, in words, or the reason why it cannot be written; with the settings
    /// that they hold for.
    lost: Option<(WriteOptions, Result<Vec<String>, String>)>,
}

/// A file that is saved to.
#[derive(Clone, Debug, PartialEq)]
pub struct SaveTarget {
    /// The file.
    pub path: PathBuf,
    /// Format and sizes, if it is written for another program.
    pub foreign: Option<WriteOptions>,
}

impl SaveChoice {
    /// Saves to a file in the native format, unless the user chooses otherwise.
    pub fn new(path: &Path) -> Self {
        Self {
            file: FileChoice::new(path),
            format: Format::Native,
            all_sizes: true,
            lost: None,
        }
    }

    fn options(&self, has_sizes: bool) -> WriteOptions {
        WriteOptions {
            format: Some(self.format),
            all_sizes: has_sizes && self.all_sizes && self.format.holds_sizes(),
        }
    }

    /// Chooses the format, and gives the file name its ending.
    fn choose(&mut self, format: Format) {
        let name = self.file.path.trim();
        // The longest ending of any format goes.
        let endings = Format::all().iter().map(|of| of.ending_of(name).len());
        let stem = &name[..name.len() - endings.max().unwrap_or(0)];
        if !stem.is_empty() {
            self.file.path = format!("{stem}{}", format.ending());
        }
        self.format = format;
    }

    /// Follows an ending that was typed; `.json` alone is that of a native file, too.
    fn follow_name(&mut self) {
        let named = Format::of_name(self.file.path.trim());
        let Some(named) = named.filter(|of| of.ending() != self.format.ending()) else {
            return;
        };
        self.format = match named {
            Format::GarmentCode => Format::Native,
            named => named,
        };
    }

    /// Contents that the chosen format leaves out.
    fn lost(&mut self, project: &Project, options: &WriteOptions) -> &Result<Vec<String>, String> {
        let is_known = matches!(&self.lost, Some((of, _)) if of == options);
        if !is_known {
            let lost = project.lost_in(self.format, options);
            let lost = lost.map(|lost| lost.iter().map(in_words).collect());
            self.lost = Some((options.clone(), lost.map_err(|error| error.to_string())));
        }
        match &self.lost {
            Some((_, lost)) => lost,
            None => const { &Ok(Vec::new()) },
        }
    }
}

/// A loss in words, with what writes the contents after all.
fn in_words(loss: &Loss) -> String {
    match loss.why == Loss::NOT_ASKED_FOR {
        true => format!("{loss}: tick All sizes to write them"),
        false => loss.to_string(),
    }
}

impl ToileApp {
    /// Shows the dialog that saves.
    pub(super) fn ask_save_choice(&self, ui: &mut Ui, choice: &mut SaveChoice) -> Answer {
        let project = self.session.project();
        let has_sizes = !project.pattern.sizes.is_empty();
        let mut format = choice.format;
        let (mut all_sizes, mut told) = (choice.all_sizes, None);
        let options = choice.options(has_sizes);
        if format != Format::Native {
            told = Some(choice.lost(project, &options).clone());
        }
        let picked = pick_file(ui, &mut choice.file, "Save the pattern", "Save", |ui| {
            ui.horizontal(|ui| {
                let label = ui.label("Format").id;
                ComboBox::from_id_salt("format to save in")
                    .selected_text(format.title())
                    .show_ui(ui, |ui| {
                        for &other in Format::all().iter().filter(|of| of.is_written()) {
                            ui.selectable_value(&mut format, other, other.title());
                        }
                    })
                    .response
                    .labelled_by(label);
                if has_sizes && format.holds_sizes() {
                    ui.checkbox(&mut all_sizes, "All sizes");
                }
            });
            let palette = Palette::of(ui.ctx());
            match &told {
                None => {}
                Some(Err(fault)) => {
                    ui.label(RichText::new(fault).color(palette.fault));
                }
                Some(Ok(lost)) if lost.is_empty() => {
                    ui.label("Nothing is left out.");
                }
                Some(Ok(lost)) => {
                    ui.label(RichText::new("The file leaves out:").color(palette.warning));
                    for words in lost.iter().take(LISTED) {
                        ui.label(RichText::new(words).small());
                    }
                    if lost.len() > LISTED {
                        let rest = format!("and {} more", lost.len() - LISTED);
                        ui.label(RichText::new(rest).small())
                            .on_hover_text(lost[LISTED..].join("\n"));
                    }
                }
            }
        });
        choice.all_sizes = all_sizes;
        match format == choice.format {
            true => choice.follow_name(),
            false => choice.choose(format),
        }
        match picked {
            Picked::Nothing => Answer::Stay,
            Picked::Cancel => Answer::Leave,
            Picked::File(path) => {
                let options = choice.options(has_sizes);
                let foreign = (choice.format != Format::Native).then_some(options);
                let target = SaveTarget { path, foreign };
                Answer::Do(Box::new(move |app| app.save_to(target, false)))
            }
        }
    }
}
