//! Transitions of a slot tool: hovering, typing, accepting answers, steps back. Typed text is either
//! applied to the document, or stays in its field with the error.

use super::answering::answer;
use super::newest;
use super::refusal::Unanswered;
use super::slots::{Answer, Plan, SlotKind, SlotState, SlotTool, is_complete, slot, usual};
use super::typing::{Typable, is_named};
use super::{Event, Outcome, PreviewChange, Reading};
use crate::canvas::placed::Placed;

/// Distance from the first of several places within which a click closes the shape (pixels).
const CLOSES: f64 = 9.0;

pub(super) fn step(
    tool: &'static SlotTool,
    state: &SlotState,
    event: &Event,
    reading: &Reading<'_>,
) -> (SlotState, Outcome) {
    let mut next = state.clone();
    next.refusal = None;
    let mut outcome = Outcome::default();
    match event {
        Event::Hover(pointer) | Event::Drag(_, pointer) => {
            if next.pointer.as_ref().is_none_or(|old| old.at != pointer.at) {
                next.snap = 0;
            }
            next.pointer = Some(pointer.clone());
        }
        Event::Leave => next.pointer = None,
        Event::Click(pointer) | Event::DoubleClick(pointer) => {
            next.pointer = Some(pointer.clone());
            outcome = clicked(tool, &mut next, reading);
        }
        Event::Enter => outcome = entered(tool, &mut next, reading),
        Event::Text(text) => {
            if let Err(mut untaken) = Typable::new(tool, state, reading).take(&mut next, text) {
                untaken.words = format!("{}. {}", untaken.words, slot(tool, state).hint);
                outcome = refused(&mut next, untaken);
            }
        }
        Event::Backspace => Typable::new(tool, state, reading).take_back(&mut next),
        Event::Tab => match next.is_typing() {
            true => Typable::new(tool, state, reading).next(&mut next),
            false => next.snap += 1,
        },
        Event::Escape => outcome.done = !back(&mut next),
        Event::Drop | Event::Go(_) => {}
    }
    next.told = None;
    if outcome.commit.is_none() {
        outcome.shown = PreviewChange::Nothing;
        if let Some(plan) = shown(tool, &next, reading) {
            outcome.shown = PreviewChange::Edits(plan.edits);
            next.told = plan.told;
        }
    }
    next.refusal = outcome.refusal.clone();
    outcome.gets_on = outcome.refusal.is_none()
        && matches!(
            event,
            Event::Click(_) | Event::DoubleClick(_) | Event::Enter | Event::Escape
        );
    (next, outcome)
}

/// Goes one step back: clears the typed text, or takes back the last answer. Returns whether there was a
/// step to take back.
fn back(state: &mut SlotState) -> bool {
    let goes = if state.is_typing() {
        state.clear_typed();
        true
    } else {
        state.places.pop().is_some() || state.chain.pop().is_some() || state.answers.pop().is_some()
    };
    if state.places.is_empty() {
        state.named.clear();
    }
    goes
}

fn refused(state: &mut SlotState, unanswered: Unanswered) -> Outcome {
    if let Some(field) = unanswered.field {
        state.typed.fault = Some(field);
        state.typed.field = field;
    }
    Outcome {
        refusal: Some(unanswered.words),
        ..Outcome::default()
    }
}

/// Handles a click: begins the next part. Refuses while text is typed that belongs to the part made last.
fn clicked(tool: &'static SlotTool, state: &mut SlotState, reading: &Reading<'_>) -> Outcome {
    let typable = Typable::new(tool, state, reading);
    let is_named = is_named(slot(tool, state).kind);
    let sets_handles = !typable.handles.is_empty() && !state.typed.is_blank(typable.numbers());
    let names = state.newest().is_some() && !is_named && !typable.typed_name(state).is_empty();
    if sets_handles || names {
        let field = state.typed.field;
        let words = "Enter takes what is typed for what was made last; then click for the next";
        return refused(
            state,
            Unanswered {
                field: Some(field),
                words: words.into(),
            },
        );
    }
    if !typable.handles.is_empty() {
        // The typed name is for the next part.
        state.named = typable.typed_name(state).to_owned();
        state.made = None;
        state.clear_typed();
    }
    accept(tool, state, reading, false)
}

