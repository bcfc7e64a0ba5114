//! Paints the pattern on its table.

use super::camera::{TableCamera, TablePoint};
use super::drawn_guide::{DrawnGuide, GuideLabel};
use super::fill::Fill;
use super::grading::Grading;
use super::hit::{ShownPoint, shown_points};
use super::rulers::{self, RULER};
use super::scene::{PanelScene, PointRole, Scene, SheetScene};
use super::selection::{Item, Selection};
use super::sheet_tag::{ground, tagged};
use super::table_layout::TableLayout;
use crate::theme::{self, Palette};
use crate::tools::Overlay;
use egui::epaint::Vertex;
use egui::{Align2, Color32, CornerRadius, Mesh, Painter, Pos2, Rect, Shape, Stroke, vec2};
use toile_geometry::Vec2;
use toile_pattern::{DisplayUnit, SeamId, SheetId};

/// Grid steps of the table (m): the finest whose lines are far enough apart is drawn, and the next coarser
/// one.
const GRID: [f64; 4] = [0.01, 0.05, 0.1, 0.5];
/// Least distance between the grid lines of the finer step that is drawn (pixels).
const GRID_LEAST: f64 = 14.0;
/// Distance of the number of a seam from the outline, inward (pixels).
pub(super) const NUMBER_INSET: f64 = 16.0;
/// Length of a notch (pixels).
const NOTCH: f32 = 9.0;

/// Opacity of drawn curves that the outline no longer follows, because operations of the panel moved it.
const FAINT: f32 = 0.55;

/// Font sizes of a panel's name: the usual one, and one for little room (pixels).
const CAPTION_SIZES: [f32; 2] = [15.0, 12.0];
/// Number of steps by which the name of a panel is moved to be clear of other labels; a step is half the
/// height of the name.
const CAPTION_STEPS: usize = 12;

/// Width of the view that the longest line of a label leaves free (pixels).
const LABEL_MARGIN: f32 = 24.0;

/// Everything that is painted in one frame.
pub struct Picture<'a> {
    /// Painter of the canvas.
    pub painter: Painter,
    /// Rectangle of the canvas on the screen.
    pub view: Rect,
    /// Camera of the table.
    pub camera: TableCamera,
    /// Positions of sheets and panels.
    pub table_layout: &'a TableLayout,
    /// The pattern.
    pub scene: &'a Scene,
    /// Selected parts.
    pub selection: &'a Selection,
    /// Part under the pointer.
    pub hover: Option<Item>,
    /// Outlines of all sizes, if they are shown.
    pub grading: Option<&'a Grading>,
    /// Origin of the rulers on the table (m), and their unit.
    pub rulers: Option<(Vec2, DisplayUnit)>,
    /// Guides.
    pub guides: &'a [DrawnGuide],
    /// Label of the guide that is dragged.
    pub guide_label: Option<&'a GuideLabel>,
    /// Whether cut lines are drawn.
    pub allowances: bool,
    /// Seams that a tool previews.
    pub fresh: &'a [SeamId],
    /// Open sheets: all of their points are shown.
    pub open: &'a [SheetId],
    /// Colours.
    pub palette: &'a Palette,
}

/// Share of the selection colour in the colour of a panel under the pointer (1).
const HOVERED: f32 = 0.4;

