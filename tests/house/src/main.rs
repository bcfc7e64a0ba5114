//! Writes `docs/FILES.md`.

use std::fs;
use toile_house::{list_of_files, root};

fn main() -> std::io::Result<()> {
    let page = root().join("docs/FILES.md");
    let new = root().join("docs/FILES.md.new");
    fs::write(&new, list_of_files())?;
    fs::rename(new, page)
}
