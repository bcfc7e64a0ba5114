//! Every command of the window in one table. Menus, keys, buttons, the palette and tests all go by
//! it.

use super::ToileApp;
use super::command::{Menu, UiCommand, command, key};
use crate::tools::{Tool, draw, panel, parts, seam};
use egui::{Key, KeyboardShortcut, Modifiers};
use toile_pattern::plan::{Alignment, Axis};

const PLAIN: Modifiers = Modifiers::NONE;
const SHIFT: Modifiers = Modifiers::SHIFT;
const COMMAND: Modifiers = Modifiers::COMMAND;
const BOTH: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);

/// All commands, in the order of their menus.
pub static COMMANDS: &[UiCommand] = &[
    command(
        Menu::File,
        "New",
        key(COMMAND, Key::N),
        "Begin a new pattern",
        always,
        ToileApp::ask_new,
    ),
    command(
        Menu::File,
        "Open",
        key(COMMAND, Key::O),
        "Open a pattern from a file",
        always,
        ToileApp::ask_open,
    ),
    command(
        Menu::File,
        "Save",
        key(COMMAND, Key::S),
        "Write the pattern to its file",
        |app| app.is_open() && app.is_unsaved(),
        ToileApp::save,
    ),
    command(
        Menu::File,
        "Save as",
        key(BOTH, Key::S),
        "Write the pattern to another file",
        ToileApp::is_open,
        ToileApp::ask_save,
    ),
    command(
        Menu::File,
        "Insert pattern",
        key(BOTH, Key::I),
        "Put the panels of another pattern, as your own block, beside these",
        ToileApp::is_open,
        ToileApp::ask_insert,
    ),
    command(
        Menu::File,
        "Print",
        key(COMMAND, Key::P),
        "Print the pieces on paper, as PDF or SVG",
        ToileApp::has_panels,
        ToileApp::ask_print,
    ),
    command(
        Menu::Edit,
        "Undo",
        key(COMMAND, Key::Z),
        "Take the last change back",
        |app| app.session.can_undo().is_some(),
        ToileApp::undo,
    ),
    command(
        Menu::Edit,
        "Redo",
        key(BOTH, Key::Z),
        "Do the change again that was taken back",
        |app| app.session.can_redo().is_some(),
        ToileApp::redo,
    ),
    command(
        Menu::Edit,
        "Cut",
        None,
        "Copy what is selected and remove it (the key is that of the system)",
        ToileApp::has_selection,
        ToileApp::cut,
    ),
    command(
        Menu::Edit,
        "Copy",
        None,
        "Copy what is selected (the key is that of the system)",
        ToileApp::has_selection,
        ToileApp::copy,
    ),
    command(
        Menu::Edit,
        "Paste",
        None,
        "Put what was copied beside what is there (the key is that of the system)",
        ToileApp::has_copied,
        ToileApp::paste_copied,
    ),
    command(
        Menu::Edit,
        "Duplicate",
        key(COMMAND, Key::D),
        "Put a copy of what is selected beside it",
        ToileApp::has_selection,
        ToileApp::duplicate,
    ),
    command(
        Menu::Edit,
        "Delete",
        key(PLAIN, Key::Delete),
        "Remove what is selected; the edges at a removed corner become one",
        ToileApp::has_selection,
        ToileApp::delete,
    ),
    command(
        Menu::Edit,
        "Add point",
        key(PLAIN, Key::Insert),
        "Divide the selected edge in its middle; double-click an edge to divide it there",
        ToileApp::has_edge,
        ToileApp::divide_edge,
    ),
    command(
        Menu::Edit,
        "Select all",
        key(COMMAND, Key::A),
        "Select every panel, or every point where there is no panel",
        ToileApp::is_open,
        ToileApp::select_all,
    ),
    command(
        Menu::Edit,
        "Deselect",
        key(PLAIN, Key::Escape),
        "Put the tool down, or select nothing",
        |app| app.has_selection() || !matches!(app.view.tool, Tool::Select),
        ToileApp::deselect,
    ),
    command(
        Menu::Edit,
        "Align left",
        None,
        "Bring left sides to the leftmost",
        ToileApp::has_several,
        |app| app.align(Alignment::Left),
    ),
    command(
        Menu::Edit,
        "Align right",
        None,
        "Bring right sides to the rightmost",
        ToileApp::has_several,
        |app| app.align(Alignment::Right),
    ),
    command(
        Menu::Edit,
        "Align top",
        None,
        "Bring upper sides to the topmost",
        ToileApp::has_several,
        |app| app.align(Alignment::Top),
    ),
    command(
        Menu::Edit,
        "Align bottom",
        None,
        "Bring lower sides to the bottommost",
        ToileApp::has_several,
        |app| app.align(Alignment::Bottom),
    ),
    command(
        Menu::Edit,
        "Align middles",
        None,
        "Bring middles onto one vertical",
        ToileApp::has_several,
        |app| app.align(Alignment::Middle),
    ),
    command(
        Menu::Edit,
        "Align levels",
        None,
        "Bring middles onto one level",
        ToileApp::has_several,
        |app| app.align(Alignment::Level),
    ),
    command(
        Menu::Edit,
        "Distribute across",
        None,
        "Spread middles evenly from left to right",
        ToileApp::has_several,
        |app| app.distribute(Axis::X),
    ),
    command(
        Menu::Edit,
        "Distribute up",
        None,
        "Spread middles evenly from below upward",
        ToileApp::has_several,
        |app| app.distribute(Axis::Y),
    ),
    command(
        Menu::Edit,
        "Find command",
        key(COMMAND, Key::K),
        "Find a command by its name",
        always,
        ToileApp::ask_command,
    ),
    command(
        Menu::View,
        "Fit",
        key(PLAIN, Key::F),
        "Show the whole pattern",
        ToileApp::is_open,
        |app| app.view.fit(),
    ),
    command(
        Menu::View,
        "Zoom in",
        key(PLAIN, Key::Plus),
        "Enlarge the pattern",
        ToileApp::is_open,
        |app| app.view.zoom(crate::views::pattern::ZOOM_STEP),
    ),
    command(
        Menu::View,
        "Zoom out",
        key(PLAIN, Key::Minus),
        "Make the pattern smaller",
        ToileApp::is_open,
        |app| app.view.zoom(1.0 / crate::views::pattern::ZOOM_STEP),
    ),
    command(
        Menu::View,
        "Tables",
        key(PLAIN, Key::F8),
        "Show or hide measurements, variables, sizes and the history",
        always,
        |app| app.shows.tables = !app.shows.tables,
    ),
    command(
        Menu::View,
        "Findings",
        key(PLAIN, Key::F9),
        "List what is found wrong with the pattern",
        always,
        |app| app.shows.findings = !app.shows.findings,
    ),
    command(
        Menu::View,
        "Garment view",
        key(PLAIN, Key::F7),
        "Show or hide the garment on the mannequin",
        always,
        |app| app.shows.garment = !app.shows.garment,
    ),
    command(
        Menu::View,
        "Dark or light",
        None,
        "Change between dark and light colours",
        always,
        ToileApp::change_theme,
    ),
    command(
        Menu::Draw,
        "Select",
        key(PLAIN, Key::V),
        "Select, move, divide",
        always,
        |app| app.take(Tool::Select),
    ),
    command(
        Menu::Draw,
        "Point",
        key(PLAIN, Key::P),
        "Draw a point by coordinates, on a curve, at a crossing or beside another",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&draw::POINT)),
    ),
    command(
        Menu::Draw,
        "Line",
        key(PLAIN, Key::L),
        "Draw straight lines, each from where the last ends",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&draw::LINE)),
    ),
    command(
        Menu::Draw,
        "Polygon",
        key(SHIFT, Key::L),
        "Draw lines through several corners; closed by a click on the first they are a panel",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&draw::POLYGON)),
    ),
    command(
        Menu::Draw,
        "Curve",
        key(PLAIN, Key::C),
        "Draw a smooth curve through several places",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&draw::SPLINE)),
    ),
    command(
        Menu::Draw,
        "Arc",
        key(PLAIN, Key::A),
        "Draw a circular arc through a place",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&draw::ARC)),
    ),
    command(
        Menu::Draw,
        "Rectangle",
        key(PLAIN, Key::R),
        "Draw a rectangular panel",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&draw::RECTANGLE)),
    ),
    command(
        Menu::Draw,
        "Point along",
        key(PLAIN, Key::E),
        "Draw a point on a curve at a distance from its end",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&draw::ALONG)),
    ),
    command(
        Menu::Draw,
        "Perpendicular",
        key(SHIFT, Key::P),
        "Draw the foot of a perpendicular from a point to a line",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&draw::FOOT)),
    ),
    command(
        Menu::Draw,
        "Mirror point",
        key(SHIFT, Key::M),
        "Draw the mirror image of a point in a line",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&draw::MIRROR)),
    ),
    command(
        Menu::Draw,
        "Move",
        key(PLAIN, Key::M),
        "Move what is selected by a way or by numbers",
        ToileApp::has_selection,
        |app| app.take(Tool::Slots(&parts::MOVE)),
    ),
    command(
        Menu::Draw,
        "Turn",
        key(PLAIN, Key::Q),
        "Turn what is selected about a place",
        ToileApp::has_selection,
        |app| app.take(Tool::Slots(&parts::TURN)),
    ),
    command(
        Menu::Draw,
        "Mirror",
        key(SHIFT, Key::Q),
        "Mirror what is selected in a line",
        ToileApp::has_selection,
        |app| app.take(Tool::Slots(&parts::MIRROR_PARTS)),
    ),
    command(
        Menu::Draw,
        "Scale",
        key(SHIFT, Key::S),
        "Make what is selected larger or smaller",
        ToileApp::has_selection,
        |app| app.take(Tool::Slots(&parts::SCALE)),
    ),
    command(
        Menu::Draw,
        "Measure",
        key(SHIFT, Key::D),
        "Tell the distance and direction between two places",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&parts::MEASURE)),
    ),
    command(
        Menu::Panel,
        "Trace",
        key(PLAIN, Key::T),
        "Make a panel of closed lines",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&draw::TRACE)),
    ),
    command(
        Menu::Panel,
        "Divide edge",
        key(PLAIN, Key::B),
        "Put a point on an edge",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&panel::DIVIDE)),
    ),
    command(
        Menu::Panel,
        "Dart",
        key(PLAIN, Key::D),
        "Take a dart out of an edge",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&panel::DART)),
    ),
    command(
        Menu::Panel,
        "Fold",
        key(SHIFT, Key::F),
        "Lay a straight edge on the fold of the cloth",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&panel::FOLD)),
    ),
    command(
        Menu::Panel,
        "Notch",
        key(PLAIN, Key::N),
        "Mark an edge with a notch",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&panel::NOTCH)),
    ),
    command(
        Menu::Panel,
        "Inner line",
        key(PLAIN, Key::I),
        "Draw a line inside a panel, or a hole by closing it",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&panel::INNER_LINE)),
    ),
    command(
        Menu::Panel,
        "Grain",
        key(PLAIN, Key::G),
        "Set the direction of the warp",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&panel::GRAIN)),
    ),
    command(
        Menu::Sew,
        "Seam",
        key(PLAIN, Key::S),
        "Sew one edge or chain of edges to another, on both sides of the wearer",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&seam::SEAM)),
    ),
    command(
        Menu::Sew,
        "Matched notches",
        key(SHIFT, Key::N),
        "Mark a seam with notches that meet when it is sewn",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&seam::MATCHED_NOTCH)),
    ),
    command(
        Menu::Sew,
        "Flip seam",
        key(PLAIN, Key::X),
        "Sew the other end of the edge: what the lines between its ends show",
        ToileApp::has_seam,
        ToileApp::flip_seam,
    ),
    command(
        Menu::Sew,
        "Select seam",
        key(SHIFT, Key::X),
        "Select the seam of the selected edge",
        ToileApp::has_edge,
        ToileApp::select_seam,
    ),
    command(
        Menu::Garment,
        "Drape",
        key(PLAIN, Key::F5),
        "Sew the garment round the mannequin and let it hang",
        ToileApp::has_panels,
        ToileApp::drape,
    ),
    command(
        Menu::Garment,
        "Pause",
        key(PLAIN, Key::F6),
        "Hold the drape, or let it go on",
        |app| app.making.is_draping(),
        |app| app.making.toggle_pause(),
    ),
    command(
        Menu::Garment,
        "Stop",
        key(SHIFT, Key::F5),
        "End the drape and keep what there is",
        |app| app.making.is_draping(),
        |app| app.making.stop(),
    ),
    command(
        Menu::Garment,
        "Front view",
        key(PLAIN, Key::Num1),
        "Look at the front of the garment",
        always,
        |app| app.stage.look_from(0.0),
    ),
    command(
        Menu::Garment,
        "Back view",
        key(PLAIN, Key::Num2),
        "Look at the back of the garment",
        always,
        |app| app.stage.look_from(std::f64::consts::PI),
    ),
    command(
        Menu::Garment,
        "Side view",
        key(PLAIN, Key::Num3),
        "Look at the wearer's left side",
        always,
        |app| app.stage.look_from(std::f64::consts::FRAC_PI_2),
    ),
];

