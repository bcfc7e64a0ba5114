//! Draws the marker view: fabric, pieces, overlaps.

use super::marker::MarkerView;
use super::marker_piece::PieceScene;
use crate::canvas::camera::ScreenPoint;
use crate::canvas::fill::{Fill, fill};
use crate::theme::{self, Palette};
use egui::epaint::Vertex;
use egui::{Align2, Color32, Mesh, Pos2, Rect, Shape, Stroke, Ui, vec2};
use toile_cut::StrokeKind;
use toile_geometry::Vec2;

impl MarkerView {
    pub(super) fn paint(&self, ui: &Ui, view: Rect) {
        let painter = ui.painter_at(view);
        let palette = Palette::of(ui.ctx());
        painter.rect_filled(view, 0.0, palette.table);
        if let Some((words, is_fault)) = &self.nothing {
            let colour = match is_fault {
                true => palette.fault,
                false => palette.ink_soft,
            };
            let font = theme::font(14.0);
            painter.text(view.center(), Align2::CENTER_CENTER, words, font, colour);
            return;
        }
        let corner = |at: Vec2| self.screen(view, at);
        let cloth = self.seen;
        painter.rect_filled(cloth, 0.0, palette.panel);
        for y in [self.selvedge, self.cloth.max.y - self.selvedge] {
            let ends = [Vec2::new(0.0, y), Vec2::new(self.cloth.max.x, y)].map(corner);
            let stroke = Stroke::new(1.0, palette.rule);
            painter.line_segment(ends, stroke);
        }
        painter.rect_stroke(
            cloth,
            0.0,
            Stroke::new(1.4, palette.pencil),
            egui::StrokeKind::Outside,
        );
        for scene in &self.pieces {
            let dragged = self
                .drag
                .as_ref()
                .is_some_and(|(_, p)| p.contains(&scene.piece));
            let shift = match (scene.waits && dragged, ui.input(|i| i.pointer.latest_pos())) {
                (true, Some(now)) => {
                    let from = self.drag.as_ref().map_or(Vec2::zeros(), |(from, _)| *from);
                    self.camera.table(view, ScreenPoint(now)).0 - from
                }
                _ => Vec2::zeros(),
            };
            self.paint_piece(&painter, (view, palette), scene, shift);
        }
        self.paint_names(&painter, palette);
        // Overlaps of pieces.
        for part in self
            .state
            .overlaps
            .iter()
            .flat_map(|overlap| &overlap.region)
        {
            let rings: Vec<Vec<Vec2>> = part.rings().cloned().collect();
            let shape = fill(&rings);
            self.paint_fill(&painter, view, (&shape, palette.fault.gamma_multiply(0.7)));
        }
    }

    fn paint_fill(&self, painter: &egui::Painter, view: Rect, (fill, colour): (&Fill, Color32)) {
        let vertices = fill.points.iter().map(|p| Vertex {
            pos: self.screen(view, Vec2::new(f64::from(p[0]), f64::from(p[1]))),
            uv: egui::epaint::WHITE_UV,
            color: colour,
        });
        painter.add(Mesh {
            vertices: vertices.collect(),
            indices: fill.indices.clone(),
            ..Mesh::default()
        });
    }

    fn paint_piece(
        &self,
        painter: &egui::Painter,
        (view, palette): (Rect, &Palette),
        scene: &PieceScene,
        shift: Vec2,
    ) {
        let overlapping = self
            .state
            .overlaps
            .iter()
            .any(|overlap| overlap.pieces.contains(&scene.piece))
            || self
                .state
                .outside
                .iter()
                .any(|outside| outside.piece == scene.piece);
        let selected = self.selection.contains(&scene.piece);
        let lit = selected || self.hover == Some(scene.piece);
        let (ground, line) = match () {
            () if overlapping => (palette.fault.gamma_multiply(0.28), palette.fault),
            () if selected => (palette.accent_soft, palette.accent),
            () if scene.locked => (palette.rule, palette.ink),
            () => (
                theme::seam(usize::from(scene.group()) + 1).gamma_multiply(0.22),
                palette.ink,
            ),
        };
        let at = |p: Vec2| self.screen(view, p + shift);
        let vertices = scene.fill.points.iter().map(|p| Vertex {
            pos: at(Vec2::new(f64::from(p[0]), f64::from(p[1]))),
            uv: egui::epaint::WHITE_UV,
            color: ground,
        });
        painter.add(Mesh {
            vertices: vertices.collect(),
            indices: scene.fill.indices.clone(),
            ..Mesh::default()
        });
        for stroke in &scene.drawing.strokes {
            let mut points: Vec<Pos2> = stroke.points.iter().map(|p| at(*p)).collect();
            if stroke.closed {
                points.extend(points.first().copied());
            }
            let (width, colour): (f32, Color32) = match stroke.kind {
                StrokeKind::Cut => (if lit { 2.2 } else { 1.4 }, line),
                StrokeKind::Sew | StrokeKind::Inside | StrokeKind::Mark | StrokeKind::Drill => {
                    (0.8, palette.pencil)
                }
                StrokeKind::Grain => (1.0, palette.ink_soft),
                StrokeKind::Fold => (1.2, palette.ink_soft),
                StrokeKind::Notch => (1.2, line),
            };
            painter.add(Shape::line(points, Stroke::new(width, colour)));
        }
        for words in &scene.drawing.words {
            let text = self.own_words(painter, words, (at(words.at), palette));
            painter.extend(text.map(Shape::from));
        }
        if scene.locked
            && let Some(bounds) = scene.bounds()
        {
            painter.text(
                at(bounds.centre()) + vec2(0.0, 14.0),
                Align2::CENTER_CENTER,
                "locked",
                theme::font(10.5),
                palette.ink_soft,
            );
        }
    }
}
