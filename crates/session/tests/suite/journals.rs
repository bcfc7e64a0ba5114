//! Journals: replayed from any folder, and against files that were changed meanwhile.

use std::path::{Path, PathBuf};
use toile_session::{Command, Session, Silent, open_journal};

fn pattern() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../patterns/poncho.toile.json");
    std::fs::read_to_string(path).unwrap()
}

/// A pattern opened, chosen a size of and exported into a folder beside it.
fn exported(folder: &Path) -> PathBuf {
    std::fs::create_dir(folder.join("patterns")).unwrap();
    let path = folder.join("patterns/p.toile.json");
    std::fs::write(&path, pattern()).unwrap();
    let dir = folder.join("deep/out");
    let mut session = Session::new();
    let fabric = Some("denim".to_owned());
    for command in [
        Command::open(path),
        Command::SetFabric { fabric },
        Command::Nest,
        Command::export(&dir),
    ] {
        session.execute(command, &mut Silent).unwrap();
    }
    dir.join("journal.jsonl")
}

#[test]
fn a_journal_moves_with_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path().join("here");
    std::fs::create_dir(&here).unwrap();
    exported(&here);
    let there = folder.path().join("there");
    std::fs::rename(&here, &there).unwrap();
    let (commands, notes) = open_journal(&there.join("deep/out/journal.jsonl")).unwrap();
    assert!(notes.is_empty(), "{notes:?}");
    let again = folder.path().join("again");
    let (session, _) = Session::replay(&commands, &again, &mut Silent).unwrap();
    assert_eq!(session.project().pattern.name, "Poncho");
    let (commands, _) = open_journal(&again.join("journal.jsonl")).unwrap();
    assert_eq!(commands.len(), 4);
}

#[test]
fn a_journal_says_what_of_an_edited_pattern_differs() {
    let folder = tempfile::tempdir().unwrap();
    let journal = exported(folder.path());
    let path = folder.path().join("patterns/p.toile.json");
    let mut edited: serde_json::Value = serde_json::from_str(&pattern()).unwrap();
    let panel = edited["panels"][0]["name"].as_str().unwrap().to_owned();
    edited["panels"][0]["fabric"] = serde_json::Value::Null;
    std::fs::write(&path, edited.to_string()).unwrap();
    let (_, notes) = open_journal(&journal).unwrap();
    let expected = format!("what differs: panels {panel}");
    assert!(
        notes.len() == 1 && notes[0].contains("p.toile.json") && notes[0].ends_with(&expected),
        "{notes:?}"
    );
}
