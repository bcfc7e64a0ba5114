//! The pattern view: pans and zooms, turns the pointer and keys into events of the tool in hand.
//! It changes no document: it says what came of the events.

use crate::canvas::boards::Boards;
use crate::canvas::camera::{ScreenPoint, TableCamera};
use crate::canvas::grading::Grading;
use crate::canvas::hit::{Hit, hits, inside_box, open_sheets, shown_points};
use crate::canvas::paint::Picture;
use crate::canvas::scene::Scene;
use crate::canvas::selection::{Item, Selection};
use crate::canvas::snap::snaps;
use crate::theme::Palette;
use crate::tools::number::begins_typing;
use crate::tools::{Event, Held, Outcome, Overlay, Pointer, Reading, State, Tool};
use egui::{
    CursorIcon, EventFilter, Id, Key, PointerButton, Pos2, Rect, Response, Role, Sense, Ui,
    WidgetInfo,
};
use toile_geometry::Vec2;
use toile_pattern::{Draft, Evaluation, PanelId, Pattern, SheetId};

/// Enlargement by one press of a zoom key.
pub const ZOOM_STEP: f64 = 1.25;
/// Parts up to this many are named for assistive technology; of more only those of the sheets that
/// something selected is on.
const MOST_NAMED: usize = 600;
/// Half the width of the named node of a part [pixels].
const NAMED_REACH: f32 = 5.0;

/// The pattern view and its state.
pub struct PatternView {
    /// How the table is seen.
    pub camera: TableCamera,
    /// Where sheets and panels lie.
    pub boards: Boards,
    /// What is drawn.
    pub scene: Scene,
    /// The same as before the gesture that is shown: what the pointer finds must not move away
    /// under it.
    base: Scene,
    /// What is selected.
    pub selection: Selection,
    /// What is under the pointer.
    pub hover: Option<Hit>,
    /// Everything under the pointer, the most wanted first.
    pub under: Vec<Item>,
    /// Panels that alone are shown; none for all.
    pub isolated: Vec<PanelId>,
    /// Whether lines to cut along are drawn.
    pub allowances: bool,
    /// Whether rulers are drawn.
    pub rulers: bool,
    /// All sizes over each other, while they are drawn.
    pub grading: Option<Grading>,
    /// Whether the click that goes on was taken by a number that is typed elsewhere.
    pub click_is_taken: bool,
    /// Whether a dialog or a menu lies over it, which all keys go to.
    pub is_covered: bool,
    /// The tool in hand.
    pub tool: Tool,
    /// How far it has come.
    pub state: State,
    /// Where the pointer is, on the sheet that is drawn on [m].
    pub pointer: Option<Vec2>,
    /// The sheet that is drawn on.
    pub sheet: Option<SheetId>,
    pressed: Option<Pointer>,
    /// Where the pointer was told to be last, and what was held.
    told: Option<(Pos2, Held)>,
    /// Whether keys went to another widget in the last frame.
    was_typed_into: bool,
    wants_fit: bool,
    /// Size of the view that everything was fitted into, until it is panned or zoomed.
    fitted: Option<egui::Vec2>,
}

impl Default for PatternView {
    fn default() -> Self {
        Self {
            camera: TableCamera::default(),
            boards: Boards::default(),
            scene: Scene::default(),
            base: Scene::default(),
            selection: Selection::default(),
            hover: None,
            under: Vec::new(),
            isolated: Vec::new(),
            allowances: true,
            rulers: true,
            grading: None,
            click_is_taken: false,
            is_covered: false,
            tool: Tool::Select,
            state: State::default(),
            pointer: None,
            sheet: None,
            pressed: None,
            told: None,
            was_typed_into: false,
            wants_fit: false,
            fitted: None,
        }
    }
}

impl PatternView {
    /// The focus of the canvas: keys typed there go to the tool.
    pub fn id() -> Id {
        Id::unique("pattern canvas")
    }

