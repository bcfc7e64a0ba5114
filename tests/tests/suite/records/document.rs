//! The document with every kind of every part: written as it was read; its numbers, references and copies.

use crate::records::{hold, recorded};
use std::collections::BTreeSet;
use std::fmt::Write;
use toile_interchange::{read_document, write_document, write_pattern};
use toile_measure::Measurements;
use toile_pattern::plan::{PasteTarget, copy, numbers_of, paste};
use toile_pattern::{Evaluation, PartId, Pattern};

pub const EVERY_PART: &str = "every-part.toile.json";

pub fn every_part() -> Pattern {
    read_document(&recorded(EVERY_PART)).unwrap().pattern
}

#[test]
fn the_document_with_every_part_is_written_as_it_was_read() {
    let file = read_document(&recorded(EVERY_PART)).unwrap();
    assert!(file.notes.is_empty(), "{:?}", file.notes);
    hold(
        EVERY_PART,
        &write_document(&file.pattern, &file.fitting).unwrap(),
    );
}

/// Every part of a pattern, those within panels too.
fn parts(pattern: &Pattern) -> Vec<PartId> {
    pattern.parts().into_iter().map(|(id, _)| id).collect()
}

#[test]
fn numbers_of_parts_are_listed_as_before() {
    let pattern = every_part();
    let evaluation = Evaluation::new(&pattern, &Measurements::adult());
    let mut lines = String::new();
    for part in parts(&pattern) {
        for entry in numbers_of(&evaluation, part) {
            let number = entry.number.as_ref();
            let shown = number.map_or("left out".to_owned(), |n| format!("{n:?}"));
            writeln!(lines, "{part}: {}, {:?}: {shown}", entry.label, entry.want).unwrap();
        }
    }
    hold("numbers.txt", &lines);
}

#[test]
fn references_of_parts_are_found_as_before() {
    let pattern = every_part();
    let mut lines = String::new();
    for (entity, place) in pattern.entities() {
        // Which parts, and how often each: their order says nothing.
        let mut references = entity.references();
        references.sort_unstable();
        let references: Vec<String> = references.iter().map(PartId::to_string).collect();
        writeln!(
            lines,
            "{}: {}",
            pattern.describe(&place),
            references.join(", ")
        )
        .unwrap();
    }
    for part in parts(&pattern) {
        let users = pattern.users(part).into_iter();
        let users: BTreeSet<String> = users.map(|place| pattern.describe(&place)).collect();
        let users: Vec<String> = users.into_iter().collect();
        writeln!(lines, "{part} is used by {}", users.join(", ")).unwrap();
    }
    hold("references.txt", &lines);
}

/// The document with all its parts pasted into a pattern.
fn pasted(into: &Pattern) -> String {
    let pattern = every_part();
    let evaluation = Evaluation::new(&pattern, &Measurements::adult());
    let chosen: Vec<PartId> = parts(&pattern)
        .into_iter()
        .filter(|part| {
            use PartId::*;
            matches!(part, Variable(_) | Sheet(_) | Panel(_) | Seam(_))
        })
        .collect();
    let fragment = copy(&evaluation, &chosen).unwrap();
    let target = PasteTarget {
        sheet: None,
        offset: [0.5, 0.25],
    };
    let onto = Evaluation::new(into, &Measurements::adult());
    let result = paste(&onto, &fragment, target).unwrap();
    let mut copied = into.clone();
    copied.apply(&result.edits).unwrap();
    let mut text = write_pattern(&copied).unwrap();
    for part in &result.parts {
        writeln!(text, "new {part}").unwrap();
    }
    let loosened = result.loosened.len();
    writeln!(
        text,
        "{loosened} numbers loosened, lost sizes {:?}",
        result.lost_sizes
    )
    .unwrap();
    text
}

#[test]
fn copies_of_parts_have_the_ids_of_before() {
    hold("pasted-beside.txt", &pasted(&every_part()));
    hold("pasted-elsewhere.txt", &pasted(&Pattern::blank("other")));
}
