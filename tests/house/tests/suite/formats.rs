//! No place but `exchange` chooses a format of patterns: readers and writers of one format are called there
//! alone, and so is the question which format a kind of file is.

use std::fs;
use toile_house::{files_below, root};

/// Readers and writers of one format.
const OF_ONE_FORMAT: [&str; 7] = [
    "read_document(",
    "read_garmentcode(",
    "write_garmentcode(",
    "read_dxf(",
    "write_dxf(",
    "read_valentina(",
    "read_svg(",
];

/// Kinds of files that are patterns.
const PATTERN_KINDS: [&str; 6] = [
    "FileKind::Pattern",
    "FileKind::GarmentCode",
    "FileKind::Dxf",
    "FileKind::Svg",
    "FileKind::ValentinaPattern",
    "FileKind::SeamlyPattern",
];

/// Where they may stand: the exchange, what tells kinds of files apart, and the folders of the formats.
const OWN: [&str; 9] = [
    "interchange/src/exchange/",
    "interchange/src/dxf/",
    "interchange/src/svg/",
    "interchange/src/valentina/",
    "interchange/src/garmentcode/",
    "interchange/src/native/",
    "interchange/src/recognise.rs",
    "interchange/src/file_kind.rs",
    "interchange/src/lib.rs",
];

/// Words of a source that choose a format.
fn choosing(text: &str) -> Vec<&'static str> {
    // Tests of a file come last, and may read what was written.
    let text = text.split("#[cfg(test)]").next().unwrap_or_default();
    let words = OF_ONE_FORMAT.into_iter().chain(PATTERN_KINDS);
    let is_whole = |word: &&str| {
        text.match_indices(*word).any(|(at, _)| {
            let rest = &text[at + word.len()..];
            word.ends_with('(') || !rest.starts_with(|c: char| c.is_alphanumeric())
        })
    };
    words.filter(is_whole).collect()
}

#[test]
fn formats_of_patterns_are_chosen_in_the_exchange_alone() {
    let mut faults = Vec::new();
    let mut is_seen = false;
    for folder in ["crates", "ui"] {
        for path in files_below(&root().join(folder), ".rs") {
            let name = path.display().to_string().replace('\\', "/");
            if !name.contains("/src/") || name.ends_with("/tests.rs") {
                continue;
            }
            let text = fs::read_to_string(&path).expect("readable");
            let words = choosing(&text);
            match OWN.iter().any(|own| name.contains(own)) {
                true => is_seen |= name.contains("exchange/") && !words.is_empty(),
                false => faults.extend(words.iter().map(|word| format!("{name}: {word}"))),
            }
        }
    }
    assert!(is_seen, "the exchange is not seen to choose");
    assert!(
        faults.is_empty(),
        "leave the choice of a format to `toile_interchange::read` and `write`:\n{}",
        faults.join("\n")
    );
}

#[test]
fn what_chooses_is_told_from_what_does_not() {
    assert_eq!(choosing("let p = read_dxf(bytes);"), ["read_dxf("]);
    assert_eq!(choosing("FileKind::Dxf => 1"), ["FileKind::Dxf"]);
    assert!(choosing("FileKind::PatternBook; read_dxf_tags(x)").is_empty());
    assert!(choosing("let a = 1;\n#[cfg(test)]\nread_dxf(bytes)").is_empty());
}
