//! The tool bar: icons of the tools in named groups, with their names beside them if wanted.

use super::ToileApp;
use super::command::shortcut_words;
use super::command_table::named;
use super::tool_icons;
use crate::theme::{self, Palette};
use crate::tools::Tool;
use egui::{Button, RichText, Ui, pos2, vec2};

/// Widths of the tool bar: icons only, and with names and keys (pixels).
const WIDTHS: [f32; 2] = [44.0, 186.0];
/// Least and largest height of a button (pixels).
const HEIGHTS: [f32; 2] = [16.0, 28.0];
/// Height of the name of a group (pixels).
const GROUP: f32 = 15.0;
/// Largest side of an icon (pixels).
const SIGN: f32 = 20.0;
/// Font size of the name of a group (pixels).
const GROUP_TEXT: f32 = 10.5;

/// Groups of tools: the name of each, empty for the first, and the commands that take the tools in hand.
const GROUPS: &[(&str, &[&str])] = &[
    ("", &["Select"]),
    (
        "Draw",
        &[
            "Point",
            "Line",
            "Curve",
            "Arc",
            "Arc about centre",
            "Tangent arc",
            "Circle",
            "Polygon",
            "Rectangle",
        ],
    ),
    (
        "Points",
        &["Point from", "Point along", "Perpendicular", "Mirror point"],
    ),
    ("Alter", &["Move", "Turn", "Mirror", "Scale", "Measure"]),
    (
        "Panel",
        &[
            "Trace",
            "Divide edge",
            "Bend edge",
            "Split",
            "Fold",
            "Notch",
            "Inner line",
            "Grain",
        ],
    ),
    ("Dart", &["Dart", "Fisheye dart", "Pivot dart", "Spread"]),
    ("Sew", &["Seam", "Matched notches", "Walk seam"]),
];

/// The commands of all buttons.
#[cfg(test)]
pub(super) fn tools() -> impl Iterator<Item = &'static str> {
    GROUPS.iter().flat_map(|(_, names)| names.iter().copied())
}

impl ToileApp {
    /// Width of the tool bar without the margin round it (pixels).
    pub(crate) fn tool_bar_width(&self) -> f32 {
        WIDTHS[usize::from(self.panes.tool_names)]
    }

    pub(crate) fn tool_bar(&mut self, ui: &mut Ui) {
        // The height of the buttons is chosen so that all of them fit.
        let named_groups = GROUPS.iter().filter(|(name, _)| !name.is_empty()).count();
        let count: usize = GROUPS.iter().map(|(_, names)| names.len()).sum();
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

    fn tool_button(&mut self, ui: &mut Ui, name: &'static str, height: f32) {
        let Some(command) = named(name) else {
            return;
        };
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
            Tool::Select => "Select",
            Tool::Slots(tool) => tool.command,
            Tool::Walk => "Walk seam",
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
