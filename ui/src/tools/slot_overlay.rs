//! The overlay and the hints of a tool of slots.

use super::slots::{
    Answer, ChainEdge, Fields, SlotKind, SlotState, SlotTool, answer, fields, slot,
};
use super::{Overlay, Reading, along, number};
use crate::canvas::selection::Item;
use toile_pattern::Want;

/// Bytes of a line at the pointer.
const LINE: usize = 44;

pub(super) fn overlay(tool: &SlotTool, state: &SlotState, reading: &Reading<'_>) -> Vec<Overlay> {
    let kind = slot(tool, state).kind;
    let mut marks = Vec::new();
    for answer in &state.answers {
        match answer {
            Answer::Place(placed) => marks.push(Overlay::Dot(placed.sheet, placed.at)),
            Answer::Places(places, ..) => {
                marks.extend(places.iter().map(|p| Overlay::Dot(p.sheet, p.at)));
            }
            Answer::Chain(chain) => marks.extend(chain.iter().map(edge)),
            _ => {}
        }
    }
    marks.extend(state.chain.iter().map(edge));
    for places in state.places.windows(2) {
        let line = places.iter().map(|placed| placed.at).collect();
        marks.push(Overlay::Line(places[0].sheet, line));
    }
    marks.extend(state.places.iter().map(|p| Overlay::Dot(p.sheet, p.at)));
    let unit = reading.evaluation.pattern().unit;
    let typed = typed_words(kind, state);
    match answer(kind, state, reading) {
        Ok(Answer::Place(placed) | Answer::Named(placed, _)) => {
            let mut words = vec![placed.words.clone()];
            if let Some(last) = state.last_place() {
                let way = placed.at - last.at;
                let length = |length: f64| number::show(length, Want::Length, unit);
                match kind {
                    SlotKind::Named(Fields::Size) => {
                        words.push(format!("{} x {}", length(way.x.abs()), length(way.y.abs())));
                    }
                    _ => {
                        marks.push(Overlay::Line(placed.sheet, vec![last.at, placed.at]));
                        words.push(length(way.norm()));
                        words.push(number::show(way.y.atan2(way.x), Want::Angle, unit));
                    }
                }
            }
            words.push(state.named.clone());
            words.retain(|word| !word.is_empty());
            let lines = [words.join("  "), typed];
            let lines = lines.into_iter().filter(|line| !line.is_empty());
            let lines = lines.collect::<Vec<_>>().join("\n");
            marks.push(Overlay::Dot(placed.sheet, placed.at));
            marks.push(Overlay::Words(placed.sheet, placed.at, lines));
        }
        Ok(Answer::Number(given)) => {
            if let (Some(pointer), SlotKind::Number { label, want, .. }) = (&state.pointer, kind) {
                let value = reading.evaluation.number(&given, want);
                let value = value.map_or_else(String::new, |v| number::show(v, want, unit));
                let words = format!("{label} {value}  {typed}");
                marks.push(Overlay::Words(
                    pointer.sheet,
                    pointer.at,
                    words.trim().into(),
                ));
            }
        }
        Ok(Answer::OnLine(panel, Item::Edge(_, edge), at, None))
            if matches!(kind, SlotKind::OnLine(Fields::Distance)) =>
        {
            if let Some(pointer) = &state.pointer {
                let told = along::told(reading, (panel, edge, at));
                let at = told.map_or(at, |(_, at)| at);
                marks.push(Overlay::Dot(pointer.sheet, at));
                let distance = told.map(|(distance, _)| number::show(distance, Want::Length, unit));
                marks.extend(distance.map(|words| Overlay::Words(pointer.sheet, at, words)));
            }
        }
        Ok(Answer::OnLine(_, _, at, _) | Answer::Edge(_, _, at) | Answer::Curve(_, _, at)) => {
            if let Some(pointer) = &state.pointer {
                marks.push(Overlay::Dot(pointer.sheet, at));
                if !typed.is_empty() {
                    marks.push(Overlay::Words(pointer.sheet, at, typed));
                }
            }
        }
        Ok(Answer::Inside(sheet, at, _)) if !typed.is_empty() => {
            marks.push(Overlay::Words(sheet, at, typed));
        }
        Ok(Answer::Chain(chain)) => {
            marks.extend(chain.last().map(edge));
            if let (Some(pointer), Some(words)) = (&state.pointer, &state.told) {
                marks.push(Overlay::Words(pointer.sheet, pointer.at, in_lines(words)));
            }
        }
        Ok(_) => {}
        Err(words) => {
            if let Some(pointer) = state.pointer.as_ref().filter(|_| state.is_typing()) {
                let words = format!("{typed}  {words}");
                marks.push(Overlay::Words(pointer.sheet, pointer.at, words));
            }
        }
    }
    marks
}

