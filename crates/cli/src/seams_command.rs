//! Runs `toile seams`.

use crate::output::{Failure, Output, count};
use crate::seams_arguments::Seams;
use serde_json::{Value, json};
use toile_session::{PairOfEdges, SeamOptions, Suggestion, suggested_seams};

/// Candidates of each edge that are listed.
const MAX_LISTED: usize = 3;
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
    let is_near = |pair: &PairOfEdges| pair.ranks.iter().any(|rank| *rank <= MAX_LISTED);
    let found = report.suggestions.iter();
    let listed = found.filter(|found| seams.all || found.pairs.iter().any(is_near));
    let listed: Vec<&Suggestion> = listed.collect();
    if report.suggestions.is_empty() {
        output.say("no seams to suggest: every edge is sewn, or has no partner");
    } else if options.accept.is_none() {
        output.say("   no  cost  best   edges");
        for line in listed.iter().flat_map(|found| lines(found)) {
            output.say(line);
        }
        match report.suggestions.len() - listed.len() {
            0 => {}
            more => output.say(format!(
                "{more} less likely are not listed; --all lists them"
            )),
        }
    }
    if options.accept.is_some() {
        let sewn = report.accepted.iter();
        let sewn = sewn.flat_map(|number| &report.suggestions[number - 1].pairs);
        for ((number, name), pair) in report.seams.iter().enumerate().zip(sewn) {
            output.say(format!("sewn {}: {name}: {}", number + 1, in_words(pair)));
        }
        if report.seams.is_empty() && !report.suggestions.is_empty() {
            output.say("nothing is sewn: no suggestion is certain; choose numbers from the list without --accept");
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
        let start = match k {
            0 => format!(
                "{:>5}  {:>4.1}  {:<5}",
                suggestion.number,
                suggestion.cost,
                if suggestion.best { "yes" } else { "" }
            ),
            _ => format!("{:>5}  {:>4}  {:<5}", "", "", "and"),
        };
        lines.push(format!("{start}  {}", in_words(pair)));
    }
    lines
}

/// Two edges with their panels and lengths.
fn in_words(pair: &PairOfEdges) -> String {
    let [one, two] = &pair.edges;
    let [a, b] = pair.lengths_mm;
    format!("{one} ({a:.1} mm) to {two} ({b:.1} mm)")
}
