//! The pattern view: pans and zooms, and turns pointer and keys into events for the tool in hand. It does
//! not change the document: it returns the outcomes of the events.
//!
//! # Decided with
//! - [`crate::views::pattern::PatternView::events`] (`input.rs`): pointer and keys as events;
//! - [`crate::views::pattern::PatternView::follow`]: a drag as it is shown;
//! - [`crate::canvas`]: what is drawn, hit and snapped to;
//! - [`crate::views::pattern::PatternView::show_finding_marks`] (`marks.rs`): findings at their parts;
//! - [`crate::views::pattern::PatternView::reveal`] (`revealed.rs`): brought into view;
//! - [`crate::canvas::walked`] (`WalkedLast`), [`crate::views::pattern::walked`]: a seam that is walked.

mod guides;
mod input;
mod marks;
mod revealed;
mod walked;

use crate::canvas::camera::{ScreenPoint, TableCamera};
use crate::canvas::finding_marks::FindingMark;
use crate::canvas::grading::Grading;
use crate::canvas::hit::{Hit, hits, inside_box, open_sheets, shown_points};
use crate::canvas::paint::Picture;
use crate::canvas::scene::Scene;
use crate::canvas::selection::{Item, Selection};
use crate::canvas::sheet_tag::tagged;
use crate::canvas::snap::snaps;
use crate::canvas::table_layout::TableLayout;
use crate::theme::{GRAB, Palette};
use crate::tools::{Event, Outcome, Overlay, Pointer, Reading, State, Tool, ToolModifiers};
use egui::{Id, Pos2, Rect, Response, Role, Sense, Ui, WidgetInfo};
use std::sync::Arc;
use toile_geometry::{Bounds2, Vec2};
use toile_pattern::{Draft, Evaluation, PanelId, Pattern, SeamId, SheetId};

/// Zoom factor of one press of a zoom key.
pub const ZOOM_STEP: f64 = 1.25;
/// Largest number of parts that are all named for assistive technology. If there are more, only parts on
/// sheets with a selected part are named.
const MAX_NAMED: usize = 600;
/// Width of the canvas that the inspector covers (pixels).
pub const INSPECTOR_ROOM: f32 = 300.0;
/// Half the side of a part's node for assistive technology (pixels).
const NAMED_REACH: f32 = 5.0;

/// The pattern view and its state.
pub struct PatternView {
    /// Camera of the table.
    pub camera: TableCamera,
    /// Positions of sheets and panels.
    pub table_layout: TableLayout,
    /// Scene that is drawn.
    pub scene: Scene,
    /// Scene without the gesture that is being previewed: hit tests use it, so that parts do not move
    /// away from the pointer.
    base: Scene,
    /// Positions of sheets and panels without the gesture.
    base_table_layout: TableLayout,
    /// Rectangles of names, seam numbers and tags, as drawn.
    labels: Vec<Rect>,
    /// Findings, at the parts they are about.
    pub finding_marks: Vec<FindingMark>,
    /// Selected parts.
    pub selection: Selection,
    /// Part under the pointer.
    pub hover: Option<Hit>,
    /// All parts under the pointer, the likeliest first.
    pub under: Vec<Item>,
    /// Isolated panels; empty to show all.
    pub isolated: Vec<PanelId>,
    /// Whether cut lines are drawn.
    pub allowances: bool,
    /// Whether rulers are drawn.
    pub rulers: bool,
    /// Whether guides are visible.
    pub guides: bool,
    /// The guide that is dragged.
    guide: Option<guides::GuideDrag>,
    /// Whether the position field of the selected guide should get the focus.
    pub asks_guide_place: bool,
    /// Outlines of all sizes, while they are shown.
    pub grading: Option<Grading>,
    /// Whether a number field of the inspector or the tables uses the present click.
    pub click_is_taken: bool,
    /// Whether a dialog or menu covers the view, and gets all keys.
    pub is_covered: bool,
    /// The tool in hand.
    pub tool: Tool,
    /// State of the tool.
    pub state: State,
    /// Position of the pointer: the sheet to draw on there, and the coordinates on it (m).
    pub pointer: Option<(SheetId, Vec2)>,
    /// The current sheet.
    pub sheet: Option<SheetId>,
    /// Response of the canvas for a context menu; `None` while a tool is in progress.
    pub canvas: Option<Response>,
    pressed: Option<Pointer>,
    /// Position of the pointer, and modifier keys, in the last hover or drag event.
    told: Option<(Pos2, ToolModifiers)>,
    /// Whether another widget had the focus in the last frame.
    was_typed_into: bool,
    /// Whether a tool was taken in hand that has not got the keys yet.
    wants_keys: bool,
    wants_fit: bool,
    /// Part or area to scroll to.
    revealed: Option<revealed::Revealed>,
    /// Size of the view to which everything was fitted; `None` once the user has panned or zoomed.
    fitted: Option<egui::Vec2>,
    /// The walked seam whose pieces were brought into view: this is done once for each walk.
    walked: Option<SeamId>,
    /// Camera before the table was moved for a walk.
    before_walk: Option<TableCamera>,
}

