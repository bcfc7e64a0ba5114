//! The bar over a pattern that was read from a file of another program: what was guessed, what was left out,
//! and the other answers, one click away.

use super::ToileApp;
use super::dialogs::Dialog;
use super::file_choice::ANY;
use super::notice::Notice;
use crate::fields::text_field;
use crate::theme::Palette;
use crate::tools::number;
use egui::{Align, ComboBox, Layout, RichText, ScrollArea, Ui};
use std::path::{Path, PathBuf};
use toile_pattern::{Number, Want};
use toile_session::{
    Choice, Command, DisplayUnit, FileUse, Format, FoundInFile, Guess, OpenOptions, ReadOption,
    file_use,
};

/// Width of a list in the bar (pixels).
const LIST: f32 = 110.0;
/// Width of the lines that the bar tells (pixels).
const LINES: f32 = 480.0;
/// Width of a field in the bar (pixels).
const FIELD: f32 = 70.0;

/// The file of another program that the pattern was read from, as long as the bar about it stands.
pub struct ForeignFile {
    path: PathBuf,
    /// How it was read.
    options: OpenOptions,
    found: FoundInFile,
    /// What the file does not say, with the answers that were taken, in words.
    guessed: Vec<String>,
    /// What the file holds and the pattern does not, in words.
    left_out: Vec<String>,
    /// The distance to the sew line, as typed.
    inside: String,
}

/// Another answer to a question that the file leaves open.
enum Answered {
    Format(Format),
    Unit(DisplayUnit),
    Inside(String),
    AsksFile,
}

impl ToileApp {
    /// Opens a pattern in place of the present one.
    pub fn open(&mut self, path: &Path) {
        self.open_with(path, OpenOptions::default());
    }

    /// Opens a pattern as options say, in place of the present one.
    pub(super) fn open_with(&mut self, path: &Path, options: OpenOptions) {
        let command = Command::OpenPattern {
            path: path.to_owned(),
            options: options.clone(),
        };
        let is_read = self.execute(command);
        self.notice.text = of_the_window(&self.notice.text);
        if is_read {
            let found = self.file_read.take();
            let unit = self.base.pattern().unit;
            let inside = options.reading.allowance_inside;
            let inside = inside.map(|by| number::show(by, Want::Length, unit));
            self.foreign = found.filter(is_told).map(|found| ForeignFile {
                path: path.to_owned(),
                guessed: found.guesses.iter().map(guess_in_words).collect(),
                left_out: found
                    .losses
                    .iter()
                    .map(|loss| of_the_window(&loss.to_string()))
                    .collect(),
                options,
                found,
                inside: inside.unwrap_or_default(),
            });
        } else if !self.is_open() {
            self.refusal = Some(std::mem::take(&mut self.notice).text);
        }
    }

    /// Takes a file that belongs to the foreign file, and reads that anew.
    pub(super) fn read_with(&mut self, file: &Path) {
        let Some(foreign) = &self.foreign else { return };
        let mut options = foreign.options.clone();
        // No format takes two.
        options.with = vec![file.to_owned()];
        self.read_anew(options);
    }

    /// Reads the foreign file anew, unless changes would be lost.
    fn read_anew(&mut self, options: OpenOptions) {
        let Some(foreign) = &self.foreign else { return };
        if self.is_unsaved() {
            self.notice = Notice::fault(
                "The file would be read anew, and the changes since would be lost: undo them first",
            );
            return;
        }
        let path = foreign.path.clone();
        self.open_with(&path, options);
    }

    /// Takes files that are dropped on the window: a pattern with the files that belong to it, or measurements
    /// of the wearer, or a fabric.
    pub(crate) fn take_files(&mut self, context: &egui::Context) {
        let dropped = context.input(|input| {
            let files = input.raw.dropped_files.iter();
            files.map(|file| file.path().to_owned()).collect::<Vec<_>>()
        });
        // What cannot be read is told by opening it.
        let use_of = |path: &PathBuf| file_use(path).unwrap_or(FileUse::Other);
        let uses: Vec<FileUse> = dropped.iter().map(use_of).collect();
        let pattern = uses.iter().position(|of| *of == FileUse::Pattern);
        let Some(first) = pattern.or_else(|| dropped.len().checked_sub(1)) else {
            return;
        };
        let path = &dropped[first];
        match uses[first] {
            FileUse::Wearer if self.is_open() => self.take_wearer(path),
            FileUse::Fabric if self.is_open() => self.cut_from_file(path),
            FileUse::Pattern if self.is_unsaved() => {
                self.notice = Notice::fault(
                    "The pattern has changes that are not saved: save it, or undo them, \
                     then drop the file again",
                );
            }
            _ => {
                let others = dropped.iter().enumerate().filter(|(k, _)| *k != first);
                let options = OpenOptions {
                    with: others.map(|(_, path)| path.clone()).collect(),
                    ..OpenOptions::default()
                };
                self.open_with(path, options);
            }
        }
    }

    /// Whether the pattern is still that of the foreign file: once it is saved to a file of its own, it is not.
    pub(super) fn is_foreign(&self) -> bool {
        let source = self.session.project().source.as_ref();
        let mut own = self.foreign.iter();
        own.any(|foreign| source == Some(&foreign.path))
    }

