//! What the program reads, writes and refuses, recorded: a change of the code that is meant to change none of it is held
//! to these records. `TOILE_RECORD=1 cargo test -p toile-tests records::` writes them anew; a commit that does so
//! says why.

mod document;
mod files;
mod formats;
mod journals;
mod json_text;
mod refusals;

use std::path::{Path, PathBuf};

/// The folder of the records.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("records")
}

/// A recorded file.
fn recorded(name: &str) -> String {
    let path = folder().join(name);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Holds a text to its record, or records it where that is asked for.
fn hold(name: &str, now: &str) {
    if std::env::var_os("TOILE_RECORD").is_some() {
        std::fs::write(folder().join(name), now).unwrap();
        return;
    }
    let before = recorded(name);
    let lines = before.lines().zip(now.lines()).enumerate();
    let differing: Vec<String> = lines
        .filter(|(_, (before, now))| before != now)
        .map(|(k, (before, now))| format!("line {}\n  was {before}\n  now {now}", k + 1))
        .collect();
    let counts = (before.lines().count(), now.lines().count());
    assert!(
        differing.is_empty() && counts.0 == counts.1,
        "{name}: {} lines differ, {} lines recorded, {} now\n{}",
        differing.len(),
        counts.0,
        counts.1,
        differing[..differing.len().min(20)].join("\n")
    );
    assert!(before == now, "{name}: the ends of lines differ");
}

/// A short number that tells texts apart: 64 bits of FNV-1a (Fowler, Noll, Vo 1991).
fn digest(text: &str) -> String {
    let step = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    let hash = text.bytes().fold(0xcbf2_9ce4_8422_2325, step);
    format!("{hash:016x}")
}