    /// Lays out a pattern that was just opened, and shows all of it.
    pub fn opened(&mut self, pattern: &Pattern) {
        self.boards.open(pattern, &self.scene);
        self.selection = Selection::default();
        self.isolated.clear();
        self.sheet = pattern.sheets.first().map(|sheet| sheet.id);
        self.take(Tool::Select);
        // On an empty table there is nothing to fit: it is seen as at first.
        match self.boards.bounds(&self.scene) {
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
        self.state = tool.begin();
        self.pressed = None;
        // A pointer that rests on the canvas is told to the new tool.
        self.told = None;
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

    /// Shows everything as large as it is, on a screen of so many pixels a metre.
    pub fn true_size(&mut self, scale: f64) {
        self.fitted = None;
        self.camera.scale = scale;
    }

    /// Follows a change of the pattern or of the enlargement; `previews` while it is a gesture's.
    pub fn follow(&mut self, evaluation: &Evaluation, draft: &Draft, previews: bool) {
        let pattern = evaluation.pattern();
        self.scene.update(evaluation, draft, self.camera.octave());
        self.isolated.retain(|id| pattern.panel(*id).is_some());
        if !self.isolated.is_empty() {
            self.scene.isolate(&self.isolated);
        }
        if !previews {
            self.base = self.scene.clone();
        }
        self.boards.follow(pattern);
        self.selection.follow(pattern);
        if self.sheet.is_none_or(|id| pattern.sheet(id).is_none()) {
            self.sheet = pattern.sheets.first().map(|sheet| sheet.id);
        }
    }

    /// Selects parts, and draws on the sheet they are on from now on.
    pub fn select(&mut self, selection: Selection) {
        let open = open_sheets(&self.scene, &selection);
        if let [.., last] = open[..] {
            self.sheet = Some(last);
        }
        self.selection = selection;
    }

    /// Whether a gesture of the tool is under way.
    pub fn is_busy(&self) -> bool {
        self.tool.is_under_way(&self.state)
    }

    /// Gives an event to the tool in hand.
    pub fn step(&mut self, event: &Event, evaluation: &Evaluation) -> Outcome {
        let open = open_sheets(&self.scene, &self.selection);
        let (scene, boards) = (&self.base, &self.boards);
        let inside = |corners| inside_box((scene, boards), &open, corners);
        let reading = Reading {
            evaluation,
            scene,
            selection: &self.selection,
            inside: &inside,
        };
        let (state, outcome) = self.tool.step(&self.state, event, &reading);
        self.state = state;
        outcome
    }

    /// What a click does now.
    pub fn hint(&self, evaluation: &Evaluation) -> String {
        let inside = |_| Vec::new();
        let reading = Reading {
            evaluation,
            scene: &self.scene,
            selection: &self.selection,
            inside: &inside,
        };
        self.tool.hint(&self.state, &reading)
    }

    /// What the tool in hand draws over the pattern.
    pub fn overlay(&self, evaluation: &Evaluation) -> Vec<Overlay> {
        let inside = |_| Vec::new();
        let reading = Reading {
            evaluation,
            scene: &self.scene,
            selection: &self.selection,
            inside: &inside,
        };
        self.tool.overlay(&self.state, &reading)
    }

    /// Draws the view, and tells what came of what is done in it. The evaluation is that before the
    /// gesture that is shown.
    pub fn show(&mut self, ui: &mut Ui, evaluation: &Evaluation) -> Vec<Outcome> {
        let view = ui.available_rect_before_wrap();
        let response = ui.interact(view, Self::id(), Sense::click_and_drag());
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
            && let Some(bounds) = self.boards.bounds(&self.scene)
        {
            self.camera.fit(view, &bounds);
            self.wants_fit = false;
            self.fitted = Some(view.size());
        }
        let mut outcomes = Vec::new();
        if std::mem::take(&mut self.click_is_taken) {
            self.click_is_taken = ui.input(|input| input.pointer.primary_down());
            self.paint(ui, view, evaluation);
            return outcomes;
        }
        for event in self.events(ui, &response, panning) {
            outcomes.push(self.step(&event, evaluation));
        }
        self.cursor(ui, panning, response.hovered());
        self.paint(ui, view, evaluation);
        if let Some(item) = self.name_parts(ui, view, evaluation.pattern()) {
            outcomes.push(Outcome {
                select: Some(Selection::one(item)),
                ..Outcome::default()
            });
        }
        outcomes
    }

    /// Panning and zooming; says whether the primary button pans too.
    fn navigate(&mut self, ui: &Ui, response: &Response) -> bool {
        let with_space = response.contains_pointer()
            && !self.is_typed_into(ui)
            && ui.input(|input| input.key_down(Key::Space));
        for button in [PointerButton::Middle, PointerButton::Secondary] {
            if response.dragged_by(button) {
                self.camera.pan(response.drag_delta());
            }
        }
        if with_space && response.dragged_by(PointerButton::Primary) && self.pressed.is_none() {
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

    /// Whether keys go to another widget.
    fn is_typed_into(&self, ui: &Ui) -> bool {
        let focused = ui.memory(|memory| memory.focused());
        focused.is_some_and(|id| id != Self::id())
    }

    /// What was done since the last frame.
    fn events(&mut self, ui: &Ui, response: &Response, panning: bool) -> Vec<Event> {
        let mut events = Vec::new();
        let held = ui.input(|input| Held {
            shift: input.modifiers.shift,
            command: input.modifiers.command,
        });
        let view = response.rect;
        let hovered = response.hover_pos().filter(|_| !panning);
        let was_there = self.pointer.is_some();
        if response.drag_started_by(PointerButton::Primary)
            && !panning
            && let Some(from) = ui.input(|input| input.pointer.press_origin())
        {
            self.pressed = Some(self.pointer_at(view, from, held));
        }
        if response.clicked() || response.drag_started() {
            response.request_focus();
        }
        match (&self.pressed, response.interact_pointer_pos()) {
            (Some(from), Some(to)) => {
                let from = from.clone();
                let place = to;
                let to = self.pointer_at(view, to, held);
                self.pointer = Some(to.at);
                if self.told.replace((place, held)) != Some((place, held)) {
                    events.push(Event::Drag(from, to));
                }
            }
            _ => match hovered {
                Some(at) => {
                    let pointer = self.pointer_at(view, at, held);
                    self.hover = pointer.hit();
                    self.under = pointer.hits.iter().map(|hit| hit.item).collect();
                    self.pointer = Some(pointer.at);
                    if self.told.replace((at, held)) != Some((at, held)) {
                        events.push(Event::Hover(pointer));
                    }
                }
                None => {
                    self.hover = None;
                    self.under.clear();
                    self.pointer = None;
                    self.told = None;
                    if was_there {
                        events.push(Event::Leave);
                    }
                }
            },
        }
        if let Some(at) = response.interact_pointer_pos()
            && !panning
            && response.clicked()
        {
            let pointer = self.pointer_at(view, at, held);
            events.push(match response.double_clicked() {
                true => Event::DoubleClick(pointer),
                false => Event::Click(pointer),
            });
        }
        // Escape ends the drag too: what it showed is left, not taken.
        if self.pressed.is_some() && ui.input(|input| input.key_pressed(Key::Escape)) {
            self.pressed = None;
        }
        if self.pressed.is_some()
            && (response.drag_stopped() || !ui.input(|input| input.pointer.primary_down()))
        {
            self.pressed = None;
            events.push(Event::Drop);
        }
        if response.secondary_clicked() && self.is_busy() {
            events.push(Event::Enter);
        }
        events.extend(self.keys(ui, response));
        events
    }

    fn keys(&mut self, ui: &Ui, response: &Response) -> Vec<Event> {
        // A key that ends the typing into a field is no key of the tool.
        let typed_now = self.is_typed_into(ui);
        let typed_before = std::mem::replace(&mut self.was_typed_into, typed_now);
        if typed_before {
            return Vec::new();
        }
        if self.is_covered || self.is_typed_into(ui) {
            return Vec::new();
        }
        let takes_tab = matches!(self.tool, Tool::Slots(_));
        if takes_tab {
            response.request_focus();
        }
        // Keys of the canvas must not move the focus of the window.
        let filter = EventFilter {
            tab: takes_tab,
            escape: true,
            horizontal_arrows: true,
            vertical_arrows: true,
        };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(Self::id(), filter));
        let typing = self.is_typing();
        let mut events = Vec::new();
        ui.input_mut(|input| {
            input.events.retain(|event| {
                let taken = match event {
                    egui::Event::Text(text) => {
                        let begins = text.starts_with(begins_typing);
                        let is_slots = matches!(self.tool, Tool::Slots(_));
                        let takes = is_slots && (typing || begins);
                        takes.then(|| Event::Text(text.clone()))
                    }
                    egui::Event::Key {
                        key, pressed: true, ..
                    } => match key {
                        Key::Enter => Some(Event::Enter),
                        Key::Tab => Some(Event::Tab),
                        Key::Backspace if typing => Some(Event::Backspace),
                        Key::Escape => Some(Event::Escape),
                        _ => None,
                    },
                    _ => None,
                };
                let is_taken = taken.is_some();
                events.extend(taken);
                !is_taken
            });
        });
        events
    }

    /// Whether a number of the tool in hand is being typed.
    pub fn is_typing(&self) -> bool {
        matches!(&self.state, State::Slots(state) if state.is_typing())
    }

    fn pointer_at(&self, view: Rect, at: Pos2, held: Held) -> Pointer {
        self.pointer(self.camera.table(view, ScreenPoint(at)).0, held)
    }

    /// What a pointer at a place of the table [m] finds there.
    pub fn pointer(&self, table: Vec2, held: Held) -> Pointer {
        let open = open_sheets(&self.scene, &self.selection);
        let found = hits((&self.base, &self.boards), &open, table, self.camera.scale);
        let begun = match &self.state {
            State::Slots(state) => state.sheet(),
            State::Select(_) => None,
        };
        let sheet = begun
            .or(found.first().map(|hit| hit.sheet))
            .or(self.sheet)
            .unwrap_or(SheetId(0));
        let at = table - self.boards.sheet(sheet);
        Pointer {
            table,
            sheet,
            at,
            snaps: snaps(&self.base, sheet, at, self.camera.scale),
            hits: found,
            pixel: 1.0 / self.camera.scale,
            held,
        }
    }

    fn cursor(&self, ui: &Ui, panning: bool, inside: bool) {
        if !inside {
            return;
        }
        let icon = match (self.tool, self.hover.map(|hit| hit.item)) {
            _ if panning => CursorIcon::Grab,
            (Tool::Slots(_), _) => CursorIcon::Crosshair,
            (_, Some(Item::Point(_) | Item::Panel(_))) => CursorIcon::Move,
            (_, Some(_)) => CursorIcon::PointingHand,
            (_, None) => CursorIcon::Default,
        };
        ui.ctx().set_cursor_icon(icon);
    }

    fn paint(&self, ui: &Ui, view: Rect, evaluation: &Evaluation) {
        let open = open_sheets(&self.scene, &self.selection);
        let overlay = self.overlay(evaluation);
        let hover = match self.tool {
            Tool::Select => self.hover.map(|hit| hit.item),
            Tool::Slots(_) => None,
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
        let picture = Picture {
            painter: ui.painter_at(view),
            view,
            camera: self.camera,
            boards: &self.boards,
            scene: &self.scene,
            selection: &self.selection,
            hover,
            allowances: self.allowances,
            rulers: self
                .rulers
                .then(|| (self.sheet_origin(), evaluation.pattern().unit)),
            grading: self.grading.as_ref(),
            fresh: &fresh,
            open: &open,
            palette: Palette::of(ui.ctx()),
        };
        picture.paint(&overlay);
    }

    /// The table place of the origin of the sheet that is drawn on [m].
    pub fn sheet_origin(&self) -> Vec2 {
        self.sheet
            .map_or_else(Vec2::zeros, |sheet| self.boards.sheet(sheet))
    }

    /// Where a place of a sheet is seen.
    pub fn screen(&self, view: Rect, origin: Vec2, at: Vec2) -> Pos2 {
        let table = crate::canvas::camera::TablePoint(at + origin);
        self.camera.screen(view, table).0
    }

    /// Points, edges, notches, darts, curves and panels that are shown, and where on the table [m].
    /// A point that is seen twice is there twice.
    pub fn parts(&self) -> Vec<(SheetId, Item, Vec2)> {
        let open = open_sheets(&self.scene, &self.selection);
        let mut parts = Vec::new();
        for panel in &self.scene.panels {
            let origin = self.boards.panel(panel.id);
            let mut part = |item, at: Vec2| parts.push((panel.sheet, item, origin + at));
            part(Item::Panel(panel.id), panel.shape.middle);
            for edge in &panel.shape.edges {
                if let Some(middle) = edge.middle() {
                    part(Item::Edge(panel.id, edge.id), middle);
                }
            }
            for (id, at, _) in &panel.shape.notches {
                part(Item::Notch(panel.id, *id), *at);
            }
            for (id, mirrored, line) in &panel.shape.darts {
                if let Some(at) = line.first().filter(|_| !mirrored) {
                    part(Item::Operation(panel.id, *id), *at);
                }
            }
        }
        for sheet in &self.scene.sheets {
            let origin = self.boards.sheet(sheet.id);
            for curve in sheet.curves.iter().filter(|curve| !curve.is_traced) {
                if let Some((middle, _)) = crate::canvas::along(&curve.line, 0.5) {
                    parts.push((sheet.id, Item::Curve(curve.id), origin + middle));
                }
            }
        }
        for shown in shown_points(&self.scene, &self.boards, &open) {
            let at = shown.origin + shown.point.at;
            parts.push((shown.sheet, Item::Point(shown.point.id), at));
        }
        parts
    }

    /// Names points, edges and panels for assistive technology, and tells which was chosen there.
    /// Their nodes take no clicks: those go to the view under them, by place, as everyone's do.
    fn name_parts(&self, ui: &Ui, view: Rect, pattern: &Pattern) -> Option<Item> {
        let open = open_sheets(&self.scene, &self.selection);
        let mut parts = self.parts();
        if parts.len() > MOST_NAMED {
            parts.retain(|(sheet, ..)| open.contains(sheet));
        }
        let mut asked = None;
        let mut named = std::collections::BTreeSet::new();
        for (_, item, at) in parts {
            let at = self.screen(view, Vec2::zeros(), at);
            // A point that is seen twice is named once.
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
