//! Paints the pattern view.

use crate::drawing::{Drawing, PanelDrawing, PointDrawing, PointRole, SeamDrawing, along};
use crate::fill::Fill;
use crate::selection::{Selection, centimetres};
use crate::space::{PanelPlace, PanelPoint, TablePoint};
use crate::table_view::TableView;
use crate::theme;
use egui::epaint::Vertex;
use egui::{Align2, Color32, CornerRadius, Mesh, Painter, Pos2, Rect, Shape, Stroke, Ui, vec2};
use toile_geometry::Vec2;

/// Distance of the fine lines of the table [m].
const GRID_FINE: f64 = 0.1;
/// Every so many of them is drawn stronger.
const GRID_GROUP: i64 = 5;
/// Fine lines nearer than this are left out [logical pixels].
const GRID_LEAST: f64 = 14.0;
/// How far inside the outline a seam's line runs [logical pixels].
const SEAM_INSET: f64 = 5.0;
/// How far inside the outline a seam's number stands [logical pixels].
const NUMBER_INSET: f64 = 16.0;
/// Stretches shorter than this carry no number [logical pixels].
const NUMBER_LEAST: f64 = 34.0;
/// Length of a notch [logical pixels].
const NOTCH: f32 = 9.0;

/// Paints one frame of the pattern view.
pub struct TablePainter<'a> {
    painter: Painter,
    view: Rect,
    table: &'a TableView,
    drawing: &'a Drawing,
}

impl<'a> TablePainter<'a> {
    /// A painter inside `view`.
    pub fn new(ui: &Ui, view: Rect, table: &'a TableView, drawing: &'a Drawing) -> Self {
        Self {
            painter: ui.painter_at(view),
            view,
            table,
            drawing,
        }
    }

    /// Paints everything.
    pub fn paint(&self) {
        self.painter.rect_filled(self.view, 0.0, theme::TABLE);
        self.grid();
        for panel in &self.drawing.panels {
            if let Some(place) = self.table.layout.place(panel.id) {
                self.cloth(panel, place);
            }
        }
        for seam in &self.drawing.seams {
            self.seam_lines(seam);
        }
        for panel in &self.drawing.panels {
            if let Some(place) = self.table.layout.place(panel.id) {
                self.marks(panel, place);
                self.outline(panel, place);
                self.caption(panel, place);
            }
        }
        for seam in &self.drawing.seams {
            self.seam_numbers(seam);
        }
        for panel in &self.drawing.panels {
            for point in &panel.points {
                self.point(panel, point);
            }
        }
        self.selected_length();
    }

    fn seen(&self, place: PanelPlace, at: Vec2) -> Pos2 {
        let camera = &self.table.camera;
        camera.screen(self.view, place.table(PanelPoint(at))).0
    }

    fn line(&self, place: PanelPlace, line: &[Vec2]) -> Vec<Pos2> {
        line.iter().map(|at| self.seen(place, *at)).collect()
    }

    fn grid(&self) {
        let camera = &self.table.camera;
        let half = vec2(self.view.width(), self.view.height()) * 0.5;
        let reach = Vec2::new(f64::from(half.x), f64::from(half.y)) / camera.scale;
        let (low, high) = (camera.centre - reach, camera.centre + reach);
        let fine = GRID_FINE * camera.scale >= GRID_LEAST;
        for coarse in [false, true] {
            let stroke = Stroke::new(
                1.0,
                if coarse {
                    theme::GRID_COARSE
                } else {
                    theme::GRID
                },
            );
            let wanted = |k: &i64| (k % GRID_GROUP == 0) == coarse && (coarse || fine);
            let range = |from: f64, to: f64| {
                ((from / GRID_FINE).floor() as i64..=(to / GRID_FINE).ceil() as i64).filter(wanted)
            };
            for k in range(low.x, high.x) {
                let at = TablePoint(Vec2::new(k as f64 * GRID_FINE, 0.0));
                let x = camera.screen(self.view, at).0.x.round();
                self.painter.vline(x, self.view.y_range(), stroke);
            }
            for k in range(low.y, high.y) {
                let at = TablePoint(Vec2::new(0.0, k as f64 * GRID_FINE));
                let y = camera.screen(self.view, at).0.y.round();
                self.painter.hline(self.view.x_range(), y, stroke);
            }
        }
    }

    fn filled(&self, place: PanelPlace, fill: &Fill, colour: Color32, shift: egui::Vec2) {
        let at = |p: &[f32; 2]| Vec2::new(f64::from(p[0]), f64::from(p[1]));
        let vertices = fill.points.iter().map(|p| Vertex {
            pos: self.seen(place, at(p)) + shift,
            uv: egui::epaint::WHITE_UV,
            color: colour,
        });
        self.painter.add(Mesh {
            vertices: vertices.collect(),
            indices: fill.indices.clone(),
            ..Mesh::default()
        });
    }

