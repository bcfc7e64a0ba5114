//! The pattern view's input: pans and zooms, and turns pointer and keys into events of the tool.

use super::PatternView;
use crate::canvas::camera::ScreenPoint;
use crate::canvas::selection::Item;
use crate::tools::number::begins_typing;
use crate::tools::typing::{NAME_SIGN, WAY_SIGNS};
use crate::tools::{Event, LineStep, Tool, ToolModifiers};
use crate::views::marker::MarkerView;
use egui::{CursorIcon, EventFilter, Key, PointerButton, Response, Ui};

impl PatternView {
    /// Handles panning and zooming; returns whether the primary button pans too.
    pub(super) fn navigate(&mut self, ui: &Ui, response: &Response) -> bool {
        let with_space = response.contains_pointer()
            && !self.is_typed_into(ui)
            && !self.is_typing()
            && ui.input(|input| input.key_down(Key::Space));
        for button in [PointerButton::Middle, PointerButton::Secondary] {
            if response.dragged_by(button) {
                self.camera.pan(response.drag_delta());
            }
        }
        if with_space && response.dragged_by(PointerButton::Primary) && self.pressed.is_none() {
            self.camera.pan(response.drag_delta());
        }
        if let Some(at) = response.hover_pos() {
            let (scroll, pinch) =
                ui.input(|input| (input.smooth_scroll_delta.y, input.zoom_delta()));
            let factor = f64::from(scroll / 240.0).exp2() * f64::from(pinch);
            if factor != 1.0 {
                self.camera.zoom(response.rect, ScreenPoint(at), factor);
            }
        }
        with_space
    }

    /// Whether the keys go to another widget: a text field or another view; without a tool that takes keys, also
    /// a button or a list that has the focus.
    fn is_typed_into(&self, ui: &Ui) -> bool {
        let focused = ui.memory(|memory| memory.focused());
        let Some(id) = focused.filter(|id| *id != Self::id()) else {
            return false;
        };
        !self.tool.takes_keys() || id == MarkerView::id() || ui.ctx().text_edit_focused()
    }

    /// Input events since the last frame.
    pub(super) fn events(&mut self, ui: &Ui, response: &Response, panning: bool) -> Vec<Event> {
        let mut events = Vec::new();
        let modifiers = ui.input(|input| ToolModifiers {
            shift: input.modifiers.shift,
            command: input.modifiers.command,
        });
        let view = response.rect;
        let hovered = response.hover_pos().filter(|_| !panning);
        let was_there = self.pointer.is_some();
        if response.drag_started_by(PointerButton::Primary)
            && !panning
            && let Some(from) = ui.input(|input| input.pointer.press_origin())
        {
            self.pressed = Some(self.pointer_at(view, from, modifiers));
        }
        if response.clicked() || response.drag_started() {
            response.request_focus();
        }
        match (&self.pressed, response.interact_pointer_pos()) {
            (Some(from), Some(to)) => {
                let from = from.clone();
                let place = to;
                let to = self.pointer_at(view, to, modifiers);
                self.pointer = Some((to.sheet, to.at));
                if self.told.replace((place, modifiers)) != Some((place, modifiers)) {
                    events.push(Event::Drag(from, to));
                }
            }
            _ => match hovered {
                Some(at) => {
                    let pointer = self.pointer_at(view, at, modifiers);
                    self.hover = pointer.hit();
                    self.under = pointer.hits.iter().map(|hit| hit.item).collect();
                    self.pointer = Some((pointer.sheet, pointer.at));
                    if self.told.replace((at, modifiers)) != Some((at, modifiers)) {
                        events.push(Event::Hover(pointer));
                    }
                }
                None => {
                    self.hover = None;
                    self.under.clear();
                    self.pointer = None;
                    self.told = None;
                    if was_there {
                        events.push(Event::Leave);
                    }
                }
            },
        }
        if let Some(at) = response.interact_pointer_pos()
            && !panning
            && response.clicked()
        {
            let pointer = self.pointer_at(view, at, modifiers);
            events.push(match response.double_clicked() {
                true => Event::DoubleClick(pointer),
                false => Event::Click(pointer),
            });
        }
        // Escape cancels the drag.
        if self.pressed.is_some() && ui.input(|input| input.key_pressed(Key::Escape)) {
            self.pressed = None;
        }
        if self.pressed.is_some()
            && (response.drag_stopped() || !ui.input(|input| input.pointer.primary_down()))
        {
            self.pressed = None;
            events.push(Event::Drop);
        }
        if response.secondary_clicked() && self.is_busy() {
            events.push(Event::Enter);
        }
        events.extend(self.keys(ui, response));
        events
    }

