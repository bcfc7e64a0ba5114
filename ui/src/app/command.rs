//! A command of the window: name, key, condition and action.
//!
//! # Decided with
//! - [`crate::app::document_commands::DOCUMENT_COMMANDS`], [`crate::app::tool_commands::TOOL_COMMANDS`]: the
//!   tables of commands;
//! - [`crate::app::command_table::pressed`]: keys, and those that wait while something is typed;
//! - [`crate::views::pattern::PatternView::keys`] (`input.rs`), [`crate::tools::Tool::takes_keys`]: other
//!   keys; keys that go to a tool;
//! - [`crate::app::command::UiCommand::on_while`]: check marks;
//! - [`crate::app::ToileApp::canvas_menu`] (`bars.rs`): the menu on the canvas;
//! - [`crate::app::ToileApp::ask_find`] (`palette.rs`): commands found by name.
//!
//! `docs/GUIDE.md` names the keys.

use super::ToileApp;
use egui::{Key, KeyboardShortcut, Modifiers};
use strum::{EnumCount, IntoStaticStr, VariantArray};

/// A command of the window.
pub struct UiCommand {
    /// Name: text of the button and menu entry, and the accessible name.
    pub name: &'static str,
    /// One sentence on the effect.
    pub tip: &'static str,
    /// Keyboard shortcut.
    pub key: Option<KeyboardShortcut>,
    /// Menu that contains the command.
    pub menu: Menu,
    /// Whether a separator stands before the command in its menu.
    pub begins_group: bool,
    /// Whether the command is available now.
    pub when: fn(&ToileApp) -> bool,
    /// Whether the part of the view that the command toggles is visible; `None` for a command that toggles
    /// no part.
    pub on: Option<fn(&ToileApp) -> bool>,
    /// Performs the command.
    pub does: fn(&mut ToileApp),
}

/// Menus, in the order of the menu bar.
#[derive(Clone, Copy, Debug, PartialEq, Eq, EnumCount, VariantArray, IntoStaticStr)]
pub enum Menu {
    /// File commands.
    File,
    /// Editing commands.
    Edit,
    /// Visibility and enlargement of the views.
    View,
    /// Drawing tools for sheets.
    Draw,
    /// Tools for panels.
    Panel,
    /// Seam commands.
    Sew,
    /// Marker commands.
    Marker,
    /// Commands for the drape.
    Garment,
}

impl Menu {
    /// All menus.
    pub const ALL: [Self; Self::COUNT] = toile_geometry::all_variants!();

    /// Name of the menu.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

pub(super) const fn key(modifiers: Modifiers, key: Key) -> Option<KeyboardShortcut> {
    Some(KeyboardShortcut::new(modifiers, key))
}

pub(super) const fn command(
    menu: Menu,
    name: &'static str,
    key: Option<KeyboardShortcut>,
    tip: &'static str,
    when: fn(&ToileApp) -> bool,
    does: fn(&mut ToileApp),
) -> UiCommand {
    UiCommand {
        name,
        tip,
        key,
        menu,
        begins_group: false,
        when,
        on: None,
        does,
    }
}

/// Declares commands as statics, and the list of them in the same order.
macro_rules! commands {
    ($(#[$about:meta])* $list:ident $($name:ident = $command:expr;)*) => {
        $(pub(crate) static $name: UiCommand = $command;)*

        $(#[$about])*
        pub(super) static $list: &[&UiCommand] = &[$(&$name),*];
    };
}
pub(super) use commands;

impl UiCommand {
    /// This command, with a separator before it in its menu.
    pub(super) const fn under_rule(self) -> Self {
        Self {
            begins_group: true,
            ..self
        }
    }

    /// This command, with a check mark in its menu while `on` says that the part of the view that the command
    /// toggles is visible.
    pub(super) const fn on_while(self, on: fn(&ToileApp) -> bool) -> Self {
        Self {
            on: Some(on),
            ..self
        }
    }

    /// Text of the tooltip: the effect, and the key.
    pub fn words(&self, context: &egui::Context) -> String {
        match self.key {
            Some(key) => format!("{} ({})", self.tip, shortcut_words(context, &key)),
            None => self.tip.to_owned(),
        }
    }
}

/// No modifier key.
pub(super) const PLAIN: Modifiers = Modifiers::NONE;
/// Shift.
pub(super) const SHIFT: Modifiers = Modifiers::SHIFT;
/// Ctrl, on a Mac Cmd.
pub(super) const COMMAND: Modifiers = Modifiers::COMMAND;
/// Ctrl (Cmd) and Shift.
pub(super) const BOTH: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);

/// Condition of a command that is always available.
pub(super) fn always(_: &ToileApp) -> bool {
    true
}

/// A keyboard shortcut in words, as `Ctrl+S`; the key of an ASCII sign is shown as the sign.
pub fn shortcut_words(context: &egui::Context, key: &egui::KeyboardShortcut) -> String {
    let words = context.format_shortcut(key);
    let (name, sign) = (key.logical_key.name(), key.logical_key.symbol_or_name());
    match words.strip_suffix(name) {
        Some(held) if sign.is_ascii() => format!("{held}{sign}"),
        _ => words,
    }
}
