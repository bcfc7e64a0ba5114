//! Performs commands of the window, and applies the outcomes of tools.

use super::ToileApp;
use super::notice::Notice;
use crate::canvas::grading::Grading;
use crate::canvas::selection::{Item, Selection};
use crate::tools::select::move_sheets;
use crate::tools::{Event, Outcome, PreviewChange, Tool};
use egui::{Key, Modifiers};
use toile_geometry::Vec2;
use toile_pattern::{Edit, EditError, Evaluation, Name, PartId, PartReference, SheetId, plan};
use toile_session::{Command, Project};

/// Largest distance between an outline and the polyline drawn for it, when all sizes are shown (m).
const GRADING_TOLERANCE: f64 = 1e-4;
/// Distance by which an arrow key moves points, alone and with Shift (m).
const NUDGES: [f64; 2] = [0.001, 0.01];

impl ToileApp {
    /// Whether a pattern is open, even an empty one.
    pub(crate) fn is_open(&self) -> bool {
        !self.session.project().pattern.sheets.is_empty()
    }

    pub(crate) fn has_panels(&self) -> bool {
        !self.session.project().pattern.panels.is_empty()
    }

    pub(crate) fn has_selection(&self) -> bool {
        !self.view.selection.is_empty()
    }

    pub(crate) fn has_edge(&self) -> bool {
        matches!(self.view.selection.single(), Some(Item::Edge(..)))
    }

    pub(crate) fn undo(&mut self) {
        self.leave_gesture();
        self.execute(Command::Undo);
    }

    pub(crate) fn redo(&mut self) {
        self.leave_gesture();
        self.execute(Command::Redo);
    }

    /// Takes a tool in hand; cancels the gesture of the previous one.
    pub(crate) fn take(&mut self, tool: Tool) {
        self.notice = Notice::default();
        self.leave_gesture();
        self.view.take(tool);
        let draws = matches!(tool, Tool::Slots(_));
        self.selected_before = draws.then(|| self.view.selection.clone());
    }

    /// Cancels the preview of a tool.
    fn leave_gesture(&mut self) {
        if self.session.cancel().is_some() {
            self.refresh();
        }
        self.view.take(self.view.tool);
    }

    pub(crate) fn deselect(&mut self) {
        self.stop_printing();
        if self.lays_loop() {
            return self.leave_loop();
        }
        self.notice = Notice::default();
        let shows_some = !self.view.isolated.is_empty();
        match self.view.tool {
            Tool::Select if shows_some && !self.has_selection() => self.isolate(),
            Tool::Select => self.give(&Event::Escape),
            Tool::Slots(_) | Tool::Walk | Tool::Suggested => self.take(Tool::Select),
        }
    }

    pub(crate) fn select_all(&mut self) {
        let pattern = self.session.project().pattern.clone();
        let panels = pattern.panels.iter().map(|panel| Item::Panel(panel.id));
        let points = pattern.sheets.iter().flat_map(|sheet| &sheet.points);
        let selection: Selection = match pattern.panels.is_empty() {
            false => panels.collect(),
            true => points.map(|point| Item::Point(point.id)).collect(),
        };
        self.view.select(selection);
    }

    /// Applies the outcome of an event in a tool.
    pub(crate) fn follow_outcome(&mut self, outcome: Outcome) {
        if outcome.gets_on {
            self.forget_fault();
        }
        match outcome.shown {
            PreviewChange::Same => {}
            PreviewChange::Nothing => {
                if self.session.cancel().is_some() {
                    self.refresh();
                }
            }
            PreviewChange::Edits(edits) => self.preview(&edits),
        }
        match outcome.commit {
            // The tool only reports a message.
            Some((edits, words)) if edits.is_empty() => self.notice = Notice::news(words),
            Some((edits, label)) => {
                self.edit(Ok(edits), &label);
            }
            None => {}
        }
        if let Some(label) = outcome.commit_shown {
            self.commit(&label);
        }
        if let Some(selection) = outcome.select {
            if !self.notice.is_news() {
                self.notice = Notice::default();
            }
            self.view.select(selection);
        }
        if let Some(words) = outcome.refusal {
            self.notice = Notice::fault(words);
        }
        if outcome.done {
            self.take(Tool::Select);
        }
    }

