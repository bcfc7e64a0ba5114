//! Colours and type of the window: paper, cloth and chalk; calm, with one accent.

use egui::{Color32, CornerRadius, FontFamily, FontId, Margin, Stroke, TextStyle, Theme, vec2};

/// Red, green and blue of a colour (sRGB, 0..=1), in steps of 1/255.
pub fn bytes(colour: [f64; 3]) -> [u8; 3] {
    colour.map(|share| (share * 255.0).round() as u8)
}

/// Colours of the window in one theme.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Palette {
    /// The table under the pattern.
    pub table: Color32,
    /// Fine lines on the table.
    pub grid: Color32,
    /// Coarse lines on the table.
    pub grid_coarse: Color32,
    /// Bars and strips.
    pub bar: Color32,
    /// Lines between bars.
    pub rule: Color32,
    /// Fields for text, and buttons.
    pub field: Color32,
    /// A panel.
    pub panel: Color32,
    /// The mirrored half of a folded panel.
    pub panel_mirrored: Color32,
    /// A panel that cannot be drawn now.
    pub panel_stale: Color32,
    /// Outlines and text.
    pub ink: Color32,
    /// Secondary text.
    pub ink_soft: Color32,
    /// Grainlines, construction, inner lines.
    pub pencil: Color32,
    /// Guides.
    pub guide: Color32,
    /// Selected and hovered parts, and the main button.
    pub accent: Color32,
    /// Text on the accent.
    pub on_accent: Color32,
    /// Background of selected widgets.
    pub accent_soft: Color32,
    /// Errors.
    pub fault: Color32,
    /// Warnings.
    pub warning: Color32,
    /// Results that are as they should be.
    pub good: Color32,
    /// Background of the garment.
    pub stage: Color32,
    /// Floor under the mannequin; it fades into the background at the rim.
    pub floor: Color32,
}

/// The light theme: paper, cloth and chalk.
pub const LIGHT: Palette = Palette {
    table: Color32::from_rgb(0xEF, 0xEC, 0xE5),
    grid: Color32::from_rgb(0xE6, 0xE2, 0xD9),
    grid_coarse: Color32::from_rgb(0xDB, 0xD6, 0xCA),
    bar: Color32::from_rgb(0xFB, 0xFA, 0xF7),
    rule: Color32::from_rgb(0xDD, 0xD8, 0xCD),
    field: Color32::WHITE,
    panel: Color32::from_rgb(0xFE, 0xFD, 0xFA),
    panel_mirrored: Color32::from_rgb(0xF6, 0xF4, 0xEE),
    panel_stale: Color32::from_rgb(0xEC, 0xDF, 0xDA),
    ink: Color32::from_rgb(0x2E, 0x33, 0x3B),
    ink_soft: Color32::from_rgb(0x62, 0x66, 0x6E),
    pencil: Color32::from_rgb(0x93, 0x90, 0x88),
    guide: Color32::from_rgb(0x6A, 0x7F, 0xE0),
    accent: Color32::from_rgb(0x1F, 0x6F, 0x78),
    on_accent: Color32::WHITE,
    accent_soft: Color32::from_rgb(0xD3, 0xE6, 0xE6),
    fault: Color32::from_rgb(0xA8, 0x32, 0x2A),
    warning: Color32::from_rgb(0x85, 0x58, 0x0A),
    good: Color32::from_rgb(0x2C, 0x6E, 0x3A),
    stage: Color32::from_rgb(0xE4, 0xE6, 0xE7),
    floor: Color32::from_rgb(0xC4, 0xC6, 0xC7),
};

/// The dark theme.
pub const DARK: Palette = Palette {
    table: Color32::from_rgb(0x23, 0x25, 0x28),
    grid: Color32::from_rgb(0x2B, 0x2D, 0x31),
    grid_coarse: Color32::from_rgb(0x38, 0x3B, 0x40),
    bar: Color32::from_rgb(0x1B, 0x1C, 0x1F),
    rule: Color32::from_rgb(0x3A, 0x3D, 0x42),
    field: Color32::from_rgb(0x2A, 0x2C, 0x30),
    panel: Color32::from_rgb(0x3B, 0x3E, 0x44),
    panel_mirrored: Color32::from_rgb(0x32, 0x35, 0x3A),
    panel_stale: Color32::from_rgb(0x4A, 0x38, 0x36),
    ink: Color32::from_rgb(0xE8, 0xE6, 0xE1),
    ink_soft: Color32::from_rgb(0xB4, 0xB3, 0xAF),
    pencil: Color32::from_rgb(0x8A, 0x8B, 0x8E),
    guide: Color32::from_rgb(0x86, 0x98, 0xF2),
    accent: Color32::from_rgb(0x5F, 0xC2, 0xCB),
    on_accent: Color32::from_rgb(0x10, 0x1A, 0x1C),
    accent_soft: Color32::from_rgb(0x22, 0x4A, 0x4F),
    fault: Color32::from_rgb(0xF0, 0x8A, 0x7E),
    warning: Color32::from_rgb(0xE2, 0xB1, 0x5A),
    good: Color32::from_rgb(0x86, 0xCB, 0x93),
    stage: Color32::from_rgb(0x2A, 0x2D, 0x31),
    floor: Color32::from_rgb(0x43, 0x47, 0x4C),
};

/// Half the width of the strip in which the border between two parts of the window can be dragged
/// (pixels).
pub const GRAB: f32 = 4.0;

