//! Wrong uses of the command, from the table in `tests/wrong-uses`: each is answered in words, with
//! its exit status, and leaves nothing behind.

use crate::common::{patterns, toile, words};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Fewest rows the table has.
const ROWS: usize = 60;

/// Every file and folder in a folder, with its size.
fn listing(folder: &Path) -> BTreeMap<PathBuf, u64> {
    let mut found = BTreeMap::new();
    let mut left = vec![folder.to_owned()];
    while let Some(next) = left.pop() {
        for entry in std::fs::read_dir(next).unwrap() {
            let entry = entry.unwrap();
            let about = entry.metadata().unwrap();
            if about.is_dir() {
                left.push(entry.path());
            }
            found.insert(entry.path(), about.len());
        }
    }
    found
}

/// A folder with the table's files and the patterns that ship.
fn prepared(table: &toml::Table) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).unwrap();
    for (name, text) in table["files"].as_table().unwrap() {
        write(name, text.as_str().unwrap().as_bytes());
    }
    for (name, bytes) in table["bytes"].as_table().unwrap() {
        let bytes = bytes.as_array().unwrap().iter();
        let bytes: Vec<u8> = bytes.map(|b| b.as_integer().unwrap() as u8).collect();
        write(name, &bytes);
    }
    for entry in std::fs::read_dir(patterns()).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            continue;
        }
        write(
            path.file_name().unwrap().to_str().unwrap(),
            &std::fs::read(&path).unwrap(),
        );
    }
    folder
}

/// What is wrong with the answer to a row of the table; nothing if it is right.
fn fault(row: &toml::Table, folder: &Path) -> Option<String> {
    let shipped = |word: &str| match word {
        "shirt" => "t-shirt.toile.json".to_owned(),
        "skirt" => "gathered-skirt.toile.json".to_owned(),
        word => word.to_owned(),
    };
    let run = row["run"].as_str().unwrap();
    let arguments: Vec<String> = run.split(' ').map(shipped).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let before = listing(folder);
    let output = toile(folder, &arguments);
    let said = words(&output.stderr);
    let mut faults = Vec::new();
    if output.status.code() != row["exit"].as_integer().map(|code| code as i32) {
        faults.push(format!("exits with {}", output.status));
    }
    for expected in row["says"].as_array().unwrap() {
        let expected = expected.as_str().unwrap();
        if !said.contains(expected) {
            faults.push(format!("does not say {expected:?}"));
        }
    }
    if said.contains("panicked") || !said.starts_with("error: ") {
        faults.push("does not answer with an error".to_owned());
    }
    if listing(folder) != before {
        faults.push("leaves something behind".to_owned());
    }
    let faults = faults.join(", ");
    (!faults.is_empty()).then(|| format!("toile {run}: {faults}\n{said}"))
}

#[test]
fn every_wrong_use_is_answered_with_file_place_and_remedy_and_leaves_nothing_behind() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/wrong-uses/table.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let table: toml::Table = text.parse().unwrap();
    let rows = table["uses"].as_array().unwrap();
    assert!(rows.len() >= ROWS, "only {} rows", rows.len());
    let folder = prepared(&table);
    let faults: Vec<String> = rows
        .iter()
        .filter_map(|row| fault(row.as_table().unwrap(), folder.path()))
        .collect();
    assert!(
        faults.is_empty(),
        "{} of {} rows:\n{}",
        faults.len(),
        rows.len(),
        faults.join("\n")
    );
}
