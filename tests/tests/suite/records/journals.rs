//! A journal of every command, and one as earlier versions wrote it: read, written, replayed.

use crate::records::document::every_part;
use crate::records::{digest, hold, recorded};
use std::fmt::Write;
use toile_interchange::write_pattern;
use toile_pattern::{Edit, Entity, Head, PartId, Pattern, SheetHead};
use toile_session::{Command, journal_lines, read_journal};

/// The edits that make the document with every part, each kind of edit among them.
fn edits() -> Vec<Edit> {
    let pattern = every_part();
    let mut edits = vec![Edit::Put(Entity::Head(Head {
        name: pattern.name.clone(),
        unit: pattern.unit,
        base_size: None,
    }))];
    let put = |entity| Edit::Put(entity);
    edits.extend(pattern.sizes.iter().cloned().map(Entity::Size).map(put));
    edits.extend(pattern.fabrics.iter().cloned().map(Entity::Fabric).map(put));
    for sheet in &pattern.sheets {
        edits.push(put(Entity::Sheet(SheetHead {
            id: sheet.id,
            name: sheet.name.clone(),
            on: sheet.on,
            on_table: sheet.on_table,
        })));
    }
    edits.extend(
        pattern
            .entities()
            .into_iter()
            .map(|(entity, _)| put(entity)),
    );
    let guide = PartId::from(pattern.guides[0].id);
    edits.push(Edit::Order { part: guide, at: 1 });
    edits.push(Edit::Remove(guide));
    edits
}

#[test]
fn edits_of_every_part_are_written_and_done_as_before() {
    let edits = edits();
    let mut start = Pattern::new("");
    start.ids.next = every_part().ids.next;
    let done = {
        let mut done = start.clone();
        done.apply(&edits).unwrap();
        done
    };
    let label = "Draw everything".to_owned();
    let command = Command::Edit { edits, label };
    hold("edits.journal", &journal_lines(&[command]).unwrap());
    hold("edits.txt", &write_pattern(&done).unwrap());
    let read = read_journal(&recorded("edits.journal")).unwrap();
    let Command::Edit { edits, .. } = &read[0] else {
        panic!("the journal holds an edit")
    };
    let mut again = start;
    again.apply(edits).unwrap();
    assert!(again == done);
}

#[test]
fn journals_are_read_written_and_done_as_before() {
    let mut lines = String::new();
    for name in ["commands.journal", "earlier.journal"] {
        let text = recorded(name);
        for (line, command) in text.lines().zip(read_journal(&text).unwrap()) {
            let written = journal_lines(std::slice::from_ref(&command)).unwrap();
            // What earlier versions left out is written today.
            let same = if written.trim_end() == line {
                "the same"
            } else {
                written.trim_end()
            };
            let word: String = line.chars().take(60).collect();
            writeln!(lines, "{word}\n  {same}").unwrap();
            if let Command::Edit { edits, .. } = &command {
                let mut pattern = every_part();
                let result = match pattern.apply(edits) {
                    Ok(_) => digest(&write_pattern(&pattern).unwrap()),
                    Err(error) => error.to_string(),
                };
                writeln!(lines, "  {result}").unwrap();
            }
        }
    }
    hold("journals.txt", &lines);
}
