//! Letters of every script on paper, labels within their pieces, numbers in the user's unit.

use super::{case, toile, words};
use lopdf::{Dictionary, Document};
use std::path::Path;

const NAMES: [&str; 7] = [
    "Перед",
    "背片",
    "שרוול",
    "كم",
    "Ärmel ½\" ő",
    "पीछे",
    "front 👗",
];

/// The letters that can be copied from every page of a PDF, without blanks.
fn copied(path: &Path) -> String {
    let file = Document::load(path).unwrap();
    let pages: Vec<u32> = file.get_pages().into_keys().collect();
    let text = file.extract_text(&pages).unwrap();
    text.chars().filter(|c| !c.is_whitespace()).collect()
}

/// The fonts of the first page.
fn fonts(path: &Path) -> Vec<Dictionary> {
    let file = Document::load(path).unwrap();
    let page = file.get_pages()[&1];
    let fonts = file.get_page_fonts(page).unwrap();
    fonts.into_values().cloned().collect()
}

fn printed(folder: &Path, input: &Path, out: &str) -> String {
    let input = input.to_str().unwrap();
    let output = toile(folder, &["print", input, "--out", out]);
    assert!(output.status.success(), "{}", words(&output.stderr));
    words(&output.stdout) + &words(&output.stderr)
}

fn nested(folder: &Path, input: &Path, formats: &str) -> String {
    let input = input.to_str().unwrap();
    let more = [
        "--width",
        "150cm",
        "--evaluations",
        "2000",
        "--write",
        formats,
    ];
    let arguments = [&["nest", input][..], &more, &["--out", "n"]].concat();
    let output = toile(folder, &arguments);
    assert!(output.status.success(), "{}", words(&output.stderr));
    words(&output.stdout) + &words(&output.stderr)
}

/// Names can be read off a PDF: right-to-left ones stand in it from the left.
fn assert_names(text: &str, said: &str) {
    for name in NAMES {
        let name: String = name.chars().filter(|c| !c.is_whitespace()).collect();
        let leftwards: String = name.chars().rev().collect();
        assert!(
            text.contains(&name) || text.contains(&leftwards),
            "{name} is not in {text}; {said}"
        );
    }
    assert!(!text.contains('?'), "{text}");
}

#[test]
fn names_in_every_script_are_read_off_both_pdfs() {
    let folder = tempfile::tempdir().unwrap();
    let input = case("names-lost-in-pdf").join("names.toile.json");
    let said = printed(folder.path(), &input, "p.pdf");
    let path = folder.path().join("p.pdf");
    assert_names(&copied(&path), &said);
    let said = nested(folder.path(), &input, "pdf,report");
    for file in ["n/marker.pdf", "n/marker-report.pdf"] {
        assert_names(&copied(&folder.path().join(file)), &said);
    }
    // Fonts of the program have these, whatever the machine has.
    for letters in ["Перед", "ő", "👗"] {
        assert!(!said.contains(letters), "{said}");
    }
    let again = std::fs::read(&path).unwrap();
    printed(folder.path(), &input, "p.pdf");
    assert_eq!(std::fs::read(&path).unwrap(), again);
}

#[test]
fn letters_that_no_font_has_are_boxes_and_told() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(case("names-lost-in-pdf").join("names.toile.json")).unwrap();
    // A letter of the private use area, which fonts of writing do not have.
    let strange = text.replace("Перед", "Пере\u{f8ffe}");
    assert_ne!(strange, text);
    let input = folder.path().join("p.toile.json");
    std::fs::write(&input, strange).unwrap();
    let told = |said: &str| said.contains("no font has these letters") && said.contains("U+F8FFE");
    assert!(told(&printed(folder.path(), &input, "p.pdf")));
    let said = nested(folder.path(), &input, "pdf,plt,report");
    assert!(told(&said), "{said}");
    for file in ["p.pdf", "n/marker.pdf"] {
        let copied = copied(&folder.path().join(file));
        assert!(copied.contains("Пере\u{f8ffe}"), "{copied}");
    }
    assert!(copied(&folder.path().join("n/marker-report.pdf")).contains("U+F8FFE"));
}

#[test]
fn western_names_take_helvetica_alone_and_others_an_embedded_part() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(case("inch-user").join("inch.toile.json")).unwrap();
    let input = folder.path().join("p.toile.json");
    let embedded = |name: &str| {
        std::fs::write(&input, text.replace("\"panel\"", &format!("\"{name}\""))).unwrap();
        printed(folder.path(), &input, "p.pdf");
        let fonts = fonts(&folder.path().join("p.pdf"));
        let kinds = fonts.iter().map(|font| font.get(b"Subtype").unwrap());
        kinds
            .filter(|kind| kind.as_name().unwrap() == b"Type0")
            .count()
    };
    assert_eq!(embedded("Rücken – Größe 38"), 0);
    assert_eq!(embedded("zsebőr"), 1);
}

#[test]
fn a_plotter_draws_letters_that_it_does_not_know() {
    let folder = tempfile::tempdir().unwrap();
    let input = case("names-lost-in-pdf").join("names.toile.json");
    nested(folder.path(), &input, "plt");
    let plot = std::fs::read_to_string(folder.path().join("n/marker.plt")).unwrap();
    assert!(plot.is_ascii() && !plot.contains('?'));
    // Seven names of other letters than ASCII: none is a label.
    assert!(!plot.contains("LB"), "{plot}");
    let drawn = plot
        .split("SP2;")
        .nth(1)
        .unwrap()
        .split("SP1;")
        .next()
        .unwrap();
    assert!(drawn.matches("PD").count() > 40);
}
