//! What the session's tests share.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toile_session::{Command, Quality};

/// A ring of two pieces round the waist: the smallest garment there is.
pub const BAND: &str = include_str!("band.toile.json");

/// Writes the band into a folder.
pub fn band(folder: &Path) -> PathBuf {
    let path = folder.join("band.toile.json");
    std::fs::write(&path, BAND).unwrap();
    path
}

/// The commands that make the band into a folder.
pub fn make(pattern: &Path, dir: &Path) -> Vec<Command> {
    vec![
        Command::open(pattern),
        Command::SetQuality {
            quality: Quality::Preview,
        },
        Command::Check,
        Command::Nest,
        Command::Assemble,
        Command::drape(),
        Command::export(dir),
    ]
}

/// Every file of a folder.
pub fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap())
        .map(|entry| {
            let name = entry.file_name().to_string_lossy().into_owned();
            (name, std::fs::read(entry.path()).unwrap())
        })
        .collect()
}

/// Files without the times.
pub fn lasting(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = files(folder);
    assert!(files.remove("timing.json").is_some());
    files
}
