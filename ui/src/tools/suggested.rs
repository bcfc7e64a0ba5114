//! Suggested seams: candidates are drawn one after another, and the shown one is accepted by a key. Nothing is
//! sewn unasked.

use super::{Event, Outcome, Overlay, Reading, Tone};
use crate::canvas::selection::{Item, Selection};
use crate::canvas::suggested::edge_lines;
use toile_geometry::Vec2;
use toile_pattern::plan::{SeamSuggestions, SewnEdge, SuggestedSeam, accept_seams};
use toile_pattern::{EdgeId, PanelId, PartId};
use toile_session::Shown;

/// Candidates of a selected edge that are drawn beside the shown one.
const MAX_DRAWN: usize = 4;
/// Height of the arc between two edges, as a part of their distance (1).
const RISE: f64 = 0.18;
/// Chords of an arc.
const CHORDS: usize = 24;

/// State of the tool.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SuggestedState {
    /// Index of the shown candidate among those for the selection.
    shown: usize,
}

/// Indices of the suggested seams for the selection: the partners of a selected edge by rank; those of a
/// selected panel; all, if neither is selected.
fn choices(suggestions: &SeamSuggestions, selection: &Selection) -> Vec<usize> {
    let all = 0..suggestions.seams.len();
    match selection.single() {
        Some(Item::Edge(panel, edge)) => of_edge(suggestions, panel, edge),
        Some(Item::Panel(panel)) => {
            let touches = |k: &usize| {
                let mut edges = suggestions.seams[*k].edges().flatten();
                edges.any(|edge| edge.panel == panel)
            };
            all.filter(touches).collect()
        }
        _ => all.collect(),
    }
}

/// Suggested seams of an edge on any copy and half of its panel, those of the first copy and half first.
fn of_edge(suggestions: &SeamSuggestions, panel: PanelId, edge: EdgeId) -> Vec<usize> {
    let open = suggestions.open.iter();
    let mut own: Vec<&SewnEdge> = open
        .filter(|open| open.panel == panel && open.edge == edge)
        .collect();
    own.sort_by_key(|open| (open.copy, open.half));
    let mut found = Vec::new();
    for (_, seam) in own.into_iter().flat_map(|edge| suggestions.partners(*edge)) {
        if !found.contains(&seam) {
            found.push(seam);
        }
    }
    found
}

pub(super) fn step(
    state: SuggestedState,
    event: &Event,
    reading: &Reading<'_>,
) -> (SuggestedState, Outcome) {
    let mut outcome = Outcome::default();
    let first = SuggestedState::default();
    if let Event::Click(pointer) | Event::DoubleClick(pointer) = event {
        let items = pointer.hits.iter().map(|hit| hit.item);
        let edge = items.clone().find(|item| matches!(item, Item::Edge(..)));
        let item = edge.or(items.clone().find(|item| matches!(item, Item::Panel(_))));
        outcome.select = Some(item.map_or_else(Selection::default, Selection::one));
        outcome.gets_on = true;
        return (first, outcome);
    }
    let found = reading.scene.suggested(reading.evaluation);
    let suggestions = match &*found {
        Ok(suggestions) => suggestions,
        Err(words) => {
            outcome.refusal = Some(words.clone());
            return (first, outcome);
        }
    };
    let choices = choices(suggestions, reading.selection);
    let shown = choices.get(state.shown % choices.len().max(1));
    match (event, shown) {
        (Event::Tab, Some(_)) => {
            outcome.gets_on = true;
            let shown = (state.shown + 1) % choices.len();
            return (SuggestedState { shown }, outcome);
        }
        (Event::Enter, Some(&shown)) => {
            let pairs: Vec<[SewnEdge; 2]> = suggestions.seams[shown].edges().collect();
            match accept_seams(reading.evaluation, &pairs) {
                Ok((edits, seams)) => {
                    let label = match seams.len() {
                        1 => "Sew suggested seam",
                        _ => "Sew suggested seams on both sides",
                    };
                    outcome.commit = Some((edits, label.to_owned()));
                    outcome.select = Some(Selection::default());
                    outcome.gets_on = true;
                }
                Err(error) => outcome.refusal = Some(error.to_string()),
            }
            return (first, outcome);
        }
        (Event::Enter | Event::Tab, None) => {
            outcome.refusal = Some(nothing(reading.selection).to_owned());
        }
        (Event::Escape, _) => outcome.done = true,
        _ => {}
    }
    (state, outcome)
}

/// Words for a selection without candidates.
fn nothing(selection: &Selection) -> &'static str {
    match selection.single() {
        Some(Item::Edge(..)) => "the edge is sewn already, or nothing fits it: click another",
        Some(Item::Panel(_)) => "no edge of the panel has a candidate: click another panel",
        _ => "every edge is sewn, or nothing fits it",
    }
}

pub(super) fn hint(state: SuggestedState, reading: &Reading<'_>) -> String {
    let found = reading.scene.suggested(reading.evaluation);
    let Ok(suggestions) = &*found else {
        return String::new();
    };
    let choices = choices(suggestions, reading.selection);
    let Some(&shown) = choices.get(state.shown % choices.len().max(1)) else {
        return nothing(reading.selection).to_owned();
    };
    let number = state.shown % choices.len() + 1;
    format!(
        "Candidate {number} of {}: {}. Enter sews it, Tab shows the next, a click on an edge its own candidates",
        choices.len(),
        words(&suggestions.seams[shown], reading)
    )
}