    /// Offers the length of the part under the pointer to the number that is being typed.
    pub(crate) fn offer_length(&mut self) {
        if self.typed.takes_parts() {
            let mut under = self.view.under.iter();
            let words = under.find_map(|item| self.length_words(*item));
            self.typed.offer(words);
        }
    }

    /// Length of a part, written as in a formula.
    fn length_words(&self, item: Item) -> Option<String> {
        let part = match item {
            Item::Edge(panel, edge) => {
                let owner = self.base.pattern().owner_of(panel, edge.into())?;
                let ends = owner.edge(edge)?.ends;
                PartReference::Stretch {
                    panel: owner.id,
                    ends: ends.map(Name::Drawn),
                }
            }
            Item::Curve(curve) => PartReference::Curve(curve),
            _ => return None,
        };
        Some(format!("length({})", self.base.names().print_part(&part)))
    }

    /// Reports why something failed.
    pub(crate) fn say_fault(&mut self, words: String) {
        self.notice = Notice::fault(words);
    }

    /// Previews edits until they are committed or cancelled.
    pub(crate) fn preview(&mut self, edits: &[Edit]) {
        match self.session.preview(edits) {
            Ok(()) => self.refresh(),
            Err(error) => self.notice = Notice::fault(error.to_string()),
        }
    }

    /// Makes the previewed edits as one step of the history.
    pub(crate) fn commit(&mut self, label: &str) {
        match self.session.commit(label) {
            Ok(events) => {
                self.forget_fault();
                self.handle_events(&events);
            }
            Err(error) => self.notice = Notice::fault(error.to_string()),
        }
    }

    /// Makes the edits of a planner as one step of the history; returns whether it succeeded.
    pub(crate) fn edit(&mut self, edits: Result<Vec<Edit>, EditError>, label: &str) -> bool {
        match edits {
            Ok(edits) => self.execute(Command::Edit {
                edits,
                label: label.to_owned(),
            }),
            Err(error) => {
                self.notice = Notice::fault(error.to_string());
                false
            }
        }
    }

    /// Divides the selected edge in its middle, and selects the new corner.
    pub(crate) fn divide_edge(&mut self) {
        let Some(Item::Edge(panel, edge)) = self.view.selection.single() else {
            return;
        };
        let planned = plan::divide_edge(&self.base, (panel, edge), None);
        let corner = planned.as_ref().ok().map(|(_, corner)| *corner);
        let done = self.edit(planned.map(|(edits, _)| edits), "Add point");
        if let Some(corner) = corner.filter(|_| done) {
            self.view.select(Selection::one(Item::Point(corner)));
        }
    }

    /// Removes the selected parts.
    pub(crate) fn delete(&mut self) {
        let items = self.view.selection.items().to_vec();
        let mut parts: Vec<PartId> = items.iter().map(|item| item.part()).collect();
        // Panels are removed together with the sheet they are traced from.
        let sheets = self.view.selection.sheets();
        let panels = self.base.pattern().panels.iter();
        let traced = panels.filter(|panel| panel.sheet().is_some_and(|id| sheets.contains(&id)));
        let traced = traced.map(|panel| panel.id.into());
        let traced: Vec<PartId> = traced.filter(|part| !parts.contains(part)).collect();
        parts.extend(traced);
        let label = match (items.len(), items.first()) {
            (1, Some(Item::Point(_))) => "Delete point",
            (1, Some(Item::Panel(_))) => "Delete panel",
            (1, Some(Item::Sheet(_))) => "Delete sheet",
            (1, Some(Item::Guide(_))) => "Remove guide",
            _ => "Delete",
        };
        self.edit(plan::remove_parts(&self.base, &parts), label);
    }

    /// The edits that replace a panel by a copy that `change` has altered.
    pub(crate) fn changed_panel(
        &self,
        id: toile_pattern::PanelId,
        change: impl FnOnce(&mut toile_pattern::Panel),
    ) -> Result<Vec<Edit>, EditError> {
        let found = self.base.pattern().panel(id);
        let panel = found.ok_or_else(|| EditError::Missing(id.to_string()))?;
        let mut panel = (**panel).clone();
        change(&mut panel);
        let put = toile_pattern::Entity::Panel(std::sync::Arc::new(panel));
        Ok(vec![Edit::Put(put)])
    }

