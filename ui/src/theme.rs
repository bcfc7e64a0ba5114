//! Colours and type of the window: paper, cloth and chalk; calm, with one accent.

use egui::{Color32, CornerRadius, FontFamily, FontId, Margin, Stroke, TextStyle, Theme, vec2};

/// The table under the pattern.
pub const TABLE: Color32 = Color32::from_rgb(0xEF, 0xEC, 0xE5);
/// Fine lines on the table.
pub const GRID: Color32 = Color32::from_rgb(0xE6, 0xE2, 0xD9);
/// Coarse lines on the table.
pub const GRID_COARSE: Color32 = Color32::from_rgb(0xDB, 0xD6, 0xCA);
/// Bars and strips.
pub const BAR: Color32 = Color32::from_rgb(0xFB, 0xFA, 0xF7);
/// Lines between bars.
pub const RULE: Color32 = Color32::from_rgb(0xDD, 0xD8, 0xCD);
/// A panel.
pub const PANEL: Color32 = Color32::from_rgb(0xFE, 0xFD, 0xFA);
/// The mirrored half of a folded panel.
pub const PANEL_MIRRORED: Color32 = Color32::from_rgb(0xF6, 0xF4, 0xEE);
/// Outlines and text.
pub const INK: Color32 = Color32::from_rgb(0x2E, 0x33, 0x3B);
/// Secondary text.
pub const INK_SOFT: Color32 = Color32::from_rgb(0x6C, 0x70, 0x78);
/// Grainlines, mirrored outlines, internal lines.
pub const PENCIL: Color32 = Color32::from_rgb(0xA3, 0xA0, 0x98);
/// What is selected or under the pointer, and the main button.
pub const ACCENT: Color32 = Color32::from_rgb(0x1F, 0x6F, 0x78);
/// Behind selected widgets.
pub const ACCENT_SOFT: Color32 = Color32::from_rgb(0xD3, 0xE6, 0xE6);
/// Faults.
pub const FAULT: Color32 = Color32::from_rgb(0xA8, 0x32, 0x2A);
/// Warnings.
pub const WARNING: Color32 = Color32::from_rgb(0x8F, 0x5F, 0x0B);
/// Behind the garment.
pub const STAGE: Color32 = Color32::from_rgb(0xE4, 0xE6, 0xE7);

/// Colours of seams: both sides share one. Muted, of like lightness, told apart by hue.
const SEAMS: [Color32; 10] = [
    Color32::from_rgb(0xC0, 0x5A, 0x4B),
    Color32::from_rgb(0x3B, 0x7E, 0xA8),
    Color32::from_rgb(0x5E, 0x8F, 0x4A),
    Color32::from_rgb(0x8A, 0x63, 0xA8),
    Color32::from_rgb(0xC0, 0x86, 0x2E),
    Color32::from_rgb(0x2F, 0x8F, 0x83),
    Color32::from_rgb(0xB0, 0x56, 0x84),
    Color32::from_rgb(0x6A, 0x72, 0xB8),
    Color32::from_rgb(0x8C, 0x84, 0x3A),
    Color32::from_rgb(0x7A, 0x6A, 0x5C),
];

/// The second round of colours is darker by this factor, so that 20 seams differ.
const SECOND_ROUND: f32 = 0.68;

/// The colour of the seam with that number (from 1).
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

/// Font of that size [logical pixels].
pub fn font(size: f32) -> FontId {
    FontId::new(size, FontFamily::Proportional)
}

/// Sets colours and type of the whole window.
pub fn apply(context: &egui::Context) {
    context.set_theme(Theme::Light);
    context.style_mut_of(Theme::Light, |style| {
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
        style.spacing.button_padding = vec2(10.0, 5.0);
        style.spacing.interact_size = vec2(40.0, 28.0);
        style.spacing.menu_margin = Margin::same(8);
        colour(&mut style.visuals);
    });
}

fn colour(visuals: &mut egui::Visuals) {
    *visuals = egui::Visuals::light();
    visuals.override_text_color = Some(INK);
    visuals.weak_text_color = Some(INK_SOFT);
    visuals.panel_fill = BAR;
    visuals.window_fill = BAR;
    visuals.window_stroke = Stroke::new(1.0, RULE);
    visuals.extreme_bg_color = Color32::WHITE;
    visuals.selection.bg_fill = ACCENT_SOFT;
    visuals.selection.stroke = Stroke::new(1.0, ACCENT);
    visuals.warn_fg_color = WARNING;
    visuals.error_fg_color = FAULT;
    let radius = CornerRadius::same(5);
    let widgets = &mut visuals.widgets;
    for (widget, fill, edge) in [
        (&mut widgets.noninteractive, BAR, RULE),
        (&mut widgets.inactive, Color32::WHITE, RULE),
        (
            &mut widgets.hovered,
            Color32::from_rgb(0xF1, 0xF5, 0xF4),
            ACCENT,
        ),
        (&mut widgets.active, ACCENT_SOFT, ACCENT),
        (&mut widgets.open, ACCENT_SOFT, ACCENT),
    ] {
        widget.bg_fill = fill;
        widget.weak_bg_fill = fill;
        widget.bg_stroke = Stroke::new(1.0, edge);
        widget.fg_stroke = Stroke::new(1.0, INK);
        widget.corner_radius = radius;
        widget.expansion = 0.0;
    }
}

/// The frame of a horizontal bar.
pub fn bar() -> egui::Frame {
    egui::Frame::new()
        .fill(BAR)
        .inner_margin(Margin::symmetric(10, 6))
}
