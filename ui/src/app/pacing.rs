//! Input in the order it was given, however slow the frames are. Within one frame the toolkit moves
//! the focus after it has told the old field what was typed: of `84`, Tab, `92` that all come while
//! a frame is drawn, the `9` would join the `84`. So a frame gets no more than a hand does between
//! two looks: what comes after a key or a click that may move the focus waits for a later frame.

use super::command_table::is_function;
use egui::{Context, Event, Key, Plugin, RawInput};
use std::collections::VecDeque;

/// Events that wait for their frame.
#[derive(Default)]
pub struct Pacing {
    waiting: VecDeque<Event>,
    /// Whether the frame before ended with something that may move the focus: the views need a
    /// frame to show where it went.
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
    /// Whether an event is the press of a key that waits already and was not let go since: a key that
    /// is held down does no more than there are frames for, and nothing after it is let go.
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

/// Whether what is typed after an event may be meant for another field than what is typed before.
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
