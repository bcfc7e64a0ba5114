//! Paints the overlay of a tool: a piece as a ghost, lines, marks, and labels that do not overlap.

use super::paint::Picture;
use crate::tools::{Overlay, Tone};
use egui::{Color32, Pos2, Rect, Shape, Stroke, vec2};
use toile_geometry::Vec2;

/// Opacity of the cloth of a ghost, the preview of a piece laid on the table.
const GHOST: f32 = 0.55;
/// Offset of a label of the tone good, warning or fault from its place (pixels): far enough to keep the lines
/// there visible.
const ABOVE: egui::Vec2 = vec2(30.0, -36.0);
/// Offset of a label of the plain tone from its place (pixels).
const BELOW: egui::Vec2 = vec2(30.0, 36.0);
/// Gap between labels, and between them and the edge of the view (pixels).
const ROOM: f32 = 3.0;

impl Picture<'_> {
    fn toned(&self, tone: Tone) -> Color32 {
        match tone {
            Tone::Plain => self.palette.accent,
            Tone::Good => self.palette.good,
            Tone::Warning => self.palette.warning,
            Tone::Fault => self.palette.fault,
        }
    }

    /// Paints an overlay mark on the table; labels are painted separately.
    pub(super) fn on_table(&self, mark: &Overlay) {
        let table = Vec2::zeros();
        match mark {
            Overlay::Ghost(rings, fill) => {
                let cloth = self.palette.accent_soft.gamma_multiply(GHOST);
                self.filled(table, fill, cloth, egui::Vec2::ZERO);
                let stroke = Stroke::new(1.4, self.palette.accent);
                for ring in rings {
                    let line = self.line(table, ring);
                    self.painter
                        .extend(Shape::dashed_line(&line, stroke, 7.0, 3.0));
                }
            }
            Overlay::Stroke(line, tone) => {
                let stroke = Stroke::new(2.6, self.toned(*tone));
                self.painter.line(self.line(table, line), stroke);
            }
            Overlay::Thread(line, tone) => {
                let stroke = Stroke::new(1.8, self.toned(*tone));
                let line = self.line(table, line);
                self.painter
                    .extend(Shape::dashed_line(&line, stroke, 6.0, 4.0));
            }
            Overlay::Pip(at, tone) => {
                let at = self.seen(table, *at);
                let reach = 5.0;
                let corners = [(0.0, -reach), (reach, 0.0), (0.0, reach), (-reach, 0.0)];
                let corners = corners.map(|(x, y)| at + vec2(x, y)).to_vec();
                let stroke = Stroke::new(1.6, self.toned(*tone));
                let shape = Shape::convex_polygon(corners, self.palette.field, stroke);
                self.painter.add(shape);
            }
            Overlay::Touch(at) => {
                let at = self.seen(table, *at);
                let stroke = Stroke::new(2.0, self.palette.accent);
                self.painter.circle(at, 6.5, self.palette.field, stroke);
                self.painter.circle_filled(at, 2.5, self.palette.accent);
            }
            _ => {}
        }
    }

    /// Paints labels beside places of the table. A label that would cover another is moved below or above
    /// it; all stay within the view.
    pub(super) fn labels(&self, overlay: &[Overlay]) {
        let mut placed: Vec<Rect> = Vec::new();
        for mark in overlay {
            let Overlay::Label(at, words, tone) = mark else {
                continue;
            };
            if words.is_empty() {
                continue;
            }
            let at = self.seen(Vec2::zeros(), *at);
            let way = match tone {
                Tone::Plain => BELOW,
                Tone::Good | Tone::Warning | Tone::Fault => ABOVE,
            };
            let colour = self.toned(*tone);
            let ground = self.words_on(words, colour, |size, _| {
                let goal = at + way - vec2(0.0, size.y * 0.5);
                let ground = clear(&placed, self.clear_view().shrink(ROOM), (goal, size));
                let line = [at, ground.clamp(at)];
                self.painter.line_segment(line, Stroke::new(1.0, colour));
                ground
            });
            placed.push(ground);
        }
    }
}

/// Rectangle for text at a point, or above or below the point, that lies inside a view and overlaps no
/// rectangle of `placed`.
fn clear(placed: &[Rect], view: Rect, (at, size): (Pos2, egui::Vec2)) -> Rect {
    let right = (view.right() - size.x).max(view.left());
    let bottom = (view.bottom() - size.y).max(view.top());
    let inside = |min: Pos2| {
        let min = Pos2::new(
            min.x.clamp(view.left(), right),
            min.y.clamp(view.top(), bottom),
        );
        Rect::from_min_size(min, size)
    };
    let first = inside(at);
    let is_clear = |rect: &Rect| {
        placed
            .iter()
            .all(|other| !other.expand(ROOM).intersects(*rect))
    };
    let ways = (0..2 * placed.len() + 2).map(|k| {
        let rows = (k / 2 + 1) as f32 * (size.y + 2.0 * ROOM);
        let down = if k % 2 == 0 { rows } else { -rows };
        inside(first.min + vec2(0.0, down))
    });
    let mut places = std::iter::once(first).chain(ways);
    places.find(is_clear).unwrap_or(first)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_at_one_place_stand_clear_of_each_other_and_within_the_view() {
        let view = Rect::from_min_size(Pos2::ZERO, vec2(400.0, 200.0));
        let mut placed: Vec<Rect> = Vec::new();
        for at in [
            (200.0, 100.0),
            (201.0, 101.0),
            (390.0, 195.0),
            (395.0, 190.0),
        ] {
            let rect = clear(&placed, view, (at.into(), vec2(120.0, 18.0)));
            assert!(view.contains_rect(rect), "{rect:?}");
            assert!(
                placed.iter().all(|other| !other.intersects(rect)),
                "{rect:?}"
            );
            placed.push(rect);
        }
    }
}