impl Picture<'_> {
    /// Paints the table, the pattern and the overlay of a tool; returns the rectangles of names, seam
    /// numbers and tags, which do not overlap.
    pub fn paint(&self, overlay: &[Overlay]) -> Vec<Rect> {
        let mut labels: Vec<Rect> = tagged(self.scene, self.open)
            .map(|sheet| {
                let origin = self.seen(self.table_layout.sheet(sheet.id), Vec2::zeros());
                ground(sheet).translate(origin.to_vec2())
            })
            .collect();
        self.painter.rect_filled(self.view, 0.0, self.palette.table);
        self.grid();
        for panel in &self.scene.panels {
            self.cloth(panel);
        }
        for sheet in &self.scene.sheets {
            self.curves(sheet);
        }
        for seam in &self.scene.seams {
            self.seam_lines(seam);
        }
        for panel in &self.scene.panels {
            self.marks(panel);
            if let Some(grading) = self.grading {
                self.graded(panel, grading);
            }
            self.outline(panel);
            self.press_arrows(panel);
        }
        for panel in &self.scene.panels {
            self.caption(panel, &mut labels);
        }
        for seam in &self.scene.seams {
            self.seam_numbers(seam, &mut labels);
        }
        self.guides();
        self.handles();
        for sheet in tagged(self.scene, self.open) {
            self.sheet_tag(sheet);
        }
        let points = shown_points(self.scene, self.table_layout, self.open);
        for shown in &points {
            self.point(shown);
        }
        // While a seam is walked its pieces lie against each other: links between seam ends are hidden, so
        // that the fit is visible.
        let is_walked = overlay
            .iter()
            .any(|mark| matches!(mark, Overlay::Ghost(..)));
        for seam in self.scene.seams.iter().filter(|_| !is_walked) {
            if self.fresh.contains(&seam.id) || self.is_lit(Item::Seam(seam.id)) {
                self.seam_links(seam);
            }
        }
        self.point_names(&points, &mut labels);
        for mark in overlay {
            self.overlay(mark);
        }
        self.labels(overlay);
        if let Some(from) = self.rulers {
            rulers::paint(&self.painter, (self.view, &self.camera), from, self.palette);
        }
        if let Some(grading) = self.grading {
            self.legend(grading);
        }
        self.guide_label();
        labels
    }

    pub(super) fn seen(&self, origin: Vec2, at: Vec2) -> Pos2 {
        self.camera.screen(self.view, TablePoint(at + origin)).0
    }

    /// The view without its rulers, in which text is placed.
    pub(super) fn clear_view(&self) -> Rect {
        let ruler = if self.rulers.is_some() { RULER } else { 0.0 };
        Rect::from_min_max(self.view.min + vec2(ruler, ruler), self.view.max)
    }

    pub(super) fn line(&self, origin: Vec2, line: &[Vec2]) -> Vec<Pos2> {
        line.iter().map(|at| self.seen(origin, *at)).collect()
    }

    pub(super) fn is_lit(&self, item: Item) -> bool {
        self.selection.contains(item) || self.hover == Some(item)
    }

    fn grid(&self) {
        let camera = &self.camera;
        let half = vec2(self.view.width(), self.view.height()) * 0.5;
        let reach = Vec2::new(f64::from(half.x), f64::from(half.y)) / camera.scale;
        let (low, high) = (camera.centre - reach, camera.centre + reach);
        let shown = GRID
            .iter()
            .position(|step| step * camera.scale >= GRID_LEAST);
        let finest = shown.unwrap_or(GRID.len() - 1);
        for (k, step) in GRID.iter().enumerate().skip(finest).take(2) {
            let colour = match k == finest {
                true => self.palette.grid,
                false => self.palette.grid_coarse,
            };
            let stroke = Stroke::new(1.0, colour);
            let range =
                |from: f64, to: f64| (from / step).floor() as i64..=(to / step).ceil() as i64;
            for n in range(low.x, high.x) {
                let at = Vec2::new(n as f64 * step, 0.0);
                let x = self.seen(Vec2::zeros(), at).x.round();
                self.painter.vline(x, self.view.y_range(), stroke);
            }
            for n in range(low.y, high.y) {
                let at = Vec2::new(0.0, n as f64 * step);
                let y = self.seen(Vec2::zeros(), at).y.round();
                self.painter.hline(self.view.x_range(), y, stroke);
            }
        }
    }

    pub(super) fn filled(&self, origin: Vec2, fill: &Fill, colour: Color32, shift: egui::Vec2) {
        let at = |p: &[f32; 2]| Vec2::new(f64::from(p[0]), f64::from(p[1]));
        let vertices = fill.points.iter().map(|p| Vertex {
            pos: self.seen(origin, at(p)) + shift,
            uv: egui::epaint::WHITE_UV,
            color: colour,
        });
        self.painter.add(Mesh {
            vertices: vertices.collect(),
            indices: fill.indices.clone(),
            ..Mesh::default()
        });
    }

    fn cloth(&self, panel: &PanelScene) {
        let origin = self.table_layout.panel(panel.id);
        let shadow = Color32::from_black_alpha(16);
        let shape = &panel.shape;
        for fill in [&shape.mirrored_fill, &shape.fill] {
            self.filled(origin, fill, shadow, vec2(1.5, 2.5));
        }
        let flat = egui::Vec2::ZERO;
        let mirrored = self.palette.panel_mirrored;
        self.filled(origin, &shape.mirrored_fill, mirrored, flat);
        self.filled(origin, &shape.fill, self.cloth_colour(panel), flat);
    }

    fn cloth_colour(&self, panel: &PanelScene) -> Color32 {
        match () {
            () if panel.is_stale => self.palette.panel_stale,
            () if self.selection.contains(Item::Panel(panel.id)) => self.palette.accent_soft,
            // Hovered, but not selected yet.
            () if self.is_lit(Item::Panel(panel.id)) => {
                let (plain, soft) = (self.palette.panel, self.palette.accent_soft);
                plain.lerp_to_gamma(soft, HOVERED)
            }
            () => self.palette.panel,
        }
    }

    /// Paints the curve that is selected or under the pointer; curves that no panel is traced along; and on
    /// an open sheet, faintly, curves from which operations moved the edges of the panel away.
    fn curves(&self, sheet: &SheetScene) {
        let origin = self.table_layout.sheet(sheet.id);
        let is_open = self.open.contains(&sheet.id);
        let is_left = |end: &Vec2| {
            let mut left = sheet.points.iter().filter(|point| point.is_left);
            left.any(|point| (point.at - end).norm() < 1e-9)
        };
        for curve in &sheet.curves {
            let lit = self.is_lit(Item::Curve(curve.id));
            let ends = [curve.line.first(), curve.line.last()];
            let stroke = match () {
                () if lit => Stroke::new(2.6, self.palette.accent),
                () if !curve.is_traced => Stroke::new(1.3, self.palette.ink_soft),
                () if is_open && ends.into_iter().flatten().any(is_left) => {
                    Stroke::new(1.0, self.palette.pencil.gamma_multiply(FAINT))
                }
                () => continue,
            };
            self.painter.line(self.line(origin, &curve.line), stroke);
        }
    }

    fn marks(&self, panel: &PanelScene) {
        let origin = self.table_layout.panel(panel.id);
        if self.allowances {
            let pencil = Stroke::new(1.0, self.palette.pencil);
            for ring in self.scene.cut_lines.of(panel.id) {
                self.painter.line(self.line(origin, ring), pencil);
            }
        }
        let shape = &panel.shape;
        let pencil = Stroke::new(1.2, self.palette.pencil);
        for line in &shape.mirrored {
            self.painter.line(self.line(origin, line), pencil);
        }
        let dashed = |line: &[Vec2], item: Item| {
            let lit = self.is_lit(item);
            let ink = match lit {
                true => Stroke::new(2.4, self.palette.accent),
                false => Stroke::new(1.2, self.palette.ink_soft),
            };
            let line = self.line(origin, line);
            self.painter
                .extend(Shape::dashed_line(&line, ink, 6.0, 4.0));
        };
        for (id, line) in shape.internal_lines.iter().chain(&shape.mirrored_lines) {
            dashed(line, Item::Line(panel.id, *id));
        }
        for (id, is_placement, line) in &shape.creases {
            let item = Item::Operation(panel.id, *id);
            match is_placement {
                true => dashed(line, item),
                false => {
                    let ink = match self.is_lit(item) {
                        true => Stroke::new(2.4, self.palette.accent),
                        false => pencil,
                    };
                    self.painter.line(self.line(origin, line), ink);
                }
            }
        }
        for (id, _, line) in &shape.darts {
            dashed(line, Item::Operation(panel.id, *id));
        }
        if let Some(ends) = shape.grainline {
            let [low, high] = ends.map(|end| self.seen(origin, end));
            if low.distance(high) > 30.0 {
                self.painter.line_segment([low, high], pencil);
                self.arrow_head(high, (high - low).normalized());
                self.arrow_head(low, (low - high).normalized());
            }
        }
        for (id, at, inward) in &shape.notches {
            let from = self.seen(origin, *at);
            let way = vec2(inward.x as f32, -inward.y as f32) * NOTCH;
            let colour = match self.is_lit(Item::Notch(panel.id, *id)) {
                true => self.palette.accent,
                false => self.palette.ink,
            };
            self.painter
                .line_segment([from, from + way], Stroke::new(2.4, colour));
        }
    }

    fn arrow_head(&self, tip: Pos2, way: egui::Vec2) {
        let back = tip - way * 8.0;
        let across = way.rot90() * 3.2;
        self.painter.add(Shape::convex_polygon(
            vec![tip, back + across, back - across],
            self.palette.pencil,
            Stroke::NONE,
        ));
    }

    fn outline(&self, panel: &PanelScene) {
        let origin = self.table_layout.panel(panel.id);
        let draw = |this: Item, line: &[Vec2]| {
            let stroke = match () {
                () if self.selection.contains(this) => Stroke::new(3.0, self.palette.accent),
                () if self.hover == Some(this) => Stroke::new(2.4, self.palette.accent),
                () => Stroke::new(1.6, self.palette.ink),
            };
            self.painter.line(self.line(origin, line), stroke);
        };
        for (by, line) in &panel.shape.made {
            draw(Item::Operation(panel.id, *by), line);
        }
        for edge in &panel.shape.edges {
            for line in &edge.lines {
                draw(Item::Edge(panel.id, edge.id), line);
            }
        }
        if let Some(fold) = panel.fold {
            let line = fold.map(|at| self.seen(origin, at));
            let lit = panel_fold_is_lit(panel, self.selection);
            let ink = match lit {
                true => Stroke::new(2.4, self.palette.accent),
                false => Stroke::new(1.4, self.palette.ink_soft),
            };
            self.painter
                .line_segment(line, Stroke::new(2.0, self.palette.panel));
            self.painter
                .extend(Shape::dashed_line(&line, ink, 14.0, 5.0));
        }
    }

    /// Paints the panel's name, and the cutting instruction below it if both fit: inside the panel, in a
    /// gap of the grainline. If they do not fit, only the name: in a smaller font if necessary, or under
    /// the panel if there is no room inside.
    fn caption(&self, panel: &PanelScene, labels: &mut Vec<Rect>) {
        let origin = self.table_layout.panel(panel.id);
        let layout = |text: &str, size: f32, colour| {
            self.painter
                .layout_no_wrap(text.to_owned(), theme::font(size), colour)
        };
        let cut = layout(&panel.cut, 12.0, self.palette.ink_soft);
        let shape = &panel.shape;
        let [low, high] = [shape.drawn_bounds.min, shape.drawn_bounds.max];
        // A folded panel also has room across its fold.
        let across = Vec2::new(
            (shape.bounds.min.x + shape.bounds.max.x) * 0.5,
            shape.middle.y,
        );
        let rooms = [
            ([low, high], shape.middle),
            ([shape.bounds.min, shape.bounds.max], across),
        ];
        let inset = NUMBER_INSET as f32;
        let fits = |size: egui::Vec2, corners: [Vec2; 2]| {
            let [low, high] = corners.map(|p| self.seen(origin, p));
            // A fold has no seam, and so no seam number stands beside it.
            let beside = match panel.fold.is_some() && corners == rooms[0].0 {
                true => inset,
                false => 2.0 * inset,
            };
            let is_wide = size.x + beside + 16.0 < (high.x - low.x).abs();
            is_wide && size.y + 2.0 * inset < (low.y - high.y).abs()
        };
        let [name, small] = CAPTION_SIZES.map(|size| layout(&panel.name, size, self.palette.ink));
        let both = vec2(
            name.size().x.max(cut.size().x),
            name.size().y + cut.size().y,
        );
        let mut choices = Vec::new();
        if !panel.cut.is_empty() {
            choices.push((both, vec![name.clone(), cut]));
        }
        choices.push((name.size(), vec![name.clone()]));
        choices.push((small.size(), vec![small]));
        // Room in the drafted half comes first, even for the name alone, so that no text lies over the
        // fold.
        let found = rooms.iter().find_map(|(corners, at)| {
            let mut choices = choices.iter();
            let (size, lines) = choices.find(|(size, _)| fits(*size, *corners))?;
            Some((*size, lines.clone(), self.seen(origin, *at)))
        });
        let inside = found.is_some();
        let (size, lines, middle) = found.unwrap_or_else(|| {
            let [low, high] = [low, high].map(|p| self.seen(origin, p));
            let below = low.y + 8.0 + name.size().y * 0.5;
            let middle = Pos2::new((low.x + high.x) * 0.5, below);
            (name.size(), vec![name], middle)
        });
        // Avoids other labels: moves up or down inside the panel, or farther down below it.
        let steps = (0..CAPTION_STEPS).flat_map(|k| match inside {
            true => [k as f32, -(k as f32)],
            false => [k as f32; 2],
        });
        let places = steps.map(|k| middle + vec2(0.0, 0.5 * k * size.y));
        let is_free = |at: &Pos2| {
            let ground = Rect::from_center_size(*at, size + vec2(4.0, 2.0));
            !labels.iter().any(|other| other.intersects(ground))
        };
        let middle = places.clone().find(is_free).unwrap_or(middle);
        labels.push(Rect::from_center_size(middle, size + vec2(4.0, 2.0)));
        if inside {
            let ground = Rect::from_center_size(middle, size + vec2(4.0, 2.0));
            self.painter
                .rect_filled(ground, 0.0, self.cloth_colour(panel));
        }
        let mut top = middle - vec2(0.0, size.y * 0.5);
        for line in lines {
            let [width, height] = line.size().into();
            let colour = self.palette.ink;
            self.painter
                .galley(top - vec2(width * 0.5, 0.0), line, colour);
            top.y += height;
        }
    }

    /// Lines from points to their handles, on open sheets.
    fn handles(&self) {
        for sheet in &self.scene.sheets {
            if !sheet.is_bare && !self.open.contains(&sheet.id) {
                continue;
            }
            let origin = self.table_layout.sheet(sheet.id);
            for pair in sheet.curves.iter().flat_map(|curve| &curve.handles) {
                let ends = pair.map(|id| sheet.points.iter().find(|point| point.id == id));
                if let [Some(from), Some(to)] = ends {
                    let line = [from, to].map(|point| self.seen(origin, point.at));
                    let pencil = Stroke::new(1.0, self.palette.pencil);
                    self.painter.line_segment(line, pencil);
                }
            }
        }
    }

    fn point(&self, shown: &ShownPoint<'_>) {
        let at = self.seen(shown.origin, shown.point.at);
        if !self.view.expand(20.0).contains(at) {
            return;
        }
        let this = Item::Point(shown.point.id);
        let selected = self.selection.contains(this);
        let lit = self.is_lit(this);
        let fill = match selected {
            true => self.palette.accent,
            false => self.palette.field,
        };
        let edge = match () {
            () if lit => self.palette.accent,
            () if shown.point.is_left => self.palette.pencil.gamma_multiply(FAINT),
            () => self.palette.ink,
        };
        let radius = if lit { 4.5 } else { 3.2 };
        let stroke = Stroke::new(1.4, edge);
        match shown.point.role {
            PointRole::Corner => {
                let square = Rect::from_center_size(at, egui::Vec2::splat(2.0 * radius));
                self.painter.rect_filled(square, 1.0, fill);
                self.painter
                    .rect_stroke(square, 1.0, stroke, egui::StrokeKind::Middle);
            }
            PointRole::Handle => {
                self.painter.circle(at, radius, fill, stroke);
            }
            PointRole::Construction => {
                for way in [vec2(radius, radius), vec2(radius, -radius)] {
                    self.painter.line_segment([at - way, at + way], stroke);
                }
            }
        }
    }

    fn overlay(&self, mark: &Overlay) {
        let accent = self.palette.accent;
        match mark {
            Overlay::Line(sheet, line) => {
                let line = self.line(self.table_layout.sheet(*sheet), line);
                let stroke = Stroke::new(1.4, accent);
                self.painter
                    .extend(Shape::dashed_line(&line, stroke, 5.0, 4.0));
            }
            Overlay::Edge(panel, edge) => {
                let shape = self.scene.panel_scene(*panel);
                let edge = shape.and_then(|panel| panel.shape.edge_shape(*edge));
                for line in edge.iter().flat_map(|edge| &edge.lines) {
                    let line = self.line(self.table_layout.panel(*panel), line);
                    self.painter.line(line, Stroke::new(3.4, accent));
                }
            }
            Overlay::Dot(sheet, at) => {
                let at = self.seen(self.table_layout.sheet(*sheet), *at);
                let stroke = Stroke::new(1.6, accent);
                self.painter.circle(at, 4.5, self.palette.field, stroke);
            }
            Overlay::Words(sheet, at, words) if !words.is_empty() => {
                let at = self.seen(self.table_layout.sheet(*sheet), *at);
                self.tag(at + vec2(12.0, 20.0), words);
            }
            Overlay::Fault(sheet, at, words) => {
                let at = self.seen(self.table_layout.sheet(*sheet), *at);
                let lines = words.lines().count().max(1) as f32;
                self.label(at + vec2(12.0, -18.0 * lines), words, self.palette.fault);
            }
            Overlay::Words(..) | Overlay::Label(..) => {}
            Overlay::Ghost(..)
            | Overlay::Stroke(..)
            | Overlay::Thread(..)
            | Overlay::Pip(..)
            | Overlay::Touch(_) => self.on_table(mark),
            Overlay::Box(corners) => {
                let [a, b] = corners.map(|at| self.seen(Vec2::zeros(), at));
                let rect = Rect::from_two_pos(a, b);
                self.painter
                    .rect_filled(rect, 0.0, accent.gamma_multiply(0.12));
                let stroke = Stroke::new(1.0, accent);
                self.painter
                    .rect_stroke(rect, 0.0, stroke, egui::StrokeKind::Middle);
            }
        }
    }

    /// Paints a small label in the accent colour beside a place.
    pub(super) fn tag(&self, at: Pos2, text: &str) -> Rect {
        self.label(at, text, self.palette.accent)
    }

    /// Paints a label beside a place, on a background of a colour; returns its rectangle.
    pub(super) fn label(&self, at: Pos2, text: &str, ground_colour: Color32) -> Rect {
        self.words_on(text, ground_colour, |size, first| {
            // The first line of text is level with the place.
            let corner = at - vec2(0.0, 0.5 * first + 2.0);
            let ground = Rect::from_min_size(corner, size);
            // At the edge of the view the label is moved inward.
            let view = self.clear_view();
            let low = (view.max - ground.max).min(egui::Vec2::ZERO);
            let ground = ground.translate(low);
            let high = (view.min - ground.min).max(egui::Vec2::ZERO);
            ground.translate(high)
        })
    }

    /// Paints text on a background; returns the rectangle of the background. `place` computes this
    /// rectangle from the size of the background and the height of the first line.
    pub(super) fn words_on(
        &self,
        words: &str,
        ground_colour: Color32,
        place: impl FnOnce(egui::Vec2, f32) -> Rect,
    ) -> Rect {
        // A long formula is wrapped rather than cut off.
        let (font, most) = (theme::font(12.5), self.clear_view().width() - LABEL_MARGIN);
        let ink = self.palette.on_accent;
        let text = self.painter.layout(words.to_owned(), font, ink, most);
        let first = text.rows.first().map_or(0.0, |row| row.height());
        let ground = place(text.size() + vec2(12.0, 4.0), first);
        self.painter
            .rect_filled(ground, CornerRadius::same(4), ground_colour);
        let corner = Align2::CENTER_CENTER.align_size_within_rect(text.size(), ground);
        self.painter.galley(corner.min, text, ink);
        ground
    }
}

/// Whether the fold of the panel is selected. The fold is an operation without a line of its own.
fn panel_fold_is_lit(panel: &PanelScene, selection: &Selection) -> bool {
    selection.items().iter().any(|item| {
        matches!(item, Item::Operation(of, id) if *of == panel.id
            && panel.fold_step == Some(*id))
    })
}
