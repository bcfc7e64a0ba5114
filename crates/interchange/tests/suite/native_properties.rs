//! Random patterns and damaged files: nothing panics, what is written is read back the same, and
//! every refusal names a place and a remedy.

use crate::random_pattern::{Dice, random_pattern};
use proptest::prelude::*;
use toile_interchange::{read_pattern, write_pattern};
use toile_measure::Measurements;
use toile_pattern::{Edit, PartId, Pattern, Seam, SeamOrigin, Severity};

const SHIPPED: [(&str, &str); 5] = [
    (
        "t-shirt",
        include_str!("../../../../patterns/t-shirt.toile.json"),
    ),
    (
        "gathered-skirt",
        include_str!("../../../../patterns/gathered-skirt.toile.json"),
    ),
    (
        "trousers",
        include_str!("../../../../patterns/trousers.toile.json"),
    ),
    (
        "poncho",
        include_str!("../../../../patterns/poncho.toile.json"),
    ),
    (
        "dress",
        include_str!("../../../../patterns/dress.toile.json"),
    ),
];

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(1000) })]

    #[test]
    fn random_patterns_are_resolved_checked_written_and_read(seed in any::<u64>()) {
        let mut dice = Dice::new(seed);
        let pattern = random_pattern(&mut dice);
        let body = Measurements::adult();
        let (draft, found) = pattern.resolve(&body);
        for diagnostic in found.iter().chain(&pattern.check(&body)) {
            prop_assert!(!diagnostic.message.is_empty() && !diagnostic.hint.is_empty());
            prop_assert!(!pattern.describe(&diagnostic.place).is_empty());
        }
        let sewn = |seam: &Seam| draft.seams.iter().any(|s| s.id == SeamOrigin::Seam(seam.id));
        if !pattern.seams.iter().all(|seam| sewn(seam)) {
            prop_assert!(found.iter().any(|d| d.severity == Severity::Error), "a seam is left out");
        }
        for piece in &draft.pieces {
            let mut edges = piece.outline.iter().chain(piece.holes.iter().flatten());
            prop_assert!(edges.all(|edge| edge.curve.is_finite()));
        }
        for span in draft.seams.iter().flat_map(|seam| seam.sides.iter().flatten()) {
            let piece = &draft.pieces[span.piece];
            let holes: usize = piece.holes.iter().map(Vec::len).sum();
            prop_assert!(span.edge < piece.outline.len() + holes);
            prop_assert!((0.0..=1.0).contains(&span.from) && (0.0..=1.0).contains(&span.to));
        }
        match write_pattern(&pattern) {
            Ok(text) => {
                // Names that were nothing's when a formula was made may be something's now.
                let (again, notes) = read_pattern(&text).unwrap();
                prop_assert!(notes.is_empty(), "{notes:?}");
                let text = write_pattern(&again).unwrap();
                prop_assert!(read_pattern(&text).unwrap().0 == again);
                prop_assert!(again.seams.len() == pattern.seams.len());
                let damaged = without_some_parts(again, &mut dice);
                let text = write_pattern(&damaged).unwrap();
                let (again, notes) = read_pattern(&text).unwrap();
                prop_assert!(notes.is_empty());
                prop_assert!(again == damaged, "{}", text);
                serde_json::from_str::<serde_json::Value>(&text).unwrap();
            }
            Err(error) => prop_assert!(!error.place.is_empty() && !error.hint.is_empty()),
        }
    }
}

/// The pattern with some parts taken out of it, whatever names them.
fn without_some_parts(mut pattern: Pattern, dice: &mut Dice) -> Pattern {
    let parts: Vec<PartId> = pattern.parts().into_iter().map(|(id, _)| id).collect();
    for _ in 0..dice.below(6) {
        let part = parts[dice.below(parts.len())];
        // What is removed with its panel alone stays, and so does what is gone already.
        if let Err(error) = pattern.apply(&[Edit::Remove(part)]) {
            assert!(!error.to_string().is_empty());
        }
    }
    pattern
}

