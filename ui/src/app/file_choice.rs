//! A file that is being chosen: a path that is typed, and the folder it is in.

use std::path::{Path, PathBuf};

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
