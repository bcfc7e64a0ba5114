//! The choice of a file: a typed path, and the listed folder.

use std::path::{Path, PathBuf};

/// File name extensions of patterns.
pub const PATTERNS: &[&str] = &["json", "yaml", "yml", "dxf", "svg", "val", "sm2d"];
/// File name extensions of measurement tables and mannequins.
pub const MEASURED: &[&str] = &["json", "yaml", "yml", "smis", "smms", "vit", "vst"];

/// All file name extensions.
pub const ANY: &[&str] = &[];

/// State of a dialog in which a file is chosen.
#[derive(Clone, Debug, Default)]
pub struct FileChoice {
    /// The path as typed.
    pub path: String,
    /// The listed folder.
    pub folder: PathBuf,
    /// Subfolders, and files with the wanted extensions.
    pub entries: Vec<Entry>,
    /// File name extensions of the files that are listed; empty for all files.
    endings: &'static [&'static str],
    /// Reason why the folder cannot be listed.
    pub fault: String,
}

/// Entry of a folder.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Entry {
    /// Whether the entry is a file; files come after folders.
    pub is_file: bool,
    /// Name of the file or folder.
    pub name: String,
}

impl FileChoice {
    /// Choice of a pattern file, with `path` as the typed text and its folder listed.
    pub fn new(path: &Path) -> Self {
        Self::showing(path, PATTERNS)
    }

    /// Choice of a file with one of the extensions `endings`, with `path` as the typed text and its folder
    /// listed.
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
                    // Programs on Windows write endings in capitals, too.
                    let lower = name.to_lowercase();
                    let is_shown = self.endings.is_empty()
                        || endings.any(|ending| lower.ends_with(&format!(".{ending}")));
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

    /// The chosen path; a relative path is in the listed folder.
    pub fn chosen(&self) -> PathBuf {
        self.folder.join(self.path.trim())
    }
}