/// Handles Enter: accepts the typed text, which may belong to the part made last.
fn entered(tool: &'static SlotTool, state: &mut SlotState, reading: &Reading<'_>) -> Outcome {
    let typable = Typable::new(tool, state, reading);
    let Some(newest) = state.newest() else {
        return accept(tool, state, reading, true);
    };
    let name = typable.typed_name(state).to_owned();
    let is_blank = state.typed.is_blank(typable.numbers());
    if !typable.handles.is_empty() && !is_blank {
        let text = |k: usize| state.typed.text(k).trim().to_owned();
        let edits = newest::set_handles(&typable.handles, text, reading);
        let mut edits = match edits {
            Ok(edits) => edits,
            Err((field, words)) => {
                let field = Some(field);
                return refused(state, Unanswered { field, words });
            }
        };
        if !name.is_empty() {
            match newest::rename(newest, &name, reading) {
                Ok(more) => edits.extend(more),
                Err(error) => return refused(state, misnamed(&typable, &error.to_string())),
            }
        }
        state.clear_typed();
        state.settled = true;
        return committed(edits, "Set handles");
    }
    if !name.is_empty() && is_blank {
        return match newest::rename(newest, &name, reading) {
            Ok(edits) => {
                state.clear_typed();
                committed(edits, "Rename")
            }
            Err(error) => refused(state, misnamed(&typable, &error.to_string())),
        };
    }
    if !name.is_empty() && !is_named(slot(tool, state).kind) {
        let words = "Enter gives a name to what was made last: type numbers after it";
        return refused(state, misnamed(&typable, words));
    }
    if !typable.handles.is_empty() {
        state.settled = true;
        return Outcome::default();
    }
    accept(tool, state, reading, true)
}

fn misnamed(typable: &Typable, words: &str) -> Unanswered {
    Unanswered {
        field: Some(typable.numbers()),
        words: format!("name: {words}"),
    }
}

fn committed(edits: Vec<toile_pattern::Edit>, label: &str) -> Outcome {
    Outcome {
        commit: (!edits.is_empty()).then(|| (edits, label.to_owned())),
        ..Outcome::default()
    }
}

/// Accepts the present answer; after the last answer makes the plan.
fn accept(
    tool: &'static SlotTool,
    state: &mut SlotState,
    reading: &Reading<'_>,
    by_key: bool,
) -> Outcome {
    let before = state.clone();
    let given = match slot(tool, state).kind {
        SlotKind::Places => accept_place(tool, state, reading, by_key),
        _ => accept_answer(tool, state, reading, by_key),
    };
    match given {
        Ok(true) => {}
        Ok(false) => return Outcome::default(),
        Err(unanswered) => return refused(state, named(tool, state, reading, unanswered)),
    }
    state.clear_typed();
    state.chain.clear();
    if !is_complete(tool, &state.answers) {
        return Outcome::default();
    }
    match (tool.plan)(&state.answers, reading) {
        Ok(plan) => {
            let made = plan.select.single();
            state.made = made.filter(|_| !plan.edits.is_empty());
            state.settled = false;
            state.answers = plan.again;
            state.named.clear();
            Outcome {
                commit: Some((plan.edits, plan.label)),
                select: Some(plan.select),
                ..Outcome::default()
            }
        }
        Err(error) => {
            // The last slot is asked for again, with its typed text.
            *state = before;
            let unanswered = named(tool, state, reading, error.to_string().into());
            refused(state, unanswered)
        }
    }
}

/// Adds the name of the field to an error in typed text.
fn named(
    tool: &SlotTool,
    state: &SlotState,
    reading: &Reading<'_>,
    unanswered: Unanswered,
) -> Unanswered {
    if !state.is_typing() {
        return unanswered;
    }
    let typable = Typable::new(tool, state, reading);
    let field = unanswered.field.unwrap_or(state.typed.field);
    let label = typable.fields.get(field).map_or("", |field| &*field.label);
    let words = match unanswered.words.starts_with(&format!("{label}:")) {
        true => unanswered.words,
        false => format!("{label}: {}", unanswered.words),
    };
    Unanswered {
        field: Some(field),
        words,
    }
}

