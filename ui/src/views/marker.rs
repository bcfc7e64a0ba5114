//! The marker view: pieces on their fabric, seen from above. It changes no document: it says what
//! is done in it.

use super::marker_piece::PieceScene;
use crate::canvas::camera::{ScreenPoint, TableCamera, TablePoint};
use crate::canvas::fill::{Fill, fill};
use crate::theme::{self, Palette};
use egui::epaint::Vertex;
use egui::{
    Align2, Color32, CursorIcon, EventFilter, Id, Key, Mesh, PointerButton, Pos2, Rect, Response,
    Role, Sense, Shape, Stroke, Ui, WidgetInfo, vec2,
};
use std::collections::HashMap;
use toile_cut::StrokeKind;
use toile_geometry::{Bounds2, Vec2};
use toile_pattern::{MarkerId, OrderedPiece};
use toile_session::{DocumentMarker, MarkerState, Pose};

/// Room between pieces that wait beside the fabric [m].
const GAP: f64 = 0.03;
/// Smaller letters are not read [pixels].
const LEAST_LETTERS: f32 = 7.0;
/// Sizes of the letters that stand in for them, the first that the piece has room for [pixels].
const SMALL_NAMES: [f32; 2] = [13.0, 10.5];
/// Quarter of a turn [rad].
const QUARTER: f64 = std::f64::consts::FRAC_PI_2;

/// Something that is done to a marker.
#[derive(Clone, Debug, PartialEq)]
pub enum MarkerAction {
    /// Pieces are dragged: how far from where they were [m].
    Drag(Vec<OrderedPiece>, Vec2),
    /// The drag is over.
    Drop,
    /// The drag is left.
    Leave,
    /// A piece that waits is laid at a place [m].
    Lay(OrderedPiece, Vec2),
    /// The selected pieces are turned together about a place by an angle [m, rad].
    Turn(Vec2, f64),
    /// They are turned over about a line along the warp [m].
    Flip(f64),
    /// They are locked, or unlocked.
    Lock,
    /// They are taken off the fabric.
    TakeOff,
}

/// The marker view and its state.
pub struct MarkerView {
    /// The marker on show.
    pub chosen: Option<MarkerId>,
    /// Pieces that are selected.
    pub selection: Vec<OrderedPiece>,
    /// What keeps it from being cut as it lies.
    pub state: MarkerState,
    /// Why there is nothing to see, and whether that is a fault.
    pub nothing: Option<(String, bool)>,
    camera: TableCamera,
    pieces: Vec<PieceScene>,
    cloth: Bounds2,
    selvedge: f64,
    hover: Option<OrderedPiece>,
    drag: Option<(Vec2, Vec<OrderedPiece>)>,
    wants_fit: bool,
    seen: Rect,
}

impl Default for MarkerView {
    fn default() -> Self {
        Self {
            chosen: None,
            selection: Vec::new(),
            state: MarkerState::default(),
            nothing: None,
            camera: TableCamera::default(),
            pieces: Vec::new(),
            cloth: Bounds2::EMPTY,
            selvedge: 0.0,
            hover: None,
            drag: None,
            wants_fit: true,
            seen: Rect::NOTHING,
        }
    }
}

impl MarkerView {
    /// The focus of the canvas.
    pub fn id() -> Id {
        Id::unique("marker canvas")
    }

    /// Shows all of it when it is next drawn.
    pub fn fit(&mut self) {
        self.wants_fit = true;
    }

    /// The fabric as it lies [m].
    pub fn cloth(&self) -> Bounds2 {
        self.cloth
    }

    /// Where the fabric is seen on the screen, as it was drawn last.
    pub fn seen_cloth(&self) -> Rect {
        self.seen
    }

    /// Nothing is to be seen: there is nothing yet, or it cannot be shown.
    pub fn clear(&mut self, why: Result<&str, String>) {
        self.pieces.clear();
        self.nothing = Some(match why {
            Ok(words) => (words.to_owned(), false),
            Err(words) => (words, true),
        });
        self.state = MarkerState::default();
    }

