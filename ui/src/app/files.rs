//! New, open, save: with a path field and a list of the folder, which work on every platform.

use super::ToileApp;
use super::dialogs::Dialog;
use super::file_choice::{FileChoice, MEASURED, PATTERNS};
use super::save_choice::SaveChoice;
use crate::tables::WornWhere;
use std::path::{Path, PathBuf};
use toile_session::{Command, Format};

impl ToileApp {
    pub(crate) fn ask_new(&mut self) {
        self.before_leaving(Dialog::New("My pattern".into()));
    }

    pub(crate) fn ask_open(&mut self) {
        self.before_leaving(Dialog::Open(self.file_beside(PATTERNS)));
    }

    pub(crate) fn ask_insert(&mut self) {
        self.dialog = Some(Dialog::Insert(self.file_beside(PATTERNS)));
    }

    pub(crate) fn ask_wearer(&mut self) {
        self.dialog = Some(Dialog::Wearer(self.file_beside(MEASURED)));
    }

    pub(crate) fn ask_worn(&mut self, place: WornWhere) {
        self.dialog = Some(Dialog::Wear(place, self.file_beside(PATTERNS)));
    }

    /// Choice of a file with one of the extensions `endings`, in the folder of the pattern; no path is
    /// typed yet.
    pub(super) fn file_beside(&self, endings: &'static [&'static str]) -> FileChoice {
        let path = self.session.project().source.clone().unwrap_or_default();
        let mut choice = FileChoice::showing(&path, endings);
        choice.path.clear();
        choice
    }

    pub(crate) fn ask_fabric_file(&mut self) {
        self.dialog = Some(Dialog::Fabric(self.file_beside(PATTERNS)));
    }

    /// Has the garment cut from the fabric of a file.
    pub(super) fn cut_from_file(&mut self, path: &Path) {
        let fabric = Some(path.display().to_string());
        self.execute(Command::SetFabric { fabric });
    }

    pub(crate) fn ask_save(&mut self) {
        self.dialog = Some(Dialog::SaveAs(Box::new(SaveChoice::new(&self.save_path()))));
    }

    /// Opens a dialog that replaces the document, after asking about unsaved changes.
    fn before_leaving(&mut self, next: Dialog) {
        self.dialog = Some(match self.is_unsaved() {
            true => Dialog::Leave(Box::new(next)),
            false => next,
        });
    }

    /// Saves to the file of the pattern; asks for a file if the pattern has none in the native format.
    pub(crate) fn save(&mut self) {
        let path = self.save_path();
        let own = self.session.project().source.as_ref() == Some(&path);
        match own {
            true => {
                self.execute(Command::SavePattern { path });
                self.keep_drape_view();
            }
            false => self.ask_save(),
        }
    }

    /// Path to save to: the file the pattern came from, if that is in the native format; else one beside
    /// it.
    fn save_path(&self) -> PathBuf {
        let project = self.session.project();
        let ending = Format::Native.ending();
        match &project.source {
            Some(path) if path.to_string_lossy().ends_with(ending) => path.clone(),
            Some(path) if path.exists() => {
                let stem = path.file_stem().unwrap_or_default().to_string_lossy();
                path.with_file_name(format!("{stem}{ending}"))
            }
            _ => {
                let plain = |c: char| match c.is_alphanumeric() {
                    true => c.to_lowercase().next().unwrap_or(c),
                    false => '-',
                };
                let name: String = project.pattern.name.chars().map(plain).collect();
                PathBuf::from(format!("{name}{ending}"))
            }
        }
    }
}
