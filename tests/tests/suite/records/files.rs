//! Every pattern that ships or is held, read and written.

use crate::records::refusals::said;
use crate::records::{digest, hold};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use toile_interchange::{read_document, write_document};

/// The files of a folder that end so, by name.
fn files(folder: &str, end: &str) -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("..")
        .join(folder);
    let entries = std::fs::read_dir(root)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let mut files: Vec<_> = entries
        .filter(|path| path.to_string_lossy().ends_with(end))
        .collect();
    files.sort();
    files
}

#[test]
fn shipped_patterns_are_written_as_they_were_read() {
    let shipped = files("patterns", ".toile.json");
    assert!(shipped.len() >= 5);
    for path in shipped {
        let text = std::fs::read_to_string(&path).unwrap();
        let file = read_document(&text).unwrap();
        let written = write_document(&file.pattern, &file.fitting).unwrap();
        assert!(written == text, "{} is written otherwise", path.display());
    }
}

#[test]
fn held_files_are_read_and_written_as_before() {
    let held = files("crates/interchange/tests/drafts", ".json");
    let mut lines = String::new();
    for path in held {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&path).unwrap();
        let result = match read_document(&text) {
            // The texts themselves are held, and come back to the byte.
            Ok(file) => digest(&write_document(&file.pattern, &file.fitting).unwrap()),
            Err(_) => said(&text),
        };
        writeln!(lines, "{name}: {result}").unwrap();
    }
    hold("held-files.txt", &lines);
}
