//! The `toile` command as tests run it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The patterns that ship.
pub fn patterns() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../patterns")
}

/// Runs the command in a folder.
pub fn toile(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_toile"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

/// What it printed.
pub fn words(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}
