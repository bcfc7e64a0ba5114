//! The marker view: pieces on their fabric, seen from above. It does not change the document: it returns
//! the actions of the user.

use super::marker_piece::{PieceName, PieceScene};
use crate::canvas::camera::{ScreenPoint, TableCamera, TablePoint};
use egui::{
    CursorIcon, EventFilter, Id, Key, PointerButton, Pos2, Rect, Response, Role, Sense, Ui,
    WidgetInfo, vec2,
};
use std::collections::HashMap;
use toile_geometry::{Bounds2, Vec2};
use toile_pattern::{MarkerId, OrderedPiece};
use toile_session::{DocumentMarker, MarkerState, Pose};

/// Gap between waiting pieces beside the fabric (m).
const GAP: f64 = 0.03;
/// Distance within which a dropped piece is moved against its neighbour (pixels).
const REACH: f64 = 10.0;
/// Least and largest value of that distance on the fabric (m).
const REACHES: [f64; 2] = [0.003, 0.02];
/// Quarter of a turn (rad).
const QUARTER: f64 = std::f64::consts::FRAC_PI_2;

/// Treatment of pieces that are dropped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LetGoAs {
    /// The pieces stay where they are dropped.
    Left,
    /// The pieces are moved against a neighbour within this distance (m), and return to their old place if
    /// they overlap another piece.
    Butted(f64),
}

/// An action of the user on a marker.
#[derive(Clone, Debug, PartialEq)]
pub enum MarkerAction {
    /// Pieces are dragged by a vector from their old place (m).
    Drag(Vec<OrderedPiece>, Vec2),
    /// The drag ends: its vector (m), and the treatment of the pieces.
    Drop(Vec<OrderedPiece>, Vec2, LetGoAs),
    /// The drag is cancelled.
    Leave,
    /// A waiting piece is laid at a place (m).
    Lay(OrderedPiece, Vec2, LetGoAs),
    /// The selected pieces are rotated together about a point by an angle (m, rad).
    Turn(Vec2, f64),
    /// The selected pieces are mirrored in a line along the warp, given by its coordinate across (m).
    Flip(f64),
    /// The selected pieces are locked, or unlocked.
    Lock,
    /// The selected pieces are taken off the fabric.
    TakeOff,
}

/// The marker view and its state.
pub struct MarkerView {
    /// The marker on show.
    pub chosen: Option<MarkerId>,
    /// Selected pieces.
    pub selection: Vec<OrderedPiece>,
    /// Index of the roll on show.
    pub roll: usize,
    /// Names of all rolls; empty if there are none.
    pub rolls: Vec<String>,
    /// Whether the fields for laying the fabric and for the rules of pieces are shown.
    pub shows_laying: bool,
    /// Result of the marker: numbers, and everything that prevents cutting.
    pub state: MarkerState,
    /// Reason why the view is empty, and whether that is an error.
    pub nothing: Option<(String, bool)>,
    pub(super) camera: TableCamera,
    pub(super) pieces: Vec<PieceScene>,
    pub(super) cloth: Bounds2,
    pub(super) selvedge: f64,
    pub(super) hover: Option<OrderedPiece>,
    pub(super) drag: Option<(Vec2, Vec<OrderedPiece>)>,
    wants_fit: bool,
    wants_all_seen: bool,
    /// Size of the view and camera when the whole marker was last fitted.
    fitted: Option<(egui::Vec2, TableCamera)>,
    pub(super) seen: Rect,
    pub(super) names: Vec<PieceName>,
}

impl Default for MarkerView {
    fn default() -> Self {
        Self {
            chosen: None,
            selection: Vec::new(),
            roll: 0,
            rolls: Vec::new(),
            shows_laying: false,
            state: MarkerState::default(),
            nothing: None,
            camera: TableCamera::default(),
            pieces: Vec::new(),
            cloth: Bounds2::EMPTY,
            selvedge: 0.0,
            hover: None,
            drag: None,
            wants_fit: true,
            wants_all_seen: false,
            fitted: None,
            seen: Rect::NOTHING,
            names: Vec::new(),
        }
    }
}

impl MarkerView {
    /// Id of the canvas, for the focus.
    pub fn id() -> Id {
        Id::unique("marker canvas")
    }

    /// Shows the whole marker when it is next drawn.
    pub fn fit(&mut self) {
        self.wants_fit = true;
    }

    /// Shows the whole marker when it is next drawn, if a part of it is out of view.
    pub fn keep_in_view(&mut self) {
        self.wants_all_seen = true;
    }

    /// Names that are written beside pieces, or in place of the pieces' own text, with their place on the
    /// screen.
    pub fn names(&self) -> &[PieceName] {
        &self.names
    }

