//! What the cut line does not do as drawn is told wherever a pattern is checked, laid or made.

use std::path::{Path, PathBuf};
use toile_session::{Budget, Command, Event, NestOptions, Session, Silent, nest_patterns};

/// A folded panel whose point is too sharp for a mitre, with a hole narrower than its allowances on
/// either side.
const PENNANT: &str = include_str!("support/pennant.toile.json");

fn pennant(folder: &Path, text: &str) -> PathBuf {
    let path = folder.join("pennant.toile.json");
    std::fs::write(&path, text).unwrap();
    path
}

/// How often a corner cut off and a hole filled by its allowance are told.
fn told<'a>(messages: impl IntoIterator<Item = &'a str>) -> [usize; 2] {
    let mut found = [0; 2];
    for message in messages {
        let panel = message.contains("\"pennant\"");
        let corner = panel && message.contains("\"slant\"") && message.contains("cut off");
        let hole = panel && message.contains("hole 1") && message.contains("filled");
        found[0] += usize::from(corner);
        found[1] += usize::from(hole);
    }
    found
}

fn done(path: &Path, commands: Vec<Command>) -> (Session, Vec<Event>) {
    let open = Command::open(path);
    let all: Vec<Command> = [open].into_iter().chain(commands).collect();
    let mut session = Session::new();
    let events = session.execute_all(&all, &mut Silent).unwrap();
    (session, events)
}

fn warned(events: &[Event]) -> Vec<&str> {
    let mut messages = Vec::new();
    for event in events {
        if let Event::Warned { message } = event {
            messages.push(message.as_str());
        }
    }
    messages
}

#[test]
fn a_check_tells_of_a_corner_cut_off_and_of_a_hole_filled_by_its_allowance() {
    let folder = tempfile::tempdir().unwrap();
    // Drawn from the right side of the cloth, and from its wrong side.
    let wrong_side = ["[60, ", "[5, ", "[6.5, "]
        .iter()
        .fold(PENNANT.to_owned(), |text, x| {
            text.replace(x, &x.replace('[', "[-"))
        });
    for text in [PENNANT, &wrong_side] {
        let path = pennant(folder.path(), text);
        let (mut session, events) = done(&path, vec![Command::Check]);
        assert_eq!(told(warned(&events)), [1, 1], "{events:?}");
        let findings = session.diagnostics();
        assert_eq!(told(findings.iter().map(|f| &*f.message)), [1, 1]);
        let corner = "the corner of edge \"slant\" at the fold";
        assert!(
            findings.iter().any(|f| f.message.contains(corner)),
            "{findings:?}"
        );
    }
    // Without an allowance nothing is cut off and nothing filled.
    let bare = PENNANT.replace("\"allowance\": 1", "\"allowance\": 0");
    let path = pennant(folder.path(), &bare);
    let (_, events) = done(&path, vec![Command::Check]);
    assert_eq!(told(warned(&events)), [0, 0], "{events:?}");
}

#[test]
fn a_marker_tells_of_them_once_each_in_its_notes() {
    let folder = tempfile::tempdir().unwrap();
    let path = pennant(folder.path(), PENNANT);
    let options = NestOptions {
        budget: Budget::Evaluations(20_000),
        ..NestOptions::default()
    };
    let place = (folder.path(), &mut Silent as _);
    let (summary, _) = nest_patterns(&[path], &options, place).unwrap();
    let notes = summary[0].notes.iter().map(|note| &**note);
    assert_eq!(told(notes), [1, 1], "{:?}", summary[0].notes);
}

#[test]
fn the_report_of_what_was_made_tells_of_them_once_each() {
    let folder = tempfile::tempdir().unwrap();
    let path = pennant(folder.path(), PENNANT);
    let dir = folder.path().join("out");
    let export = Command::export(&dir);
    let (_, events) = done(&path, vec![Command::Check, Command::Nest, export]);
    assert_eq!(told(warned(&events)), [1, 1], "{events:?}");
    let text = std::fs::read_to_string(dir.join("report.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&text).unwrap();
    let warnings = report["warnings"].as_array().unwrap();
    let words = warnings.iter().map(|warning| warning.as_str().unwrap());
    assert_eq!(told(words), [1, 1], "{warnings:?}");
}
