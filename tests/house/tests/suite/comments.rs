//! Comments say a thing by its name: few of their lines begin with a word that only points at one.

use std::fs;
use toile_house::{files_below, root};

/// Packages whose sources are held to this rule.
const FOLDERS: [&str; 6] = [
    "ui",
    "crates/pattern",
    "crates/body",
    "crates/cut",
    "crates/session",
    "crates/interchange",
];
/// Words that only point.
const OPENERS: [&str; 5] = ["What", "Where", "How", "Its", "That"];
/// Share of a package's comment lines that may begin with one of these words, in thousandths (1).
const MAX_OPENERS: usize = 30;
/// Number of lines that a failure shows.
const SHOWN: usize = 20;

/// The words of a comment line; none for code and for a comment without words.
fn comment(line: &str) -> Option<&str> {
    let words = line.trim_start().strip_prefix("//")?;
    let words = words.strip_prefix(['/', '!']).unwrap_or(words).trim();
    (!words.is_empty()).then_some(words)
}

/// Whether the first word of a comment only points.
fn only_points(comment: &str) -> bool {
    let mut words = comment.split(|c: char| !c.is_alphanumeric() && c != '_');
    words.next().is_some_and(|word| OPENERS.contains(&word))
}

#[test]
fn few_comment_lines_begin_with_a_word_that_only_points() {
    for folder in FOLDERS {
        let (mut count, mut pointing) = (0, Vec::new());
        for path in files_below(&root().join(folder).join("src"), ".rs") {
            let text = fs::read_to_string(&path).expect("readable");
            for (k, line) in text.lines().enumerate() {
                let Some(words) = comment(line) else { continue };
                count += 1;
                if only_points(words) {
                    pointing.push(format!("{}:{}: {words}", path.display(), k + 1));
                }
            }
        }
        assert!(count > 100, "{folder} has only {count} comment lines");
        assert!(
            pointing.len() * 1000 <= MAX_OPENERS * count,
            "{} of {count} comment lines of {folder} begin with one of {OPENERS:?}: name the thing itself in\n{}",
            pointing.len(),
            pointing[..pointing.len().min(SHOWN)].join("\n")
        );
    }
}

#[test]
fn the_first_word_of_a_comment_is_told() {
    for (line, points) in [
        ("    /// What it weighs.", Some(true)),
        ("//! Its weight.", Some(true)),
        ("//How", Some(true)),
        ("// Whatever it weighs.", Some(false)),
        ("/// The weight: What?", Some(false)),
        ("///", None),
        ("let what = 1; // What", None),
    ] {
        assert_eq!(comment(line).map(only_points), points, "{line}");
    }
}