/// The part of the view beside the inspector, if there is room for both.
fn free_room(view: Rect) -> Rect {
    let taken = INSPECTOR_ROOM * f32::from(u8::from(view.width() > 2.0 * INSPECTOR_ROOM));
    Rect::from_min_max(view.min, Pos2::new(view.max.x - taken, view.max.y))
}

impl Default for PatternView {
    fn default() -> Self {
        Self {
            camera: TableCamera::default(),
            table_layout: TableLayout::default(),
            scene: Scene::default(),
            base: Scene::default(),
            base_table_layout: TableLayout::default(),
            labels: Vec::new(),
            finding_marks: Vec::new(),
            selection: Selection::default(),
            hover: None,
            under: Vec::new(),
            isolated: Vec::new(),
            allowances: true,
            rulers: true,
            guides: true,
            guide: None,
            asks_guide_place: false,
            grading: None,
            click_is_taken: false,
            is_covered: false,
            tool: Tool::Select,
            state: State::default(),
            pointer: None,
            sheet: None,
            canvas: None,
            pressed: None,
            told: None,
            was_typed_into: false,
            wants_keys: false,
            wants_fit: false,
            revealed: None,
            fitted: None,
            walked: None,
            before_walk: None,
        }
    }
}

impl PatternView {
    /// Id of the canvas: while it has the focus, keys go to the tool.
    pub fn id() -> Id {
        Id::unique("pattern canvas")
    }

    /// Lays out a pattern that was just opened, and shows all of it.
    pub fn opened(&mut self, pattern: &Pattern) {
        self.table_layout.open(pattern, &self.scene);
        self.base_table_layout = self.table_layout.clone();
        self.selection = Selection::default();
        self.isolated.clear();
        self.sheet = pattern.sheets.first().map(|sheet| sheet.id);
        self.take(Tool::Select);
        // An empty table has nothing to fit: the camera is reset.
        match self.table_layout.bounds(&self.scene) {
            Some(_) => self.fit(),
            None => {
                self.camera = TableCamera::default();
                self.wants_fit = false;
                self.fitted = None;
            }
        }
    }

    /// Takes a tool in hand.
    pub fn take(&mut self, tool: Tool) {
        self.tool = tool;
        self.wants_keys = tool.takes_keys();
        self.state = tool.begin();
        self.pressed = None;
        self.guide = None;
        // A hover event is sent to the new tool, even if the pointer rests on the canvas.
        self.told = None;
    }

    /// Shows the whole pattern when it is next drawn.
    pub fn fit(&mut self) {
        self.wants_fit = true;
    }

    /// Zooms about the middle of the view.
    pub fn zoom(&mut self, factor: f64) {
        self.fitted = None;
        let middle = ScreenPoint(Pos2::ZERO);
        let view = Rect::from_center_size(Pos2::ZERO, egui::Vec2::ZERO);
        self.camera.zoom(view, middle, factor);
    }

    /// Shows everything at true size, on a screen with `scale` pixels per metre.
    pub fn true_size(&mut self, scale: f64) {
        self.fitted = None;
        self.camera.scale = scale;
    }

    /// Updates the view after a change of the pattern or of the enlargement; `previews` is set during the
    /// preview of a gesture.
    pub fn follow(&mut self, evaluation: &Evaluation, draft: &Arc<Draft>, previews: bool) {
        let pattern = evaluation.pattern();
        self.scene.update(evaluation, draft, self.camera.octave());
        self.isolated.retain(|id| pattern.panel(*id).is_some());
        if !self.isolated.is_empty() {
            self.scene.isolate(&self.isolated);
        }
        self.table_layout.follow(pattern);
        if !previews {
            self.table_layout.push_apart(pattern, &self.scene);
            self.base = self.scene.clone();
            self.base_table_layout = self.table_layout.clone();
        }
        self.selection.follow(pattern);
        if self.sheet.is_none_or(|id| pattern.sheet(id).is_none()) {
            self.sheet = pattern.sheets.first().map(|sheet| sheet.id);
        }
    }

