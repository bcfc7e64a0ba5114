//! One fault a file: for every field of every kind of part, what is said where it is left out, given twice, of another
//! kind, out of range, or beside one that does not go with it or is not known.

use crate::records::json_text::{Field, Fields, replaced, without, without_numbers};
use crate::records::{digest, hold, recorded};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use toile_interchange::{read_document, write_document};

/// Values of every kind, and numbers at the ends of ranges.
const VALUES: [&str; 10] = [
    "null",
    "true",
    "\"?\"",
    "[]",
    "{}",
    "-1",
    "0.5",
    "1000000",
    "5000000000",
    "1e999",
];

/// What is said of a text: the place, words and remedy it is refused with, or a number for what it is read as, with what
/// is noted.
pub fn said(text: &str) -> String {
    match read_document(text) {
        Err(error) => format!("refused {} | {} | {}", error.place, error.what, error.hint),
        Ok(file) => {
            let mut said = match write_document(&file.pattern, &file.fitting) {
                Ok(text) => format!("read {}", digest(&text)),
                Err(error) => format!("read, not written: {error}"),
            };
            for note in &file.notes {
                let place = file.pattern.describe(&note.place);
                write!(said, " | noted {place}, {}, {}", note.message, note.hint).unwrap();
            }
            said
        }
    }
}

/// Every faulty text that comes of a sound one, with words for its fault.
fn faults(text: &str, mut take: impl FnMut(&str, String)) {
    let found = Fields::of(text);
    let mut seen = BTreeSet::new();
    // A field is the same wherever a part of its kind stands below a field of one name.
    let last = |path: &str| without_numbers(path.rsplit('.').next().unwrap_or_default());
    let own_kind = |field: &Field| {
        let object = &found.objects[field.object];
        (last(&object.path), field.name.clone(), object.names.clone())
    };
    let firsts = found
        .fields
        .iter()
        .filter(|field| seen.insert(own_kind(field)));
    for field in firsts {
        let path = &field.path;
        take(&format!("{path} left out"), without(text, field));
        let value = &text[field.value.clone()];
        for other in VALUES.into_iter().filter(|other| *other != value) {
            let changed = replaced(text, field.value.clone(), other);
            take(&format!("{path} is {other}"), changed);
        }
        let start = field.whole.start;
        let twice = format!("{}, ", &text[field.whole.clone()]);
        take(
            &format!("{path} twice"),
            replaced(text, start..start, &twice),
        );
    }
    // Fields of parts of one place that are of different kinds, put together.
    let mut kinds: BTreeMap<String, BTreeMap<&str, &Field>> = BTreeMap::new();
    for field in &found.fields {
        let place = without_numbers(&found.objects[field.object].path);
        let known = kinds.entry(place).or_default();
        known.entry(&field.name).or_insert(field);
    }
    let mut seen = BTreeSet::new();
    for object in &found.objects {
        let place = without_numbers(&object.path);
        if !seen.insert((last(&object.path), object.names.clone())) {
            continue;
        }
        let comma = if object.names.is_empty() { "" } else { ", " };
        let beside =
            |own: &str| replaced(text, object.inside..object.inside, &format!("{own}{comma}"));
        take(
            &format!("{} with \"zzz\"", object.path),
            beside("\"zzz\": 0"),
        );
        for (name, field) in kinds.get(&place).into_iter().flatten() {
            if object.names.iter().any(|own| own == name) {
                continue;
            }
            let words = format!("{} with {name:?}", object.path);
            take(&words, beside(&text[field.whole.clone()]));
        }
    }
}

fn all_said(text: &str) -> String {
    let mut lines = String::new();
    faults(text, |fault, text| {
        writeln!(lines, "{fault}: {}", said(&text)).unwrap();
    });
    lines
}

#[test]
fn faults_of_every_field_are_told_as_before() {
    hold(
        "refusals.txt",
        &all_said(&recorded("every-part.toile.json")),
    );
}

/// What the garment is tried on, where the file with every part says something else.
const FITTINGS: [&str; 3] = [
    r#"{ "wearer": { "figure": "man" } }"#,
    r#"{ "wearer": { "mannequin": "anna.mannequin.json" }, "fabric": { "file": "silk.fabric.json" } }"#,
    r#"{ "wearer": { "figure": "child-8", "measurements": { "height": 1300 } } }"#,
];

#[test]
fn faults_of_what_a_garment_is_tried_on_are_told_as_before() {
    let mut lines = String::new();
    for fitting in FITTINGS {
        let text = format!(
            "{{ \"toile\": 2, \"kind\": \"pattern\", \"name\": \"\", \"unit\": \"cm\",\n  \"fitting\": {fitting},\n  \"next_id\": 0 }}\n"
        );
        writeln!(lines, "{fitting}: {}", said(&text)).unwrap();
        lines += &all_said(&text);
    }
    hold("refusals-fitting.txt", &lines);
}
