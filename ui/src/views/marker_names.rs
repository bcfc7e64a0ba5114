//! Names of pieces on a marker: their own text, larger text in its place, or a label outside with a
//! leader line.

use super::marker::MarkerView;
use super::marker_piece::{PieceName, PieceScene};
use crate::canvas::camera::ScreenPoint;
use crate::theme::{self, Palette};
use egui::epaint::TextShape;
use egui::{Painter, Pos2, Rect, Stroke, Ui, Vec2 as Way, vec2};
use toile_cut::Words;
use toile_geometry::Vec2;

/// Least readable height of letters (pixels).
const MIN_LETTER_HEIGHT: f32 = 7.0;
/// Font sizes of names in place of a piece's text; the first size that fits the piece is used (pixels).
const SMALL_NAMES: [f32; 2] = [13.0, 10.5];
/// Least size of pieces with a name (pixels).
const MIN_PIECE_SIZE: f64 = 12.0;
/// Largest number of names with a leader line.
const MAX_LEADERS: usize = 100;
/// Distances that are tried between a piece and its name outside the piece (pixels).
const DISTANCES: [f32; 6] = [10.0, 20.0, 34.0, 50.0, 70.0, 95.0];
/// Number of directions from a piece that are tried for its name.
const DIRECTIONS: usize = 16;
/// Empty margin round a name outside its piece (pixels).
const MARGIN: f32 = 2.0;

impl MarkerView {
    /// Names to write instead of a piece's own text; the names do not overlap.
    pub(super) fn placed_names(&self, ui: &Ui, view: Rect) -> Vec<PieceName> {
        let painter = ui.painter_at(view);
        let palette = Palette::of(ui.ctx());
        let mut taken: Vec<Rect> = Vec::new();
        let mut names = Vec::new();
        let mut led = Vec::new();
        for scene in &self.pieces {
            let Some(around) = self.seen_bounds(scene, view) else {
                continue;
            };
            let own = scene.drawing.words.first().map_or(0.0, |words| words.size);
            if (own * self.camera.scale) as f32 >= MIN_LETTER_HEIGHT {
                for words in &scene.drawing.words {
                    let at = self.screen(view, words.at);
                    let text = self.own_words(&painter, words, (at, palette));
                    taken.extend(text.map(|text| text.visual_bounding_rect()));
                }
                continue;
            }
            let size_of = |letters: f32| {
                let font = theme::font(letters);
                let galley = painter.layout_no_wrap(scene.name.clone(), font, palette.ink);
                galley.size()
            };
            let middle = self.screen(view, scene.middle());
            let sizes = SMALL_NAMES.map(|letters| (letters, size_of(letters)));
            let placed =
                sizes.map(|(letters, size)| (letters, Rect::from_center_size(middle, size)));
            let inside = placed
                .into_iter()
                .find(|(_, rect)| self.holds(scene, (*rect, view)));
            let is_free = |rect: &Rect| !taken.iter().any(|other| other.intersects(*rect));
            match inside.filter(|(_, rect)| is_free(rect)) {
                Some((letters, rect)) => {
                    taken.push(rect);
                    names.push(PieceName {
                        name: scene.name.clone(),
                        rect,
                        led_to: None,
                        letters,
                    });
                }
                None => led.push((scene, around, sizes[1])),
            }
        }
        let all = self.pieces.iter();
        let boxes: Vec<Rect> = all
            .filter_map(|scene| self.seen_bounds(scene, view))
            .collect();
        for (scene, around, (letters, size)) in led.into_iter().take(MAX_LEADERS) {
            let size = size + Way::splat(2.0 * MARGIN);
            let middle = self.inner_place(scene, view);
            if let Some(rect) = place_outside((around, size), view, (&taken, &boxes)) {
                taken.push(rect);
                names.push(PieceName {
                    name: scene.name.clone(),
                    rect,
                    led_to: Some(middle),
                    letters,
                });
            }
        }
        names
    }

