//! Pattern files written by earlier versions of the program draft as they did then: every point,
//! length and seam side of every size, and the same findings where they do not draft.
#![allow(clippy::unwrap_used)]

mod draft_table;

use draft_table::draft_table;
use std::path::Path;

/// Coordinates and lengths may differ by this [m].
const TOLERANCE: f64 = 1e-9;

/// Whether a line says the same, numbers within the tolerance.
fn agrees(line: &str, recorded: &str) -> bool {
    let mut words = line.split(' ');
    let mut known = recorded.split(' ');
    loop {
        match (words.next(), known.next()) {
            (None, None) => return true,
            (Some(a), Some(b)) if a == b => {}
            (Some(a), Some(b)) => match (a.parse::<f64>(), b.parse::<f64>()) {
                (Ok(a), Ok(b)) if (a - b).abs() <= TOLERANCE => {}
                _ => return false,
            },
            _ => return false,
        }
    }
}

#[test]
fn files_of_earlier_versions_draft_as_recorded() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/drafts");
    let table = std::fs::read_to_string(folder.join("table.txt")).unwrap();
    let mut files = 0;
    let mut faults = Vec::new();
    for recorded in table.split("file ").filter(|part| part.contains('\n')) {
        let (name, recorded) = recorded.split_once('\n').unwrap();
        let text = std::fs::read_to_string(folder.join(format!("{name}.json"))).unwrap();
        let now = draft_table(&text);
        files += 1;
        if now.lines().count() != recorded.lines().count() {
            faults.push(format!("{name}: another number of lines"));
        }
        let differing = now
            .lines()
            .zip(recorded.lines())
            .find(|(line, recorded)| !agrees(line, recorded));
        if let Some((line, recorded)) = differing {
            faults.push(format!("{name}: {line}\n     was {recorded}"));
        }
    }
    assert_eq!(files, 234);
    let count = faults.len();
    faults.truncate(40);
    assert!(
        count == 0,
        "{count} of {files} files:\n{}",
        faults.join("\n")
    );
}
