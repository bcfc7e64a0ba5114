//! Paints seams, and the outlines of all sizes.

use super::grading::{CornerWay, Grading};
use super::paint::{NUMBER_INSET, Picture};
use super::panel_shape::along;
use super::scene::PanelScene;
use super::seams::{SeamDrawing, SeamEnd};
use super::selection::Item;
use crate::theme;
use egui::{Align2, Color32, Pos2, Rect, Shape, Stroke, vec2};
use toile_geometry::Vec2;

/// Inset of the coloured line of a seam from the outline (pixels).
const SEAM_INSET: f64 = 5.0;
/// Least length of a stretch of a seam that carries the seam's number (pixels).
const NUMBER_LEAST: f64 = 34.0;
/// Places along a stretch that are tried for its number, the preferred first (share of its length).
const NUMBER_PLACES: [f64; 7] = [0.5, 0.4, 0.6, 0.28, 0.72, 0.15, 0.85];
/// Radius of the background of a number (pixels).
const NUMBER_RADIUS: f32 = 8.5;
/// Largest difference of length between the sides of a seam that is shown without a warning (m).
const UNEVEN: f64 = 0.001;

impl Picture<'_> {
    /// Whether a seam is drawn wider, because the seam or an edge that it joins is selected or hovered.
    pub(super) fn touched(&self, seam: &SeamDrawing) -> bool {
        self.is_lit(Item::Seam(seam.id))
            || seam.stretches.iter().any(|stretch| {
                let item = stretch.edge.map(|edge| Item::Edge(stretch.panel, edge));
                item.is_some_and(|item| self.is_lit(item))
            })
    }

    pub(super) fn seam_lines(&self, seam: &SeamDrawing) {
        let width = if self.touched(seam) { 5.0 } else { 2.6 };
        for stretch in &seam.stretches {
            let Some(panel) = self.scene.panel_scene(stretch.panel) else {
                continue;
            };
            let origin = self.table_layout.panel(panel.id);
            let inset = panel.shape.cloth_side * SEAM_INSET / self.camera.scale;
            let line = self.line(origin, &beside(&stretch.line, inset));
            let colour = theme::seam(seam.number);
            let colour = match stretch.edge {
                Some(_) => colour,
                None => colour.gamma_multiply(0.45),
            };
            self.painter.line(line, Stroke::new(width, colour));
        }
    }

    /// Paints the number of a seam beside each of its stretches that is long enough, in the middle or where
    /// the number is clear of other labels.
    pub(super) fn seam_numbers(&self, seam: &SeamDrawing, labels: &mut Vec<Rect>) {
        for stretch in &seam.stretches {
            let Some(panel) = self.scene.panel_scene(stretch.panel) else {
                continue;
            };
            let scale = self.camera.scale;
            let length: f64 = stretch.line.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
            if length * scale < NUMBER_LEAST {
                continue;
            }
            let origin = self.table_layout.panel(panel.id);
            let places = NUMBER_PLACES.iter().filter_map(|share| {
                let (at, way) = along(&stretch.line, *share)?;
                let inward = Vec2::new(-way.y, way.x) * panel.shape.cloth_side;
                Some(self.seen(origin, at + inward * (NUMBER_INSET / scale)))
            });
            let room = |at: Pos2| Rect::from_center_size(at, vec2(2.0, 2.0) * NUMBER_RADIUS);
            let is_free = |at: &Pos2| !labels.iter().any(|other| other.intersects(room(*at)));
            let Some(middle) = places.into_iter().find(is_free) else {
                continue;
            };
            labels.push(room(middle));
            self.painter
                .circle_filled(middle, NUMBER_RADIUS, theme::seam(seam.number));
            self.painter.text(
                middle,
                Align2::CENTER_CENTER,
                seam.number,
                theme::font(11.0),
                Color32::WHITE,
            );
        }
    }

    /// Paints lines between the seam ends that are sewn together, and the difference in length of the two
    /// sides: in the warning colour if the difference is more than a millimetre.
    pub(super) fn seam_links(&self, seam: &SeamDrawing) {
        let [Some(first), Some(second)] = seam.ends else {
            return;
        };
        let difference = seam.difference();
        let colour = match difference.abs() > UNEVEN {
            true => self.palette.warning,
            false => self.palette.accent,
        };
        let seen = |(panel, at): SeamEnd| self.seen(self.table_layout.panel(panel), at);
        for k in [0, 1] {
            let line = [seen(first[k]), seen(second[k])];
            let stroke = Stroke::new(1.4, colour);
            self.painter
                .extend(Shape::dashed_line(&line, stroke, 3.0, 4.0));
            for at in line {
                match k {
                    0 => self.painter.circle_filled(at, 5.0, colour),
                    _ => self.painter.circle(at, 5.0, self.palette.field, stroke),
                };
            }
        }
        let middle = seen(first[0]) + (seen(second[0]) - seen(first[0])) * 0.5;
        let millimetres = 1e3 * difference.abs();
        let words = match millimetres {
            m if m < 0.05 => "same length".to_owned(),
            m => {
                let longer = if difference > 0.0 { first } else { second };
                let panel = self.scene.panel_scene(longer[0].0);
                let panel = panel.map_or("", |panel| &panel.name);
                format!("{panel} {m:.1} mm longer")
            }
        };
        self.label(middle, &words, colour);
    }

    /// Paints the outlines of a panel in all sizes.
    pub(super) fn graded(&self, panel: &PanelScene, grading: &Grading) {
        let origin = self.table_layout.panel(panel.id);
        for (k, size) in grading.sizes.iter().enumerate() {
            let stroke = Stroke::new(1.1, Grading::colour(k));
            let own = size.panels.iter().filter(|(id, _)| *id == panel.id);
            for ring in own.flat_map(|(_, rings)| rings) {
                self.painter.line(self.line(origin, ring), stroke);
            }
        }
        for way in grading.ways.iter().filter(|way| way.panel == panel.id) {
            self.corner_way(origin, way);
        }
    }

    /// Paints the way of a corner from size to size, with a dot for each; a jump is marked by its colour and a
    /// ring.
    fn corner_way(&self, origin: Vec2, way: &CornerWay) {
        let places = self.line(origin, &way.places);
        for k in 1..places.len() {
            let (colour, width) = match way.is_jump[k] {
                true => (self.palette.warning, 2.0),
                false => (self.palette.ink_soft, 1.0),
            };
            let stroke = Stroke::new(width, colour);
            self.painter
                .line_segment([places[k - 1], places[k]], stroke);
        }
        for (k, &at) in places.iter().enumerate() {
            self.painter.circle_filled(at, 2.5, Grading::colour(k));
            if way.is_jump[k] {
                let stroke = Stroke::new(1.5, self.palette.warning);
                self.painter.circle_stroke(at, 5.0, stroke);
            }
        }
    }

    /// Paints the legend: colours and names of the sizes.
    pub(super) fn legend(&self, grading: &Grading) {
        let mut at = self.view.min + vec2(30.0, 34.0);
        for (k, size) in grading.sizes.iter().enumerate() {
            let colour = Grading::colour(k);
            let line = [at, at + vec2(22.0, 0.0)];
            self.painter.line_segment(line, Stroke::new(2.0, colour));
            self.painter.text(
                at + vec2(30.0, 0.0),
                Align2::LEFT_CENTER,
                &size.name,
                theme::font(12.5),
                self.palette.ink,
            );
            at.y += 17.0;
        }
    }
}

/// Offsets a polyline to its left by a distance, corner by corner; at the ends the offset is perpendicular.
fn beside(line: &[Vec2], distance: f64) -> Vec<Vec2> {
    if line.len() < 2 {
        return Vec::new();
    }
    let direction = |k: usize| (line[k + 1] - line[k]).try_normalize(1e-12);
    let last = line.len().saturating_sub(2);
    (0..line.len())
        .filter_map(|k| {
            let before = direction(k.saturating_sub(1).min(last));
            let after = direction(k.min(last));
            let way = match (before, after) {
                (Some(a), Some(b)) => (a + b).try_normalize(1e-9).unwrap_or(b),
                (a, b) => a.or(b)?,
            };
            Some(line[k] + Vec2::new(-way.y, way.x) * distance)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_beside_a_line_keeps_its_distance() {
        let line = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]].map(Vec2::from);
        for (a, b) in line.iter().zip(beside(&line, 0.25)) {
            assert!((b - a - Vec2::new(0.0, 0.25)).norm() < 1e-12);
        }
        assert!(beside(&line[..1], 0.1).is_empty());
        assert!(beside(&[], 0.1).is_empty());
    }
}