    /// Selects parts, and makes their sheet the current one.
    pub fn select(&mut self, selection: Selection) {
        let open = open_sheets(&self.scene, &selection);
        if let [.., last] = open[..] {
            self.sheet = Some(last);
        }
        self.selection = selection;
    }

    /// Open sheets, whose points are all shown: those with selected parts, and with a tool in hand the
    /// current one.
    fn open(&self) -> Vec<SheetId> {
        let mut open = open_sheets(&self.scene, &self.selection);
        let drawn = self.sheet.filter(|sheet| !open.contains(sheet));
        if let Tool::Slots(_) = self.tool {
            open.extend(drawn);
        }
        open
    }

    /// Whether a gesture of the tool is in progress.
    pub fn is_busy(&self) -> bool {
        self.guide.is_some() || self.tool.is_under_way(&self.state)
    }

    /// Gives an event to the tool in hand.
    pub fn step(&mut self, event: &Event, evaluation: &Evaluation) -> Outcome {
        let open = self.open();
        let (scene, table_layout) = (&self.base, &self.table_layout);
        let inside = |corners| inside_box((scene, table_layout), &open, corners);
        let reading = Reading {
            evaluation,
            scene,
            table_layout: &self.base_table_layout,
            selection: &self.selection,
            sheet: self.sheet,
            inside: &inside,
        };
        let (state, outcome) = self.tool.step(&self.state, event, &reading);
        self.state = state;
        outcome
    }

    /// Read access of the tool for hints and overlays, in which the search of parts in a box finds no part.
    fn reading<'a>(&'a self, evaluation: &'a Evaluation) -> Reading<'a> {
        Reading {
            evaluation,
            scene: &self.scene,
            table_layout: &self.table_layout,
            selection: &self.selection,
            sheet: self.sheet,
            inside: &|_| Vec::new(),
        }
    }

    /// Hint on the effect of a click.
    pub fn hint(&self, evaluation: &Evaluation) -> String {
        let hint = || self.tool.hint(&self.state, &self.reading(evaluation));
        self.guide_hint().unwrap_or_else(hint)
    }

    /// Marks that the tool in hand draws over the pattern.
    pub fn overlay(&self, evaluation: &Evaluation) -> Vec<Overlay> {
        self.tool.overlay(&self.state, &self.reading(evaluation))
    }

    /// Bounding box of everything that is shown, with the outlines of other sizes (m).
    fn bounds(&self) -> Option<Bounds2> {
        let drawn = self.table_layout.bounds(&self.scene);
        let sizes = self.grading.iter().flat_map(|grading| &grading.sizes);
        let panels = sizes.flat_map(|size| &size.panels);
        let graded = panels.map(|(id, rings)| {
            let at = self.table_layout.panel(*id);
            Bounds2::of(rings.iter().flatten().map(|p| p + at))
        });
        drawn.into_iter().chain(graded).reduce(|a, b| a.union(&b))
    }

