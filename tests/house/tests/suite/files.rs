//! The page of files is what its command writes, and every file says what is in it.

use std::fs;
use std::path::{Path, PathBuf};
use toile_house::{files_below, first_sentence, list_of_files, root};

#[test]
fn the_page_of_files_is_written_anew_by_cargo_files() {
    let page = fs::read_to_string(root().join("docs/FILES.md")).expect("readable");
    assert!(
        page == list_of_files(),
        "docs/FILES.md is old: run `cargo files`"
    );
}

#[test]
fn every_source_file_says_what_is_in_it() {
    let folders = ["crates", "ui", "tests"].map(|folder| root().join(folder));
    let files = folders.iter().flat_map(|folder| files_below(folder, ".rs"));
    let silent = files.filter(|path| {
        let text = fs::read_to_string(path).expect("readable");
        first_sentence(&text).is_empty()
    });
    let silent: Vec<String> = silent.map(|path| path.display().to_string()).collect();
    assert!(
        silent.is_empty(),
        "no first line `//! ...` in\n{}",
        silent.join("\n")
    );
}

/// Files that are no module of another: roots of programs and libraries, and what lies at the top of such folders.
fn is_root(path: &Path) -> bool {
    let folder = path.parent().and_then(Path::file_name).unwrap_or_default();
    let stem = path.file_stem().unwrap_or_default();
    let own = ["tests", "benches", "examples", "bin"].iter();
    ["main", "lib", "build"].iter().any(|name| stem == *name)
        || own.into_iter().any(|name| folder == *name)
}

/// Whether a text has the `mod` line of a file, or names the file as the place of a module.
fn names_module(text: &str, module: &Path) -> bool {
    let stem = module.file_stem().unwrap_or_default().display().to_string();
    let (line, place) = (format!("mod {stem};"), format!("\"{stem}.rs\""));
    let of_line = |one: &str| {
        one.trim_end()
            .rsplit_once("mod ")
            .map(|(_, name)| format!("mod {name}"))
    };
    text.contains(&place) || text.lines().filter_map(of_line).any(|one| one == line)
}

#[test]
fn every_source_file_is_a_module_of_another() {
    let folders = ["crates", "ui", "tests"].map(|folder| root().join(folder));
    let files: Vec<PathBuf> = folders
        .iter()
        .flat_map(|folder| files_below(folder, ".rs"))
        .collect();
    let left_out = files.iter().filter(|path| {
        let module = match path.ends_with("mod.rs") {
            true => path.parent().expect("a folder"),
            false => path,
        };
        let above = module.parent().expect("a folder");
        let same_name = above.with_extension("rs");
        let beside = files
            .iter()
            .filter(|file| file.parent() == Some(above) || **file == same_name);
        let mut texts = beside.map(|file| fs::read_to_string(file).expect("readable"));
        !is_root(path) && !texts.any(|text| names_module(&text, module))
    });
    let left_out: Vec<String> = left_out.map(|path| path.display().to_string()).collect();
    assert!(
        left_out.is_empty(),
        "compiled into nothing, for want of a `mod` line:\n{}",
        left_out.join("\n")
    );
}

#[test]
fn the_first_sentence_ends_where_it_ends() {
    for (text, sentence) in [
        ("//! A file. It does.\n", "A file."),
        (
            "//! By Kabsch et al. (1976), e.g. this\n//! and that.\n//!\n//! More.",
            "By Kabsch et al. (1976), e.g. this and that.",
        ),
        ("use std;", ""),
    ] {
        assert_eq!(first_sentence(text), sentence);
    }
}