/// Makes the text worse in one of many ways.
fn damage(text: &str, dice: &mut Dice) -> String {
    let mut bytes = text.as_bytes().to_vec();
    let at = dice.below(bytes.len());
    match dice.below(9) {
        0 => bytes.truncate(at),
        1 => {
            for _ in 0..=dice.below(8) {
                let k = dice.below(bytes.len());
                bytes[k] ^= 1 << dice.below(8);
            }
        }
        2 => return swapped(text, dice, r#""NaN""#),
        3 => return swapped(text, dice, "NaN"),
        4 => return swapped(text, dice, "1e999"),
        5 => return swapped(text, dice, &"[".repeat(10_000)),
        6 => {
            let values = [
                "null", "true", "-1", "{}", "[]", "\"\"", "1e300", "0", "[[[1]]]",
            ];
            let value = values[dice.below(values.len())];
            return swapped(text, dice, value);
        }
        7 => {
            let end = (at + 1 + dice.below(200)).min(bytes.len());
            bytes.drain(at..end);
        }
        _ => {
            let formulas = [
                "\"((((\"",
                "\"bust / 0\"",
                "\"sqrt(-1)\"",
                "\"bust + 1\"",
                "\"elephant\"",
                "\"length(front.nothing)\"",
                "\"neck_half * neck_half * neck_half\"",
            ];
            let formula = formulas[dice.below(formulas.len())];
            return swapped(text, dice, formula);
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Puts something else in the place of one value.
fn swapped(text: &str, dice: &mut Dice, value: &str) -> String {
    let starts: Vec<usize> = text.match_indices(": ").map(|(at, _)| at + 2).collect();
    let start = starts[dice.below(starts.len())];
    let length = text[start..].find([',', '}', '\n']).unwrap_or(0);
    format!("{}{value}{}", &text[..start], &text[start + length..])
}

#[test]
fn damaged_files_are_read_or_refused_with_place_and_remedy() {
    let mut dice = Dice::new(2026);
    let mut refused = 0;
    for case in 0..2000 {
        let (name, text) = SHIPPED[case % SHIPPED.len()];
        let mut bad = damage(text, &mut dice);
        if case % 3 == 0 {
            bad = damage(&format!("{bad}\"a\": 1,\n"), &mut dice);
        }
        match read_pattern(&bad) {
            Ok((pattern, notes)) => {
                for note in notes.iter().chain(&pattern.check(&Measurements::adult())) {
                    assert!(!note.message.is_empty() && !note.hint.is_empty());
                }
                let text = write_pattern(&pattern).unwrap();
                assert_eq!(read_pattern(&text).unwrap().0, pattern);
            }
            Err(error) => {
                refused += 1;
                assert!(error.place.starts_with("line "), "{name}: {error}");
                assert!(!error.what.is_empty() && !error.hint.is_empty(), "{error}");
                assert!(error.to_string().len() < 1000, "{error}");
            }
        }
    }
    assert!(refused > 800, "only {refused} of 2000 were refused");
}

#[test]
fn shipped_files_are_in_the_form_the_writer_gives_them() {
    for (name, text) in SHIPPED {
        let (pattern, notes) = read_pattern(text).unwrap();
        assert!(notes.is_empty(), "{name}: {notes:?}");
        assert_eq!(write_pattern(&pattern).unwrap(), text, "{name}");
    }
}

#[test]
fn no_prefix_of_a_file_is_taken_for_the_whole() {
    let (_, text) = SHIPPED[0];
    let text = text.trim_end();
    for end in (0..text.len())
        .step_by(7)
        .filter(|end| text.is_char_boundary(*end))
    {
        assert!(read_pattern(&text[..end]).is_err(), "{end} bytes were read");
    }
}

#[test]
fn unknown_fields_are_reported_with_their_path() {
    let (_, text) = SHIPPED[0];
    let more = text.replacen("\"sheet\"", "\"colour of thread\": 3, \"sheet\"", 1);
    let (pattern, notes) = read_pattern(&more).unwrap();
    assert_eq!(pattern, read_pattern(text).unwrap().0);
    assert_eq!(notes.len(), 1);
    let said = notes[0].to_string();
    assert!(said.contains("panels[0].colour of thread"), "{said}");
    assert!(said.contains("line "), "{said}");
}

#[test]
fn refusals_say_what_was_meant() {
    for (field, from, to, says) in [
        (
            "reference",
            "\"fabric\": ",
            "\"fabric\": 9999",
            "right kind",
        ),
        (
            "kind of part",
            "\"sheet\": ",
            "\"sheet\": 1, \"sheet no\": ",
            "right kind",
        ),
        ("id", "\"id\": 2", "\"id\": 1", "id of its own"),
        (
            "next id",
            "\"next_id\": ",
            "\"next_id\": 1, \"next\": ",
            "write ",
        ),
        (
            "word",
            "\"facing\": \"front\"",
            "\"facing\": \"forward\"",
            "use one of front",
        ),
        ("version", "\"toile\": 2", "\"toile\": 9", "newer program"),
        (
            "kind",
            "\"kind\": \"pattern\"",
            "\"kind\": \"scene\"",
            "kind \"pattern\"",
        ),
        (
            "unit",
            "\"unit\": \"cm\"",
            "\"unit\": \"furlong\"",
            "mm, cm, m, in",
        ),
        (
            "line",
            "\"kind\": \"outline\"",
            "\"kind\": \"border\"",
            "outline, hole, internal",
        ),
        (
            "formula",
            "\"waist_line + ",
            "\"waist_line + * ",
            "write a number",
        ),
    ] {
        let (_, text) = SHIPPED[0];
        assert!(text.contains(from), "{field}");
        let error = read_pattern(&text.replacen(from, to, 1)).unwrap_err();
        assert!(error.hint.contains(says), "{field}: {error}");
        assert!(error.place.contains("line "), "{field}: {error}");
    }
}

/// What has fields of two kinds would lose one of them: it is refused, with both named.
#[test]
fn fields_of_two_kinds_are_refused_by_name() {
    for (from, to, named) in [
        (
            "\"at\": [",
            "\"curve\": 40, \"share\": 0.5, \"at\": [",
            ["curve", "at"],
        ),
        ("\"at\": [", "\"index\": 1, \"at\": [", ["index", "at"]),
        (
            "\"offset\": [",
            "\"toward\": 29, \"offset\": [",
            ["toward", "offset"],
        ),
        (
            "\"handles\": [",
            "\"bulge\": 1, \"handles\": [",
            ["handles", "bulge"],
        ),
        ("\"handles\": [", "\"knots\": [", ["knots", "without"]),
        (
            "\"fold\": {",
            "\"dart\": {\"line\": 37}, \"fold\": {",
            ["fold", "dart"],
        ),
        (
            "\"between\": [",
            "\"notch\": 50, \"between\": [",
            ["between", "notch"],
        ),
        (
            "\"part\": ",
            "\"translation_m\": [0, 0, 0], \"part\": ",
            ["part", "translation_m"],
        ),
        (
            "\"value\": \"11.5cm\"",
            "\"value\": {\"formula\": \"11.5cm\", \"by\": 0, \"usual\": 1}",
            ["usual", "formula"],
        ),
        (
            "\"value\": \"11.5cm\"",
            "\"value\": {\"usual\": \"11.5cm\", \"sizes\": [[2, 1], [2, 3]]}",
            ["size 2", "two values"],
        ),
    ] {
        let (_, text) = SHIPPED[0];
        assert!(text.contains(from), "{from}");
        let error = read_pattern(&text.replacen(from, to, 1)).unwrap_err();
        assert!(
            named.iter().all(|name| error.what.contains(name)),
            "{to}: {error}"
        );
        assert!(
            error.place.contains("line ") && error.hint.contains("keep"),
            "{to}: {error}"
        );
    }
    let (_, darts) = SHIPPED[2];
    let both = darts.replacen("\"depth\": ", "\"apex\": 80, \"depth\": ", 1);
    let error = read_pattern(&both).unwrap_err();
    assert!(
        error.what.contains("depth") && error.what.contains("apex"),
        "{error}"
    );
}

#[test]
fn damaged_operations_are_refused_at_their_place() {
    let (_, text) = SHIPPED[0];
    let fold = "\"fold\": {";
    let before = &text[..text.find(fold).unwrap()];
    let line = before.lines().count();
    let end = text[before.len()..].find('}').unwrap();
    let with = |operation: &str| {
        let rest = &text[before.len() + end + 1..];
        read_pattern(&format!("{before}{operation}{rest}"))
    };
    let pivot = r#""pivot": {"dart": 52, "line": 37, "mouth": 29, "share": 0.5, "back": 2}"#;
    let spread = r#""spread": {"line": 37, "held": 27, "cuts": [{"number": 3, "from": 28, "to": 29, "openings": [2, 0]}]}"#;
    let split = r#""split": {"line": 37, "curve": 42}"#;
    for whole in [pivot, spread, split] {
        let (pattern, notes) = with(whole).unwrap();
        assert!(notes.is_empty(), "{notes:?}");
        let (again, _) = read_pattern(&write_pattern(&pattern).unwrap()).unwrap();
        assert_eq!(again, pattern);
    }
    for (whole, from, to, says) in [
        (pivot, "\"dart\": 52, ", "", "dart"),
        (pivot, "52", "29", "point 29"),
        (pivot, "0.5", "\"late +\"", "share"),
        (pivot, "\"back\": 2", "\"turned\": \"round\"", "round"),
        (split, ", \"curve\": 42", "", "curve"),
        (split, "42", "37", "line 37"),
        (spread, "\"held\": 27, ", "", "held"),
        (spread, "[2, 0]", "[2]", "openings"),
        (
            spread,
            "\"number\": 3",
            "\"number\": 60000",
            "not that many",
        ),
        (
            spread,
            "\"cuts\"",
            "\"bridge\": \"wooden\", \"cuts\"",
            "wooden",
        ),
    ] {
        let error = with(&whole.replacen(from, to, 1)).unwrap_err();
        let told = format!("{error}");
        assert!(told.contains(says), "{to}: {told}");
        assert!(
            error.place.contains(&format!("line {line}, column ")),
            "{to}: {told}"
        );
        assert!(!error.hint.is_empty());
    }
}

#[test]
fn unknown_fields_of_numbers_are_reported() {
    for value in [
        "{\"formula\": \"11.5cm\", \"by\": 0.01, \"why\": 1}",
        "{\"usual\": \"11.5cm\", \"sizes\": [[2, 0.1]], \"why\": 1}",
    ] {
        let (_, text) = SHIPPED[0];
        let more = text.replacen("\"11.5cm\"", value, 1);
        let (pattern, notes) = read_pattern(&more).unwrap();
        assert_eq!(notes.len(), 1, "{notes:?}");
        assert!(
            notes[0].to_string().contains("variables[0].value.why"),
            "{}",
            notes[0]
        );
        assert!(!write_pattern(&pattern).unwrap().contains("why"));
    }
}

/// A part by its id in a formula is a reference like any other.
#[test]
fn ids_in_formulas_are_checked() {
    for (formula, says) in [
        ("x(?999999)", "never given"),
        ("?26", "the file has panel 26"),
        ("length(front.?29..front.?26)", "the file has panel 26"),
    ] {
        let (_, text) = SHIPPED[0];
        let bad = text.replacen("\"11.5cm\"", &format!("\"{formula}\""), 1);
        let error = read_pattern(&bad).unwrap_err();
        assert!(error.what.contains(says), "{formula}: {error}");
    }
}
