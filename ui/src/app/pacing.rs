//! Delays input that follows a change of focus to the next frame, because egui delivers text before it moves
//! the focus: of `84`, Tab, `92` that all come in one frame, the `9` would otherwise join the `84`.

use super::command_table::is_function;
use egui::{Context, Event, Key, Plugin, RawInput};
use std::collections::VecDeque;

/// Events that wait for a later frame.
#[derive(Default)]
pub struct Pacing {
    waiting: VecDeque<Event>,
    /// Whether the last frame ended with an event that can move the focus: then the views need a frame to
    /// move it before the next event.
    rests: bool,
}

impl Plugin for Pacing {
    fn debug_name(&self) -> &'static str {
        "pacing"
    }

    fn input_hook(&mut self, context: &Context, input: &mut RawInput) {
        for event in input.events.drain(..) {
            if !self.is_repeated(&event) {
                self.waiting.push_back(event);
            }
        }
        if !std::mem::take(&mut self.rests) {
            let last = self.waiting.iter().position(may_move_focus);
            let count = last.map_or(self.waiting.len(), |last| last + 1);
            input.events.extend(self.waiting.drain(..count));
            self.rests = last.is_some();
        }
        if self.rests || !self.waiting.is_empty() {
            context.request_repaint();
        }
    }
}

impl Pacing {
    /// Whether an event repeats a key press that already waits, without a release since: a key that is
    /// held down acts at most once a frame, so that it does not delay what follows.
    fn is_repeated(&self, event: &Event) -> bool {
        let Event::Key {
            key, pressed: true, ..
        } = event
        else {
            return false;
        };
        let mut presses = self
            .waiting
            .iter()
            .rev()
            .filter_map(|waiting| match waiting {
                Event::Key {
                    key: other,
                    pressed,
                    ..
                } if other == key => Some(*pressed),
                _ => None,
            });
        may_move_focus(event) && presses.next() == Some(true)
    }
}

/// Whether text typed after an event can go to another field than text typed before it.
fn may_move_focus(event: &Event) -> bool {
    match event {
        Event::PointerButton { pressed, .. } => !pressed,
        Event::Key {
            key,
            pressed: true,
            modifiers,
            ..
        } => {
            matches!(key, Key::Enter | Key::Tab | Key::Escape)
                || modifiers.command
                || is_function(*key)
        }
        _ => false,
    }
}
