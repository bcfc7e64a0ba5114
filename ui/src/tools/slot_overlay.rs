//! Overlay marks and hints of a slot tool.

use super::answering::answer;
use super::slots::{Answer, ChainEdge, Fields, SlotKind, SlotState, SlotTool, slot};
use super::typing::{Typable, Way};
use super::{Overlay, Reading, along, number};
use crate::canvas::placed::Placed;
use crate::canvas::selection::Item;
use toile_geometry::Vec2;
use toile_pattern::{Number, SheetId, Want};

/// Longest line of notes at the pointer (bytes).
const LINE: usize = 44;

pub(super) fn overlay(tool: &SlotTool, state: &SlotState, reading: &Reading<'_>) -> Vec<Overlay> {
    let mut marks = given(state);
    let typable = Typable::new(tool, state, reading);
    let typed = typed_words(&typable, state);
    if !typable.handles.is_empty() {
        // The curve itself shows the effect of typed handle numbers.
        if let Some(pointer) = state.pointer.as_ref().filter(|_| !typed.is_empty()) {
            marks.push(Overlay::Words(pointer.sheet, pointer.at, typed));
        }
        return marks;
    }
    match answer(tool, state, reading) {
        Ok(found) => marks.extend(told(tool, state, reading, (found, typed))),
        Err(unanswered) => {
            if let Some(pointer) = state.pointer.as_ref().filter(|_| state.is_typing()) {
                marks.push(Overlay::Words(pointer.sheet, pointer.at, typed));
                let words = in_lines(&unanswered.words);
                marks.push(Overlay::Fault(pointer.sheet, pointer.at, words));
            }
        }
    }
    marks
}