    fn keys(&mut self, ui: &Ui, response: &Response) -> Vec<Event> {
        if self.wants_keys && !self.is_covered {
            self.wants_keys = false;
            response.request_focus();
        }
        // A key that ends typing into a field is not passed to the tool.
        let typed_now = self.is_typed_into(ui);
        let typed_before = std::mem::replace(&mut self.was_typed_into, typed_now);
        if typed_before {
            return Vec::new();
        }
        if self.is_covered || typed_now {
            return Vec::new();
        }
        let takes_tab = self.tool.takes_keys();
        if takes_tab {
            response.request_focus();
        }
        // Keys for the canvas must not move the focus of the window.
        let filter = EventFilter {
            tab: takes_tab,
            escape: true,
            horizontal_arrows: true,
            vertical_arrows: true,
        };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(Self::id(), filter));
        // Several characters may come in one frame: the first begins the typing, and the others continue
        // it.
        let mut typing = self.is_typing();
        let mut events = Vec::new();
        let mut chosen = false;
        ui.input_mut(|input| {
            // Keys that are no shortcut of a command type text.
            let free: Vec<Key> = input.events.iter().filter_map(pressed).collect();
            input.events.retain(|event| {
                let taken = match event {
                    egui::Event::Text(text) => {
                        let is_choice = text == "=" && self.pressed.is_some();
                        let is_typed =
                            self.tool.takes_keys() && (typing || self.begins(text, &free));
                        let takes = is_typed || is_choice;
                        typing |= is_typed;
                        chosen |= is_choice;
                        takes.then(|| Event::Text(text.clone()))
                    }
                    egui::Event::Key {
                        key, pressed: true, ..
                    } => match key {
                        Key::Enter => Some(Event::Enter),
                        Key::Tab => Some(Event::Tab),
                        Key::Backspace if typing => Some(Event::Backspace),
                        Key::Escape => Some(Event::Escape),
                        key if matches!(self.tool, Tool::Walk) => going(*key).map(Event::Go),
                        _ => None,
                    },
                    _ => None,
                };
                let is_taken = taken.is_some();
                events.extend(taken);
                !is_taken
            });
        });
        if chosen {
            // Updates the preview of the drag to the new choice, even though the pointer rests.
            self.told = None;
            ui.ctx().request_repaint();
        }
        events
    }

    /// Whether a text begins typed input of the tool in hand.
    fn begins(&self, text: &str, free: &[Key]) -> bool {
        let has_slots = matches!(self.tool, Tool::Slots(_));
        let is_sign = text.starts_with(NAME_SIGN) || text.starts_with(WAY_SIGNS);
        text.starts_with(begins_typing) || has_slots && (is_sign || is_words(text, free))
    }

    /// Sets the shape of the mouse cursor by the effect that a press would have.
    pub(super) fn cursor(&self, ui: &Ui, panning: bool, inside: bool) {
        if !inside || self.guide.is_some() {
            return;
        }
        let icon = match (self.tool, self.hover.map(|hit| hit.item)) {
            _ if panning => CursorIcon::Grab,
            (Tool::Slots(_) | Tool::Walk | Tool::Suggested, _) => CursorIcon::Crosshair,
            (_, Some(Item::Point(_) | Item::Panel(_) | Item::Sheet(_))) => CursorIcon::Move,
            (_, Some(Item::Guide(id))) => self.guide_cursor(id),
            (_, Some(_)) => CursorIcon::PointingHand,
            (_, None) => CursorIcon::Default,
        };
        ui.ctx().set_cursor_icon(icon);
    }
}

/// The key that an event presses; `None` for another event.
fn pressed(event: &egui::Event) -> Option<Key> {
    match event {
        egui::Event::Key {
            key, pressed: true, ..
        } => Some(*key),
        _ => None,
    }
}

/// Whether a text is typed input rather than the shortcut of a command: several characters at once, or the
/// letter of a key that is no shortcut.
fn is_words(text: &str, free: &[Key]) -> bool {
    let is_free =
        |text: &str| Key::from_name(&text.to_uppercase()).is_some_and(|key| free.contains(&key));
    !text.trim().is_empty() && (text.chars().count() > 1 || is_free(text))
}

/// Movement that a key makes along a walked seam; `None` for other keys.
fn going(key: Key) -> Option<LineStep> {
    Some(match key {
        Key::ArrowLeft | Key::ArrowDown => LineStep::Back,
        Key::ArrowRight | Key::ArrowUp => LineStep::On,
        Key::Home => LineStep::ToStart,
        Key::End => LineStep::ToEnd,
        _ => return None,
    })
}
