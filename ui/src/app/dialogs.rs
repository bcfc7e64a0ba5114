//! Dialogs: questions to answer before something is done.
//!
//! # Decided with
//! - [`crate::app::answer::Answer`], [`crate::app::answer::main_button`]: answers; the button that Enter
//!   presses;
//! - [`crate::app::ToileApp::guard_closing`], [`crate::app::ToileApp::before_leaving`] (`files.rs`): asked
//!   before unsaved work is lost;
//! - [`crate::app::notice::Notice`]: messages of the status line;
//! - [`crate::app::export_choice`], [`crate::app::print_choice`], [`crate::app::file_choice`],
//!   [`crate::app::save_choice`]: exports, prints, files;
//! - [`crate::tools`] (`refusal.rs`, `refuse`): words of refusals.

use super::ToileApp;
use super::answer::{Answer, main_button};
use super::export_choice::ExportChoice;
use super::file_choice::FileChoice;
use super::notice::Notice;
use super::pick_file::{Picked, pick_file};
use super::print_choice::PrintChoice;
use super::save_choice::{SaveChoice, SaveTarget};
use crate::fields::text_field;
use crate::tables::WornWhere;
use egui::{Context, Key, Ui, ViewportCommand};
use toile_session::Command;

/// Width of a dialog (pixels).
const WIDTH: f32 = 420.0;

/// A dialog that is open.
pub enum Dialog {
    /// The name of a new pattern.
    New(String),
    /// The file to open.
    Open(FileChoice),
    /// The file to save to.
    SaveAs(Box<SaveChoice>),
    /// Content and settings of a print.
    Print(Box<PrintChoice>),
    /// Content and folder of an export.
    Export(Box<ExportChoice>),
    /// The pattern whose panels are inserted.
    Insert(FileChoice),
    /// The file of the fabric that the garment is cut from.
    Fabric(FileChoice),
    /// The file with the measurements or the mannequin of the wearer.
    Wearer(FileChoice),
    /// The pattern of a garment that is worn over or under this one.
    Wear(WornWhere, FileChoice),
    /// A file that belongs to the foreign file that the pattern was read from.
    With(FileChoice),
    /// Asks whether to replace an existing file.
    Replace(SaveTarget),
    /// Asks about unsaved changes; holds the dialog that opens afterwards.
    Leave(Box<Dialog>),
    /// Asks about unsaved changes before the window closes.
    Close,
    /// Documents left by a crash.
    Recover,
    /// Search for a command by name: the typed text, and the index of the chosen result.
    Find(String, usize),
    /// The glossary: the text that is searched for in it.
    Words(String),
}

impl ToileApp {
    pub(crate) fn show_dialog(&mut self, context: &Context) {
        let Some(mut dialog) = self.dialog.take() else {
            return;
        };
        let mut answer = Answer::Stay;
        let modal = egui::Modal::new(egui::Id::unique("dialog")).show(context, |ui| {
            ui.set_width(WIDTH);
            answer = match &mut dialog {
                Dialog::New(name) => ask_name(ui, name),
                Dialog::Open(choice) => ask_file(ui, choice, "Open a pattern", "Open"),
                Dialog::SaveAs(choice) => self.ask_save_choice(ui, choice),
                Dialog::With(choice) => ask_file(
                    ui,
                    choice,
                    "A file that belongs to the pattern",
                    "Read with it",
                ),
                Dialog::Print(choice) => self.ask_print_choice(ui, choice),
                Dialog::Export(choice) => self.ask_export_choice(ui, choice),
                Dialog::Insert(choice) => {
                    ask_file(ui, choice, "Insert the panels of a pattern", "Insert")
                }
                Dialog::Fabric(choice) => ask_file(ui, choice, "Cut the garment from", "Choose"),
                Dialog::Wearer(choice) => ask_file(
                    ui,
                    choice,
                    "Measurements or a mannequin of the wearer",
                    "Take",
                ),
                Dialog::Wear(WornWhere::Over, choice) => ask_file(
                    ui,
                    choice,
                    "A garment to wear over this one",
                    "Wear over it",
                ),
                Dialog::Wear(WornWhere::Under, choice) => ask_file(
                    ui,
                    choice,
                    "A garment to wear under this one",
                    "Wear under it",
                ),
                Dialog::Replace(target) => ask_replace(ui, target),
                Dialog::Leave(_) | Dialog::Close => ask_save(ui),
                Dialog::Recover => self.ask_recover(ui),
                Dialog::Find(text, chosen) => self.ask_find(ui, text, chosen),
                Dialog::Words(text) => Self::show_words(ui, text),
            };
        });
        // In a text field egui uses a first Escape to take the focus away; here that press closes the
        // dialog, too.
        let escaped = context.input(|input| input.key_pressed(Key::Escape));
        let closes = (escaped || modal.should_close()) && !self.menu_is_open;
        if matches!(answer, Answer::Stay) && closes {
            answer = Answer::Leave;
        }
        match answer {
            Answer::Stay => self.dialog = Some(dialog),
            Answer::Leave => {}
            Answer::Do(then) => {
                let next = match dialog {
                    Dialog::Leave(next) => Some(*next),
                    Dialog::Close => {
                        self.closes = true;
                        self.closes_at = self.session.revision();
                        None
                    }
                    _ => None,
                };
                // The action may set a message of its own: so the old one is cleared before.
                self.notice = Notice::default();
                then(self);
                self.leave(next);
            }
        }
    }

