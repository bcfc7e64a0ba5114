//! The page of files is what its command writes; every file says what is in it and is compiled into something.

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

/// Whether a file of a package, by its path in there, is the root of a program or a library.
fn is_root(path: &Path) -> bool {
    let names: Vec<&str> = path.iter().filter_map(|name| name.to_str()).collect();
    matches!(
        names[..],
        ["build.rs"]
            | ["src", "lib.rs" | "main.rs"]
            | ["src", "bin", _]
            | ["tests" | "benches" | "examples", _]
            | ["tests" | "benches" | "examples", _, "main.rs"]
    )
}

/// Whether a text has the `mod` line of a module.
fn declares(text: &str, module: &str) -> bool {
    text.lines().any(|line| {
        let line = line.trim_start();
        let line = ["pub(crate) ", "pub "]
            .iter()
            .find_map(|word| line.strip_prefix(word))
            .unwrap_or(line);
        line.strip_prefix("mod ")
            .and_then(|line| line.strip_suffix(';'))
            == Some(module)
    })
}

/// Those of the files, by their paths in a package, that no other names as its module.
fn left_out(files: &[(PathBuf, String)]) -> impl Iterator<Item = &Path> {
    files.iter().map(|(path, _)| path.as_path()).filter(|path| {
        let module = match path.ends_with("mod.rs") {
            true => path.parent().expect("a folder"),
            false => path,
        };
        let stem = module
            .file_stem()
            .expect("a name")
            .to_str()
            .expect("readable");
        let above = module.parent().expect("a folder");
        let place = format!("#[path = \"{stem}.rs\"]");
        let named = files.iter().any(|(file, text)| {
            let is_beside = file.parent() == Some(above);
            let has_modules_here = is_root(file) || file.ends_with("mod.rs");
            (is_beside && has_modules_here || *file == above.with_extension("rs"))
                && declares(text, stem)
                || is_beside && text.contains(&place)
        });
        !is_root(path) && !named
    })
}

#[test]
fn every_source_file_is_a_module_of_another() {
    let manifests = files_below(&root(), "Cargo.toml");
    let packages: Vec<&Path> = manifests.iter().filter_map(|path| path.parent()).collect();
    let mut lost = Vec::new();
    for package in &packages {
        // Not those of a package within this one.
        let is_own = |path: &PathBuf| {
            let within = packages.iter().filter(|other| path.starts_with(other));
            within.max_by_key(|other| other.components().count()) == Some(package)
        };
        let files = files_below(package, ".rs").into_iter().filter(is_own);
        let texts = files.map(|path| {
            let text = fs::read_to_string(&path).expect("readable");
            (path.strip_prefix(package).expect("below").to_owned(), text)
        });
        let texts: Vec<(PathBuf, String)> = texts.collect();
        lost.extend(left_out(&texts).map(|path| package.join(path).display().to_string()));
    }
    assert!(
        lost.is_empty(),
        "compiled into nothing, for want of a `mod` line:\n{}",
        lost.join("\n")
    );
}

#[test]
fn a_file_without_its_line_is_found() {
    for (file, parent, text, is_found) in [
        ("src/a.rs", "src/lib.rs", "pub(crate) mod a;", false),
        ("src/a.rs", "src/lib.rs", "// mod a;", true),
        ("src/a.rs", "src/lib.rs", "mod b;", true),
        ("src/a.rs", "src/b.rs", "mod a;", true),
        ("src/a.rs", "src/b.rs", "#[path = \"a.rs\"]\nmod c;", false),
        ("src/a/b.rs", "src/a.rs", "pub mod b;", false),
        ("src/a/mod.rs", "src/lib.rs", "mod a;", false),
        ("src/a/tests/mod.rs", "src/a/mod.rs", "mod b;", true),
        ("tests/suite/a.rs", "tests/suite/main.rs", "", true),
        ("tests/a.rs", "tests/suite/main.rs", "", false),
        ("tests/help/mod.rs", "tests/a.rs", "mod help;", false),
    ] {
        let files =
            [(file, ""), (parent, text)].map(|(path, text)| (PathBuf::from(path), text.to_owned()));
        let found = left_out(&files).any(|path| path == Path::new(file));
        assert_eq!(found, is_found, "{file}, {parent}: {text}");
    }
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