    /// Follows a marker as it lies now. Pieces that lie as before are not drawn anew.
    pub fn follow(&mut self, laid: &DocumentMarker) {
        self.nothing = None;
        self.state = laid.state();
        let mut old: HashMap<OrderedPiece, PieceScene> = std::mem::take(&mut self.pieces)
            .into_iter()
            .map(|scene| (scene.piece, scene))
            .collect();
        let strip = laid.strip();
        let length = strip.max_length.unwrap_or(self.state.length).max(0.5);
        self.wants_fit |= self.cloth.max.y != strip.width;
        self.cloth = Bounds2 {
            min: Vec2::zeros(),
            max: Vec2::new(length, strip.width),
        };
        self.selvedge = strip.selvedge;
        for piece in laid.laid() {
            let before = old.remove(&piece.piece).filter(|known| {
                known.pose == piece.pose && !known.waits && known.name == piece.name
            });
            let mut scene = before.unwrap_or_else(|| {
                PieceScene::new(piece.piece, piece.name, piece.pose, |place, words| {
                    piece.cut.drawing(place, words)
                })
            });
            // The same place may hold another shape: its outline tells.
            let outline = piece.cut.polygon();
            let first = outline.outer.first().map(|at| piece.pose.apply(*at));
            let drawn = scene
                .drawing
                .fill
                .as_ref()
                .and_then(|fill| fill.outer.first().copied());
            if first != drawn {
                scene = PieceScene::new(piece.piece, piece.name, piece.pose, |place, words| {
                    piece.cut.drawing(place, words)
                });
            }
            scene.locked = piece.locked;
            self.pieces.push(scene);
        }
        // What waits lies beyond the end of the fabric, in columns as high as it is wide.
        let mut pen = Vec2::new(length + 3.0 * GAP, strip.width);
        let mut widest: f64 = 0.0;
        for piece in laid.waiting() {
            let upright = Pose {
                grain: piece.cut.grain,
                turn: 0.0,
                mirrored: false,
                translation: Vec2::zeros(),
            };
            let bounds = piece.cut.outer().mapped(|at| upright.apply(at)).bounds();
            let size = bounds.size();
            if pen.y < size.y && pen.y < strip.width {
                pen = Vec2::new(pen.x + widest + GAP, strip.width);
                widest = 0.0;
            }
            let pose = Pose {
                translation: Vec2::new(pen.x - bounds.min.x, pen.y - bounds.max.y),
                ..upright
            };
            pen.y -= size.y + GAP;
            widest = widest.max(size.x);
            let mut scene = PieceScene::new(piece.piece, piece.name, pose, |place, words| {
                piece.cut.drawing(place, words)
            });
            scene.waits = true;
            self.pieces.push(scene);
        }
        let known = |piece: &OrderedPiece| self.pieces.iter().any(|scene| scene.piece == *piece);
        self.selection.retain(known);
    }