    /// Whether all corners of a rectangle on the screen are inside a piece.
    fn holds(&self, scene: &PieceScene, (rect, view): (Rect, Rect)) -> bool {
        let corners = [
            rect.left_top(),
            rect.right_top(),
            rect.left_bottom(),
            rect.right_bottom(),
        ];
        let polygon = scene.drawing.fill.as_ref();
        let is_in = |at: &Pos2| {
            let at = self.camera.table(view, ScreenPoint(*at)).0;
            polygon.is_some_and(|polygon| polygon.contains(at))
        };
        corners.iter().all(is_in)
    }

    /// Bounding box of a piece on the screen; `None` if the piece is not visible or is too small for a
    /// name.
    fn seen_bounds(&self, scene: &PieceScene, view: Rect) -> Option<Rect> {
        let bounds = scene.bounds()?;
        let seen = [bounds.min, bounds.max].map(|at| self.screen(view, at));
        let seen = Rect::from_two_pos(seen[0], seen[1]);
        let is_large = bounds.size().max() * self.camera.scale >= MIN_PIECE_SIZE;
        (is_large && view.contains(seen.center())).then_some(seen)
    }

    /// A point inside a piece, at which a leader line ends.
    fn inner_place(&self, scene: &PieceScene, view: Rect) -> Pos2 {
        let middle = scene.middle();
        let polygon = scene.drawing.fill.as_ref();
        let is_inside = polygon.is_some_and(|polygon| polygon.contains(middle));
        let inside = match (is_inside, polygon) {
            (false, Some(polygon)) => {
                let near =
                    |a: &&Vec2, b: &&Vec2| (*a - middle).norm().total_cmp(&(*b - middle).norm());
                polygon.outer.iter().min_by(near).copied().unwrap_or(middle)
            }
            _ => middle,
        };
        self.screen(view, inside)
    }

    /// The piece's own text as a shape, if it is readable at this enlargement.
    pub(super) fn own_words(
        &self,
        painter: &Painter,
        words: &Words,
        (at, palette): (Pos2, &Palette),
    ) -> Option<TextShape> {
        let size = (words.size * self.camera.scale) as f32;
        if size < MIN_LETTER_HEIGHT {
            return None;
        }
        let font = theme::font(size.min(22.0));
        let galley = painter.layout_no_wrap(words.text.clone(), font, palette.ink);
        // Y points down on the screen, so the angle is reversed.
        let turn = -words.angle as f32;
        let half = vec2(galley.size().x * 0.5, galley.size().y);
        let corner = at - egui::emath::Rot2::from_angle(turn) * half;
        Some(TextShape::new(corner, galley, palette.ink).with_angle(turn))
    }

    pub(super) fn paint_names(&self, painter: &Painter, palette: &Palette) {
        for one in &self.names {
            if let Some(place) = one.led_to {
                let line = Stroke::new(1.0, palette.ink_soft);
                painter.line_segment([place, one.rect.clamp(place)], line);
                painter.circle_filled(place, 2.0, palette.ink_soft);
                painter.rect_filled(one.rect, 2.0, palette.panel);
            }
            let font = theme::font(one.letters);
            let galley = painter.layout_no_wrap(one.name.clone(), font, palette.ink);
            painter.galley(one.rect.center() - galley.size() * 0.5, galley, palette.ink);
        }
    }
}

/// Rectangle for a name beside the piece with the bounds `around`: it overlaps no name of `taken`, and as
/// few pieces of `boxes` as possible.
fn place_outside(
    (around, size): (Rect, Way),
    view: Rect,
    (taken, boxes): (&[Rect], &[Rect]),
) -> Option<Rect> {
    let places = DISTANCES.iter().flat_map(|distance| {
        (0..DIRECTIONS).map(move |k| {
            let angle = std::f32::consts::TAU * k as f32 / DIRECTIONS as f32;
            let way = Way::angled(angle);
            let reach = 0.5 * (around.size() + size) + Way::splat(*distance);
            around.center() + vec2(way.x * reach.x, way.y * reach.y)
        })
    });
    let free = places
        .map(|at| Rect::from_center_size(at, size))
        .filter(|rect| view.contains_rect(*rect))
        .filter(|rect| !taken.iter().any(|other| other.intersects(*rect)));
    let covers = |rect: &Rect| boxes.iter().filter(|own| own.intersects(*rect)).count();
    free.min_by_key(covers)
}
