//! A command of the window: name, key, when it can be done, what it does.

use super::ToileApp;
use egui::{Key, KeyboardShortcut, Modifiers};
use strum::{EnumCount, IntoStaticStr, VariantArray};

/// A command of the window.
pub struct UiCommand {
    /// Its name: text of its button and menu entry, and its accessible name.
    pub name: &'static str,
    /// One sentence on what it does.
    pub tip: &'static str,
    /// Its key.
    pub key: Option<KeyboardShortcut>,
    /// The menu it is in.
    pub menu: Menu,
    /// Whether a rule parts it from what is above it in the menu.
    pub begins_group: bool,
    /// Whether it can be done now.
    pub when: fn(&ToileApp) -> bool,
    /// Does it.
    pub does: fn(&mut ToileApp),
}

/// Menus, in the order of the menu bar.
#[derive(Clone, Copy, Debug, PartialEq, Eq, EnumCount, VariantArray, IntoStaticStr)]
pub enum Menu {
    /// Files.
    File,
    /// Changes.
    Edit,
    /// What is seen.
    View,
    /// Tools for sheets.
    Draw,
    /// Tools for panels.
    Panel,
    /// Seams.
    Sew,
    /// Markers.
    Marker,
    /// The drape.
    Garment,
}

impl Menu {
    /// All of them.
    pub const ALL: [Self; Self::COUNT] = toile_geometry::all_variants!();

    /// Its name.
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
        does,
    }
}

impl UiCommand {
    /// The same as the first of a group of its menu.
    pub(super) const fn under_rule(self) -> Self {
        Self {
            begins_group: true,
            ..self
        }
    }

    /// What is said of it where the pointer rests: what it does, and its key.
    pub fn words(&self, context: &egui::Context) -> String {
        match self.key {
            Some(key) => format!("{} ({})", self.tip, shortcut_words(context, &key)),
            None => self.tip.to_owned(),
        }
    }
}

/// No key beside it.
pub(super) const PLAIN: Modifiers = Modifiers::NONE;
/// With Shift.
pub(super) const SHIFT: Modifiers = Modifiers::SHIFT;
/// With Ctrl, on a Mac Cmd.
pub(super) const COMMAND: Modifiers = Modifiers::COMMAND;
/// With both.
pub(super) const BOTH: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);

/// When a command can always be done.
pub(super) fn always(_: &ToileApp) -> bool {
    true
}

/// A key in words, as `Ctrl+S`; signs stand for themselves.
pub fn shortcut_words(context: &egui::Context, key: &egui::KeyboardShortcut) -> String {
    let words = context.format_shortcut(key);
    let (name, sign) = (key.logical_key.name(), key.logical_key.symbol_or_name());
    match words.strip_suffix(name) {
        Some(held) if sign.is_ascii() => format!("{held}{sign}"),
        _ => words,
    }
}