    /// Opens the next dialog, once the changes are saved or given up.
    fn leave(&mut self, next: Option<Dialog>) {
        // A pattern that could not be saved stays open.
        if self.dialog.is_none() && !self.notice.is_fault() {
            self.dialog = next;
        }
        // Saving failed, or asks for a file first: the window stays open.
        if self.closes && (self.dialog.is_some() || self.notice.is_fault()) {
            self.closes = false;
        }
    }

    /// Asks before unsaved changes are lost, and closes the window only when no export or print is being
    /// written; a second request to close stops the writing.
    pub(crate) fn guard_closing(&mut self, context: &Context) {
        let closing = context.input(|input| input.viewport().close_requested());
        if closing && !self.closes && self.is_unsaved() {
            context.send_viewport_cmd(ViewportCommand::CancelClose);
            self.waits_to_close = false;
            self.dialog = Some(Dialog::Close);
            return;
        }
        // Changes that were drawn while files were written are asked about, too.
        if self.closes && self.is_unsaved() && self.session.revision() != self.closes_at {
            (self.closes, self.waits_to_close) = (false, false);
            self.dialog = Some(Dialog::Close);
            return;
        }
        if !(closing || self.closes || self.waits_to_close) {
            return;
        }
        if self.is_writing() {
            if closing {
                context.send_viewport_cmd(ViewportCommand::CancelClose);
            }
            if closing && self.waits_to_close {
                self.stop_writing();
            } else if !self.waits_to_close {
                self.waits_to_close = true;
                let words =
                    "The window closes once the files are written; close it again to stop that";
                self.notice = Notice::news(words);
            }
            return;
        }
        if self.closes {
            self.forget_recovery();
        }
        if self.closes || self.waits_to_close {
            context.send_viewport_cmd(ViewportCommand::Close);
        }
    }
}

fn ask_name(ui: &mut Ui, name: &mut String) -> Answer {
    ui.heading("New pattern");
    let label = ui.label("Name").id;
    let field = text_field(ui, egui::Id::unique("new name"), name).labelled_by(label);
    if ui.memory(|memory| memory.focused().is_none()) {
        field.request_focus();
    }
    let mut answer = Answer::Stay;
    ui.horizontal(|ui| {
        if main_button(ui, "Create") {
            let name = name.trim().to_owned();
            answer = Answer::Do(Box::new(move |app| {
                if !app.execute(Command::NewPattern { name: name.clone() }) {
                    app.dialog = Some(Dialog::New(name));
                }
            }));
        } else if ui.button("Cancel").clicked() {
            answer = Answer::Leave;
        }
    });
    answer
}

fn ask_file(ui: &mut Ui, choice: &mut FileChoice, title: &str, verb: &'static str) -> Answer {
    let path = match pick_file(ui, choice, title, verb, |_| {}) {
        Picked::Nothing => return Answer::Stay,
        Picked::Cancel => return Answer::Leave,
        Picked::File(path) => path,
    };
    Answer::Do(match verb {
        "Choose" => Box::new(move |app: &mut ToileApp| app.cut_from_file(&path)),
        "Insert" => Box::new(move |app: &mut ToileApp| app.insert_file(&path)),
        "Take" => Box::new(move |app: &mut ToileApp| app.take_wearer(&path)),
        "Read with it" => Box::new(move |app: &mut ToileApp| app.read_with(&path)),
        "Wear over it" => Box::new(move |app: &mut ToileApp| app.wear(&path, WornWhere::Over)),
        "Wear under it" => Box::new(move |app: &mut ToileApp| app.wear(&path, WornWhere::Under)),
        _ => Box::new(move |app: &mut ToileApp| app.open(&path)),
    })
}

fn ask_replace(ui: &mut Ui, target: &SaveTarget) -> Answer {
    ui.heading("Replace the file?");
    ui.label(format!("{} is there already.", target.path.display()));
    let mut answer = Answer::Stay;
    ui.horizontal(|ui| {
        // Enter does not replace the existing file.
        if main_button(ui, "Another file") {
            answer = Answer::Do(Box::new(ToileApp::ask_save));
        } else if ui.button("Replace").clicked() {
            let target = target.clone();
            answer = Answer::Do(Box::new(move |app| app.save_to(target, true)));
        }
    });
    answer
}

fn ask_save(ui: &mut Ui) -> Answer {
    ui.heading("Save the changes?");
    ui.label("The pattern has changes that are in no file.");
    let mut answer = Answer::Stay;
    ui.horizontal(|ui| {
        if main_button(ui, "Save") {
            answer = Answer::Do(Box::new(ToileApp::save));
        } else if ui.button("Leave without saving").clicked() {
            answer = Answer::Do(Box::new(|_| {}));
        } else if ui.button("Keep working").clicked() {
            answer = Answer::Leave;
        }
    });
    answer
}
