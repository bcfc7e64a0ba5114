//! Signs of findings at the parts they are about: a triangle for a fault or a warning, a ring for a note.

use super::selection::Item;
use crate::theme::{self, Palette};
use egui::{Align2, Color32, Painter, Pos2, Rect, Shape, Stroke, Vec2, vec2};
use toile_pattern::Severity;

/// Sign for all findings on one part.
#[derive(Clone, Debug, PartialEq)]
pub struct FindingMark {
    /// The part.
    pub item: Item,
    /// End of the seam that the findings are about: 0 the start, 1 the end; `None` if they are about no
    /// end.
    pub end: Option<usize>,
    /// Highest severity of the findings.
    pub severity: Severity,
    /// Texts of all findings, one per line.
    pub words: String,
}

/// Offset of the sign from the part (pixels).
const AWAY: Vec2 = vec2(13.0, -15.0);
/// Half the side of a sign (pixels).
const REACH: f32 = 8.0;

impl FindingMark {
    /// Rectangle of the sign of a part that is drawn at a screen position.
    pub fn place(at: Pos2) -> Rect {
        Rect::from_center_size(at + AWAY, Vec2::splat(2.0 * REACH))
    }

    /// Colour of the sign.
    pub fn colour(severity: Severity, palette: &Palette) -> Color32 {
        match severity {
            Severity::Note => palette.accent,
            Severity::Warning => palette.warning,
            Severity::Error => palette.fault,
        }
    }

    /// Draws the sign.
    pub fn paint(&self, painter: &Painter, place: Rect, palette: &Palette) {
        let colour = Self::colour(self.severity, palette);
        let (middle, letter) = match self.severity {
            Severity::Note => {
                painter.circle(
                    place.center(),
                    REACH - 1.0,
                    palette.bar,
                    Stroke::new(1.5, colour),
                );
                (place.center(), "i")
            }
            Severity::Warning | Severity::Error => {
                let corners = vec![
                    place.center_top(),
                    place.right_bottom(),
                    place.left_bottom(),
                ];
                let rim = Stroke::new(1.0, palette.bar);
                painter.add(Shape::convex_polygon(corners, colour, rim));
                (place.center() + vec2(0.0, 2.0), "!")
            }
        };
        let ink = match self.severity {
            Severity::Note => colour,
            Severity::Warning | Severity::Error => palette.on_accent,
        };
        let font = theme::font(11.5);
        painter.text(middle, Align2::CENTER_CENTER, letter, font, ink);
    }
}
