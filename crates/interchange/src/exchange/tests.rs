//! Patterns read and written through the one way in and the one way out.

use super::*;
use crate::write_pattern;
use toile_pattern::Pattern;
use toile_pattern::fields::Choice;

#[test]
fn a_format_is_known_by_its_content_and_by_its_name() {
    let native = write_pattern(&Pattern::blank("skirt")).unwrap();
    let read_native = read(native.as_bytes(), &ReadOptions::default(), &[]).unwrap();
    assert_eq!(read_native.format, Format::Native);
    assert_eq!(Format::of_name("a.Toile.json"), Some(Format::Native));
    assert_eq!(Format::of_name("a.json"), Some(Format::GarmentCode));
    assert_eq!(Format::of_name("a.png"), None);
    for &format in Format::all() {
        let of_kind = Format::of_kind(format.kind()).unwrap();
        assert_eq!(of_kind.kind(), format.kind());
        let of_name = Format::of_name(&format!("a{}", format.ending()));
        assert_eq!(of_name.is_some(), format.is_written());
    }
}

#[test]
fn another_format_than_the_content_shows_may_be_asked_for() {
    let native = write_pattern(&Pattern::blank("skirt")).unwrap();
    let asked = ReadOptions {
        format: Some(Format::GarmentCode),
        ..ReadOptions::default()
    };
    let refused = read(native.as_bytes(), &asked, &[]).unwrap_err();
    assert!(refused.what.contains("pattern"), "{refused}");
}

#[test]
fn an_answer_to_a_question_that_the_format_does_not_ask_is_refused() {
    let native = write_pattern(&Pattern::blank("skirt")).unwrap();
    let asked = ReadOptions {
        allowance_inside: Some(0.01),
        ..ReadOptions::default()
    };
    let refused = read(native.as_bytes(), &asked, &[]).unwrap_err();
    assert!(refused.what.contains("--inside"), "{refused}");
}

#[test]
fn text_that_is_not_utf_8_is_refused_with_its_line() {
    let refused = read(
        b"{\n\"toile\": 2, \"name\": \"\xe9\"}",
        &ReadOptions::default(),
        &[],
    );
    assert_eq!(refused.unwrap_err().place, "line 2");
}

#[test]
fn every_kind_of_contents_has_its_words() {
    use strum::VariantArray;
    let mut words: Vec<&str> = Content::VARIANTS.iter().map(|one| one.words()).collect();
    words.sort_unstable();
    words.dedup();
    assert_eq!(words.len(), Content::VARIANTS.len());
}
