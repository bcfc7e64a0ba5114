//! New, open, save: with a path field and a list of the folder, which work everywhere.

use super::ToileApp;
use super::dialogs::Dialog;
use super::notice::Notice;
use std::path::{Path, PathBuf};
use toile_session::Command;

/// How the names of files in the native format end.
pub const ENDING: &str = ".toile.json";

/// A file that is being chosen.
#[derive(Clone, Debug, Default)]
pub struct FileChoice {
    /// The path as it is typed.
    pub path: String,
    /// The folder that is listed.
    pub folder: PathBuf,
    /// Folders and patterns in it.
    pub entries: Vec<Entry>,
    /// Why the folder cannot be listed.
    pub fault: String,
}

/// Something in a folder.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Entry {
    /// Files come after folders.
    pub is_file: bool,
    /// Its name.
    pub name: String,
}

impl FileChoice {
    /// A choice that begins with a path.
    pub fn new(path: &Path) -> Self {
        let folder = match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
            _ => std::env::current_dir().unwrap_or_else(|_| PathBuf::from(".")),
        };
        let mut choice = Self {
            path: path.display().to_string(),
            ..Self::default()
        };
        choice.list(folder);
        choice
    }

    /// Lists a folder.
    pub fn list(&mut self, folder: PathBuf) {
        self.entries.clear();
        self.fault.clear();
        match std::fs::read_dir(&folder) {
            Ok(entries) => {
                for entry in entries.flatten() {
                    let name = entry.file_name().to_string_lossy().into_owned();
                    let is_file = entry.path().is_file();
                    let is_pattern = ["json", "yaml", "yml"]
                        .iter()
                        .any(|ending| name.ends_with(&format!(".{ending}")));
                    if !name.starts_with('.') && (!is_file || is_pattern) {
                        self.entries.push(Entry { is_file, name });
                    }
                }
                self.entries.sort();
            }
            Err(error) => self.fault = format!("{}: {error}", folder.display()),
        }
        self.folder = folder;
    }

    /// The path that is chosen; one without a folder is in the folder that is listed.
    pub fn chosen(&self) -> PathBuf {
        self.folder.join(self.path.trim())
    }
}

impl ToileApp {
    pub(crate) fn ask_new(&mut self) {
        self.before_leaving(Dialog::New("My pattern".into()));
    }

    pub(crate) fn ask_open(&mut self) {
        let path = self.session.project().source.clone().unwrap_or_default();
        let mut choice = FileChoice::new(&path);
        choice.path.clear();
        self.before_leaving(Dialog::Open(choice));
    }

    pub(crate) fn ask_save(&mut self) {
        self.dialog = Some(Dialog::SaveAs(FileChoice::new(&self.save_path())));
    }

    /// Goes on to a dialog that replaces the document, after asking about changes that are in no
    /// file.
    fn before_leaving(&mut self, next: Dialog) {
        self.dialog = Some(match self.is_unsaved() {
            true => Dialog::Leave(Box::new(next)),
            false => next,
        });
    }

    /// Saves to the pattern's own file; asks for one if it has none in the native format.
    pub(crate) fn save(&mut self) {
        let path = self.save_path();
        let own = self.session.project().source.as_ref() == Some(&path);
        match own {
            true => {
                self.execute(Command::SavePattern { path });
            }
            false => self.ask_save(),
        }
    }

    /// Saves to a path; a file that is there and is another's is replaced only if that was said.
    pub(crate) fn save_to(&mut self, path: PathBuf, replaces: bool) {
        let path = match path.to_string_lossy().ends_with(".json") {
            true => path,
            false => PathBuf::from(format!("{}{ENDING}", path.display())),
        };
        let own = self.session.project().source.as_ref() == Some(&path);
        if !own && !replaces && path.exists() {
            self.dialog = Some(Dialog::Replace(path));
            return;
        }
        self.dialog = None;
        self.execute(Command::SavePattern { path });
    }

    /// The file it came from, if that is in the native format; else one beside it.
    fn save_path(&self) -> PathBuf {
        let project = self.session.project();
        match &project.source {
            Some(path) if path.to_string_lossy().ends_with(ENDING) => path.clone(),
            Some(path) if path.exists() => {
                let stem = path.file_stem().unwrap_or_default().to_string_lossy();
                path.with_file_name(format!("{stem}{ENDING}"))
            }
            _ => {
                let plain = |c: char| match c.is_alphanumeric() {
                    true => c.to_lowercase().next().unwrap_or(c),
                    false => '-',
                };
                let name: String = project.pattern.name.chars().map(plain).collect();
                PathBuf::from(format!("{name}{ENDING}"))
            }
        }
    }

    /// Opens a file that is dropped on the window.
    pub(crate) fn take_files(&mut self, context: &egui::Context) {
        let dropped = context.input(|input| {
            let files = input.raw.dropped_files.iter();
            files.map(|file| file.path().to_owned()).next_back()
        });
        match dropped {
            Some(path) if !self.is_unsaved() => self.open(&path),
            Some(_) => {
                self.notice = Notice::fault(
                    "The pattern has changes that are not saved: save it, or undo them, \
                     then drop the file again",
                );
            }
            None => {}
        }
    }
}
