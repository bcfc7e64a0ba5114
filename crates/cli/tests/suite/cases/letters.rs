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

/// Words of an SVG print with the middle of their baseline, size and whether they run upwards.
struct SvgWords {
    at: [f64; 2],
    size: f64,
    upright: bool,
    text: String,
}

fn attribute<'t>(tag: &'t str, name: &str) -> Option<&'t str> {
    let start = tag.find(&format!(" {name}=\""))? + name.len() + 3;
    tag[start..].split('"').next()
}

fn numbers(text: &str) -> Vec<f64> {
    let parts = text.split(|c: char| !(c.is_ascii_digit() || c == '.' || c == '-'));
    parts.filter_map(|part| part.parse().ok()).collect()
}

fn middle_words(svg: &str) -> Vec<SvgWords> {
    let tags = svg.lines().filter(|line| line.starts_with("<text"));
    let read = |tag: &str| {
        let number = |name| attribute(tag, name)?.parse::<f64>().ok();
        (attribute(tag, "text-anchor") == Some("middle")).then_some(())?;
        Some(SvgWords {
            at: [number("x")?, number("y")?],
            size: number("font-size")?,
            upright: tag.contains("rotate(-90 "),
            text: tag.split('>').nth(1)?.split('<').next()?.to_owned(),
        })
    };
    tags.filter_map(read).collect()
}

/// Boxes of the lines of a class: left, right, top, bottom (mm).
fn boxes(svg: &str, class: &str) -> Vec<[f64; 4]> {
    let class = format!("class=\"{class}\"");
    let lines = svg.lines().filter(|line| line.contains(&class));
    let of = |line: &str| {
        let all = numbers(attribute(line, "d").unwrap());
        let side = |k: usize, sign: f64| {
            let own = all.iter().skip(k).step_by(2);
            sign * own.map(|x| sign * x).fold(f64::INFINITY, f64::min)
        };
        [side(0, 1.0), side(0, -1.0), side(1, 1.0), side(1, -1.0)]
    };
    lines.map(of).collect()
}

#[test]
fn labels_lie_inside_the_smallest_pieces_and_clear_of_their_notches() {
    let folder = tempfile::tempdir().unwrap();
    for (file, names) in [
        ("doll", &["front bodice", "sleeve", "collar", "pocket"][..]),
        ("long", &["ppp"]),
    ] {
        let name = format!("{file}.toile.json");
        printed(
            folder.path(),
            &case("small-pieces-on-paper").join(name),
            "p.svg",
        );
        let svg = std::fs::read_to_string(folder.path().join("p.svg")).unwrap();
        let pieces = boxes(&svg, "sew");
        let notches = boxes(&svg, "notch");
        let all = middle_words(&svg);
        let is_label = |words: &&SvgWords| {
            let other = ["cut 1", "cotton"];
            names
                .iter()
                .chain(&other)
                .any(|name| words.text.starts_with(name))
        };
        let labels: Vec<&SvgWords> = all.iter().filter(is_label).collect();
        assert!(labels.len() >= 3 * names.len(), "{file}: {}", labels.len());
        for words in labels {
            // Letters are half as wide as high, about.
            let (along, tall) = (
                0.25 * words.text.chars().count() as f64 * words.size,
                words.size,
            );
            let [x, y] = words.at;
            let own = match words.upright {
                false => [x - along, x + along, y - 0.7 * tall, y],
                true => [x - 0.7 * tall, x, y - along, y + along],
            };
            let inside =
                |b: &[f64; 4]| b[0] <= own[0] && own[1] <= b[1] && b[2] <= own[2] && own[3] <= b[3];
            let meets =
                |b: &[f64; 4]| b[0] < own[1] && own[0] < b[1] && b[2] < own[3] && own[2] < b[3];
            assert!(pieces.iter().any(inside), "{file}: {} {own:?}", words.text);
            assert!(!notches.iter().any(meets), "{file}: {} {own:?}", words.text);
        }
        let sheet = all.iter().all(|words| words.at[0] > 0.0);
        assert!(sheet && svg.contains("row 1, column 1"));
    }
}

#[test]
fn a_name_too_long_for_its_piece_ends_with_an_ellipsis() {
    let folder = tempfile::tempdir().unwrap();
    let input = case("small-pieces-on-paper").join("long.toile.json");
    printed(folder.path(), &input, "p.svg");
    let svg = std::fs::read_to_string(folder.path().join("p.svg")).unwrap();
    let all = middle_words(&svg);
    let name = all
        .iter()
        .find(|words| words.text.starts_with("ppp"))
        .unwrap();
    assert!(
        name.text.ends_with('…') && name.size >= 1.5,
        "{} {}",
        name.text,
        name.size
    );
    let other = all.iter().filter(|words| words.text == "cotton").count();
    assert_eq!(other, 1);
}

#[test]
fn a_pattern_in_inches_is_told_in_inches() {
    let folder = tempfile::tempdir().unwrap();
    let input = case("inch-user").join("inch.toile.json");
    let said = printed(folder.path(), &input, "p.pdf");
    // 11.25 x 21.25 in with the allowance, in square inches.
    assert!(said.contains("(239 in2)") && !said.contains("cm"), "{said}");
    let sheets = copied(&folder.path().join("p.pdf"));
    assert!(
        sheets.contains("2x4in") && !sheets.contains("50x100mm"),
        "{sheets}"
    );
    printed(folder.path(), &input, "p.svg");
    let svg = std::fs::read_to_string(folder.path().join("p.svg")).unwrap();
    let is_box = |line: &str| {
        let all = attribute(line, "d").map(numbers).unwrap_or_default();
        let [x, y] = [0, 1].map(|k| {
            let own: Vec<f64> = all.iter().skip(k).step_by(2).copied().collect();
            let most = own.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            most - own.iter().copied().fold(f64::INFINITY, f64::min)
        });
        (x - 101.6).abs() < 0.01 && (y - 50.8).abs() < 0.01
    };
    assert!(svg.lines().any(is_box));
    let said = nested(folder.path(), &input, "pdf,svg,report");
    assert!(
        said.contains("59.1 in wide and ") && said.contains(" yd of fabric ("),
        "{said}"
    );
    let marker = copied(&folder.path().join("n/marker.pdf"));
    assert!(marker.contains("offabric59.1inwide"), "{marker}");
    let report = copied(&folder.path().join("n/marker-report.pdf"));
    assert!(
        report.contains("area,in2") && !report.contains("cm"),
        "{report}"
    );
    let svg = std::fs::read_to_string(folder.path().join("n/marker.svg")).unwrap();
    assert!(svg.contains(">4 in</text>"));
}
