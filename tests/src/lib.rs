//! Data-driven suite over the public interfaces, and the house rules.

#![allow(clippy::print_stdout)] // tests say what they skip

pub mod edits;
pub mod events;
pub mod losses;
pub mod random;

use std::path::{Path, PathBuf};

/// The project's root folder.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The folder of shared test material, when it stands beside the project; says so when not.
pub fn shared_data() -> Option<PathBuf> {
    let place = std::env::var_os("TOILE_SHARED")
        .map_or_else(|| root().join("../shared"), PathBuf::from)
        .join("data");
    if place.is_dir() {
        return Some(place);
    }
    println!("skipped: no shared test data at {}", place.display());
    None
}

/// Every file below a folder with an ending, sorted, but for build output and hidden folders.
pub fn files_below(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(folder) = open.pop() {
        let Ok(entries) = std::fs::read_dir(&folder) else {
            continue;
        };
        for entry in entries.flatten() {
            let path = entry.path();
            let name = entry.file_name();
            let name = name.to_string_lossy();
            if path.is_dir() {
                if !name.starts_with('.') && name != "target" && name != "out" {
                    open.push(path);
                }
            } else if name.ends_with(ending) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}