    /// Shows the bar.
    pub(super) fn foreign_bar(&mut self, ui: &mut Ui) {
        let Some(foreign) = &mut self.foreign else {
            return;
        };
        let palette = Palette::of(ui.ctx());
        let mut answer = None;
        let mut is_dismissed = false;
        ui.horizontal(|ui| {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                is_dismissed = ui.button("Dismiss").clicked();
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    let title = foreign.found.format.title();
                    ui.label(RichText::new(format!("Read as {title}")).strong());
                    answer = foreign.questions(ui);
                    for (lines, what) in [
                        (&foreign.guessed, "guessed"),
                        (&foreign.left_out, "left out"),
                    ] {
                        if !lines.is_empty() {
                            ui.separator();
                            let words = format!("{} {what}", lines.len());
                            let words = RichText::new(words).color(palette.warning);
                            ui.menu_button(words, |ui| told(ui, lines));
                        }
                    }
                });
            });
        });
        if is_dismissed {
            self.foreign = None;
            return;
        }
        let Some(answer) = answer else { return };
        let mut options = foreign.options.clone();
        match answer {
            Answered::Format(format) => options.reading.format = Some(format),
            Answered::Unit(unit) => options.reading.unit = Some(unit),
            Answered::Inside(text) if text.trim().is_empty() => {
                options.reading.allowance_inside = None;
            }
            Answered::Inside(text) => {
                let fault = match number::parse(&text, Want::Length, &self.base) {
                    Ok(Number::Value(inside)) => {
                        options.reading.allowance_inside = Some(inside);
                        None
                    }
                    Ok(_) => Some("type a length, as in 10mm".to_owned()),
                    Err(fault) => Some(fault),
                };
                if let Some(fault) = fault {
                    self.notice = Notice::fault(fault);
                    return;
                }
            }
            Answered::AsksFile => {
                self.dialog = Some(Dialog::With(self.file_beside(ANY)));
                return;
            }
        }
        self.read_anew(options);
    }
}

/// Shows lines, each whole.
fn told(ui: &mut Ui, lines: &[String]) {
    ui.set_width(LINES);
    ScrollArea::vertical().show(ui, |ui| {
        for line in lines {
            ui.add(egui::Label::new(line).wrap());
        }
    });
}

/// A guess in words.
fn guess_in_words(guess: &Guess) -> String {
    let Guess {
        what,
        chosen,
        because,
        ..
    } = guess;
    of_the_window(&format!("{what}: {chosen}: {because}"))
}

/// Words with the names that the window has for options of the command line.
fn of_the_window(words: &str) -> String {
    let mut words = words.to_owned();
    for &option in ReadOption::ALL {
        let own = format!("\u{201c}{}\u{201d}", title(option));
        words = words.replace(&format!("`{option}`"), &own);
        words = words.replace(option.word(), &own);
    }
    words
}

/// The name of the widget that answers a question.
fn title(option: ReadOption) -> &'static str {
    match option {
        ReadOption::Format => "Format",
        ReadOption::Unit => "Unit of the file",
        ReadOption::Inside => "Sew line inside by",
        ReadOption::With => "Add a file\u{2026}",
    }
}

/// Whether the user is told of what reading a file found out, and may want it otherwise.
fn is_told(found: &FoundInFile) -> bool {
    let is_drawing = found.format.takes(ReadOption::Unit);
    is_drawing || !found.guesses.is_empty() || !found.losses.is_empty()
}

impl ForeignFile {
    /// Shows a widget for each question that the file leaves open; returns what was answered.
    fn questions(&mut self, ui: &mut Ui) -> Option<Answered> {
        let mut answer = None;
        let format = self.found.format;
        for &option in ReadOption::ALL {
            let guesses = self
                .found
                .guesses
                .iter()
                .filter(|guess| guess.option == option);
            let guesses: Vec<&Guess> = guesses.collect();
            // Units and lines of drawings are often other than the file says.
            let is_asked = format.takes(ReadOption::Unit) && option != ReadOption::With;
            if guesses.is_empty() && !is_asked {
                continue;
            }
            ui.separator();
            match option {
                ReadOption::Format => {
                    let formats = Format::all().iter().copied();
                    let chosen = list(
                        ui,
                        title(option),
                        format.title(),
                        formats.map(|f| (f, f.title())),
                    );
                    answer = chosen
                        .filter(|f| *f != format)
                        .map(Answered::Format)
                        .or(answer);
                }
                ReadOption::Unit => {
                    let given = self.options.reading.unit.map(DisplayUnit::word);
                    let guessed = guesses.first().map(|guess| guess.chosen.clone());
                    let now = given.map(str::to_owned).or(guessed);
                    let now = now.unwrap_or_else(|| "as stated".to_owned());
                    let units = DisplayUnit::all().iter().copied();
                    let units = units.map(|unit| (unit, unit.word()));
                    let chosen = list(ui, title(option), &now, units);
                    answer = chosen.map(Answered::Unit).or(answer);
                }
                ReadOption::Inside => {
                    let label = ui.label(title(option)).id;
                    let id = egui::Id::unique("sew line inside by");
                    let field = ui.scope(|ui| {
                        ui.set_max_width(FIELD);
                        text_field(ui, id, &mut self.inside)
                    });
                    let field = field.inner.labelled_by(label);
                    let entered = ui.input(|input| input.key_pressed(egui::Key::Enter));
                    if field.lost_focus() && entered {
                        answer = Some(Answered::Inside(self.inside.clone()));
                    }
                }
                ReadOption::With => {
                    if ui.button(title(option)).clicked() {
                        answer = Some(Answered::AsksFile);
                    }
                }
            }
        }
        answer
    }
}

/// A list to choose from; returns what was chosen.
fn list<Value>(
    ui: &mut Ui,
    name: &str,
    now: &str,
    values: impl Iterator<Item = (Value, &'static str)>,
) -> Option<Value> {
    let label = ui.label(name).id;
    let mut chosen = None;
    ComboBox::from_id_salt(name)
        .selected_text(now)
        .width(LIST)
        .show_ui(ui, |ui| {
            for (value, words) in values {
                if ui.selectable_label(words == now, words).clicked() {
                    chosen = Some(value);
                }
            }
        })
        .response
        .labelled_by(label);
    chosen
}