/// Accepts the answer to a slot; returns whether the slot is complete. It is not complete after a Shift-click
/// that adds an edge to a chain.
fn accept_answer(
    tool: &SlotTool,
    state: &mut SlotState,
    reading: &Reading<'_>,
    by_key: bool,
) -> Result<bool, Unanswered> {
    let adds = state.pointer.as_ref().is_some_and(|at| at.modifiers.shift);
    let typable = Typable::new(tool, state, reading);
    match answer(tool, state, reading)? {
        Answer::Chain(chain) if adds && !by_key => {
            state.chain = chain;
            Ok(false)
        }
        answer => {
            state.pointed = state.typed.is_blank(typable.numbers());
            state.answers.push(answer);
            Ok(true)
        }
    }
}

/// Accepts one of several places, or the end of the places; returns whether they have ended.
fn accept_place(
    tool: &SlotTool,
    state: &mut SlotState,
    reading: &Reading<'_>,
    by_key: bool,
) -> Result<bool, Unanswered> {
    let typable = Typable::new(tool, state, reading);
    // A name alone gives no place: Enter after a name ends the places.
    let ends = by_key && state.typed.is_blank(typable.numbers());
    let named = match typable.typed_name(state) {
        "" => state.named.clone(),
        typed => typed.to_owned(),
    };
    let given = match ends {
        true => None,
        false => match answer(tool, state, reading)? {
            Answer::Place(placed) => Some(placed),
            _ => None,
        },
    };
    let numbers = typable.numbers();
    let closes = given
        .as_ref()
        .is_some_and(|given| closes(state, given, numbers));
    if let Some(placed) = given.filter(|_| !closes) {
        state.places.push(placed);
        state.clear_typed();
        state.named = named;
        return Ok(false);
    }
    if state.places.len() < 2 {
        // The typed name is stored while further places are given.
        if state.is_typing() && !named.is_empty() {
            state.clear_typed();
            state.named = named;
            return Ok(false);
        }
        return Err("click at least two places first, or type their numbers".into());
    }
    let places = std::mem::take(&mut state.places);
    let name = (!named.is_empty()).then_some(named);
    state.answers.push(Answer::Places(places, closes, name));
    Ok(true)
}

/// Whether a place closes the shape, because it lies on the first of the several places; `numbers` is the
/// number of fields for numbers.
fn closes(state: &SlotState, given: &Placed, numbers: usize) -> bool {
    let pointer = state.pointer.as_ref();
    let near = pointer.map_or(0.0, |pointer| CLOSES * pointer.pixel);
    // A typed place must lie on the first exactly; a name that is being typed does not matter.
    let near = match state.typed.is_blank(numbers) {
        true => near,
        false => 1e-9,
    };
    let first = state.places.first();
    first.is_some_and(|first| state.places.len() > 2 && (given.at - first.at).norm() <= near)
}

/// The plan to preview, made with the present answer.
fn shown(tool: &SlotTool, state: &SlotState, reading: &Reading<'_>) -> Option<Plan> {
    let typable = Typable::new(tool, state, reading);
    if !typable.handles.is_empty() && !state.typed.is_blank(typable.numbers()) {
        let text = |k: usize| state.typed.text(k).trim().to_owned();
        return Some(Plan {
            edits: newest::set_handles(&typable.handles, text, reading).ok()?,
            label: String::new(),
            select: reading.selection.clone(),
            again: Vec::new(),
            told: None,
        });
    }
    let kind = slot(tool, state).kind;
    // If the present slot and all later ones are number slots, the plan is previewed with the defaults of
    // the later ones.
    let rest = tool.slots.iter().skip(state.answers.len() + 1);
    let rest = rest.map(usual).collect::<Option<Vec<Answer>>>()?;
    let is_number = matches!(kind, SlotKind::Number { .. } | SlotKind::Numbers { .. });
    if matches!(kind, SlotKind::Places) || !(is_number || rest.is_empty()) {
        return None;
    }
    let mut answers = state.answers.clone();
    answers.push(answer(tool, state, reading).ok()?);
    if !is_complete(tool, &answers) {
        answers.extend(rest);
    }
    (tool.plan)(&answers, reading).ok()
}
