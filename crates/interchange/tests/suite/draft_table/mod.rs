//! What a pattern file drafts to, as text: every point, length and seam side of every size.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::Arc;
use toile_interchange::read_pattern;
use toile_measure::Measurements;
use toile_pattern::{
    Code, Diagnostic, Draft, DraftSpan, Evaluation, Name, Pattern, Piece, PieceEdge, SeamOrigin,
    Severity,
};

/// The table of one file: a line a fact, words first, then numbers (m) or (rad).
pub fn draft_table(text: &str) -> String {
    let mut table = String::new();
    match read_pattern(text) {
        Err(error) => writeln!(table, "refused {}", place_in_file(&error.place)).expect("text"),
        Ok((mut pattern, _)) => {
            // Seams of these files join edges at random: which side of a piece they show, and whether a ring of
            // pieces has a half turn, is not recorded.
            for seam in &mut pattern.seams {
                Arc::make_mut(seam).right_sides_together = false;
            }
            let adult = Measurements::adult();
            if pattern.sizes.is_empty() {
                write_size(&mut table, &pattern, "adult", &adult);
            }
            for size in &pattern.sizes {
                write_size(&mut table, &pattern, &size.name, &size.measurements);
            }
        }
    }
    table
}

/// Line and column of a refusal.
fn place_in_file(place: &str) -> &str {
    let end = place.match_indices(',').nth(1).map_or(place.len(), |m| m.0);
    &place[..end]
}

fn write_size(table: &mut String, pattern: &Pattern, name: &str, body: &Measurements) {
    let line = |table: &mut String, text: String| {
        table.push_str(&text);
        table.push('\n');
    };
    line(table, format!("size {name:?}"));
    let (draft, _) = pattern.resolve(body);
    let mut found = pattern.check(body);
    found.retain(|diagnostic| diagnostic.code != Code::InsideOut);
    let unsound = found.iter().any(|d| d.severity == Severity::Error);
    for text in said(pattern, &found) {
        line(table, text);
    }
    if unsound {
        return;
    }
    for piece in &draft.pieces {
        // Copies and mirror images follow from the first.
        if piece.id.copy > 1 {
            continue;
        }
        let sewn = if piece.sewn { "sewn" } else { "cut" };
        let words = format!("piece {:?} {sewn} {}", piece.name, piece.fabric);
        line(table, with_numbers(words, &[piece.grain]));
        for edge in piece.outline.iter().chain(piece.holes.iter().flatten()) {
            line(table, edge_line(pattern, piece, edge));
        }
        for inside in &piece.internal_lines {
            let panel = pattern.panel(piece.id.panel);
            let named = panel.and_then(|p| match inside.name {
                Name::Drawn(id) => p.line(id),
                Name::Made { .. } => None,
            });
            let words = format!("line {:?}", named.map_or("", |l| &l.name));
            let places = inside
                .curves
                .iter()
                .flat_map(|curve| [curve.start(), curve.point(0.5), curve.end()]);
            let numbers: Vec<f64> = places.flat_map(|p| [p.x, p.y]).collect();
            line(table, with_numbers(words, &numbers));
        }
        for notch in &piece.notches {
            let panel = pattern.panel(piece.id.panel);
            let named = panel.and_then(|p| p.notches.iter().find(|n| n.id == notch.id));
            let (p, d) = (notch.point, notch.inward);
            let words = format!("notch {:?}", named.map_or("", |n| &n.name));
            line(table, with_numbers(words, &[p.x, p.y, d.x, d.y]));
        }
    }
    for seam in &draft.seams {
        let kind = match seam.id {
            SeamOrigin::Seam(_) => "seam",
            SeamOrigin::Dart { .. } => "dart seam",
        };
        let [a, b] = seam.sides.each_ref().map(|side| side_length(&draft, side));
        let [c, d] = seam.sides.each_ref().map(|side| first_point(&draft, side));
        let words = format!("{kind} {:?}", seam.name);
        line(table, with_numbers(words, &[a, b, c.x, c.y, d.x, d.y]));
    }
    for ((sheet, point), place) in Evaluation::new(pattern, body).points() {
        let Some(sheet) = pattern.sheet(sheet) else {
            continue;
        };
        let name = sheet.point(point).map_or("", |p| &p.name);
        // Handles that version 1 did not have.
        if name.contains(" handle ") {
            continue;
        }
        let words = format!("point {:?} of {:?}", name, sheet.name);
        line(table, with_numbers(words, &[place.x, place.y]));
    }
}

/// Words and numbers with ten decimals, zeros at the end left out.
fn with_numbers(mut words: String, numbers: &[f64]) -> String {
    for number in numbers {
        let text = format!("{number:.10}");
        let text = text.trim_end_matches('0').trim_end_matches('.');
        let text = match text {
            "-0" => "0".to_owned(),
            _ => text.replacen("0.", ".", usize::from(number.abs() < 1.0)),
        };
        write!(words, " {text}").expect("text");
    }
    words
}

/// Findings, counted: severity, code and place.
fn said(pattern: &Pattern, found: &[Diagnostic]) -> Vec<String> {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for diagnostic in found {
        // Points and edges of version 1 were those of a panel.
        let place = pattern
            .describe(&diagnostic.place)
            .replace("sheet ", "panel ");
        let place = place.replace(", curve ", ", edge ");
        let (severity, code) = (diagnostic.severity, diagnostic.code);
        *counts
            .entry(format!("{severity} {code:?} at {place}"))
            .or_default() += 1;
    }
    counts
        .into_iter()
        .map(|(text, count)| format!("{text}, {count}"))
        .collect()
}

fn edge_line(pattern: &Pattern, piece: &Piece, edge: &PieceEdge) -> String {
    let panel = pattern.panel(piece.id.panel);
    let name = match (edge.origin.name, edge.origin.leg()) {
        (_, Some((dart, leg))) => {
            let found = panel.and_then(|p| p.operations.iter().find(|d| d.id == dart));
            format!("leg {leg} of {:?}", found.map_or("", |d| &d.name))
        }
        (Name::Drawn(edge), _) => {
            let found = panel.and_then(|p| p.edge(edge));
            format!("edge {:?}", found.map_or("", |e| &e.name))
        }
        (other, _) => format!("{other:?}"),
    };
    let reflected = edge.origin.half > 0;
    let half = if reflected { "other half" } else { "half" };
    let curve = &edge.curve;
    let (third, end) = (curve.point(0.3), curve.end());
    let words = format!("{name} {half}");
    let [length, allowance] = [curve.length(), edge.seam_allowance];
    with_numbers(words, &[third.x, third.y, end.x, end.y, length, allowance])
}

fn span_edge<'d>(draft: &'d Draft, span: &DraftSpan) -> &'d PieceEdge {
    let piece = &draft.pieces[span.piece];
    let mut edges = piece.outline.iter().chain(piece.holes.iter().flatten());
    edges.nth(span.edge).expect("spans name edges")
}

fn side_length(draft: &Draft, side: &[DraftSpan]) -> f64 {
    side.iter()
        .map(|span| (span.to - span.from).abs() * span_edge(draft, span).curve.length())
        .sum()
}

fn first_point(draft: &Draft, side: &[DraftSpan]) -> toile_geometry::Vec2 {
    let curve = &span_edge(draft, &side[0]).curve;
    curve.point(curve.parameter_at_length(side[0].from * curve.length()))
}
