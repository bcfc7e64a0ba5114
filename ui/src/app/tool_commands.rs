//! Commands that take a tool in hand, and commands for seams and the garment.

use super::ToileApp;
use super::command::{BOTH, Menu, PLAIN, SHIFT, UiCommand, always, command, commands, key};
use super::tab::Tab;
use crate::tables::WornWhere;
use crate::tools::{Tool, alter, arc, compass, draw, panel, parts, ring, seam};
use crate::views::marker::{MarkerAction, MarkerView};
use egui::Key;

commands! {
    /// Commands that take a tool in hand, and commands for seams and the garment, in the order of their
    /// menus.
    TOOL_COMMANDS

    SELECT = command(
        Menu::Draw,
        "Select",
        key(PLAIN, Key::V),
        "Select, move, divide",
        always,
        |app| app.take(Tool::Select),
    );
    NEW_SHEET = command(
        Menu::Draw,
        "New sheet",
        key(BOTH, Key::N),
        "Add an empty sheet to draw the next piece on, with names of its own",
        ToileApp::is_open,
        ToileApp::new_sheet,
    )
    .under_rule();
    POINT = command(
        Menu::Draw,
        "Point",
        key(PLAIN, Key::P),
        "Draw a point by coordinates, on a curve, at a crossing or beside another",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&draw::POINT)),
    )
    .under_rule();
    POINT_FROM = command(
        Menu::Draw,
        "Point from",
        key(PLAIN, Key::U),
        "Draw a point at a distance and an angle from another",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&draw::POINT_FROM)),
    );
    LINE = command(
        Menu::Draw,
        "Line",
        key(PLAIN, Key::L),
        "Draw straight lines, each from where the last ends",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&draw::LINE)),
    );
    POLYGON = command(
        Menu::Draw,
        "Polygon",
        key(SHIFT, Key::L),
        "Draw lines through several corners; closed by a click on the first they are a panel",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&draw::POLYGON)),
    );
    CURVE = command(
        Menu::Draw,
        "Curve",
        key(PLAIN, Key::C),
        "Draw a smooth curve through several places",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&draw::SPLINE)),
    );
    ARC = command(
        Menu::Draw,
        "Arc",
        key(PLAIN, Key::A),
        "Draw a circular arc through a place",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&arc::ARC)),
    );
    ARC_ABOUT_CENTRE = command(
        Menu::Draw,
        "Arc about centre",
        key(SHIFT, Key::O),
        "Draw a circular arc by its centre, its radius and the angle it sweeps",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&arc::CENTRE_ARC)),
    );
    TANGENT_ARC = command(
        Menu::Draw,
        "Tangent arc",
        key(SHIFT, Key::T),
        "Draw a circular arc that goes on smoothly from the end of a curve",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&arc::TANGENT_ARC)),
    );
    CIRCLE = command(
        Menu::Draw,
        "Circle",
        key(SHIFT, Key::C),
        "Draw a circle, a ring or a part of one as a panel: circular skirts, flounces, collars",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&ring::RING)),
    );
    RECTANGLE = command(
        Menu::Draw,
        "Rectangle",
        key(PLAIN, Key::R),
        "Draw a rectangular panel",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&draw::RECTANGLE)),
    );
    POINT_ALONG = command(
        Menu::Draw,
        "Point along",
        key(PLAIN, Key::E),
        "Draw a point on a curve at a distance from its end",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&draw::ALONG)),
    )
    .under_rule();
    PERPENDICULAR = command(
        Menu::Draw,
        "Perpendicular",
        key(SHIFT, Key::P),
        "Draw the foot of a perpendicular from a point to a line",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&draw::FOOT)),
    );
    MIRROR_POINT = command(
        Menu::Draw,
        "Mirror point",
        key(SHIFT, Key::M),
        "Draw the mirror image of a point in a line",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&draw::MIRROR)),
    );
    COMPASS_ON_LINE = command(
        Menu::Draw,
        "Compass on line",
        None,
        "Draw a point on a line at a distance from another point",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&compass::ON_LINE)),
    );
    TWO_COMPASSES = command(
        Menu::Draw,
        "Two compasses",
        None,
        "Draw a point at given distances from two others",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&compass::TWO)),
    );
    MOVE = command(
        Menu::Draw,
        "Move",
        key(PLAIN, Key::M),
        "Move what is selected by a way or by numbers",
        ToileApp::has_selection,
        |app| app.take(Tool::Slots(&parts::MOVE)),
    )
    .under_rule();
    TURN = command(
        Menu::Draw,
        "Turn",
        key(PLAIN, Key::Q),
        "Turn what is selected about a place",
        ToileApp::has_selection,
        |app| app.take(Tool::Slots(&parts::TURN)),
    );
    MIRROR = command(
        Menu::Draw,
        "Mirror",
        key(SHIFT, Key::Q),
        "Mirror what is selected in a line",
        ToileApp::has_selection,
        |app| app.take(Tool::Slots(&parts::MIRROR_PARTS)),
    );
    SCALE = command(
        Menu::Draw,
        "Scale",
        key(SHIFT, Key::S),
        "Make what is selected larger or smaller",
        ToileApp::has_selection,
        |app| app.take(Tool::Slots(&parts::SCALE)),
    );
    MEASURE = command(
        Menu::Draw,
        "Measure",
        key(SHIFT, Key::D),
        "Tell the distance and direction between two places",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&parts::MEASURE)),
    );
    TRACE = command(
        Menu::Panel,
        "Trace",
        key(PLAIN, Key::T),
        "Make a panel of closed lines",
        ToileApp::is_open,
        |app| app.take(Tool::Slots(&draw::TRACE)),
    );
    DIVIDE_EDGE = command(
        Menu::Panel,
        "Divide edge",
        key(PLAIN, Key::B),
        "Put a point on an edge",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&panel::DIVIDE)),
    );
    BEND_EDGE = command(
        Menu::Panel,
        "Bend edge",
        key(SHIFT, Key::B),
        "Bend an edge to an arc through a place",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&panel::BEND)),
    );
    DART = command(
        Menu::Panel,
        "Dart",
        key(PLAIN, Key::D),
        "Take a dart out of an edge",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&panel::DART)),
    )
    .under_rule();
    FISHEYE_DART = command(
        Menu::Panel,
        "Fisheye dart",
        key(PLAIN, Key::O),
        "Take a dart with two points out of the inside of a panel",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&panel::FISHEYE)),
    );
    PIVOT_DART = command(
        Menu::Panel,
        "Pivot dart",
        key(SHIFT, Key::E),
        "Move a dart, or a part of it, to another place",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&alter::PIVOT)),
    );
    SPREAD = command(
        Menu::Panel,
        "Spread",
        key(SHIFT, Key::W),
        "Cut a panel from edge to edge and spread the parts",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&alter::SPREAD)),
    );
    KNIFE_PLEAT = command(
        Menu::Panel,
        "Knife pleat",
        key(PLAIN, Key::Y),
        "Fold pleats pressed to one side, from edge to edge",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&alter::KNIFE_PLEAT)),
    )
    .under_rule();
    BOX_PLEAT = command(
        Menu::Panel,
        "Box pleat",
        key(SHIFT, Key::Y),
        "Fold pleats that stand as boxes, from edge to edge",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&alter::BOX_PLEAT)),
    );
    INVERTED_PLEAT = command(
        Menu::Panel,
        "Inverted pleat",
        key(SHIFT, Key::J),
        "Fold pleats whose folds meet, from edge to edge",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&alter::INVERTED_PLEAT)),
    );
    SPLIT = command(
        Menu::Panel,
        "Split",
        key(PLAIN, Key::K),
        "Cut a panel in two along a straight line from edge to edge",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&alter::SPLIT)),
    )
    .under_rule();
    SPLIT_ALONG = command(
        Menu::Panel,
        "Split along",
        key(SHIFT, Key::K),
        "Cut a panel in two along a curve that is drawn across it",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&alter::SPLIT_ALONG)),
    );
    FOLD = command(
        Menu::Panel,
        "Fold",
        key(SHIFT, Key::F),
        "Lay a straight edge on the fold of the cloth",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&panel::FOLD)),
    );
    NOTCH = command(
        Menu::Panel,
        "Notch",
        key(PLAIN, Key::N),
        "Mark an edge with a notch",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&panel::NOTCH)),
    )
    .under_rule();
    ROW_OF_NOTCHES = command(
        Menu::Panel,
        "Row of notches",
        None,
        "Divide an edge evenly by notches",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&panel::NOTCH_ROW)),
    );
    INNER_LINE = command(
        Menu::Panel,
        "Inner line",
        key(PLAIN, Key::I),
        "Draw a line inside a panel, or a hole by closing it",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&panel::INNER_LINE)),
    )
    .under_rule();
    DRAW_ON_PANEL = command(
        Menu::Panel,
        "Draw on panel",
        key(SHIFT, Key::I),
        "Draw points and lines on a panel as it is finished: on a side of a split, after a pivot",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&panel::DRAW_ON)),
    );
    INSERT_LINE = command(
        Menu::Panel,
        "Insert line",
        key(PLAIN, Key::J),
        "Make a curve that is drawn a line of the panel it lies on",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&panel::INSERT_LINE)),
    );
    GRAIN = command(
        Menu::Panel,
        "Grain",
        key(PLAIN, Key::G),
        "Set the direction of the warp",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&panel::GRAIN)),
    )
    .under_rule();
    SEAM = command(
        Menu::Sew,
        "Seam",
        key(PLAIN, Key::S),
        "Sew one edge or chain of edges to another, on both sides of the wearer",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&seam::SEAM)),
    );
    SUGGESTED_SEAMS = command(
        Menu::Sew,
        "Suggested seams",
        key(SHIFT, Key::U),
        "Show which edges that are not sewn may belong together, and sew those that are accepted",
        ToileApp::has_panels,
        |app| app.take(Tool::Suggested),
    );
    MATCHED_NOTCHES = command(
        Menu::Sew,
        "Matched notches",
        key(SHIFT, Key::N),
        "Mark a seam with notches that meet when it is sewn",
        ToileApp::has_panels,
        |app| app.take(Tool::Slots(&seam::MATCHED_NOTCH)),
    );
    FLIP_SEAM = command(
        Menu::Sew,
        "Flip seam",
        key(PLAIN, Key::X),
        "Sew the other end of the edge: what the lines between its ends show",
        ToileApp::has_seam,
        ToileApp::flip_seam,
    )
    .under_rule();
    SELECT_SEAM = command(
        Menu::Sew,
        "Select seam",
        key(SHIFT, Key::X),
        "Select the seam of the selected edge",
        ToileApp::has_edge,
        ToileApp::select_seam,
    );
    WALK_SEAM = command(
        Menu::Sew,
        "Walk seam",
        key(PLAIN, Key::W),
        "Lay the two pieces of the selected seam on each other along it, and see what lines cross it",
        ToileApp::has_seams,
        ToileApp::walk_seam,
    )
    .under_rule();
    SHOW_MARKER = command(
        Menu::Marker,
        "Show marker",
        key(PLAIN, Key::F10),
        "Show or hide how the pieces lie on the fabric",
        ToileApp::has_panels,
        ToileApp::toggle_marker,
    )
    .on_while(|app| app.panes.marker);
    NEW_MARKER = command(
        Menu::Marker,
        "New marker",
        None,
        "Make a marker of a fabric",
        ToileApp::has_panels,
        ToileApp::new_marker,
    )
    .under_rule();
    REMOVE_MARKER = command(
        Menu::Marker,
        "Remove marker",
        None,
        "Take the marker away; the panels stay",
        ToileApp::has_marker,
        ToileApp::remove_marker,
    );
    SEARCH_MARKER = command(
        Menu::Marker,
        "Search marker",
        key(SHIFT, Key::F10),
        "Lay all pieces in as little fabric as can be found",
        |app| app.has_marker() && !app.is_searching(),
        ToileApp::search_marker,
    )
    .under_rule();
    STOP_SEARCH = command(
        Menu::Marker,
        "Stop search",
        None,
        "End the search with the best marker so far",
        ToileApp::is_searching,
        ToileApp::stop_search,
    );
    EXPORT_MARKER_DXF = command(
        Menu::Marker,
        "Export marker DXF",
        None,
        "Write the marker for cutters and drafting programs: as it lies, or laid anew where there is none",
        |app| app.has_panels() && !app.is_exporting(),
        ToileApp::ask_export_dxf,
    );
    TURN_PIECE = command(
        Menu::Marker,
        "Turn piece",
        None,
        "Turn the selected pieces by half a turn (R in the marker)",
        ToileApp::has_pieces,
        |app| app.on_pieces(|view| view.turn(2.0)),
    )
    .under_rule();
    TURN_OVER = command(
        Menu::Marker,
        "Turn over",
        None,
        "Turn the selected pieces face down (F in the marker)",
        ToileApp::has_pieces,
        |app| app.on_pieces(MarkerView::flip),
    );
    LOCK_PIECE = command(
        Menu::Marker,
        "Lock piece",
        None,
        "Keep the selected pieces where they are, or free them (L in the marker)",
        ToileApp::has_pieces,
        |app| app.on_pieces(|_| Some(MarkerAction::Lock)),
    );
    TAKE_OFF = command(
        Menu::Marker,
        "Take off",
        None,
        "Take the selected pieces off the fabric (Delete in the marker)",
        ToileApp::has_pieces,
        |app| app.on_pieces(|_| Some(MarkerAction::TakeOff)),
    );
    DRAPE = command(
        Menu::Garment,
        "Drape",
        key(PLAIN, Key::F5),
        "Sew the garment round the mannequin and let it hang, anew where it hangs already",
        ToileApp::has_panels,
        ToileApp::drape,
    );
    PAUSE = command(
        Menu::Garment,
        "Pause",
        key(PLAIN, Key::F6),
        "Hold the drape, or let it go on",
        |app| app.background_work.is_draping(),
        |app| app.background_work.toggle_pause(),
    );
    STOP = command(
        Menu::Garment,
        "Stop",
        key(SHIFT, Key::F5),
        "End the drape and keep what there is",
        |app| app.background_work.is_draping(),
        |app| app.background_work.stop(),
    );
    REGION = command(
        Menu::Garment,
        "Panel from the mannequin",
        key(SHIFT, Key::F6),
        "Click places round a region of the mannequin, and make a panel that covers it",
        ToileApp::is_open,
        ToileApp::toggle_loop,
    )
    .on_while(ToileApp::lays_loop);
    WEARER = command(
        Menu::Garment,
        "Wearer",
        key(PLAIN, Key::F3),
        "Choose who wears the garment, and see all measurements of theirs",
        ToileApp::is_open,
        |app| app.show_table(Tab::Wearer),
    );
    WEARER_FROM_FILE = command(
        Menu::Garment,
        "Wearer from file",
        None,
        "Take the wearer from a table of measurements or a mannequin file",
        ToileApp::is_open,
        ToileApp::ask_wearer,
    );
    WORN_WITH = command(
        Menu::Garment,
        "Worn with",
        key(SHIFT, Key::F3),
        "Show what is worn over and under the garment",
        ToileApp::is_open,
        |app| app.show_table(Tab::WornWith),
    );
    WEAR_OVER = command(
        Menu::Garment,
        "Wear over",
        None,
        "Wear the garment of another pattern over this one",
        ToileApp::is_open,
        |app| app.ask_worn(WornWhere::Over),
    );
    WEAR_UNDER = command(
        Menu::Garment,
        "Wear under",
        None,
        "Wear the garment of another pattern under this one",
        ToileApp::is_open,
        |app| app.ask_worn(WornWhere::Under),
    );
    FRONT_VIEW = command(
        Menu::Garment,
        "Front view",
        key(PLAIN, Key::Num1),
        "Look at the front of the garment",
        always,
        |app| app.stage.look_from(0.0),
    )
    .under_rule();
    BACK_VIEW = command(
        Menu::Garment,
        "Back view",
        key(PLAIN, Key::Num2),
        "Look at the back of the garment",
        always,
        |app| app.stage.look_from(std::f64::consts::PI),
    );
    SIDE_VIEW = command(
        Menu::Garment,
        "Side view",
        key(PLAIN, Key::Num3),
        "Look at the wearer's left side",
        always,
        |app| app.stage.look_from(std::f64::consts::FRAC_PI_2),
    );
}