/// A suggested seam in words: edges with their lengths.
fn words(seam: &SuggestedSeam, reading: &Reading<'_>) -> String {
    let pattern = reading.evaluation.pattern();
    let shown = Shown(pattern.unit);
    let named = |edge: SewnEdge| {
        let panel = pattern.panel(edge.panel).map_or("", |panel| &panel.name);
        let owner = pattern.owner_of(edge.panel, PartId::Edge(edge.edge));
        let drawn = owner.and_then(|owner| owner.edge(edge.edge));
        format!("{panel} {}", drawn.map_or("", |edge| &edge.name))
    };
    let Some(pair) = seam.pairs.first() else {
        return String::new();
    };
    let [one, two] = pair.edges.map(named);
    let [a, b] = pair.lengths.map(|length| shown.length(length));
    let both = match seam.pairs.len() {
        1 => "",
        _ => ", on both sides",
    };
    format!("{one} ({a}) to {two} ({b}){both}")
}

pub(super) fn overlay(state: SuggestedState, reading: &Reading<'_>) -> Vec<Overlay> {
    let found = reading.scene.suggested(reading.evaluation);
    let Ok(suggestions) = &*found else {
        return Vec::new();
    };
    let choices = choices(suggestions, reading.selection);
    let Some(current) = (!choices.is_empty()).then(|| state.shown % choices.len()) else {
        return Vec::new();
    };
    let mut marks = Vec::new();
    // All candidates of one edge are drawn, each with its rank.
    if matches!(reading.selection.single(), Some(Item::Edge(..))) {
        for (k, seam) in choices.iter().enumerate().take(MAX_DRAWN) {
            if k != current {
                marks.extend(drawn(
                    &suggestions.seams[*seam],
                    k + 1,
                    Tone::Plain,
                    reading,
                ));
            }
        }
    }
    let seam = &suggestions.seams[choices[current]];
    marks.extend(drawn(seam, current + 1, Tone::Good, reading));
    marks
}

/// The edges of a suggested seam, and a dashed arc between them with its rank.
fn drawn(seam: &SuggestedSeam, rank: usize, tone: Tone, reading: &Reading<'_>) -> Vec<Overlay> {
    let mut marks = Vec::new();
    for pair in &seam.pairs {
        let mut middles = Vec::new();
        for edge in pair.edges {
            let moved = reading.table_layout.panel(edge.panel);
            let lines = edge_lines(&reading.scene.draft, edge).into_iter();
            let lines = lines.map(|line| line.into_iter().map(|at| at + moved).collect::<Vec<_>>());
            let lines: Vec<Vec<Vec2>> = lines.collect();
            middles.extend(middle(&lines));
            if tone == Tone::Good {
                marks.extend(lines.into_iter().map(|line| Overlay::Stroke(line, tone)));
            }
        }
        // A copy that is not drawn on the table has no middle.
        if let [from, to] = middles[..] {
            let arc = arc(from, to);
            marks.push(Overlay::Label(arc[CHORDS / 2], rank.to_string(), tone));
            marks.push(Overlay::Thread(arc, tone));
        }
    }
    marks
}

/// The point half way along a row of polylines (m).
fn middle(lines: &[Vec<Vec2>]) -> Option<Vec2> {
    let chords = || lines.iter().flat_map(|line| line.windows(2));
    let total: f64 = chords().map(|chord| (chord[1] - chord[0]).norm()).sum();
    let mut left = 0.5 * total;
    for chord in chords() {
        let length = (chord[1] - chord[0]).norm();
        if left <= length && length > 0.0 {
            return Some(chord[0] + (chord[1] - chord[0]) * (left / length));
        }
        left -= length;
    }
    None
}

/// An arc between two places of the table that rises to the left of the way (m).
fn arc(from: Vec2, to: Vec2) -> Vec<Vec2> {
    let way = to - from;
    let top = (from + to) * 0.5 + Vec2::new(-way.y, way.x) * (2.0 * RISE);
    let at = |k: usize| {
        let t = k as f64 / CHORDS as f64;
        from * (1.0 - t).powi(2) + top * (2.0 * t * (1.0 - t)) + to * t.powi(2)
    };
    (0..=CHORDS).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arc_joins_its_ends_and_rises_between() {
        let (from, to) = (Vec2::new(1.0, 2.0), Vec2::new(3.0, 2.0));
        let arc = arc(from, to);
        assert_eq!((arc[0], arc[CHORDS]), (from, to));
        let top = arc[CHORDS / 2];
        assert!((top - Vec2::new(2.0, 2.0 + 2.0 * RISE)).norm() < 1e-12);
        let line = vec![Vec2::zeros(), Vec2::new(1.0, 0.0)];
        assert_eq!(middle(&[line]), Some(Vec2::new(0.5, 0.0)));
        assert_eq!(middle(&[]), None);
    }
}
