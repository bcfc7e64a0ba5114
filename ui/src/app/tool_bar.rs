//! The tool bar: icons of the tools in named groups, with their names beside them if wanted.
//!
//! # Decided with
//! - [`crate::app::tool_commands::TOOL_COMMANDS`]: name and key of each tool;
//! - [`crate::tools::slots::SlotTool`]: names its command, by which the button of the tool in hand is
//!   marked;
//! - [`crate::app::tool_icons`] (`strokes`): icon of each tool;
//! - [`crate::app::ToileApp::canvas_menu`] (`bars.rs`): the menu on the canvas.
//!
//! By hand: a new tool in `GROUPS` and in that menu; `docs/GUIDE.md`, `ui/tests/suite/drafting.rs` or
//! `ui/tests/suite/alter.rs`. `ui/tests/suite/every_slot.rs` and `ui/tests/suite/commands.rs` find it by themselves.

use super::ToileApp;
use super::command::{UiCommand, shortcut_words};
use super::tool_commands::{
    ARC, ARC_ABOUT_CENTRE, BEND_EDGE, CIRCLE, COMPASS_ON_LINE, CURVE, DART, DIVIDE_EDGE,
    FISHEYE_DART, FOLD, GRAIN, INNER_LINE, LINE, MATCHED_NOTCHES, MEASURE, MIRROR, MIRROR_POINT,
    MOVE, NOTCH, PERPENDICULAR, PIVOT_DART, POINT, POINT_ALONG, POINT_FROM, POLYGON, RECTANGLE,
    SCALE, SEAM, SELECT, SPLIT, SPREAD, SUGGESTED_SEAMS, TANGENT_ARC, TRACE, TURN, TWO_COMPASSES,
    WALK_SEAM,
};
use super::tool_icons;
use crate::theme::{self, Palette};
use crate::tools::Tool;
use egui::{Button, RichText, Ui, pos2, vec2};

/// Widths of the tool bar: icons only, and with names and keys (pixels).
const WIDTHS: [f32; 2] = [44.0, 186.0];
/// Least and largest height of a button (pixels).
const HEIGHTS: [f32; 2] = [14.0, 28.0];
/// Height of the name of a group (pixels).
const GROUP: f32 = 13.0;
/// Largest side of an icon (pixels).
const SIGN: f32 = 20.0;
/// Font size of the name of a group (pixels).
const GROUP_TEXT: f32 = 10.5;

/// Groups of tools: name of the group, empty for the first, and the commands that take its tools in hand.
static GROUPS: &[(&str, &[&UiCommand])] = &[
    ("", &[&SELECT]),
    (
        "Draw",
        &[
            &POINT,
            &LINE,
            &CURVE,
            &ARC,
            &ARC_ABOUT_CENTRE,
            &TANGENT_ARC,
            &CIRCLE,
            &POLYGON,
            &RECTANGLE,
        ],
    ),
    (
        "Points",
        &[
            &POINT_FROM,
            &POINT_ALONG,
            &PERPENDICULAR,
            &MIRROR_POINT,
            &COMPASS_ON_LINE,
            &TWO_COMPASSES,
        ],
    ),
    ("Alter", &[&MOVE, &TURN, &MIRROR, &SCALE, &MEASURE]),
    (
        "Panel",
        &[
            &TRACE,
            &DIVIDE_EDGE,
            &BEND_EDGE,
            &SPLIT,
            &FOLD,
            &NOTCH,
            &INNER_LINE,
            &GRAIN,
        ],
    ),
    ("Dart", &[&DART, &FISHEYE_DART, &PIVOT_DART, &SPREAD]),
    (
        "Sew",
        &[&SEAM, &SUGGESTED_SEAMS, &MATCHED_NOTCHES, &WALK_SEAM],
    ),
];

/// Names of the commands of all buttons.
#[cfg(test)]
pub(super) fn tools() -> impl Iterator<Item = &'static str> {
    GROUPS
        .iter()
        .flat_map(|(_, tools)| tools.iter().map(|tool| tool.name))
}