    pub(crate) fn drape(&mut self) {
        self.notice = Notice::default();
        self.panes.garment = true;
        self.background_work.start_garment(&self.session);
    }

    pub(crate) fn can_isolate(&self) -> bool {
        !self.view.isolated.is_empty()
            || self
                .view
                .selection
                .items()
                .iter()
                .any(|i| i.panel().is_some())
    }

    /// Isolates the selected panels, or shows everything again.
    pub(crate) fn isolate(&mut self) {
        let items = self.view.selection.items().iter();
        let panels = items.filter_map(|item| item.panel()).collect();
        self.view.isolated = match self.view.isolated.is_empty() {
            true => panels,
            false => Vec::new(),
        };
        self.revision = None;
        self.refresh();
        self.view.fit();
    }

    pub(crate) fn has_sizes(&self) -> bool {
        self.session.project().pattern.sizes.len() > 1
    }

    /// Shows or hides the outlines of all sizes on top of each other.
    pub(crate) fn toggle_grading(&mut self) {
        self.view.grading = match self.view.grading {
            Some(_) => None,
            None => Some(self.graded()),
        };
        // Zooms so that the outlines of all sizes are in view.
        if self.view.grading.is_some() {
            self.view.fit();
        }
    }

    /// The outlines of all sizes of the pattern as it is.
    pub(crate) fn graded(&self) -> Grading {
        let project = self.session.project();
        Grading::new(&self.base, GRADING_TOLERANCE, |size| {
            let sized = Project {
                size: Some(size.to_owned()),
                ..project.clone()
            };
            Evaluation::new(&project.pattern, sized.drafted_to())
        })
    }

    /// Moves the tables from below the pattern to beside it, or back.
    pub(crate) fn toggle_tables_side(&mut self) {
        self.panes.tables_beside = Some(!self.tables_are_beside);
    }

    pub(crate) fn change_theme(&mut self) {
        self.wants_theme = true;
    }

    /// Enlarges or reduces the interface by a share of its usual size; `None` restores the usual size.
    pub(crate) fn change_scale(&mut self, step: Option<f32>) {
        self.wants_scale = Some(step);
    }

    /// Moves the selected points, sheets or guide by the arrow keys.
    pub(crate) fn nudge(&mut self, context: &egui::Context) {
        // While a seam is walked the arrow keys move along it.
        if matches!(self.view.tool, Tool::Walk) {
            return;
        }
        let items = self.view.selection.items().iter();
        let parts: Vec<PartId> = items.map(|item| item.part()).collect();
        let points = plan::points_of(&self.base, &parts);
        let sheets = parts.iter().filter_map(|part| match part {
            PartId::Sheet(id) => Some(*id),
            _ => None,
        });
        let sheets: Vec<SheetId> = sheets.collect();
        let moves_sheets = !sheets.is_empty() && sheets.len() == parts.len();
        let guide = match self.view.selection.single() {
            Some(Item::Guide(id)) => Some(id),
            _ => None,
        };
        let moves_nothing = points.is_empty() && !moves_sheets && guide.is_none();
        if moves_nothing || self.view.is_typing() || self.types(context) {
            return;
        }
        let way = context.input_mut(|input| {
            let mut way = Vec2::zeros();
            for (key, x, y) in [
                (Key::ArrowLeft, -1.0, 0.0),
                (Key::ArrowRight, 1.0, 0.0),
                (Key::ArrowUp, 0.0, 1.0),
                (Key::ArrowDown, 0.0, -1.0),
            ] {
                for (modifiers, step) in
                    [(Modifiers::SHIFT, NUDGES[1]), (Modifiers::NONE, NUDGES[0])]
                {
                    if input.consume_key(modifiers, key) {
                        way += Vec2::new(x, y) * step;
                    }
                }
            }
            way
        });
        if way == Vec2::zeros() {
            return;
        }
        if let Some(guide) = guide {
            self.nudge_guide(guide, way);
            return;
        }
        if moves_sheets {
            let moved = move_sheets(&self.base, &self.view.table_layout, &sheets, way);
            self.edit(moved, "Move sheet");
            return;
        }
        let map = plan::Affine::translation(way);
        let moved = plan::transform_points(&self.base, &points, &map);
        let label = if points.len() == 1 {
            "Move point"
        } else {
            "Move points"
        };
        self.edit(moved.map(|moved| moved.edits), label);
    }
}
