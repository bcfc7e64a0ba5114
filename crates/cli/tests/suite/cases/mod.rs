//! What people of the trade ran into: the inputs of `tests/cases`, a folder a case, given to the
//! command as its user would, one module a kind.

mod girths;
mod knife;
mod letters;
mod meshes;
mod put_on;
mod roads;
mod sides;
mod sizes;
mod study;
mod verdict;
mod xpbd;

use crate::common::{toile, words};
use std::path::{Path, PathBuf};

/// The folder of a case's inputs.
fn case(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../tests/cases")
        .join(name)
}

#[test]
fn every_case_has_inputs_that_the_command_can_open() {
    for entry in std::fs::read_dir(case("")).unwrap() {
        let folder = entry.unwrap().path();
        let files = std::fs::read_dir(&folder).unwrap().count();
        assert!(files > 0, "{} is empty", folder.display());
    }
    let output = toile(&case("notch-at-a-corner"), &["check", "p.toile.json"]);
    assert!(output.status.success(), "{}", words(&output.stderr));
}
