//! The files of a crate do not import each other in a circle.
//!
//! A file imports another when one of its `use` lines, or a path in its code, leads to an item
//! that the other defines; re-exports on the way are followed. Left apart are a file and the one
//! that has its `mod` line, `pub use` as such, and all that is built for tests only. Circles that
//! have been there longer stand in [`known`]: that list may shrink, and must when they do. What
//! ties one of them is told by the test as soon as its entry is deleted.

mod cases;
mod imports;
mod known;
mod mentions;
mod modules;
mod verdict;

use known::KNOWN;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::thread;
use toile_tests::root;

/// The folders of sources, by their names from the project's root.
fn source_folders() -> BTreeMap<String, PathBuf> {
    let crates = fs::read_dir(root().join("crates")).expect("readable");
    let names = crates.flatten().map(|entry| entry.file_name());
    let mut folders: Vec<_> = names
        .map(|n| format!("crates/{}/src", n.display()))
        .collect();
    folders.push("ui/src".to_owned());
    let placed = folders.into_iter().map(|folder| {
        let place = root().join(&folder);
        (folder, place)
    });
    placed.filter(|(_, place)| place.is_dir()).collect()
}

/// The circles of the crate with a folder of sources.
fn circles_below(folder: &Path) -> Vec<imports::Circle> {
    let all = modules::Modules::read(&|name| fs::read_to_string(folder.join(name)).ok());
    assert!(!all.files.is_empty(), "no crate in {}", folder.display());
    imports::Imports::of(&all).circles()
}

#[test]
fn files_of_a_crate_do_not_import_each_other_in_a_circle() {
    let folders = source_folders();
    assert!(folders.len() >= 15, "only {} crates found", folders.len());
    let found: BTreeMap<&str, _> = thread::scope(|scope| {
        let reading = folders
            .iter()
            .map(|(name, place)| (name.as_str(), scope.spawn(|| circles_below(place))));
        let reading: Vec<_> = reading.collect();
        let read = reading.into_iter();
        read.map(|(name, thread)| (name, thread.join().expect("its sources are read")))
            .collect()
    });
    let complaints = verdict::complaints(&found, KNOWN);
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n\n"));
}