    /// Draws the view, and returns the outcomes of its input. `evaluation` is the pattern without the
    /// gesture that is being previewed.
    pub fn show(&mut self, ui: &mut Ui, evaluation: &Evaluation) -> Vec<Outcome> {
        let view = ui.available_rect_before_wrap();
        // A rim of the view is left out: there the borders between the parts of the window are dragged.
        let inner = view.shrink(GRAB);
        let response = ui.interact(inner, Self::id(), Sense::click_and_drag());
        ui.advance_cursor_after_rect(view);
        response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, "Pattern view"));
        let camera = self.camera;
        let panning = self.navigate(ui, &response);
        if self.camera != camera {
            self.fitted = None;
        }
        let resized = self.fitted.is_some_and(|size| size != view.size());
        if (self.wants_fit || resized)
            && view.width() > 50.0
            && let Some(bounds) = self.bounds()
        {
            self.camera.fit_into(view, free_room(view), &bounds);
            self.wants_fit = false;
            self.fitted = Some(view.size());
        }
        self.follow_revealed(view);
        self.make_room(ui, view, evaluation);
        let mut outcomes = Vec::new();
        self.canvas = (!self.is_busy()).then(|| response.clone());
        if response.secondary_clicked()
            && !self.is_busy()
            && let Some(hit) = self.hover.filter(|hit| !self.selection.contains(hit.item))
        {
            outcomes.push(Outcome {
                select: Some(Selection::one(hit.item)),
                ..Outcome::default()
            });
        }
        if std::mem::take(&mut self.click_is_taken) {
            self.click_is_taken = ui.input(|input| input.pointer.primary_down());
            self.paint(ui, view, evaluation);
            return outcomes;
        }
        outcomes.extend(self.drag_guide(ui, (view, &response), panning, evaluation));
        let events = match self.guide {
            Some(_) => Vec::new(),
            None => self.events(ui, &response, panning),
        };
        for event in events {
            outcomes.push(self.step(&event, evaluation));
            if matches!(event, Event::Tab | Event::Go(_) | Event::Enter) {
                self.follow_walk(view, evaluation);
            }
        }
        self.cursor(ui, panning, response.hovered());
        self.paint(ui, view, evaluation);
        if let Some(item) = self.show_finding_marks(ui, view) {
            outcomes.push(Outcome {
                select: Some(Selection::one(item)),
                ..Outcome::default()
            });
        }
        if let Some(item) = self.name_parts(ui, view, evaluation.pattern()) {
            outcomes.push(Outcome {
                select: Some(Selection::one(item)),
                ..Outcome::default()
            });
        }
        outcomes
    }

    /// Whether a number of the tool in hand is being typed.
    pub fn is_typing(&self) -> bool {
        match &self.state {
            State::Slots(state) => state.is_typing(),
            State::Walk(state) => state.is_typing(),
            State::Select(_) | State::Suggested(_) => false,
        }
    }

    fn pointer_at(&self, view: Rect, at: Pos2, modifiers: ToolModifiers) -> Pointer {
        self.pointer(self.camera.table(view, ScreenPoint(at)).0, modifiers)
    }

    /// The pointer at a place of the table (m), with the sheet, parts and snapping places found there.
    pub fn pointer(&self, table: Vec2, modifiers: ToolModifiers) -> Pointer {
        let open = self.open();
        let mut found = hits(
            (&self.base, &self.table_layout),
            &open,
            table,
            self.camera.scale,
        );
        self.add_guide_hit(&mut found, table);
        let begun = match &self.state {
            State::Slots(state) => state.sheet(),
            State::Select(_) | State::Walk(_) | State::Suggested(_) => None,
        };
        // While the current sheet lies on a panel, the pointer over that panel draws on it.
        let is_on = |id: &SheetId| {
            let on = self.base.sheet_scene(*id).and_then(|sheet| sheet.on);
            on.is_some() && found.iter().any(|hit| hit.item.panel() == on)
        };
        let sheet = begun
            .or(self.sheet.filter(is_on))
            .or(found.first().map(|hit| hit.sheet))
            .or(self.sheet)
            .unwrap_or(SheetId(0));
        let at = table - self.table_layout.sheet(sheet);
        Pointer {
            table,
            sheet,
            at,
            snaps: snaps(
                (&self.base, &self.guides_on(sheet)),
                sheet,
                at,
                self.camera.scale,
            ),
            hits: found,
            pixel: 1.0 / self.camera.scale,
            modifiers,
        }
    }

    fn paint(&mut self, ui: &Ui, view: Rect, evaluation: &Evaluation) {
        let open = self.open();
        let overlay = self.overlay(evaluation);
        let hover = match self.tool {
            Tool::Select => self.hover.map(|hit| hit.item),
            Tool::Slots(_) | Tool::Walk | Tool::Suggested => None,
        };
        let known = |seam: &&crate::canvas::seams::SeamDrawing| {
            self.base.seams.iter().all(|old| old.id != seam.id)
        };
        let fresh: Vec<_> = self
            .scene
            .seams
            .iter()
            .filter(known)
            .map(|s| s.id)
            .collect();
        let (guides, guide_label) = (self.drawn_guides(), self.guide_label(evaluation));
        let picture = Picture {
            painter: ui.painter_at(view),
            view,
            camera: self.camera,
            table_layout: &self.table_layout,
            scene: &self.scene,
            selection: &self.selection,
            hover,
            guides: &guides,
            guide_label: guide_label.as_ref(),
            allowances: self.allowances,
            rulers: self
                .rulers
                .then(|| (self.sheet_origin(), evaluation.pattern().unit)),
            grading: self.grading.as_ref(),
            fresh: &fresh,
            open: &open,
            palette: Palette::of(ui.ctx()),
        };
        self.labels = picture.paint(&overlay);
    }

    /// Position of the origin of the current sheet on the table (m).
    pub fn sheet_origin(&self) -> Vec2 {
        self.sheet
            .map_or_else(Vec2::zeros, |sheet| self.table_layout.sheet(sheet))
    }

    /// Rectangles of names of panels and points, seam numbers, tags and signs of findings, as last drawn.
    pub fn labels(&self) -> &[Rect] {
        &self.labels
    }

    /// Screen position of a point of a sheet.
    pub fn screen(&self, view: Rect, origin: Vec2, at: Vec2) -> Pos2 {
        let table = crate::canvas::camera::TablePoint(at + origin);
        self.camera.screen(view, table).0
    }

    /// Visible points, edges, notches, darts, curves and panels, with their places on the table (m). A
    /// point that is drawn twice is listed twice.
    pub fn parts(&self) -> Vec<(SheetId, Item, Vec2)> {
        let open = self.open();
        let mut parts = Vec::new();
        for panel in &self.scene.panels {
            let origin = self.table_layout.panel(panel.id);
            let mut part = |item, at: Vec2| parts.push((panel.sheet, item, origin + at));
            part(Item::Panel(panel.id), panel.shape.middle);
            for edge in &panel.shape.edges {
                if let Some(middle) = edge.middle() {
                    part(Item::Edge(panel.id, edge.id), middle);
                }
            }
            for (id, line) in &panel.shape.internal_lines {
                if let Some((at, _)) = crate::canvas::along(line, 0.5) {
                    part(Item::Line(panel.id, *id), at);
                }
            }
            for (id, at, _) in &panel.shape.notches {
                part(Item::Notch(panel.id, *id), *at);
            }
            for (id, line) in &panel.shape.made {
                if let Some((at, _)) = crate::canvas::along(line, 0.5) {
                    part(Item::Operation(panel.id, *id), at);
                }
            }
            for (id, mirrored, line) in &panel.shape.darts {
                // The place of a dart is on its first leg, a quarter along it: at the mouth the edge would
                // be as near.
                if let Some((at, _)) = crate::canvas::along(line, 0.25).filter(|_| !mirrored) {
                    part(Item::Operation(panel.id, *id), at);
                }
            }
        }
        for sheet in &self.scene.sheets {
            let origin = self.table_layout.sheet(sheet.id);
            for curve in sheet.curves.iter().filter(|curve| !curve.is_traced) {
                if let Some((middle, _)) = crate::canvas::along(&curve.line, 0.5) {
                    parts.push((sheet.id, Item::Curve(curve.id), origin + middle));
                }
            }
        }
        for sheet in tagged(&self.scene, &open) {
            let origin = self.table_layout.sheet(sheet.id);
            parts.push((sheet.id, Item::Sheet(sheet.id), origin));
        }
        for shown in shown_points(&self.scene, &self.table_layout, &open) {
            let at = shown.origin + shown.point.at;
            parts.push((shown.sheet, Item::Point(shown.point.id), at));
        }
        parts.extend(self.guide_parts());
        parts
    }

    /// Whether a selected part is visible in a rectangle of the screen; `view` is the rectangle of the
    /// table.
    pub fn selection_is_in(&self, view: Rect, place: Rect) -> bool {
        let parts = self.parts();
        let mut selected = parts
            .iter()
            .filter(|(_, item, _)| self.selection.contains(*item));
        selected.any(|(.., at)| place.contains(self.screen(view, Vec2::zeros(), *at)))
    }

    /// Names points, edges and panels for assistive technology; returns a part that was chosen by it. The
    /// named nodes take no mouse clicks, which go to the view.
    fn name_parts(&self, ui: &Ui, view: Rect, pattern: &Pattern) -> Option<Item> {
        let open = self.open();
        let mut parts = self.parts();
        if parts.len() > MAX_NAMED {
            parts.retain(|(sheet, item, _)| open.contains(sheet) || matches!(item, Item::Guide(_)));
        }
        let mut asked = None;
        let mut named = std::collections::BTreeSet::new();
        for (_, item, at) in parts {
            let at = self.screen(view, Vec2::zeros(), at);
            // A point that is drawn twice is named once.
            if !view.contains(at) || !named.insert(item) {
                continue;
            }
            let Some(words) = item.words(pattern) else {
                continue;
            };
            let rect = Rect::from_center_size(at, egui::Vec2::splat(2.0 * NAMED_REACH));
            let id = Self::id().with(item);
            let response = ui.interact(rect, id, Sense::hover());
            response.widget_info(|| {
                WidgetInfo::selected(Role::Button, true, self.selection.contains(item), &words)
            });
            let click = egui::accesskit::Action::Click;
            if ui.input(|input| input.has_accesskit_action_request(id, click)) {
                asked = Some(item);
            }
        }
        asked
    }
}
