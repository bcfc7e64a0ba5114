//! The project's files: where they are, and the page that lists the sources by what is in them.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// The project's root folder.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
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

/// The page that lists every source file with the first sentence of its own comment, by crates from the lowest on.
pub fn list_of_files() -> String {
    let mut page = "# Files\n\nEvery source file by what is in it, in the words of its first line: `cargo files` writes this page. What the crates are \
         for, and which uses which, is in [Architecture](ARCHITECTURE.md#parts); equations are in [Methods](METHODS.md).\n"
        .to_owned();
    for folder in source_folders() {
        let place = root().join(&folder);
        let name = folder.trim_end_matches("/src");
        // Writing to a text does not fail.
        let _ = write!(page, "\n## `{name}`\n\n");
        for path in files_below(&place, ".rs") {
            let file = path.strip_prefix(&place).unwrap_or(&path);
            let file = file.display().to_string().replace('\\', "/");
            let text = fs::read_to_string(&path).unwrap_or_default();
            let _ = writeln!(page, "- `{file}` {}", first_sentence(&text));
        }
    }
    page
}

/// The folders of sources, the crates in the order of the workspace.
fn source_folders() -> Vec<String> {
    let manifest = fs::read_to_string(root().join("Cargo.toml")).unwrap_or_default();
    let list = |name: &str| {
        let after = manifest.split(name).nth(1).unwrap_or_default();
        after.split(']').next().unwrap_or_default()
    };
    let lists = [list("\nmembers = ["), list("\nexclude = [")];
    let quoted = lists
        .into_iter()
        .flat_map(|list| list.split('"').skip(1).step_by(2));
    let own = quoted.filter(|member| !member.starts_with("tests"));
    own.map(|member| format!("{member}/src")).collect()
}

/// The first sentence of a file's own comment; nothing where it has none.
pub fn first_sentence(text: &str) -> String {
    let lines = text.lines().map_while(|line| line.strip_prefix("//!"));
    let paragraph: Vec<&str> = lines
        .map(str::trim)
        .take_while(|line| !line.is_empty())
        .collect();
    let paragraph = paragraph.join(" ");
    let ends = paragraph.match_indices(". ").map(|(at, _)| at);
    // A sentence begins with a capital; what is abbreviated goes on without one.
    let mut ends = ends.filter(|at| paragraph[at + 2..].starts_with(char::is_uppercase));
    match ends.next() {
        Some(at) => paragraph[..=at].to_owned(),
        None => paragraph,
    }
}
