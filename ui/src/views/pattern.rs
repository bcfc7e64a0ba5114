//! The pattern view: pan, zoom, select, drag. It changes nothing itself: it says what was asked.

use crate::drawing::{Drawing, PanelDrawing, PointRole};
use crate::layout::Layout;
use crate::selection::Selection;
use crate::space::{PanelPoint, ScreenPoint, TableCamera};
use crate::table_paint::TablePainter;
use egui::{CursorIcon, Key, PointerButton, Pos2, Rect, Response, Role, Sense, Ui, WidgetInfo};
use toile_geometry::{Vec2, closest_on_segment};
use toile_pattern::{EdgeId, PanelId, PointId};

/// How near the pointer must be to a point to take hold of it [logical pixels].
const POINT_REACH: f32 = 10.0;
/// How near it must be to an edge [logical pixels].
const EDGE_REACH: f32 = 8.0;
/// Enlargement by one press of a zoom key.
pub const ZOOM_STEP: f64 = 1.25;

/// Something asked for in the view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TableAction {
    /// Show a point somewhere else while it is dragged.
    Move {
        /// The panel.
        panel: PanelId,
        /// The point.
        point: PointId,
        /// Where to.
        to: PanelPoint,
    },
    /// Leave the dragged point where it is shown.
    Drop,
    /// Divide an edge at the place nearest to a point.
    Split {
        /// The panel.
        panel: PanelId,
        /// The edge.
        edge: EdgeId,
        /// Where.
        near: PanelPoint,
    },
}

/// A point held by the pointer.
#[derive(Clone, Copy, Debug)]
struct PointDrag {
    panel: PanelId,
    point: PointId,
    /// Where the pointer was pressed.
    pressed: ScreenPoint,
    /// Where the point was then.
    origin: PanelPoint,
    /// Where it was last asked to go.
    asked: PanelPoint,
}

/// The pattern view and its state.
#[derive(Default)]
pub struct TableView {
    /// How the table is seen.
    pub camera: TableCamera,
    /// Where the panels lie.
    pub layout: Layout,
    /// What is selected.
    pub selection: Selection,
    /// What is under the pointer.
    pub hover: Selection,
    /// Where the pointer is, in the panel it is over or that is selected.
    pub pointer: Option<PanelPoint>,
    held: Option<PointDrag>,
    wants_fit: bool,
    /// Size of the view that everything was fitted into, until it is panned or zoomed.
    fitted: Option<egui::Vec2>,
}

impl TableView {
    /// Lays out a pattern that was just opened, and shows all of it.
    pub fn opened(&mut self, drawing: &Drawing) {
        self.layout = Layout::arrange(drawing);
        self.selection = Selection::Nothing;
        self.held = None;
        self.fit();
    }

    /// Shows the whole pattern when it is next drawn.
    pub fn fit(&mut self) {
        self.wants_fit = true;
    }

    /// Enlarges about the middle of the view.
    pub fn zoom(&mut self, factor: f64) {
        self.fitted = None;
        let middle = ScreenPoint(Pos2::ZERO);
        let view = Rect::from_center_size(Pos2::ZERO, egui::Vec2::ZERO);
        self.camera.zoom(view, middle, factor);
    }

    /// Follows a change of the pattern.
    pub fn changed(&mut self, drawing: &Drawing) {
        self.layout.add_missing(drawing);
        if !self.selection.exists(drawing) {
            self.selection = Selection::Nothing;
            self.held = None;
        }
    }

    /// Whether a point is being dragged.
    pub fn dragging(&self) -> bool {
        self.held.is_some()
    }