fn edge((panel, edge): &ChainEdge) -> Overlay {
    Overlay::Edge(*panel, *edge)
}

/// A sentence in lines short enough to stand at the pointer.
fn in_lines(words: &str) -> String {
    let mut lines = vec![String::new()];
    for word in words.split(' ') {
        if let Some(line) = lines.last_mut() {
            if line.is_empty() || line.len() + word.len() < LINE {
                line.push_str(if line.is_empty() { "" } else { " " });
                line.push_str(word);
            } else {
                lines.push(word.to_owned());
            }
        }
    }
    lines.join("\n")
}

/// What is typed, a line each, the one in hand with a bar.
fn typed_words(kind: SlotKind, state: &SlotState) -> String {
    if !state.is_typing() {
        return String::new();
    }
    let labels = fields(kind);
    let is_told = |k: &usize| !state.naming || *k == state.field || !state.typed[*k].is_empty();
    let told = labels.iter().enumerate().filter(|(k, _)| is_told(k));
    let words = told.map(|(k, (label, _))| {
        let bar = if k == state.field { "|" } else { "" };
        format!("{label} {}{bar}", state.typed[k])
    });
    words.collect::<Vec<_>>().join("\n")
}

pub(super) fn hint(tool: &SlotTool, state: &SlotState) -> String {
    if let Some(words) = state.refusal.as_ref().or(state.told.as_ref()) {
        return words.clone();
    }
    let slot = slot(tool, state);
    let labels: Vec<&str> = fields(slot.kind).iter().map(|(label, _)| *label).collect();
    let keys = match slot.kind {
        // Some numbers are shown at the pointer; the others are only typed.
        SlotKind::Number { .. } if slot.hint.starts_with("Type") => {
            "; Enter takes it; Esc goes a step back".to_owned()
        }
        SlotKind::Number { .. } => ", or type it; Enter takes it; Esc goes a step back".to_owned(),
        SlotKind::Places => {
            "; type length or =formula, Tab angle, or 'name; Enter ends; Esc goes a step back"
                .to_owned()
        }
        SlotKind::Inside => "; 'name before it names it; Esc goes a step back".to_owned(),
        SlotKind::Named(Fields::None) => "; 'name before it names it; Esc goes a step back".into(),
        SlotKind::OnLine(Fields::Distance) => {
            "; or type its distance from the nearer corner, Enter; Esc goes a step back".to_owned()
        }
        SlotKind::Chain => {
            "; Shift-click to add the next edge of a chain; Esc goes a step back".into()
        }
        _ if labels.is_empty() => "; Esc goes a step back".to_owned(),
        _ => format!(
            "; or type {} (a formula begins with ={}), Enter; Tab next snap, Shift level, {} free",
            labels.join(", Tab, "),
            match slot.kind {
                SlotKind::Named(_) => ", a name with '",
                _ => "",
            },
            if cfg!(target_os = "macos") {
                "Cmd"
            } else {
                "Ctrl"
            }
        ),
    };
    format!("{}{keys}", slot.hint)
}
