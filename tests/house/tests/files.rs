//! The page of files is what its command writes, and every file says what is in it.

use std::fs;
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
