//! Tables of the formats of patterns for `docs/FORMATS.md`, as the program decides.

use super::{Content, Format, ReadOption};
use crate::exchange::contents::lost_in;
use std::fmt::Write;
use strum::VariantArray;
use toile_pattern::fields::Choice;

/// Tables in Markdown: the formats with their words, endings and options; and which kind of contents each format
/// that is written carries.
pub fn format_tables() -> String {
    let mut text = "| format | `--from`, `--to` | ending | read with | written | sizes in a file |\n|---|---|---|---|---|---|\n".to_owned();
    for &format in Format::all() {
        let options = ReadOption::ALL
            .iter()
            .filter(|option| format.takes(**option));
        let options: Vec<String> = options.map(|option| format!("`{option}`")).collect();
        let sizes = match (format.holds_shapes(), format.holds_sizes()) {
            (false, _) => "all",
            (true, true) => "one, or all as shapes",
            (true, false) => "one",
        };
        // Writing to a text does not fail.
        let _ = writeln!(
            text,
            "| {} | `{}` | `{}` | {} | {} | {sizes} |",
            format.title(),
            format.word(),
            format.ending(),
            options.join(" "),
            if format.is_written() { "yes" } else { "no" },
        );
    }
    let written = Format::all().iter().filter(|format| format.is_written());
    let written: Vec<Format> = written.copied().collect();
    let titles: Vec<&str> = written.iter().map(|format| format.title()).collect();
    let _ = writeln!(text, "\n| contents | {} |", titles.join(" | "));
    let _ = writeln!(text, "|---|{}", "---|".repeat(titles.len()));
    for &content in Content::VARIANTS {
        let carried = written
            .iter()
            .map(|format| lost_in(content, *format).unwrap_or("yes"));
        let carried: Vec<&str> = carried.collect();
        let _ = writeln!(text, "| {} | {} |", content.words(), carried.join(" | "));
    }
    text
}