fn always(_: &ToileApp) -> bool {
    true
}

/// The command with that name.
pub fn named(name: &str) -> Option<&'static UiCommand> {
    COMMANDS.iter().find(|command| command.name == name)
}

/// Commands whose keys were pressed in this frame. While text is typed only those with a
/// command key count; while a tool is `busy`, Escape is its own.
pub fn pressed(context: &egui::Context, typing: bool, busy: bool) -> Vec<&'static UiCommand> {
    // Keys with more modifiers first: a key without them matches those with them too.
    let mut keyed: Vec<(&UiCommand, KeyboardShortcut)> = COMMANDS
        .iter()
        .filter_map(|command| Some((command, command.key?)))
        .collect();
    let modifiers =
        |key: &KeyboardShortcut| u8::from(key.modifiers.shift) + u8::from(key.modifiers.command);
    keyed.sort_by_key(|(_, key)| std::cmp::Reverse(modifiers(key)));
    let mut pressed = Vec::new();
    context.input_mut(|input| {
        for (command, key) in keyed {
            let waits = typing && !key.modifiers.command || busy && key.logical_key == Key::Escape;
            if !waits && input.consume_shortcut(&key) {
                pressed.push(command);
            }
        }
    });
    pressed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_keys_are_all_different() {
        for (k, one) in COMMANDS.iter().enumerate() {
            for other in &COMMANDS[k + 1..] {
                assert_ne!(one.name, other.name);
                let same = one.key.is_some() && one.key == other.key;
                assert!(!same, "{} and {}", one.name, other.name);
            }
            assert!(!one.tip.is_empty());
        }
    }

    #[test]
    fn commands_of_a_menu_stand_together() {
        let mut menus: Vec<Menu> = COMMANDS.iter().map(|command| command.menu).collect();
        menus.dedup();
        assert_eq!(menus, Menu::ALL);
    }
}
