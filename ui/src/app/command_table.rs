//! Every command of the window. Menus, keys, buttons, the palette and tests all go by this table.

use super::command::UiCommand;
use super::document_commands::DOCUMENT_COMMANDS;
use super::tool_commands::TOOL_COMMANDS;
use egui::{Key, KeyboardShortcut};

/// All commands, in the order of their menus.
pub fn commands() -> impl Iterator<Item = &'static UiCommand> {
    DOCUMENT_COMMANDS.iter().chain(TOOL_COMMANDS)
}

/// The command with that name.
pub fn named(name: &str) -> Option<&'static UiCommand> {
    commands().find(|command| command.name == name)
}

/// Keys that are no commands now.
#[derive(Clone, Copy, Debug, Default)]
pub struct KeysTaken {
    /// Text is typed: all but those with a command key.
    pub typing: bool,
    /// A tool takes numbers: those a number begins with.
    pub numbers: bool,
    /// A tool is under way: Escape goes a step back in it.
    pub busy: bool,
}

/// Whether a number can begin with a key.
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

/// Commands whose keys were pressed in this frame.
pub fn pressed(context: &egui::Context, keys: KeysTaken) -> Vec<&'static UiCommand> {
    // Keys with more modifiers first: a key without them matches those with them too.
    let mut keyed: Vec<(&UiCommand, KeyboardShortcut)> = commands()
        .filter_map(|command| Some((command, command.key?)))
        .collect();
    let modifiers =
        |key: &KeyboardShortcut| u8::from(key.modifiers.shift) + u8::from(key.modifiers.command);
    keyed.sort_by_key(|(_, key)| std::cmp::Reverse(modifiers(key)));
    let mut pressed = Vec::new();
    context.input_mut(|input| {
        for (command, key) in keyed {
            let plain = !key.modifiers.command;
            let waits = keys.typing && plain
                || keys.numbers && plain && begins_number(key.logical_key)
                || keys.busy && key.logical_key == Key::Escape;
            if !waits && input.consume_shortcut(&key) {
                pressed.push(command);
            }
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
