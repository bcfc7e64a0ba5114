//! Pattern files written by earlier versions of the program draft as they did then: every point,
//! length and seam side of every size, and the same findings where they do not draft.

use crate::draft_table::draft_table;
use std::collections::BTreeSet;
use std::path::Path;

/// Coordinates and lengths may differ by this (m).
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

/// What is said of a pattern that does not draft. A cycle is told once today, at any of its
/// members; spans that are not there and spans without length are one fault.
fn findings(table: &str) -> BTreeSet<String> {
    let found = table.lines().filter(|line| !line.starts_with("size"));
    let plain = found.map(|line| {
        let line = line.rsplit_once(", ").map_or(line, |(text, _)| text);
        match line {
            _ if line.contains(" Cycle ") => "error Cycle".to_owned(),
            _ => line
                .replace("BadSpan", "MissingSpan")
                .replace("line \"hole 1\"", "hole 1")
                .replace("internal line", "line")
                .replace("edge \"line", "line \"line"),
        }
    });
    plain.collect()
}

/// The panel a finding is about, in words.
fn panel_of(line: &str) -> Option<&str> {
    let start = line.find("panel \"")?;
    let length = line[start + 7..].find('"')?;
    Some(&line[start..start + 8 + length])
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
        // Kinks were not told when the drafts were recorded.
        let now = draft_table(&text);
        let lines = now.lines().filter(|line| !line.starts_with("note Kink"));
        let now: String = lines.map(|line| format!("{line}\n")).collect();
        files += 1;
        if name.starts_with("unsound") {
            // A line that leaves its panel stops it no longer: the cloth has what lies inside.
            let recorded = recorded.replace("error LineOutside", "note LineOutside");
            let (now, recorded) = (findings(&now), findings(&recorded));
            // What only follows from another fault of the panel is not told again today.
            let follows = |line: &str| {
                // So does a seam of it wait, and tells nothing.
                let is_seam = |line: &str| line.starts_with("error MissingSpan at seam");
                let mut errors = now.iter().filter(|other| other.starts_with("error"));
                if is_seam(line) && errors.any(|other| !is_seam(other)) {
                    return true;
                }
                let words = [", dart ", "TooMany", "EmptyOutline"];
                words.iter().any(|word| line.contains(word))
                    && panel_of(line).is_some_and(|panel| {
                        now.iter()
                            .any(|other| other != line && other.contains(panel))
                    })
            };
            let lost: Vec<_> = recorded
                .difference(&now)
                .filter(|line| !follows(line))
                .collect();
            // Points that nothing uses are computed too today, and the measurements they name; steps that
            // take in nothing are told.
            let unused = |line: &str| {
                line.contains(", point ")
                    || line.starts_with("note Borrowed")
                    || line.starts_with("note NoEffect")
            };
            let more: Vec<_> = now
                .difference(&recorded)
                .filter(|line| !unused(line))
                .collect();
            if !(lost.is_empty() && more.is_empty()) {
                faults.push(format!("{name}: {more:?}\n     was {lost:?}"));
            }
            continue;
        }
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