    fn cloth(&self, panel: &PanelDrawing, place: PanelPlace) {
        let shadow = Color32::from_black_alpha(16);
        for fill in [&panel.mirrored_fill, &panel.fill] {
            self.filled(place, fill, shadow, vec2(1.5, 2.5));
        }
        let flat = egui::Vec2::ZERO;
        self.filled(place, &panel.mirrored_fill, theme::PANEL_MIRRORED, flat);
        self.filled(place, &panel.fill, theme::PANEL, flat);
    }

    fn marks(&self, panel: &PanelDrawing, place: PanelPlace) {
        let pencil = Stroke::new(1.2, theme::PENCIL);
        for line in &panel.mirrored {
            self.painter.line(self.line(place, line), pencil);
        }
        for line in panel.internal_lines.iter().chain(&panel.darts) {
            let line = self.line(place, line);
            let ink = Stroke::new(1.2, theme::INK_SOFT);
            self.painter
                .extend(Shape::dashed_line(&line, ink, 6.0, 4.0));
        }
        if let Some(ends) = panel.grainline {
            let [low, high] = ends.map(|end| self.seen(place, end));
            if low.distance(high) > 30.0 {
                self.painter.line_segment([low, high], pencil);
                self.arrow_head(high, (high - low).normalized(), theme::PENCIL);
                self.arrow_head(low, (low - high).normalized(), theme::PENCIL);
            }
        }
        for (at, inward) in &panel.notches {
            let from = self.seen(place, *at);
            let way = vec2(inward.x as f32, -inward.y as f32) * NOTCH;
            let ink = Stroke::new(2.0, theme::INK);
            self.painter.line_segment([from, from + way], ink);
        }
    }

    fn arrow_head(&self, tip: Pos2, way: egui::Vec2, colour: Color32) {
        let back = tip - way * 8.0;
        let across = way.rot90() * 3.2;
        self.painter.add(Shape::convex_polygon(
            vec![tip, back + across, back - across],
            colour,
            Stroke::NONE,
        ));
    }

    fn outline(&self, panel: &PanelDrawing, place: PanelPlace) {
        for edge in &panel.edges {
            let this = Selection::Edge(panel.id, edge.id);
            let stroke = match () {
                () if self.table.selection == this => Stroke::new(3.0, theme::ACCENT),
                () if self.table.hover == this => Stroke::new(2.4, theme::ACCENT),
                () => Stroke::new(1.6, theme::INK),
            };
            for line in &edge.lines {
                self.painter.line(self.line(place, line), stroke);
            }
            if self.table.selection.panel() == Some(panel.id) {
                for handle in &edge.handles {
                    let line = handle.map(|at| self.seen(place, at));
                    self.painter
                        .line_segment(line, Stroke::new(1.0, theme::PENCIL));
                }
            }
        }
        if let Some(fold) = panel.fold {
            let line = fold.map(|at| self.seen(place, at));
            self.painter
                .line_segment(line, Stroke::new(2.0, theme::PANEL));
            let ink = Stroke::new(1.4, theme::INK_SOFT);
            self.painter
                .extend(Shape::dashed_line(&line, ink, 14.0, 5.0));
        }
    }

    /// The panel's name and cut: inside where there is room, else under it.
    fn caption(&self, panel: &PanelDrawing, place: PanelPlace) {
        let layout = |text: &str, size: f32, colour| {
            self.painter
                .layout_no_wrap(text.to_owned(), theme::font(size), colour)
        };
        let name = layout(&panel.name, 15.0, theme::INK);
        let cut = layout(&panel.cut, 12.0, theme::INK_SOFT);
        let width = name.size().x.max(cut.size().x);
        let height = name.size().y
            + if panel.cut.is_empty() {
                0.0
            } else {
                cut.size().y
            };
        let bounds = &panel.drawn_bounds;
        let [low, high] = [bounds.min, bounds.max].map(|p| self.seen(place, p));
        let room = 2.0 * NUMBER_INSET as f32;
        let fits =
            width + room + 16.0 < (high.x - low.x).abs() && height + room < (low.y - high.y).abs();
        let middle = if fits {
            self.seen(place, panel.middle)
        } else {
            Pos2::new((low.x + high.x) * 0.5, low.y + 8.0 + height * 0.5)
        };
        let ground = Rect::from_center_size(middle, vec2(width + 10.0, height + 6.0));
        if fits {
            self.painter
                .rect_filled(ground, CornerRadius::same(4), theme::PANEL);
        }
        let top = middle - vec2(0.0, height * 0.5);
        let centred = |width: f32, down: f32| top + vec2(-width * 0.5, down);
        let (name_size, cut_size) = (name.size(), cut.size());
        self.painter
            .galley(centred(name_size.x, 0.0), name, theme::INK);
        self.painter
            .galley(centred(cut_size.x, name_size.y), cut, theme::INK_SOFT);
    }

