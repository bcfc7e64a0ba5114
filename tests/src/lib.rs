//! Data-driven suite over the public interfaces, and the house rules.

#![allow(clippy::print_stdout)] // tests say what they skip

pub mod damaged;
pub mod edits;
pub mod events;
pub mod losses;
pub mod random;

use std::path::PathBuf;
pub use toile_house::{files_below, root};

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
