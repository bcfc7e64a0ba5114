//! What several tests need.
#![allow(dead_code, clippy::print_stdout)]

pub mod survey;

use std::path::{Path, PathBuf};
use toile_body::Mannequin;

/// A file of the test material, where it is present; says so where it is not.
pub fn shared(file: &str) -> Option<PathBuf> {
    let found = Path::new(env!("CARGO_MANIFEST_DIR"))
        .ancestors()
        .map(|folder| folder.join("shared/data").join(file))
        .find(|path| path.is_file());
    if found.is_none() {
        println!("skipped: no shared data folder");
    }
    found
}

/// Whether a body's skin is one closed, outward surface that nowhere crosses itself.
pub fn is_sound(body: &Mannequin) -> bool {
    survey::is_closed(body.skin()) && body.skin_tree().self_intersections().is_empty()
}