    /// Draws the view, and tells what is done in it.
    pub fn show(&mut self, ui: &mut Ui) -> Vec<MarkerAction> {
        let view = ui.available_rect_before_wrap();
        let response = ui.interact(view, Self::id(), Sense::click_and_drag());
        ui.advance_cursor_after_rect(view);
        response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, "Marker view"));
        self.navigate(ui, &response);
        if self.wants_fit && view.width() > 50.0 {
            let pieces = self.pieces.iter().filter_map(|scene| scene.bounds());
            let all = pieces.fold(self.cloth, |all, bounds| all.union(&bounds));
            self.camera.fit(view, &all);
            self.wants_fit = false;
        }
        let corners = [self.cloth.min, self.cloth.max].map(|at| self.screen(view, at));
        self.seen = Rect::from_two_pos(corners[0], corners[1]);
        let mut actions = self.pointed(ui, &response);
        actions.extend(self.keyed(ui, &response));
        self.paint(ui, view);
        self.name_pieces(ui, view);
        actions
    }

    fn navigate(&mut self, ui: &Ui, response: &Response) {
        for button in [PointerButton::Middle, PointerButton::Secondary] {
            if response.dragged_by(button) {
                self.camera.pan(response.drag_delta());
            }
        }
        if let Some(at) = response.hover_pos() {
            let (scroll, pinch) =
                ui.input(|input| (input.smooth_scroll_delta.y, input.zoom_delta()));
            let factor = f64::from(scroll / 240.0).exp2() * f64::from(pinch);
            if factor != 1.0 {
                self.camera.zoom(response.rect, ScreenPoint(at), factor);
            }
        }
    }

    /// The topmost piece at a place [m].
    fn at(&self, place: Vec2) -> Option<&PieceScene> {
        self.pieces.iter().rev().find(|scene| {
            let polygon = scene.drawing.fill.as_ref();
            polygon.is_some_and(|polygon| polygon.contains(place))
        })
    }

    fn pointed(&mut self, ui: &Ui, response: &Response) -> Vec<MarkerAction> {
        let mut actions = Vec::new();
        let view = response.rect;
        let table = |at: Pos2| self.camera.table(view, ScreenPoint(at)).0;
        let hover = response.hover_pos().map(table);
        let shift = ui.input(|input| input.modifiers.shift);
        self.hover = hover.and_then(|at| self.at(at)).map(|scene| scene.piece);
        if response.drag_started_by(PointerButton::Primary)
            && let Some(from) = ui.input(|input| input.pointer.press_origin())
        {
            let from = self.camera.table(view, ScreenPoint(from)).0;
            if let Some(scene) = self.at(from) {
                let piece = scene.piece;
                if !self.selection.contains(&piece) {
                    self.selection = vec![piece];
                }
                self.drag = Some((from, self.selection.clone()));
            }
        }
        if response.clicked() || response.drag_started() {
            response.request_focus();
        }
        // Escape ends the drag too: what it showed is left, not taken.
        if self.drag.is_some() && ui.input(|input| input.key_pressed(Key::Escape)) {
            self.drag = None;
            actions.push(MarkerAction::Leave);
        }
        let now = response.interact_pointer_pos();
        if let (Some((from, pieces)), Some(now)) = (self.drag.clone(), now) {
            let to = self.camera.table(view, ScreenPoint(now)).0;
            let waits = |piece: &OrderedPiece| {
                let found = self.pieces.iter().find(|scene| scene.piece == *piece);
                found.is_some_and(|scene| scene.waits)
            };
            let mut way = to - from;
            if shift {
                way = match way.x.abs() > way.y.abs() {
                    true => Vec2::new(way.x, 0.0),
                    false => Vec2::new(0.0, way.y),
                };
            }
            let released = response.drag_stopped();
            match pieces.iter().copied().find(waits) {
                // A piece that waits is laid where it is let go.
                Some(piece) if released => {
                    let found = self.pieces.iter().find(|scene| scene.piece == piece);
                    if let Some(scene) = found {
                        actions.push(MarkerAction::Lay(piece, scene.pose.translation + way));
                    }
                }
                Some(_) => {}
                None => {
                    actions.push(MarkerAction::Drag(pieces, way));
                    if released {
                        actions.push(MarkerAction::Drop);
                    }
                }
            }
        }
        if response.drag_stopped() {
            self.drag = None;
        }
        if response.clicked() {
            let piece = self.hover;
            match (piece, shift) {
                (Some(piece), true) => match self.selection.iter().position(|p| *p == piece) {
                    Some(k) => {
                        self.selection.remove(k);
                    }
                    None => self.selection.push(piece),
                },
                (Some(piece), false) => self.selection = vec![piece],
                (None, false) => self.selection.clear(),
                (None, true) => {}
            }
        }
        if self.hover.is_some() {
            ui.ctx().set_cursor_icon(CursorIcon::Move);
        }
        actions
    }

    /// The middle of what is selected [m].
    fn middle(&self) -> Option<Vec2> {
        let selected = self
            .pieces
            .iter()
            .filter(|s| self.selection.contains(&s.piece));
        let all = selected
            .filter_map(PieceScene::bounds)
            .reduce(|a, b| a.union(&b));
        all.map(|bounds| bounds.centre())
    }

    /// Turns what is selected by quarters.
    pub fn turn(&self, quarters: f64) -> Option<MarkerAction> {
        Some(MarkerAction::Turn(self.middle()?, quarters * QUARTER))
    }

    /// Turns what is selected over.
    pub fn flip(&self) -> Option<MarkerAction> {
        Some(MarkerAction::Flip(self.middle()?.y))
    }

    fn keyed(&mut self, ui: &Ui, response: &Response) -> Vec<MarkerAction> {
        if !response.has_focus() {
            return Vec::new();
        }
        let filter = EventFilter {
            escape: true,
            horizontal_arrows: true,
            vertical_arrows: true,
            tab: false,
        };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(Self::id(), filter));
        let pressed =
            |key: Key| ui.input_mut(|input| input.consume_key(egui::Modifiers::NONE, key));
        let mut actions = Vec::new();
        if pressed(Key::R) {
            actions.extend(self.turn(2.0));
        }
        if pressed(Key::F) {
            actions.extend(self.flip());
        }
        if pressed(Key::L) {
            actions.push(MarkerAction::Lock);
        }
        if pressed(Key::Delete) {
            actions.push(MarkerAction::TakeOff);
        }
        if pressed(Key::Escape) {
            self.selection.clear();
        }
        for (key, way) in [
            (Key::ArrowLeft, Vec2::new(-1.0, 0.0)),
            (Key::ArrowRight, Vec2::new(1.0, 0.0)),
            (Key::ArrowUp, Vec2::new(0.0, 1.0)),
            (Key::ArrowDown, Vec2::new(0.0, -1.0)),
        ] {
            if pressed(key) && !self.selection.is_empty() {
                let pieces = self.selection.clone();
                actions.push(MarkerAction::Drag(pieces, way * 0.001));
                actions.push(MarkerAction::Drop);
            }
        }
        actions
    }

    fn screen(&self, view: Rect, at: Vec2) -> Pos2 {
        self.camera.screen(view, TablePoint(at)).0
    }

    fn paint(&self, ui: &Ui, view: Rect) {
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
        // What would be cut twice.
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
        self.small_name(painter, scene, (at(scene.middle()), palette));
        for words in &scene.drawing.words {
            let size = (words.size * self.camera.scale) as f32;
            if size < LEAST_LETTERS {
                continue;
            }
            let galley = painter.layout_no_wrap(
                words.text.clone(),
                theme::font(size.min(22.0)),
                palette.ink,
            );
            // Seen on the screen y points down: the words are turned the other way.
            let turn = -words.angle as f32;
            let half = vec2(galley.size().x * 0.5, galley.size().y);
            let corner = at(words.at) - egui::emath::Rot2::from_angle(turn) * half;
            let text = egui::epaint::TextShape::new(corner, galley, palette.ink).with_angle(turn);
            painter.add(text);
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

    /// The name of a piece whose own letters are too small to read, where there is room for it.
    fn small_name(
        &self,
        painter: &egui::Painter,
        scene: &PieceScene,
        (middle, palette): (Pos2, &Palette),
    ) {
        let own = scene.drawing.words.first().map_or(0.0, |words| words.size);
        let Some(bounds) = scene.bounds() else {
            return;
        };
        if (own * self.camera.scale) as f32 >= LEAST_LETTERS {
            return;
        }
        let room = bounds.size() * self.camera.scale;
        for letters in SMALL_NAMES {
            let font = theme::font(letters);
            let galley = painter.layout_no_wrap(scene.name.clone(), font, palette.ink);
            let size = galley.size();
            if f64::from(size.x) < room.x && f64::from(size.y) < room.y {
                painter.galley(middle - size * 0.5, galley, palette.ink);
                return;
            }
        }
    }

    /// Names the pieces for assistive technology.
    fn name_pieces(&self, ui: &Ui, view: Rect) {
        for scene in &self.pieces {
            let Some(bounds) = scene.bounds() else {
                continue;
            };
            let at = self.screen(view, bounds.centre());
            if !view.contains(at) {
                continue;
            }
            let rect = Rect::from_center_size(at, vec2(10.0, 10.0));
            let response = ui.interact(rect, Self::id().with(scene.piece), Sense::hover());
            let words = match scene.waits {
                true => format!("Waiting piece {}", scene.name),
                false => format!("Piece {}", scene.name),
            };
            let selected = self.selection.contains(&scene.piece);
            response.widget_info(|| WidgetInfo::selected(Role::Button, true, selected, &words));
        }
    }
}
