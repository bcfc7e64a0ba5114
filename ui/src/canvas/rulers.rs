//! Rulers along the upper and the left rim of the view, in the unit of the document.

use super::camera::{TableCamera, TablePoint};
use crate::theme::{self, Palette};
use egui::{Align2, Painter, Rect, Stroke, pos2, vec2};
use toile_geometry::Vec2;
use toile_pattern::DisplayUnit;

/// Width of a ruler (pixels).
pub const RULER: f32 = 18.0;
/// Least distance between numbers (pixels).
const NUMBERS: f64 = 56.0;

/// Possible steps between numbers in a unit, each with its number of subdivisions. The smallest step with
/// enough distance between the numbers is used.
fn steps(unit: DisplayUnit) -> &'static [(f64, u32)] {
    match unit {
        DisplayUnit::Inch => &[
            (0.125, 2),
            (0.25, 4),
            (0.5, 4),
            (1.0, 8),
            (3.0, 3),
            (6.0, 6),
            (12.0, 12),
            (36.0, 3),
            (72.0, 6),
            (144.0, 4),
        ],
        _ => &[
            (0.1, 10),
            (0.2, 2),
            (0.5, 5),
            (1.0, 10),
            (2.0, 2),
            (5.0, 5),
            (10.0, 10),
            (20.0, 2),
            (50.0, 5),
            (100.0, 10),
            (200.0, 2),
            (500.0, 5),
            (1000.0, 10),
            (2000.0, 2),
            (5000.0, 5),
        ],
    }
}

/// The step between numbers and its subdivisions, at an enlargement (pixels per metre).
pub fn step(unit: DisplayUnit, scale: f64) -> (f64, u32) {
    let all = steps(unit);
    let pixels = scale * unit.metres();
    let wide = all.iter().find(|(step, _)| step * pixels >= NUMBERS);
    wide.or(all.last()).copied().unwrap_or((1.0, 1))
}

/// Paints both rulers; their zero is at the table point `origin` (m).
pub fn paint(
    painter: &Painter,
    (view, camera): (Rect, &TableCamera),
    (origin, unit): (Vec2, DisplayUnit),
    palette: &Palette,
) {
    let (step, parts) = step(unit, camera.scale);
    let part = step / f64::from(parts);
    let tick = Stroke::new(1.0, palette.pencil);
    let top = Rect::from_min_size(view.min, vec2(view.width(), RULER));
    let left = Rect::from_min_size(view.min, vec2(RULER, view.height()));
    let metres = unit.metres();
    let half = Vec2::new(f64::from(view.width()), f64::from(view.height())) * 0.5 / camera.scale;
    let (low, high) = (camera.centre - half - origin, camera.centre + half - origin);
    let range = |from: f64, to: f64| {
        (from / metres / part).floor() as i64..=(to / metres / part).ceil() as i64
    };
    let words = |n: i64| {
        let value = n as f64 * part;
        let text = format!("{value:.3}");
        let text = text.trim_end_matches('0').trim_end_matches('.');
        if text == "-0" {
            "0".to_owned()
        } else {
            text.to_owned()
        }
    };
    painter.rect_filled(top, 0.0, palette.bar);
    for n in range(low.x, high.x) {
        let at = origin + Vec2::new(n as f64 * part * metres, 0.0);
        let x = camera.screen(view, TablePoint(at)).0.x.round();
        let is_whole = n.rem_euclid(i64::from(parts)) == 0;
        let length = if is_whole { RULER } else { 4.0 };
        painter.vline(x, top.bottom() - length..=top.bottom(), tick);
        if is_whole {
            painter.text(
                pos2(x + 3.0, top.top() + 1.0),
                Align2::LEFT_TOP,
                words(n),
                theme::font(10.0),
                palette.ink_soft,
            );
        }
    }
    painter.rect_filled(left, 0.0, palette.bar);
    for n in range(low.y, high.y) {
        let at = origin + Vec2::new(0.0, n as f64 * part * metres);
        let y = camera.screen(view, TablePoint(at)).0.y.round();
        let is_whole = n.rem_euclid(i64::from(parts)) == 0;
        let length = if is_whole { RULER } else { 4.0 };
        painter.hline(left.right() - length..=left.right(), y, tick);
        if is_whole {
            let galley = painter.layout_no_wrap(words(n), theme::font(10.0), palette.ink_soft);
            // Numbers of the left ruler read from bottom to top.
            let corner = pos2(left.left() + 1.0, y - 3.0);
            let turned = egui::epaint::TextShape::new(corner, galley, palette.ink_soft)
                .with_angle(-std::f32::consts::FRAC_PI_2);
            painter.add(turned);
        }
    }
    let corner = Rect::from_min_size(view.min, vec2(RULER, RULER));
    painter.rect_filled(corner, 0.0, palette.bar);
    painter.text(
        corner.center(),
        Align2::CENTER_CENTER,
        unit.sign(),
        theme::font(9.5),
        palette.ink_soft,
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_a_ruler_keep_apart_and_lie_on_its_ticks() {
        for unit in [
            DisplayUnit::Millimetre,
            DisplayUnit::Centimetre,
            DisplayUnit::Metre,
            DisplayUnit::Inch,
        ] {
            for k in 0..40 {
                let scale = 20.0 * 1.2_f64.powi(k);
                let (step, parts) = step(unit, scale);
                let pixels = step * unit.metres() * scale;
                let is_finest = step == steps(unit)[0].0;
                assert!(pixels >= NUMBERS - 1e-9, "{unit:?} {scale}: {pixels}");
                assert!(
                    is_finest || pixels < 6.0 * NUMBERS,
                    "{unit:?} {scale}: {pixels}"
                );
                assert!(parts > 0);
            }
        }
    }
}
