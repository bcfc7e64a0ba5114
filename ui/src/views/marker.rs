//! The marker view: pieces on their fabric, seen from above. It changes no document: it says what
//! is done in it.

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

/// Room between pieces that wait beside the fabric (m).
const GAP: f64 = 0.03;
/// How near to another a piece is let go to come to lie against it (pixels), and the least and most of it (m).
const REACH: f64 = 10.0;
const REACHES: [f64; 2] = [0.003, 0.02];
/// Quarter of a turn (rad).
const QUARTER: f64 = std::f64::consts::FRAC_PI_2;

/// What becomes of pieces that are let go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LetGoAs {
    /// They lie where they are.
    Left,
    /// They come to lie against what is nearer than that (m), and go back from where they lie over another.
    Butted(f64),
}

/// Something that is done to a marker.
#[derive(Clone, Debug, PartialEq)]
pub enum MarkerAction {
    /// Pieces are dragged: how far from where they were (m).
    Drag(Vec<OrderedPiece>, Vec2),
    /// The drag is over: how far the pieces were moved (m), and whether they lie as they are let go.
    Drop(Vec<OrderedPiece>, Vec2, LetGoAs),
    /// The drag is left.
    Leave,
    /// A piece that waits is laid at a place (m).
    Lay(OrderedPiece, Vec2, LetGoAs),
    /// The selected pieces are turned together about a place by an angle (m, rad).
    Turn(Vec2, f64),
    /// They are turned over about a line along the warp (m).
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
    /// The roll on show, from 0.
    pub roll: usize,
    /// Names of all its rolls; none where it has none.
    pub rolls: Vec<String>,
    /// Whether the fields of its laying and its rules are shown.
    pub shows_laying: bool,
    /// What keeps it from being cut as it lies.
    pub state: MarkerState,
    /// Why there is nothing to see, and whether that is a fault.
    pub nothing: Option<(String, bool)>,
    pub(super) camera: TableCamera,
    pub(super) pieces: Vec<PieceScene>,
    pub(super) cloth: Bounds2,
    pub(super) selvedge: f64,
    pub(super) hover: Option<OrderedPiece>,
    pub(super) drag: Option<(Vec2, Vec<OrderedPiece>)>,
    wants_fit: bool,
    wants_all_seen: bool,
    /// The size of the view and the camera when all of it was shown last.
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
    /// The focus of the canvas.
    pub fn id() -> Id {
        Id::unique("marker canvas")
    }

    /// Shows all of it when it is next drawn.
    pub fn fit(&mut self) {
        self.wants_fit = true;
    }

    /// Shows all of it when it is next drawn, if some of it lies beyond what is seen.
    pub fn keep_in_view(&mut self) {
        self.wants_all_seen = true;
    }

    /// Where names stand on the screen that are written beside their pieces or in place of their letters.
    pub fn names(&self) -> &[PieceName] {
        &self.names
    }

    /// The fabric as it lies (m).
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
        // A view of another size shows all of it again where nobody has moved it since.
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

    /// The topmost piece at a place (m).
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

    /// What is near on the screen is near, but not more than a few millimetres where pieces are seen small; with
    /// Alt pieces lie as they are let go.
    fn let_go_as(&self, ui: &Ui) -> LetGoAs {
        match ui.input(|input| input.modifiers.alt) {
            true => LetGoAs::Left,
            false => LetGoAs::Butted((REACH / self.camera.scale).clamp(REACHES[0], REACHES[1])),
        }
    }

    /// The middle of what is selected (m).
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