    /// Draws the view and takes what is done in it.
    pub fn show(&mut self, ui: &mut Ui, drawing: &Drawing) -> Vec<TableAction> {
        let view = ui.available_rect_before_wrap();
        let response = ui.allocate_rect(view, Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, "Pattern view"));
        let camera = self.camera;
        let panning = self.navigate(ui, &response);
        if self.camera != camera {
            self.fitted = None;
        }
        let resized = self.fitted.is_some_and(|size| size != view.size());
        if (self.wants_fit || resized)
            && view.width() > 50.0
            && let Some(bounds) = self.layout.bounds(drawing)
        {
            self.camera.fit(view, &bounds);
            self.wants_fit = false;
            self.fitted = Some(view.size());
        }
        let pointer = response.hover_pos();
        self.hover = match (pointer, self.held) {
            (_, Some(held)) => Selection::Point(held.panel, held.point),
            (Some(at), None) if !panning => self.hit(view, drawing, at),
            _ => Selection::Nothing,
        };
        self.pointer = pointer.and_then(|at| {
            let panel = self.hover.panel().or(self.selection.panel())?;
            let place = self.layout.place(panel)?;
            Some(place.panel(self.camera.table(view, ScreenPoint(at))))
        });
        let mut actions = Vec::new();
        if !panning {
            self.select_and_split(&response, drawing, &mut actions);
            self.drag(ui, &response, drawing, &mut actions);
        }
        cursor(ui, panning, self.hover, response.hovered());
        TablePainter::new(ui, view, self, drawing).paint();
        self.name_parts(ui, view, drawing);
        actions
    }

    /// Panning and zooming; says whether the primary button pans too.
    fn navigate(&mut self, ui: &Ui, response: &Response) -> bool {
        let with_space = response.contains_pointer()
            && !ui.ctx().egui_wants_keyboard_input()
            && ui.input(|input| input.key_down(Key::Space));
        for button in [PointerButton::Middle, PointerButton::Secondary] {
            if response.dragged_by(button) {
                self.camera.pan(response.drag_delta());
            }
        }
        if with_space && response.dragged_by(PointerButton::Primary) && self.held.is_none() {
            self.camera.pan(response.drag_delta());
        }
        if let Some(at) = response.hover_pos() {
            let (scroll, pinch) =
                ui.input(|input| (input.smooth_scroll_delta.y, input.zoom_delta()));
            let factor = f64::from(scroll / 240.0).exp2() * f64::from(pinch);
            if factor != 1.0 {
                self.camera.zoom(response.rect, ScreenPoint(at), factor);
            }
        }
        with_space
    }

    fn select_and_split(
        &mut self,
        response: &Response,
        drawing: &Drawing,
        actions: &mut Vec<TableAction>,
    ) {
        let Some(at) = response.interact_pointer_pos() else {
            return;
        };
        if response.clicked() {
            self.selection = self.hit(response.rect, drawing, at);
        }
        if response.double_clicked()
            && let Selection::Edge(panel, edge) = self.hit(response.rect, drawing, at)
            && let Some(place) = self.layout.place(panel)
        {
            let table = self.camera.table(response.rect, ScreenPoint(at));
            actions.push(TableAction::Split {
                panel,
                edge,
                near: place.panel(table),
            });
        }
    }

    fn drag(
        &mut self,
        ui: &Ui,
        response: &Response,
        drawing: &Drawing,
        actions: &mut Vec<TableAction>,
    ) {
        if response.drag_started_by(PointerButton::Primary)
            && let Some(pressed) = ui.input(|input| input.pointer.press_origin())
        {
            let hit = self.hit(response.rect, drawing, pressed);
            self.held = self.take_hold(drawing, hit, pressed);
            if hit != Selection::Nothing {
                self.selection = hit;
            }
        }
        let Some(mut held) = self.held else { return };
        if let Some(now) = response.interact_pointer_pos() {
            // The whole way since the press, not the sum of the frames' ways, which loses moves.
            let mut way = self.camera.way(now - held.pressed.0);
            if ui.input(|input| input.modifiers.shift) {
                way = straight(way);
            }
            let to = PanelPoint(held.origin.0 + way);
            if to != held.asked {
                held.asked = to;
                actions.push(TableAction::Move {
                    panel: held.panel,
                    point: held.point,
                    to,
                });
            }
        }
        self.held = Some(held);
        if response.drag_stopped() || !ui.input(|input| input.pointer.primary_down()) {
            self.held = None;
            actions.push(TableAction::Drop);
        }
    }

    fn take_hold(&self, drawing: &Drawing, hit: Selection, at: Pos2) -> Option<PointDrag> {
        let Selection::Point(panel, point) = hit else {
            return None;
        };
        let origin = drawing.panel(panel)?.point(point)?.at;
        Some(PointDrag {
            panel,
            point,
            pressed: ScreenPoint(at),
            origin,
            asked: origin,
        })
    }

    /// Where a point of a panel is seen.
    pub fn screen(&self, view: Rect, panel: PanelId, point: PanelPoint) -> Option<Pos2> {
        let place = self.layout.place(panel)?;
        Some(self.camera.screen(view, place.table(point)).0)
    }

    /// Whether a point of a panel is shown: corners always, the others while something of their
    /// panel is selected.
    pub fn shows(&self, panel: PanelId, role: PointRole) -> bool {
        role == PointRole::Corner || self.selection.panel() == Some(panel)
    }

    /// What is at a place of the screen: a point, else an edge. The nearest wins.
    fn hit(&self, view: Rect, drawing: &Drawing, at: Pos2) -> Selection {
        let mut best = (POINT_REACH, Selection::Nothing);
        for panel in &drawing.panels {
            for point in &panel.points {
                if !self.shows(panel.id, point.role) {
                    continue;
                }
                let seen = self.screen(view, panel.id, point.at);
                let away = seen.map_or(f32::INFINITY, |seen| seen.distance(at));
                if away < best.0 {
                    best = (away, Selection::Point(panel.id, point.id));
                }
            }
        }
        if best.1 != Selection::Nothing {
            return best.1;
        }
        best.0 = EDGE_REACH;
        for panel in &drawing.panels {
            let Some(place) = self.layout.place(panel.id) else {
                continue;
            };
            let there = place.panel(self.camera.table(view, ScreenPoint(at))).0;
            if let Some((edge, away)) = nearest_edge(panel, there) {
                let away = (away * self.camera.scale) as f32;
                if away < best.0 {
                    best = (away, Selection::Edge(panel.id, edge));
                }
            }
        }
        best.1
    }

    /// Names the points and edges for assistive technology. Their nodes take no clicks: those go
    /// to the view under them, by place, as everyone's do.
    fn name_parts(&mut self, ui: &Ui, view: Rect, drawing: &Drawing) {
        for panel in &drawing.panels {
            let points = panel
                .points
                .iter()
                .filter(|point| self.shows(panel.id, point.role))
                .map(|point| (Selection::Point(panel.id, point.id), Some(point.at)));
            let edges = panel.edges.iter().map(|edge| {
                let middle = edge.middle().map(PanelPoint);
                (Selection::Edge(panel.id, edge.id), middle)
            });
            let mut asked = None;
            for (part, at) in edges.chain(points) {
                let seen = at.and_then(|at| self.screen(view, panel.id, at));
                let Some(seen) = seen.filter(|seen| view.contains(*seen)) else {
                    continue;
                };
                let id = ui.scope_id().with(match part {
                    Selection::Nothing => continue,
                    Selection::Point(panel, point) => ("point", panel.0, point.0),
                    Selection::Edge(panel, edge) => ("edge", panel.0, edge.0),
                });
                let rect = Rect::from_center_size(seen, egui::Vec2::splat(POINT_REACH));
                let response = ui.interact(rect, id, Sense::hover());
                response.widget_info(|| {
                    let words = part.words(drawing);
                    WidgetInfo::selected(Role::Button, true, self.selection == part, words)
                });
                let click = egui::accesskit::Action::Click;
                if ui.input(|input| input.has_accesskit_action_request(id, click)) {
                    asked = Some(part);
                }
            }
            self.selection = asked.unwrap_or(self.selection);
        }
    }
}

fn cursor(ui: &Ui, panning: bool, hover: Selection, inside: bool) {
    if !inside {
        return;
    }
    let icon = match hover {
        _ if panning => CursorIcon::Grab,
        Selection::Point(..) => CursorIcon::Move,
        Selection::Edge(..) => CursorIcon::PointingHand,
        Selection::Nothing => CursorIcon::Default,
    };
    ui.ctx().set_cursor_icon(icon);
}

/// The way across or up only, whichever is longer.
fn straight(way: Vec2) -> Vec2 {
    match way.x.abs() >= way.y.abs() {
        true => Vec2::new(way.x, 0.0),
        false => Vec2::new(0.0, way.y),
    }
}

/// The edge of a panel nearest to a place, and how far it is [m].
fn nearest_edge(panel: &PanelDrawing, there: Vec2) -> Option<(EdgeId, f64)> {
    let mut best: Option<(EdgeId, f64)> = None;
    for edge in &panel.edges {
        for side in edge.lines.iter().flat_map(|line| line.windows(2)) {
            let away = (closest_on_segment(there, [side[0], side[1]]) - there).norm();
            if best.is_none_or(|(_, least)| away < least) {
                best = Some((edge.id, away));
            }
        }
    }
    best
}