/// Marks for the answers given so far.
fn given(state: &SlotState) -> Vec<Overlay> {
    let mut marks = Vec::new();
    for answer in &state.answers {
        match answer {
            Answer::Place(placed) | Answer::End(placed, ..) => {
                marks.push(Overlay::Dot(placed.sheet, placed.at));
            }
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
    marks
}

/// Text beside a place. While text is typed all of this text stays at the pointer, wherever the typed place
/// is, and the fields come first: so fields do not move while they are edited.
fn words_at(state: &SlotState, (sheet, at): (SheetId, Vec2), told: &str, typed: &str) -> Overlay {
    let pointer = state.pointer.as_ref().filter(|_| state.is_typing());
    let (sheet, at) = pointer.map_or((sheet, at), |pointer| (pointer.sheet, pointer.at));
    Overlay::Words(sheet, at, joined(&[typed, told]))
}

/// Marks for the present answer, and the text typed for it.
fn told(
    tool: &SlotTool,
    state: &SlotState,
    reading: &Reading<'_>,
    (found, typed): (Answer, String),
) -> Vec<Overlay> {
    let kind = slot(tool, state).kind;
    let unit = reading.evaluation.pattern().unit;
    let pointer = state.pointer.as_ref();
    let mut marks = Vec::new();
    match found {
        Answer::Place(placed) | Answer::Named(placed, _) => {
            marks.extend(placed_words(kind, state, reading, (&placed, typed)));
        }
        Answer::Number(given) => {
            let asked = match kind {
                SlotKind::Number { label, want, .. } => Some((label, want)),
                SlotKind::Numbers { label, .. } => Some((label, Want::Plain)),
                _ => None,
            };
            if let (Some(pointer), Some((label, want))) = (pointer, asked) {
                let place = (pointer.sheet, pointer.at);
                let words = number_words(state, reading, (label, &given, want));
                let words = joined(&[&words, &told_words(state)]);
                marks.push(words_at(state, place, &words, &typed));
            }
        }
        Answer::Numbers(lengths) => {
            if let Some(pointer) = pointer {
                let values = lengths.iter().filter_map(|number| {
                    let value = reading.evaluation.number(number, Want::Length)?;
                    Some(number::show(value, Want::Length, unit))
                });
                let words = in_lines(&format!("= {}", values.collect::<Vec<_>>().join(", ")));
                let words = joined(&[&words, &told_words(state)]);
                let place = (pointer.sheet, pointer.at);
                marks.push(words_at(state, place, &words, &typed));
            }
        }
        Answer::OnLine(panel, Item::Edge(_, edge), at, None) => {
            if let Some(pointer) = pointer {
                let told = along::told(reading, (panel, edge, at));
                let at = told.map_or(at, |(_, at)| at);
                marks.push(Overlay::Dot(pointer.sheet, at));
                let distance = told.map(|(distance, _)| number::show(distance, Want::Length, unit));
                let words = distance.unwrap_or_default();
                marks.push(words_at(state, (pointer.sheet, at), &words, &typed));
            }
        }
        Answer::OnLine(_, _, at, _)
        | Answer::Edge(_, _, at)
        | Answer::Curve(_, _, at)
        | Answer::End(Placed { at, .. }, ..) => {
            if let Some(pointer) = pointer {
                marks.push(Overlay::Dot(pointer.sheet, at));
                marks.push(words_at(state, (pointer.sheet, at), "", &typed));
            }
        }
        Answer::Inside(sheet, at, _) => marks.push(words_at(state, (sheet, at), "", &typed)),
        Answer::Chain(chain) => {
            marks.extend(chain.last().map(edge));
            if let (Some(pointer), Some(words)) = (pointer, &state.told) {
                marks.push(Overlay::Words(pointer.sheet, pointer.at, in_lines(words)));
            }
        }
        _ => {}
    }
    marks
}

/// Notes on the effect of the present answer, broken into lines.
fn told_words(state: &SlotState) -> String {
    let told = state.told.as_ref();
    told.map_or_else(String::new, |told| in_lines(told))
}

/// Text of a number; without its label while the field for typing, which shows the label, is there.
fn number_words(
    state: &SlotState,
    reading: &Reading<'_>,
    (label, given, want): (&str, &Number, Want),
) -> String {
    let unit = reading.evaluation.pattern().unit;
    let value = reading.evaluation.number(given, want);
    let value = value.map_or_else(String::new, |v| number::show(v, want, unit));
    let sign = if state.is_typing() { "=" } else { label };
    format!("{sign} {value}")
}

/// Text for the place of the present answer, with the text typed for it.
fn placed_words(
    kind: SlotKind,
    state: &SlotState,
    reading: &Reading<'_>,
    (placed, typed): (&Placed, String),
) -> Vec<Overlay> {
    let unit = reading.evaluation.pattern().unit;
    let length = |length: f64| number::show(length, Want::Length, unit);
    let mut marks = Vec::new();
    let mut words = vec![placed.words.clone()];
    if let Some(last) = state.last_place() {
        let way = placed.at - last.at;
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
    marks.push(Overlay::Dot(placed.sheet, placed.at));
    let place = (placed.sheet, placed.at);
    marks.push(words_at(state, place, &words.join("  "), &typed));
    marks
}

/// Texts that are not empty, one per line.
fn joined(lines: &[&str]) -> String {
    let lines = lines.iter().filter(|line| !line.is_empty());
    lines.copied().collect::<Vec<_>>().join("\n")
}

fn edge((panel, edge): &ChainEdge) -> Overlay {
    Overlay::Edge(*panel, *edge)
}

/// A sentence broken into lines that are short enough to stand beside the pointer.
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

/// The typed fields, one per line, with a cursor in the present field and a sign at a field with an error;
/// then the signs that choose other ways to type the answer.
fn typed_words(typable: &Typable, state: &SlotState) -> String {
    if !state.is_typing() {
        return String::new();
    }
    let typed = &state.typed;
    let is_told = |k: &usize| {
        let is_taken = match *k == typable.numbers() {
            true => typable.takes_name,
            false => typable.takes_numbers,
        };
        let is_filled = *k == typed.field || !typed.text(*k).is_empty();
        is_filled || !typed.naming && is_taken
    };
    let told = typable
        .fields
        .iter()
        .enumerate()
        .filter(|(k, _)| is_told(k));
    let mut lines: Vec<String> = told
        .map(|(k, field)| {
            let bar = if k == typed.field { "|" } else { "" };
            let sign = if typed.fault == Some(k) { "! " } else { "" };
            format!("{sign}{} {}{bar}", field.label, typed.text(k))
        })
        .collect();
    if typed.is_blank(typable.numbers()) && !typed.naming {
        lines.extend(other_ways(typable, typed.way));
    }
    lines.join("\n")
}

/// The signs that choose other ways to type a place, each with the numbers typed in that way; `None` if
/// there are no other ways.
fn other_ways(typable: &Typable, way: usize) -> Option<String> {
    let others = typable.ways.iter().enumerate().filter(|(k, _)| *k != way);
    let words = others.filter_map(|(_, way)| Some(format!("{} {}", way.sign()?, way.words())));
    let words = words.collect::<Vec<_>>().join("; ");
    (!words.is_empty()).then_some(words)
}

pub(super) fn hint(tool: &SlotTool, state: &SlotState, reading: &Reading<'_>) -> String {
    if let Some(words) = &state.refusal {
        return words.clone();
    }
    let asked = asked(tool, state, reading);
    match &state.told {
        Some(told) => format!("{told}. {asked}"),
        None => asked,
    }
}

/// Request to the user for an answer to the present slot.
fn asked(tool: &SlotTool, state: &SlotState, reading: &Reading<'_>) -> String {
    let typable = Typable::new(tool, state, reading);
    if state.is_typing() {
        // The pointer may be elsewhere, and the fields beside it out of sight: so the status line shows
        // them, too.
        let typed = typed_words(&typable, state).replace('\n', ", ");
        return format!("{typed}; Tab goes on, Enter takes it, Esc takes it back");
    }
    let slot = slot(tool, state);
    if !typable.handles.is_empty() {
        let labels: Vec<&str> = typable.handles.iter().map(|h| &*h.label).collect();
        return format!(
            "Type {} (a formula begins with =), Enter; or its 'name, Enter. {}",
            labels.join(", Tab, "),
            slot.hint
        );
    }
    let names = match (typable.takes_name, state.newest()) {
        (true, Some(newest)) => {
            let words = newest.words(reading.evaluation.pattern());
            let words = words.unwrap_or_else(|| "the last".into());
            format!("; 'name, Enter names {words}")
        }
        (true, None) => "; 'name before it names it".to_owned(),
        (false, _) => String::new(),
    };
    let ends = match slot.kind {
        SlotKind::Places => "; Enter ends",
        SlotKind::Chain => "; Shift-click to add the next edge of a chain",
        _ => "",
    };
    format!(
        "{}{}{names}{ends}; Esc goes a step back",
        slot.hint,
        numbers_hint(slot.hint, &typable)
    )
}

/// Hint on the numbers that can be typed, and on other ways to type a place.
fn numbers_hint(hint: &str, typable: &Typable) -> String {
    let fields = typable.fields.iter().take(typable.numbers());
    let labels: Vec<&str> = fields.map(|field| &*field.label).collect();
    match typable.ways.first() {
        None => String::new(),
        // Some numbers follow the pointer; the others can only be typed.
        Some(Way::Number(..)) if hint.starts_with("Type") => "; Enter takes it".to_owned(),
        Some(Way::Number(..)) => ", or type it; Enter takes it".to_owned(),
        Some(Way::Distance) => "; or type its distance from the nearer corner, Enter".to_owned(),
        Some(_) => {
            let other = other_ways(typable, 0);
            let other = other.map_or_else(String::new, |words| format!("; {words}"));
            let free = if cfg!(target_os = "macos") {
                "Cmd"
            } else {
                "Ctrl"
            };
            format!(
                "; or type {} (= begins a formula{other}), Enter; Tab next snap, Shift level, {free} \
                 free",
                labels.join(", Tab, "),
            )
        }
    }
}