    /// Rectangle of the fabric as it is laid (m).
    pub fn cloth(&self) -> Bounds2 {
        self.cloth
    }

    /// Rectangle of the fabric on the screen when it was last drawn.
    pub fn seen_cloth(&self) -> Rect {
        self.seen
    }

    /// Empties the view, and shows a message or an error in it.
    pub fn clear(&mut self, why: Result<&str, String>) {
        self.pieces.clear();
        self.nothing = Some(match why {
            Ok(words) => (words.to_owned(), false),
            Err(words) => (words, true),
        });
        self.state = MarkerState::default();
    }

    /// Updates the view to the present marker. Pieces that did not move are not drawn anew.
    pub fn follow(&mut self, laid: &DocumentMarker) {
        self.nothing = None;
        self.roll = laid.roll();
        self.rolls = laid.rolls().flatten().map(str::to_owned).collect();
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
            // With the same id and pose the piece may have another shape: then the first point of its
            // outline differs.
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
        // Waiting pieces are placed beyond the end of the fabric, in columns as high as the fabric is
        // wide.
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

    /// Draws the view, and returns the actions of the user.
    pub fn show(&mut self, ui: &mut Ui) -> Vec<MarkerAction> {
        let view = ui.available_rect_before_wrap();
        let response = ui.interact(view, Self::id(), Sense::click_and_drag());
        ui.advance_cursor_after_rect(view);
        response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, "Marker view"));
        self.navigate(ui, &response);
        if view.width() > 50.0 {
            self.fit_in(view);
        }
        let corners = [self.cloth.min, self.cloth.max].map(|at| self.screen(view, at));
        self.seen = Rect::from_two_pos(corners[0], corners[1]);
        let mut actions = self.pointed(ui, &response);
        actions.extend(self.keyed(ui, &response));
        self.names = self.placed_names(ui, view);
        self.paint(ui, view);
        self.name_pieces(ui, view);
        actions
    }

    fn fit_in(&mut self, view: Rect) {
        let pieces = self.pieces.iter().filter_map(|scene| scene.bounds());
        let all = pieces.fold(self.cloth, |all, bounds| all.union(&bounds));
        let is_seen = |at: Vec2| view.contains(self.screen(view, at));
        let hides = self.wants_all_seen && !(is_seen(all.min) && is_seen(all.max));
        // If the size of the view changes, the whole marker is fitted again, unless the user has panned
        // or zoomed since.
        let fitted = self.fitted.filter(|(_, camera)| *camera == self.camera);
        let is_resized = fitted.is_some_and(|(size, _)| size != view.size());
        if self.wants_fit || hides || is_resized {
            self.camera.fit(view, &all);
            self.fitted = Some((view.size(), self.camera));
        }
        self.wants_fit = false;
        self.wants_all_seen = false;
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

    /// The topmost piece at a point (m).
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
        // Escape cancels the drag.
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
                // A waiting piece is laid where it is dropped.
                Some(piece) if released => {
                    let found = self.pieces.iter().find(|scene| scene.piece == piece);
                    if let Some(scene) = found {
                        let at = scene.pose.translation + way;
                        actions.push(MarkerAction::Lay(piece, at, self.let_go_as(ui)));
                    }
                }
                Some(_) => {}
                None => {
                    actions.push(MarkerAction::Drag(pieces.clone(), way));
                    if released {
                        actions.push(MarkerAction::Drop(pieces, way, self.let_go_as(ui)));
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

    /// Treatment of pieces dropped now: they are moved against a neighbour within 10 pixels on the screen, on
    /// the fabric at least 3 and at most 20 mm; with Alt they stay where they are dropped.
    fn let_go_as(&self, ui: &Ui) -> LetGoAs {
        match ui.input(|input| input.modifiers.alt) {
            true => LetGoAs::Left,
            false => LetGoAs::Butted((REACH / self.camera.scale).clamp(REACHES[0], REACHES[1])),
        }
    }

    /// Middle of the selected pieces (m).
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

    /// The action that rotates the selected pieces by quarter turns.
    pub fn turn(&self, quarters: f64) -> Option<MarkerAction> {
        Some(MarkerAction::Turn(self.middle()?, quarters * QUARTER))
    }

    /// The action that turns the selected pieces over.
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
                let way = way * 0.001;
                actions.push(MarkerAction::Drag(pieces.clone(), way));
                actions.push(MarkerAction::Drop(pieces, way, LetGoAs::Left));
            }
        }
        actions
    }

    pub(super) fn screen(&self, view: Rect, at: Vec2) -> Pos2 {
        self.camera.screen(view, TablePoint(at)).0
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