impl Palette {
    /// Colours of the present theme.
    pub fn of(context: &egui::Context) -> &'static Self {
        match context.theme() {
            Theme::Light => &LIGHT,
            Theme::Dark => &DARK,
        }
    }
}

/// Colours of seams; both sides of a seam have the same. They are muted and of similar lightness, and
/// differ in hue; red is left out, because it means errors.
const SEAMS: [Color32; 10] = [
    Color32::from_rgb(0x3B, 0x7E, 0xA8),
    Color32::from_rgb(0xC0, 0x86, 0x2E),
    Color32::from_rgb(0x5E, 0x8F, 0x4A),
    Color32::from_rgb(0x8A, 0x63, 0xA8),
    Color32::from_rgb(0x2F, 0x8F, 0x83),
    Color32::from_rgb(0xA8, 0x58, 0x9C),
    Color32::from_rgb(0x8C, 0x84, 0x3A),
    Color32::from_rgb(0x6A, 0x72, 0xB8),
    Color32::from_rgb(0x4F, 0x9F, 0xC4),
    Color32::from_rgb(0x7A, 0x6A, 0x5C),
];

/// Factor on the lightness of the second round of colours, so that 20 seams differ (1).
const SECOND_ROUND: f32 = 0.68;

/// Colour of a seam by its number (from 1).
pub fn seam(number: usize) -> Color32 {
    let k = number.saturating_sub(1);
    let colour = SEAMS[k % SEAMS.len()];
    match (k / SEAMS.len()) % 2 {
        0 => colour,
        _ => {
            let [red, green, blue, _] = colour.to_array();
            let darker = |x: u8| (f32::from(x) * SECOND_ROUND) as u8;
            Color32::from_rgb(darker(red), darker(green), darker(blue))
        }
    }
}

/// Font of a height (logical pixels).
pub fn font(size: f32) -> FontId {
    FontId::new(size, FontFamily::Proportional)
}

/// A title above fields: larger, and drawn twice with a small offset to look bold, because the font has
/// one weight only.
pub fn title(ui: &mut egui::Ui, words: &str) -> egui::Response {
    let words = egui::RichText::new(words).font(font(16.0));
    let ink = Palette::of(ui.ctx()).ink;
    let (at, galley, response) = egui::Label::new(words).wrap().layout_in_ui(ui);
    for across in [0.0, 0.45] {
        let at = at + vec2(across, 0.0);
        ui.painter().galley(at, galley.clone(), ink);
    }
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, galley.text()));
    response
}

/// Sets colours and fonts of the whole window, in both themes.
pub fn apply(context: &egui::Context) {
    for theme in [Theme::Light, Theme::Dark] {
        context.style_mut_of(theme, |style| {
            style.text_styles = [
                (TextStyle::Heading, font(18.0)),
                (TextStyle::Body, font(14.5)),
                (TextStyle::Button, font(14.5)),
                (TextStyle::Small, font(12.5)),
                (
                    TextStyle::Monospace,
                    FontId::new(13.0, FontFamily::Monospace),
                ),
            ]
            .into();
            style.spacing.item_spacing = vec2(6.0, 6.0);
            style.spacing.button_padding = vec2(8.0, 4.0);
            style.spacing.interact_size = vec2(40.0, 26.0);
            style.spacing.menu_margin = Margin::same(6);
            // Drop-down lists scroll only if they are longer than most windows are high.
            style.spacing.combo_height = 480.0;
            style.interaction.resize_grab_radius_side = GRAB;
            // A scroll bar stays visible while the pointer is elsewhere, to show that there is more.
            style.spacing.scroll.dormant_handle_opacity = 0.6;
            colour(&mut style.visuals, theme);
        });
    }
}

fn colour(visuals: &mut egui::Visuals, theme: Theme) {
    let palette = match theme {
        Theme::Light => &LIGHT,
        Theme::Dark => &DARK,
    };
    *visuals = match theme {
        Theme::Light => egui::Visuals::light(),
        Theme::Dark => egui::Visuals::dark(),
    };
    visuals.override_text_color = Some(palette.ink);
    visuals.weak_text_color = Some(palette.ink_soft);
    visuals.panel_fill = palette.bar;
    visuals.window_fill = palette.bar;
    visuals.window_stroke = Stroke::new(1.0, palette.rule);
    visuals.extreme_bg_color = palette.field;
    visuals.selection.bg_fill = palette.accent_soft;
    visuals.selection.stroke = Stroke::new(1.0, palette.accent);
    visuals.hyperlink_color = palette.accent;
    visuals.warn_fg_color = palette.warning;
    visuals.error_fg_color = palette.fault;
    let radius = CornerRadius::same(5);
    let widgets = &mut visuals.widgets;
    let soft = palette.accent_soft;
    for (widget, fill, edge) in [
        (&mut widgets.noninteractive, palette.bar, palette.rule),
        (&mut widgets.inactive, palette.field, palette.rule),
        (&mut widgets.hovered, palette.field, palette.accent),
        (&mut widgets.active, soft, palette.accent),
        (&mut widgets.open, soft, palette.accent),
    ] {
        widget.bg_fill = fill;
        widget.weak_bg_fill = fill;
        widget.bg_stroke = Stroke::new(1.0, edge);
        widget.fg_stroke = Stroke::new(1.0, palette.ink);
        widget.corner_radius = radius;
        widget.expansion = 0.0;
    }
}

/// The frame of a horizontal bar.
pub fn bar(context: &egui::Context) -> egui::Frame {
    egui::Frame::new()
        .fill(Palette::of(context).bar)
        .inner_margin(Margin::symmetric(8, 4))
}
