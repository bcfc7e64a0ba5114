//! A file that is being chosen: a path that is typed, and the folder it is in.

use std::path::{Path, PathBuf};

/// How the names of patterns end.
pub const PATTERNS: &[&str] = &["json", "yaml", "yml"];
/// How the names of tables of measurements and of mannequins end.
pub const MEASURED: &[&str] = &["json", "yaml", "yml", "smis", "smms", "vit", "vst"];

/// A file that is being chosen.
#[derive(Clone, Debug, Default)]
pub struct FileChoice {
    /// The path as it is typed.
    pub path: String,
    /// The folder that is listed.
    pub folder: PathBuf,
    /// Folders in it, and files of the endings that are shown.
    pub entries: Vec<Entry>,
    /// How the names of the files end that are shown.
    endings: &'static [&'static str],
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
    /// A choice of a pattern that begins with a path.
    pub fn new(path: &Path) -> Self {
        Self::showing(path, PATTERNS)
    }

    /// A choice of a file of some endings that begins with a path.
    pub fn showing(path: &Path, endings: &'static [&'static str]) -> Self {
        let folder = match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
            _ => std::env::current_dir().unwrap_or_else(|_| PathBuf::from(".")),
        };
        let mut choice = Self {
            path: path.display().to_string(),
            endings,
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
                    let mut endings = self.endings.iter();
                    let is_shown = endings.any(|ending| name.ends_with(&format!(".{ending}")));
                    if !name.starts_with('.') && (!is_file || is_shown) {
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
