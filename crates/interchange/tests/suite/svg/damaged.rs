//! Drawings that are damaged, empty or meant ill: refused or read with a place and a remedy, never a panic.

use crate::random_pattern::Dice;
use crate::svg::{back, read};
use std::fmt::Write as _;
use std::time::Instant;

fn svg(inside: &str) -> String {
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='1000mm' height='1000mm' viewBox='0 0 1000 1000'>\n{inside}\n</svg>"
    )
}

#[test]
fn what_is_no_pattern_is_refused_with_place_and_remedy() {
    let piece = "<path d='M0 0H300V300H0z'/>";
    let mut bomb = String::from("<defs><g id='l0'><path d='M0 0H1'/></g>");
    for k in 1..40 {
        let before = format!("<use href='#l{}'/>", k - 1).repeat(10);
        let _ = write!(bomb, "<g id='l{k}'>{before}</g>");
    }
    bomb += "</defs><use href='#l39'/>";
    let deep = format!("{}{piece}{}", "<g>".repeat(80), "</g>".repeat(80));
    let many = format!("<path d='M0 0{}z'/>", "l1 1".repeat(1_000_000));
    let apart: String = (0..2_500)
        .map(|k| {
            format!(
                "<rect x='{}' y='{}' width='8' height='8'/>",
                k % 100 * 10,
                k / 100 * 10
            )
        })
        .collect();
    for (inside, says) in [
        (bomb.as_str(), "elements"),
        ("<g id='a'><use href='#a'/></g>", "deep"),
        (deep.as_str(), "deep"),
        (many.as_str(), "points"),
        (apart.as_str(), "side by side"),
        ("", "nothing is drawn"),
        (
            "<style>* { display: none }</style><path d='M0 0H300V300H0z'/>",
            "nothing is drawn",
        ),
        ("<path d='M0 0H300' stroke='red'/>", "no closed line"),
        ("<path d='M0 0L300 300L0 0z'/>", "no closed line"),
        ("<path d='M0 0H1e300V1e300z'/>", "coordinate"),
        (
            "<path transform='scale(NaN)' d='M0 0H300V300z'/>",
            "transformation",
        ),
        (
            "<path transform='scale(1e300)' d='M0 0H300V300z'/>",
            "coordinate",
        ),
    ] {
        let error = read(&svg(inside)).unwrap_err();
        assert!(error.what.contains(says), "{says}: {error}");
        assert!(!error.place.is_empty() && !error.hint.is_empty(), "{error}");
    }
    for root in ["viewBox='0 0 0 0'", "viewBox='0 0 NaN 10'", "viewBox='5'"] {
        let text = format!("<svg xmlns='http://www.w3.org/2000/svg' {root}>{piece}</svg>");
        let error = read(&text).unwrap_err();
        assert!(error.what.contains("view box"), "{root}: {error}");
    }
    let broken = "<svg xmlns='http://www.w3.org/2000/svg'>\n<g>\n</svg>";
    assert_eq!(read(broken).unwrap_err().place, "line 3");
}

#[test]
fn scripts_links_and_pictures_are_left_out_and_told() {
    let inside = "<script>alert(1)</script><script href='http://example.org/x.js'/>\
        <image href='http://example.org/x.png' width='10' height='10'/><use href='other.svg#a'/><use href='#none'/>\
        <a href='http://example.org'><path d='M0 0H300V300H0z'/></a><path d='M0 400H300V700H0zL5 x'/>";
    let reading = read(&svg(inside)).unwrap();
    assert_eq!(reading.pattern.panels.len(), 2);
    let told = |what: &str| {
        reading
            .losses
            .iter()
            .find(|loss| loss.what == what)
            .map(|l| l.count)
    };
    assert_eq!(told("scripts"), Some(2));
    assert_eq!(told("pictures"), Some(1));
    assert_eq!(told("links to other files"), Some(1));
    assert_eq!(told("links to elements that are not there"), Some(1));
    assert_eq!(told("ends of damaged paths"), Some(1));
}

#[test]
fn outlines_that_cross_themselves_are_read() {
    let reading = read(&svg(
        "<path d='M0 0L300 300H0L300 50L100 0z'/><path d='M400 0C900 300 400 300 800 0z'/>",
    ));
    let reading = reading.unwrap();
    assert_eq!(reading.pattern.panels.len(), 2);
    let _ = crate::svg::drafted(&reading.pattern, None);
}

#[test]
fn a_damaged_document_in_the_metadata_is_refused() {
    let text = back::shirt()
        .replace("&gt;", ">")
        .replacen("\"panels\"", "\"panels", 1);
    let error = read(&text).unwrap_err();
    assert!(error.place.contains("metadata"), "{error}");
    assert!(error.hint.contains("take <metadata> out"), "{error}");
    assert!(read(&back::shirt()).is_ok());
}

#[test]
fn mutated_files_are_answered() {
    let drawing = svg(
        "<style>.a { fill: none } g.b path { stroke: red }</style><defs><g id='u'><path d='M5 5H10'/></g></defs>\
         <g class='b' transform='translate(10 10) rotate(5)'><path class='a' d='M0 0C10 -20 280 0 300 0V300Q100 350 0 300z'/>\
         <path class='a' d='M10 10H290V290H10z'/><use href='#u' x='7'/><text x='50' y='60'>Front</text></g>\
         <circle cx='600' cy='300' r='200'/><rect x='20' y='500' width='400' height='300' rx='20'/>\
         <path d='M500 600A200 100 20 0 1 900 600S950 900 700 950T500 600'/>",
    );
    let shirt = back::shirt();
    let own: Vec<&[u8]> = vec![drawing.as_bytes(), shirt.as_bytes()];
    let signs = b"<>/='\"0159-.eMLCAZ {}#&;\xff\x00";
    let mut dice = Dice::new(17);
    let (mut answered, mut refused) = (0, 0);
    for round in 0..1_000 {
        let mut bytes = own[usize::from(round % 10 == 0)].to_vec();
        for _ in 0..1 + dice.below(3) {
            let at = dice.below(bytes.len());
            match dice.below(4) {
                0 => bytes[at] = signs[dice.below(signs.len())],
                1 => bytes.insert(at, signs[dice.below(signs.len())]),
                2 => {
                    let end = (at + 1 + dice.below(40)).min(bytes.len());
                    bytes.drain(at..end);
                }
                _ => {
                    let end = (at + dice.below(60)).min(bytes.len());
                    let part = bytes[at..end].to_vec();
                    let to = dice.below(bytes.len());
                    bytes.splice(to..to, part);
                }
            }
        }
        let start = Instant::now();
        match toile_interchange::read(&bytes, &Default::default(), &[]) {
            Ok(reading) => {
                answered += 1;
                let _ = crate::svg::drafted(&reading.pattern, None);
            }
            Err(error) => {
                refused += 1;
                assert!(!error.place.is_empty() && !error.hint.is_empty(), "{error}");
            }
        }
        assert!(start.elapsed().as_secs() < 10, "round {round}");
    }
    println!("{answered} read, {refused} refused");
    assert!(answered > 50 && refused > 100);
}