    /// Seams at the selected or pointed edge are drawn stronger.
    fn touched(&self, seam: &SeamDrawing) -> bool {
        [self.table.selection, self.table.hover].iter().any(|part| {
            seam.stretches.iter().any(|stretch| {
                matches!((*part, stretch.edge), (Selection::Edge(panel, edge), Some(own))
                    if panel == stretch.panel && edge == own)
            })
        })
    }

    fn seam_lines(&self, seam: &SeamDrawing) {
        let width = if self.touched(seam) { 5.0 } else { 2.6 };
        for stretch in &seam.stretches {
            let places = (
                self.drawing.panel(stretch.panel),
                self.table.layout.place(stretch.panel),
            );
            let (Some(panel), Some(place)) = places else {
                continue;
            };
            let inset = panel.cloth_side * SEAM_INSET / self.table.camera.scale;
            let line: Vec<Pos2> = beside(&stretch.line, inset)
                .into_iter()
                .map(|at| self.seen(place, at))
                .collect();
            let colour = theme::seam(seam.number);
            let colour = match stretch.edge {
                Some(_) => colour,
                None => colour.gamma_multiply(0.45),
            };
            self.painter.line(line, Stroke::new(width, colour));
        }
    }

    fn seam_numbers(&self, seam: &SeamDrawing) {
        for stretch in &seam.stretches {
            let places = (
                self.drawing.panel(stretch.panel),
                self.table.layout.place(stretch.panel),
            );
            let (Some(panel), Some(place)) = places else {
                continue;
            };
            let scale = self.table.camera.scale;
            let length: f64 = stretch.line.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
            if length * scale < NUMBER_LEAST {
                continue;
            }
            let Some((at, way)) = along(&stretch.line, 0.5) else {
                continue;
            };
            let inward = Vec2::new(-way.y, way.x) * panel.cloth_side;
            let middle = self.seen(place, at + inward * (NUMBER_INSET / scale));
            let colour = theme::seam(seam.number);
            self.painter.circle_filled(middle, 8.5, colour);
            self.painter.text(
                middle,
                Align2::CENTER_CENTER,
                seam.number,
                theme::font(11.0),
                Color32::WHITE,
            );
        }
    }

    fn point(&self, panel: &PanelDrawing, point: &PointDrawing) {
        if !self.table.shows(panel.id, point.role) {
            return;
        }
        let Some(at) = self.table.screen(self.view, panel.id, point.at) else {
            return;
        };
        let this = Selection::Point(panel.id, point.id);
        let selected = self.table.selection == this;
        let hovered = self.table.hover == this;
        let fill = if selected {
            theme::ACCENT
        } else {
            Color32::WHITE
        };
        let edge = match selected || hovered {
            true => theme::ACCENT,
            false => theme::INK,
        };
        let radius = if selected || hovered { 4.5 } else { 3.2 };
        let stroke = Stroke::new(1.4, edge);
        match point.role {
            PointRole::Corner => {
                let square = Rect::from_center_size(at, egui::Vec2::splat(2.0 * radius));
                self.painter.rect_filled(square, 1.0, fill);
                self.painter
                    .rect_stroke(square, 1.0, stroke, egui::StrokeKind::Middle);
            }
            PointRole::Control => {
                self.painter.circle(at, radius, fill, stroke);
            }
            PointRole::Construction => {
                for way in [vec2(radius, radius), vec2(radius, -radius)] {
                    self.painter.line_segment([at - way, at + way], stroke);
                }
            }
        }
        if hovered || selected {
            self.tag(at + vec2(10.0, -14.0), &point.name);
        }
    }

    fn selected_length(&self) {
        let Selection::Edge(panel, edge) = self.table.selection else {
            return;
        };
        let drawn = self.drawing.panel(panel);
        let edge = drawn.and_then(|panel| panel.edge(edge));
        let middle = edge.and_then(|edge| Some((edge, edge.middle()?)));
        if let Some((edge, middle)) = middle
            && let Some(at) = self.table.screen(self.view, panel, PanelPoint(middle))
        {
            self.tag(at + vec2(12.0, -16.0), &centimetres(edge.length));
        }
    }

    /// A small label beside something.
    fn tag(&self, at: Pos2, text: &str) {
        let text = self
            .painter
            .layout_no_wrap(text.to_owned(), theme::font(12.5), Color32::WHITE);
        let ground = Align2::LEFT_CENTER.anchor_size(at, text.size() + vec2(12.0, 4.0));
        self.painter
            .rect_filled(ground, CornerRadius::same(4), theme::ACCENT);
        let corner = Align2::CENTER_CENTER.align_size_within_rect(text.size(), ground);
        self.painter.galley(corner.min, text, Color32::WHITE);
    }
}

/// A polyline moved to its left by a distance, corner by corner; ends stay square to it.
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
