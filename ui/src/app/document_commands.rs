//! Commands for files, edits and views.

use super::ToileApp;
use super::command::{
    BOTH, COMMAND, Menu, PLAIN, SHIFT, UiCommand, always, command, commands, key,
};
use crate::tools::Tool;
use egui::Key;
use toile_pattern::plan::{Alignment, Axis};

/// Enlargement that shows things at true size on a screen of 96 pixels per inch (pixels per metre).
const PIXELS_PER_METRE: f64 = 96.0 / 0.0254;

/// Step of the scale of the interface (share of the usual size).
const SCALE_STEP: f32 = 0.1;

commands! {
    /// Commands for files, edits and views, in the order of their menus.
    DOCUMENT_COMMANDS

    NEW = command(
        Menu::File,
        "New",
        key(COMMAND, Key::N),
        "Begin a new pattern",
        always,
        ToileApp::ask_new,
    );
    OPEN = command(
        Menu::File,
        "Open",
        key(COMMAND, Key::O),
        "Open a pattern from a file",
        always,
        ToileApp::ask_open,
    );
    SAVE = command(
        Menu::File,
        "Save",
        key(COMMAND, Key::S),
        "Write the pattern to its file",
        |app| app.is_open() && app.is_unsaved(),
        ToileApp::save,
    )
    .under_rule();
    SAVE_AS = command(
        Menu::File,
        "Save as",
        key(BOTH, Key::S),
        "Write the pattern to another file",
        ToileApp::is_open,
        ToileApp::ask_save,
    );
    INSERT_PATTERN = command(
        Menu::File,
        "Insert pattern",
        key(BOTH, Key::I),
        "Put the panels of another pattern, as your own block, beside these",
        ToileApp::is_open,
        ToileApp::ask_insert,
    )
    .under_rule();
    PRINT = command(
        Menu::File,
        "Print",
        key(COMMAND, Key::P),
        "Print the pieces on paper, as PDF or SVG",
        ToileApp::has_panels,
        ToileApp::ask_print,
    )
    .under_rule();
    EXPORT = command(
        Menu::File,
        "Export",
        key(COMMAND, Key::E),
        "Write the garment, its marker, its pieces, pictures and numbers for other programs",
        |app| app.has_panels() && !app.is_exporting(),
        ToileApp::ask_export,
    );
    STOP_EXPORT = command(
        Menu::File,
        "Stop export",
        None,
        "Stop the export that goes on; nothing of it is written",
        ToileApp::is_exporting,
        ToileApp::stop_export,
    );
    UNDO = command(
        Menu::Edit,
        "Undo",
        key(COMMAND, Key::Z),
        "Take the last change back",
        |app| app.session.can_undo().is_some(),
        ToileApp::undo,
    );
    REDO = command(
        Menu::Edit,
        "Redo",
        key(BOTH, Key::Z),
        "Do the change again that was taken back",
        |app| app.session.can_redo().is_some(),
        ToileApp::redo,
    );
    CUT = command(
        Menu::Edit,
        "Cut",
        None,
        "Copy what is selected and remove it (the key is that of the system)",
        ToileApp::has_selection,
        ToileApp::cut,
    )
    .under_rule();
    COPY = command(
        Menu::Edit,
        "Copy",
        None,
        "Copy what is selected (the key is that of the system)",
        ToileApp::has_selection,
        ToileApp::copy,
    );
    PASTE = command(
        Menu::Edit,
        "Paste",
        None,
        "Put what was copied beside what is there (the key is that of the system)",
        ToileApp::has_copied,
        ToileApp::paste_copied,
    );
    DUPLICATE = command(
        Menu::Edit,
        "Duplicate",
        key(COMMAND, Key::D),
        "Put a copy of what is selected beside it",
        ToileApp::has_selection,
        ToileApp::duplicate,
    );
    DELETE = command(
        Menu::Edit,
        "Delete",
        key(PLAIN, Key::Delete),
        "Remove what is selected; the edges at a removed corner become one",
        ToileApp::has_selection,
        ToileApp::delete,
    );
    ADD_POINT = command(
        Menu::Edit,
        "Add point",
        key(PLAIN, Key::Insert),
        "Divide the selected edge in its middle; double-click an edge to divide it there",
        ToileApp::has_edge,
        ToileApp::divide_edge,
    )
    .under_rule();
    SELECT_ALL = command(
        Menu::Edit,
        "Select all",
        key(COMMAND, Key::A),
        "Select every panel, or every point where there is no panel",
        ToileApp::is_open,
        ToileApp::select_all,
    )
    .under_rule();
    DESELECT = command(
        Menu::Edit,
        "Deselect",
        key(PLAIN, Key::Escape),
        "Put the tool down, select nothing, or show all panels again",
        |app| {
            let shows_some = !app.view.isolated.is_empty();
            let has_tool = !matches!(app.view.tool, Tool::Select) || app.lays_loop();
            app.has_selection() || shows_some || has_tool
        },
        ToileApp::deselect,
    );
    ALIGN_LEFT = command(
        Menu::Edit,
        "Align left",
        None,
        "Bring left sides to the leftmost",
        ToileApp::has_several,
        |app| app.align(Alignment::Left),
    )
    .under_rule();
    ALIGN_RIGHT = command(
        Menu::Edit,
        "Align right",
        None,
        "Bring right sides to the rightmost",
        ToileApp::has_several,
        |app| app.align(Alignment::Right),
    );
    ALIGN_TOP = command(
        Menu::Edit,
        "Align top",
        None,
        "Bring upper sides to the topmost",
        ToileApp::has_several,
        |app| app.align(Alignment::Top),
    );
    ALIGN_BOTTOM = command(
        Menu::Edit,
        "Align bottom",
        None,
        "Bring lower sides to the bottommost",
        ToileApp::has_several,
        |app| app.align(Alignment::Bottom),
    );
    ALIGN_MIDDLES = command(
        Menu::Edit,
        "Align middles",
        None,
        "Bring middles onto one vertical",
        ToileApp::has_several,
        |app| app.align(Alignment::Middle),
    );
    ALIGN_LEVELS = command(
        Menu::Edit,
        "Align levels",
        None,
        "Bring middles onto one level",
        ToileApp::has_several,
        |app| app.align(Alignment::Level),
    );
    DISTRIBUTE_ACROSS = command(
        Menu::Edit,
        "Distribute across",
        None,
        "Spread middles evenly from left to right",
        ToileApp::has_several,
        |app| app.distribute(Axis::X),
    )
    .under_rule();
    DISTRIBUTE_UP = command(
        Menu::Edit,
        "Distribute up",
        None,
        "Spread middles evenly from below upward",
        ToileApp::has_several,
        |app| app.distribute(Axis::Y),
    );
    PATTERN_PROPERTIES = command(
        Menu::Edit,
        "Pattern properties",
        None,
        "Name and unit of the pattern, and the sheet that is drawn on",
        ToileApp::is_open,
        ToileApp::show_properties,
    )
    .under_rule();
    GIVE_GRADE_RULE = command(
        Menu::Edit,
        "Give grade rule",
        None,
        "Give the selected points a new grade rule; its shifts by size are typed into the table",
        ToileApp::can_grade,
        ToileApp::give_grade_rule,
    )
    .under_rule();
    COPY_GRADE_RULE = command(
        Menu::Edit,
        "Copy grade rule",
        None,
        "Give the rule of the first selected point that has one to the others",
        ToileApp::can_grade,
        ToileApp::copy_grade_rule,
    );
    MIRROR_GRADE_RULE_ACROSS = command(
        Menu::Edit,
        "Mirror grade rule across",
        None,
        "Turn the shifts of the selected points from right to left",
        ToileApp::can_grade,
        |app| app.mirror_grade_rule(Axis::X),
    );
    MIRROR_GRADE_RULE_UP = command(
        Menu::Edit,
        "Mirror grade rule up",
        None,
        "Turn the shifts of the selected points from up to down",
        ToileApp::can_grade,
        |app| app.mirror_grade_rule(Axis::Y),
    );
    READ_GRADE_RULES = command(
        Menu::Edit,
        "Read grade rules",
        None,
        "Put grade rules in place of the formulas that move the selected points from size to size",
        ToileApp::can_grade,
        ToileApp::read_grade_rules,
    );
    REMOVE_GRADE_RULE = command(
        Menu::Edit,
        "Remove grade rule",
        None,
        "Leave the selected points in all sizes where they lie in the base size",
        ToileApp::can_grade,
        ToileApp::remove_grade_rule,
    );
    FIND = command(
        Menu::Edit,
        "Find",
        key(COMMAND, Key::K),
        "Find a command, a part of the pattern, a variable or a measurement by its name",
        always,
        ToileApp::ask_command,
    )
    .under_rule();
    WORDS = command(
        Menu::Edit,
        "Words",
        key(PLAIN, Key::F1),
        "Look up a word of the trade that the program uses",
        always,
        ToileApp::ask_words,
    );
    FIT = command(
        Menu::View,
        "Fit",
        key(PLAIN, Key::F),
        "Show the whole pattern: F while nothing is drawn, Home always",
        ToileApp::is_open,
        |app| app.view.fit(),
    );
    ZOOM_IN = command(
        Menu::View,
        "Zoom in",
        key(PLAIN, Key::Plus),
        "Enlarge the pattern",
        ToileApp::is_open,
        |app| app.view.zoom(crate::views::pattern::ZOOM_STEP),
    );
    ZOOM_OUT = command(
        Menu::View,
        "Zoom out",
        key(PLAIN, Key::Minus),
        "Make the pattern smaller",
        ToileApp::is_open,
        |app| app.view.zoom(1.0 / crate::views::pattern::ZOOM_STEP),
    );
    TRUE_SIZE = command(
        Menu::View,
        "True size",
        key(PLAIN, Key::Num0),
        "Show the pattern as large as it is, on a screen of 96 pixels an inch",
        ToileApp::is_open,
        |app| app.view.true_size(PIXELS_PER_METRE),
    );
    RULERS = command(
        Menu::View,
        "Rulers",
        key(SHIFT, Key::R),
        "Show or hide the rulers",
        always,
        |app| app.panes.rulers = !app.panes.rulers,
    )
    .under_rule()
    .on_while(|app| app.panes.rulers);
    SHOW_GUIDES = command(
        Menu::View,
        "Show guides",
        key(COMMAND, Key::Semicolon),
        "Show or hide the guides; drag one out of a ruler, and drop it back there to remove it",
        always,
        ToileApp::toggle_guides,
    )
    .on_while(|app| app.panes.guides);
    REMOVE_ALL_GUIDES = command(
        Menu::View,
        "Remove all guides",
        None,
        "Remove every guide from the pattern",
        ToileApp::has_guides,
        ToileApp::remove_guides,
    );
    ISOLATE = command(
        Menu::View,
        "Isolate",
        key(PLAIN, Key::Period),
        "Show the selected panels alone, or all again",
        ToileApp::can_isolate,
        ToileApp::isolate,
    )
    .under_rule()
    .on_while(|app| !app.view.isolated.is_empty());
    ALL_SIZES = command(
        Menu::View,
        "All sizes",
        key(SHIFT, Key::G),
        "Show or hide the outlines of all sizes over each other",
        ToileApp::has_sizes,
        ToileApp::toggle_grading,
    )
    .on_while(|app| app.view.grading.is_some());
    TABLES = command(
        Menu::View,
        "Tables",
        key(PLAIN, Key::F8),
        "Show or hide measurements, variables, sizes and the history",
        always,
        |app| app.panes.tables = !app.panes.tables,
    )
    .under_rule()
    .on_while(|app| app.panes.tables);
    TABLES_BESIDE = command(
        Menu::View,
        "Tables beside",
        key(SHIFT, Key::F8),
        "Stand the tables beside the pattern, or below it; their strip can be dragged there too",
        always,
        ToileApp::toggle_tables_side,
    )
    .on_while(|app| app.tables_are_beside);
    TOOL_NAMES = command(
        Menu::View,
        "Tool names",
        key(PLAIN, Key::F2),
        "Show or hide the names of the tools beside their signs",
        always,
        |app| app.panes.tool_names = !app.panes.tool_names,
    )
    .on_while(|app| app.panes.tool_names);
    FABRICS = command(
        Menu::View,
        "Fabrics",
        key(PLAIN, Key::F4),
        "Show or hide what the garment is cut from, and the fabrics of the pattern and of the library",
        ToileApp::is_open,
        ToileApp::toggle_fabrics,
    );
    FINDINGS = command(
        Menu::View,
        "Findings",
        key(PLAIN, Key::F9),
        "List what is found wrong with the pattern",
        always,
        |app| app.panes.findings = !app.panes.findings,
    )
    .on_while(|app| app.panes.findings);
    GARMENT_VIEW = command(
        Menu::View,
        "Garment view",
        key(PLAIN, Key::F7),
        "Show or hide the garment on the mannequin",
        always,
        |app| app.panes.garment = !app.panes.garment,
    )
    .on_while(|app| app.panes.garment);
    ALLOWANCE = command(
        Menu::View,
        "Allowance",
        key(SHIFT, Key::A),
        "Show or hide the lines to cut along",
        always,
        |app| app.panes.allowances = !app.panes.allowances,
    )
    .under_rule()
    .on_while(|app| app.panes.allowances);
    DARK_OR_LIGHT = command(
        Menu::View,
        "Dark or light",
        None,
        "Change between dark and light colours",
        always,
        ToileApp::change_theme,
    )
    .under_rule();
    LARGER_INTERFACE = command(
        Menu::View,
        "Larger interface",
        key(COMMAND, Key::Plus),
        "Show text, signs and buttons larger",
        always,
        |app| app.change_scale(Some(SCALE_STEP)),
    );
    SMALLER_INTERFACE = command(
        Menu::View,
        "Smaller interface",
        key(COMMAND, Key::Minus),
        "Show text, signs and buttons smaller",
        always,
        |app| app.change_scale(Some(-SCALE_STEP)),
    );
    INTERFACE_AT_USUAL_SIZE = command(
        Menu::View,
        "Usual interface",
        key(COMMAND, Key::Num0),
        "Show text, signs and buttons as large as at first",
        always,
        |app| app.change_scale(None),
    );
}

/// The commands for grade rules.
pub(crate) fn grading_commands() -> [&'static UiCommand; 6] {
    [
        &GIVE_GRADE_RULE,
        &COPY_GRADE_RULE,
        &MIRROR_GRADE_RULE_ACROSS,
        &MIRROR_GRADE_RULE_UP,
        &READ_GRADE_RULES,
        &REMOVE_GRADE_RULE,
    ]
}
