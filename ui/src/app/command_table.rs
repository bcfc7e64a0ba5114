//! Every command of the window. Menus, keys, buttons, the palette and tests all go by this table.

use super::command::{Menu, UiCommand};
use super::document_commands::DOCUMENT_COMMANDS;
use super::document_commands::FIT;
use super::tool_commands::TOOL_COMMANDS;
use crate::tools::number::begins_typing;
use crate::tools::typing::{NAME_SIGN, WAY_SIGNS};
use egui::{Key, KeyboardShortcut};

/// All commands, in the order of their menus.
pub fn commands() -> impl Iterator<Item = &'static UiCommand> {
    DOCUMENT_COMMANDS.iter().chain(TOOL_COMMANDS).copied()
}

/// The command with a name; tests and scripts of steps name commands so.
pub fn named(name: &str) -> Option<&'static UiCommand> {
    commands().find(|command| command.name == name)
}

/// Keys that have another use in this frame, and so start no command.
#[derive(Clone, Copy, Debug, Default)]
pub struct KeysTaken {
    /// Text is typed: takes all keys without the command modifier (Ctrl, Cmd).
    pub typing: bool,
    /// A text field has the focus: takes also the keys with the command modifier that edit text.
    pub text: bool,
    /// The focused text field is empty: Undo and Redo still go to the window.
    pub empty: bool,
    /// A tool is in hand: takes the keys that begin a number; view commands whose key is a letter or digit
    /// are not performed.
    pub tool: bool,
    /// A seam is walked: takes Home and End, which move along the seam.
    pub walks: bool,
    /// Takes Escape: it undoes a step of the tool in progress, or closes a menu.
    pub escape: bool,
    /// A dialog is open: takes all keys.
    pub modal: bool,
}

/// Whether a text field uses a key together with the command modifier.
fn edits_text(key: Key) -> bool {
    use Key::{A, C, V, X, Y, Z};
    matches!(key, A | C | V | X | Y | Z)
}

/// Whether a key with the command modifier undoes or redoes.
fn undoes(key: Key) -> bool {
    matches!(key, Key::Y | Key::Z)
}

/// Whether a key is one of F1 to F12, which type no text.
pub(super) fn is_function(key: Key) -> bool {
    use Key::{F1, F2, F3, F4, F5, F6, F7, F8, F9, F10, F11, F12};
    matches!(
        key,
        F1 | F2 | F3 | F4 | F5 | F6 | F7 | F8 | F9 | F10 | F11 | F12
    )
}

/// Whether a number can begin with the sign of a key.
fn begins_number(key: Key) -> bool {
    use Key::{
        Comma, Equals, Minus, Num0, Num1, Num2, Num3, Num4, Num5, Num6, Num7, Num8, Num9, Period,
        Plus,
    };
    matches!(
        key,
        Num0 | Num1
            | Num2
            | Num3
            | Num4
            | Num5
            | Num6
            | Num7
            | Num8
            | Num9
            | Comma
            | Equals
            | Minus
            | Period
            | Plus
    )
}

/// Commands whose keys were pressed in a frame.
#[derive(Default)]
pub struct Pressed {
    /// Commands to perform.
    pub commands: Vec<&'static UiCommand>,
    /// A view command that is not performed, because its key is a letter or digit and a tool is in hand.
    pub held: Option<&'static UiCommand>,
}

/// Whether a command changes a view and has a letter or digit as its key; such keys type text while a tool
/// is in hand.
fn is_view_letter(command: &UiCommand, key: Key) -> bool {
    matches!(command.menu, Menu::View | Menu::Garment) && !is_function(key) && key != Key::Home
}

/// Commands whose keys were pressed in this frame.
pub fn pressed(context: &egui::Context, keys: KeysTaken) -> Pressed {
    // Shortcuts with more modifiers first, because a shortcut without them matches a press with them too.
    let mut keyed: Vec<(&UiCommand, KeyboardShortcut)> = commands()
        .filter_map(|command| Some((command, command.key?)))
        .collect();
    let modifiers =
        |key: &KeyboardShortcut| u8::from(key.modifiers.shift) + u8::from(key.modifiers.command);
    keyed.sort_by_key(|(_, key)| std::cmp::Reverse(modifiers(key)));
    let mut pressed = Pressed::default();
    context.input_mut(|input| {
        // Several letters may come in one frame: if one begins a number, formula or name, the others are
        // part of it.
        let begun = keys.tool
            && input.events.iter().any(|event| match event {
                egui::Event::Text(text) => {
                    text.starts_with(begins_typing)
                        || text.starts_with(NAME_SIGN)
                        || text.starts_with(WAY_SIGNS)
                }
                _ => false,
            });
        for (command, key) in keyed {
            let plain = !key.modifiers.command && !is_function(key.logical_key);
            let waits = keys.modal
                || (keys.typing || begun) && plain
                || keys.text
                    && edits_text(key.logical_key)
                    && !(keys.empty && undoes(key.logical_key))
                || keys.tool && plain && begins_number(key.logical_key)
                || keys.escape && key.logical_key == Key::Escape;
            if waits || !input.consume_shortcut(&key) {
                continue;
            }
            match keys.tool && plain && is_view_letter(command, key.logical_key) {
                true => pressed.held = Some(command),
                false => pressed.commands.push(command),
            }
        }
        let is_home_free = !(keys.modal || keys.text || keys.walks);
        if is_home_free && input.consume_key(egui::Modifiers::NONE, Key::Home) {
            pressed.commands.push(&FIT);
        }
    });
    pressed
}

#[cfg(test)]
mod tests {
    use super::super::command::Menu;
    use super::*;

    #[test]
    fn names_and_keys_are_all_different() {
        for (k, one) in commands().enumerate() {
            for other in commands().skip(k + 1) {
                assert_ne!(one.name, other.name);
                let same = one.key.is_some() && one.key == other.key;
                assert!(!same, "{} and {}", one.name, other.name);
            }
            assert!(!one.tip.is_empty());
        }
    }

    #[test]
    fn commands_of_a_menu_stand_together() {
        let mut menus: Vec<Menu> = commands().map(|command| command.menu).collect();
        menus.dedup();
        assert_eq!(menus, Menu::ALL);
    }
}