impl ToileApp {
    /// Width of the tool bar without the margin round it (pixels).
    pub(crate) fn tool_bar_width(&self) -> f32 {
        WIDTHS[usize::from(self.panes.tool_names)]
    }

    pub(crate) fn tool_bar(&mut self, ui: &mut Ui) {
        // The buttons get the largest height at which all of them fit.
        let named_groups = GROUPS.iter().filter(|(name, _)| !name.is_empty()).count();
        let count: usize = GROUPS.iter().map(|(_, tools)| tools.len()).sum();
        let room = ui.available_height() - named_groups as f32 * GROUP;
        let height = (room / count as f32).floor().clamp(HEIGHTS[0], HEIGHTS[1]);
        let rows = egui::ScrollArea::vertical()
            .scroll_bar_visibility(egui::scroll_area::ScrollBarVisibility::AlwaysHidden);
        rows.show(ui, |ui| {
            let spacing = ui.spacing_mut();
            spacing.item_spacing = vec2(0.0, 0.0);
            spacing.interact_size.y = height;
            spacing.button_padding = vec2(4.0, 0.0);
            for (name, tools) in GROUPS {
                if !name.is_empty() {
                    group_name(ui, name);
                }
                for tool in *tools {
                    self.tool_button(ui, tool, height);
                }
            }
        });
    }

    fn tool_button(&mut self, ui: &mut Ui, command: &'static UiCommand, height: f32) {
        let name = command.name;
        let in_hand = self.tool_name() == name;
        let key = command.key.map(|key| shortcut_words(ui.ctx(), &key));
        let side = height.min(SIGN);
        let button = match self.panes.tool_names {
            // Spaces leave room for the icon before the name.
            true => Button::new(RichText::new(format!("{}{name}", " ".repeat(8))).small())
                .shortcut_text(RichText::new(key.unwrap_or_default()).small()),
            false => Button::new(RichText::new("").size(8.0)),
        };
        let button = button
            .selected(in_hand)
            .frame_when_inactive(in_hand)
            .truncate()
            .min_size(vec2(ui.available_width(), height));
        let words = match self.panes.tool_names {
            true => None,
            false => Some(format!("{name}: {}", command.words(ui.ctx()))),
        };
        let top = ui.next_widget_position();
        let (width, palette) = (ui.available_width(), Palette::of(ui.ctx()));
        let can_be = (command.when)(self);
        self.command_widget(ui, command, button, words);
        let middle = match self.panes.tool_names {
            true => pos2(top.x + 4.0 + 0.5 * side, top.y + 0.5 * height),
            false => pos2(top.x + 0.5 * width, top.y + 0.5 * height),
        };
        let place = egui::Rect::from_center_size(middle, vec2(side, side));
        let colour = match (in_hand, can_be) {
            (true, _) => palette.accent,
            (false, true) => palette.ink,
            (false, false) => palette.pencil,
        };
        tool_icons::paint(ui.painter(), place, name, colour);
    }

    /// Name of the command that takes the present tool in hand.
    fn tool_name(&self) -> &'static str {
        match self.view.tool {
            Tool::Select => SELECT.name,
            Tool::Slots(tool) => tool.command,
            Tool::Walk => WALK_SEAM.name,
            Tool::Suggested => SUGGESTED_SEAMS.name,
        }
    }
}

/// The name of a group above its tools.
fn group_name(ui: &mut Ui, name: &str) {
    let size = vec2(ui.available_width(), GROUP);
    let (rect, _) = ui.allocate_exact_size(size, egui::Sense::hover());
    let palette = Palette::of(ui.ctx());
    let at = rect.left_bottom() + vec2(2.0, -1.0);
    let (font, colour) = (theme::font(GROUP_TEXT), palette.ink_soft);
    ui.painter()
        .text(at, egui::Align2::LEFT_BOTTOM, name, font, colour);
}
