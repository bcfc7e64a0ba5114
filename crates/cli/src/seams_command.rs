//! Runs `toile seams`.

use crate::output::{Failure, Output, count};
use crate::seams_arguments::Seams;
use serde_json::{Value, json};
use toile_session::{SeamOptions, Suggestion, suggested_seams};

/// Most edges that are named when an edge stays open.
const MAX_NAMED: usize = 12;

/// Seams suggested for edges that have none; accepted ones are written.
pub fn seams(seams: &Seams, output: &Output) -> Result<Value, Failure> {
    let accept = match (&seams.accept, &seams.out) {
        (Some(accept), Some(out)) => Some((accept.clone(), out.clone())),
        (None, _) | (_, None) => None,
    };
    let options = SeamOptions {
        open: seams.read.options(),
        size: seams.size.clone(),
        accept,
    };
    let report = suggested_seams(&seams.pattern, &options)
        .map_err(|error| Failure::from(error).about(&seams.pattern))?;
    for note in &report.notes {
        output.say(format!("note: {note}"));
    }
    match report.suggestions.is_empty() {
        true => output.say("no seams to suggest: every edge is sewn, or has no partner"),
        false => output.say("   no  cost  first  edges"),
    }
    for suggestion in &report.suggestions {
        for line in lines(suggestion) {
            output.say(line);
        }
    }
    if options.accept.is_some() {
        for (number, name) in report.seams.iter().enumerate() {
            output.say(format!("sewn {}: {name}", number + 1));
        }
        let named: Vec<String> = report
            .open
            .iter()
            .take(MAX_NAMED)
            .map(ToString::to_string)
            .collect();
        let more = match report.open.len().saturating_sub(MAX_NAMED) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        match named.is_empty() {
            true => output.say("no edge is left open"),
            false => output.say(format!(
                "left open: {}: {}{more}",
                count(report.open.len(), "edge"),
                named.join(", ")
            )),
        }
    }
    for file in &report.files {
        output.say(format!("wrote {}", file.display()));
    }
    Ok(json!(report))
}

/// A suggestion in words, a line for each pair of edges.
fn lines(suggestion: &Suggestion) -> Vec<String> {
    let mut lines = Vec::new();
    for (k, pair) in suggestion.pairs.iter().enumerate() {
        let [one, two] = &pair.edges;
        let [a, b] = pair.lengths_mm;
        let start = match k {
            0 => format!(
                "{:>5}  {:>4.1}  {:<5}",
                suggestion.number,
                suggestion.cost,
                if suggestion.best { "yes" } else { "" }
            ),
            _ => format!("{:>5}  {:>4}  {:<5}", "", "", "and"),
        };
        lines.push(format!("{start}  {one} ({a:.1} mm) to {two} ({b:.1} mm)"));
    }
    lines
}
