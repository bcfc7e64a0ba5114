//! Guides in the pattern view: dragged out of the rulers, moved, and dropped back on them.

use super::PatternView;
use crate::canvas::camera::ScreenPoint;
use crate::canvas::drawn_guide::{DrawnGuide, GuideLabel};
use crate::canvas::guides::guide_at;
use crate::canvas::hit::Hit;
use crate::canvas::placed::{Spec, grid_step, rounded};
use crate::canvas::rulers::RULER;
use crate::canvas::selection::{Item, Selection};
use crate::theme::GRAB;
use crate::tools::{Outcome, Tool, ToolModifiers, number};
use egui::{CursorIcon, Key, Modifiers, PointerButton, Pos2, Rect, Response, Role, Sense, Ui};
use egui::{WidgetInfo, pos2};
use toile_geometry::Vec2;
use toile_pattern::{
    Edit, EditError, Evaluation, Guide, GuideId, GuideRun, Number, PointRule, SheetId, Want, plan,
};

/// State of a guide that is being dragged.
#[derive(Clone, Debug)]
pub(super) struct GuideDrag {
    /// Identity of the guide; `None` for a new one.
    id: Option<GuideId>,
    runs: GuideRun,
    /// Position of the pointer.
    pointer: Pos2,
    /// Coordinate of the guide on the table (m), and a description of the part it snaps to; `None` over the
    /// ruler.
    place: Option<(f64, String)>,
}

impl PatternView {
    /// Visible guides.
    fn seen_guides(&self) -> impl Iterator<Item = &Guide> {
        let guides = self.base.guides.iter().filter(|_| self.guides);
        guides.map(|guide| &**guide)
    }

    /// Visible guides in the coordinates of a sheet.
    pub(super) fn guides_on(&self, sheet: SheetId) -> Vec<Guide> {
        crate::canvas::guides::on_sheet(self.seen_guides(), self.table_layout.sheet(sheet))
    }

    /// Inserts the guide at a place of the table (m) into the parts found there, after points and lines and
    /// before panels. Does nothing while a drawing tool is in hand.
    pub(super) fn add_guide_hit(&self, found: &mut Vec<Hit>, table: Vec2) {
        if !matches!(self.tool, Tool::Select) {
            return;
        }
        let Some((guide, away)) = guide_at(self.seen_guides(), table, self.camera.scale) else {
            return;
        };
        let sheet = found.first().map(|hit| hit.sheet).or(self.sheet);
        let sheet = sheet.unwrap_or(SheetId(0));
        let origin = self.table_layout.sheet(sheet);
        let hit = Hit {
            item: Item::Guide(guide.id),
            sheet,
            at: crate::canvas::guides::nearest(guide, table) - origin,
            origin,
            away,
        };
        let is_panel = |hit: &Hit| matches!(hit.item, Item::Panel(_));
        let behind = found.iter().position(is_panel).unwrap_or(found.len());
        found.insert(behind, hit);
    }

    /// Visible guides, each with its point nearest to the middle of the view.
    pub(super) fn guide_parts(&self) -> Vec<(SheetId, Item, Vec2)> {
        let sheet = self.sheet.unwrap_or(SheetId(0));
        let parts = self.seen_guides().map(|guide| {
            let at = crate::canvas::guides::nearest(guide, self.camera.centre);
            (sheet, Item::Guide(guide.id), at)
        });
        parts.collect()
    }

    /// The mouse cursor over a guide.
    pub(super) fn guide_cursor(&self, id: GuideId) -> CursorIcon {
        let guide = self.seen_guides().find(|guide| guide.id == id);
        guide.map_or(CursorIcon::Default, |guide| cursor(guide.runs))
    }

    /// Hint on the effect of dropping the dragged guide.
    pub(super) fn guide_hint(&self) -> Option<String> {
        self.guide.as_ref().map(|_| {
            "Drop it back on the ruler to remove it; Ctrl lets it lie anywhere; Esc leaves it"
                .into()
        })
    }

    /// Handles a drag of a guide out of a ruler or to another place; returns the outcome. `canvas` is the
    /// response of the rest of the view.
    pub(super) fn drag_guide(
        &mut self,
        ui: &Ui,
        (view, canvas): (Rect, &Response),
        panning: bool,
        evaluation: &Evaluation,
    ) -> Option<Outcome> {
        for runs in [GuideRun::Horizontal, GuideRun::Vertical] {
            self.begin_at_ruler(ui, view, runs);
        }
        if canvas.drag_started_by(PointerButton::Primary)
            && !panning
            && let Some(from) = ui.input(|input| input.pointer.press_origin())
        {
            self.begin_at_guide(view, from);
        }
        if self.guide.is_some() {
            // The Delete key applies to the guide from then on.
            canvas.request_focus();
        }
        if canvas.double_clicked()
            && let Some(at) = canvas.interact_pointer_pos()
            && self.guide_under(view, at).is_some()
        {
            self.asks_guide_place = true;
        }
        let drag = self.guide.clone()?;
        ui.ctx().set_cursor_icon(cursor(drag.runs));
        let (at, modifiers, is_down, is_left) = ui.input_mut(|input| {
            let modifiers = ToolModifiers {
                shift: false,
                command: input.modifiers.command,
            };
            let is_left = input.consume_key(Modifiers::NONE, Key::Escape);
            let at = input.pointer.interact_pos();
            (at, modifiers, input.pointer.primary_down(), is_left)
        });
        if is_left {
            self.guide = None;
            return None;
        }
        let pointer = at.unwrap_or(drag.pointer);
        let place = self.guide_place(view, (pointer, drag.runs), modifiers);
        let drag = GuideDrag {
            pointer,
            place,
            ..drag
        };
        self.hover = None;
        self.under.clear();
        self.told = None;
        let table = self.camera.table(view, ScreenPoint(pointer)).0;
        self.pointer = self
            .sheet
            .map(|sheet| (sheet, table - self.table_layout.sheet(sheet)));
        if is_down {
            self.guide = Some(drag);
            return None;
        }
        self.guide = None;
        Some(self.dropped(&drag, evaluation))
    }

    /// Handles the strip of a ruler: a drag that begins there drags a new guide.
    fn begin_at_ruler(&mut self, ui: &Ui, view: Rect, runs: GuideRun) {
        if !self.rulers {
            return;
        }
        let inner = view.shrink(GRAB);
        // The corner where both rulers meet is left out.
        let (strip, name) = match runs {
            GuideRun::Horizontal => (
                Rect::from_min_max(
                    pos2(view.left() + RULER, inner.top()),
                    pos2(inner.right(), view.top() + RULER),
                ),
                "Top ruler",
            ),
            GuideRun::Vertical => (
                Rect::from_min_max(
                    pos2(inner.left(), view.top() + RULER),
                    pos2(view.left() + RULER, inner.bottom()),
                ),
                "Left ruler",
            ),
        };
        if !strip.is_positive() {
            return;
        }
        let response = ui.interact(strip, Self::id().with(name), Sense::drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Splitter, true, name));
        let response = response.on_hover_cursor(cursor(runs));
        if response.drag_started_by(PointerButton::Primary)
            && let Some(pointer) = response.interact_pointer_pos()
        {
            self.guide = Some(GuideDrag {
                id: None,
                runs,
                pointer,
                place: None,
            });
        }
    }

    /// Starts to drag a guide if the drag begins on one, at a place where no other part comes first.
    fn begin_at_guide(&mut self, view: Rect, from: Pos2) {
        if let Some(guide) = self.guide_under(view, from) {
            self.guide = Some(GuideDrag {
                id: Some(guide.id),
                runs: guide.runs,
                pointer: from,
                place: Some((guide.at, String::new())),
            });
        }
    }

    /// The guide that a click at a place selects.
    fn guide_under(&self, view: Rect, at: Pos2) -> Option<Guide> {
        match self
            .pointer_at(view, at, ToolModifiers::default())
            .hit()?
            .item
        {
            Item::Guide(id) => self.seen_guides().find(|guide| guide.id == id).copied(),
            _ => None,
        }
    }

    /// Coordinate of a dragged guide on the table (m), and a description of the part it snaps to: a point,
    /// an intersection or the middle of a curve near the pointer, else the grid. `None` over the guide's
    /// ruler.
    fn guide_place(
        &self,
        view: Rect,
        (at, runs): (Pos2, GuideRun),
        modifiers: ToolModifiers,
    ) -> Option<(f64, String)> {
        let is_back = match runs {
            GuideRun::Horizontal => at.y < view.top() + RULER,
            GuideRun::Vertical => at.x < view.left() + RULER,
        };
        if is_back && self.rulers {
            return None;
        }
        let axis = runs.axis();
        let table = self.camera.table(view, ScreenPoint(at)).0;
        if modifiers.command {
            return Some((table[axis], String::new()));
        }
        let pointer = self.pointer(table, modifiers);
        let point = pointer.hits.iter().find_map(|hit| match hit.item {
            Item::Point(id) => Some((hit.origin + hit.at, self.base.point(id)?.1.name.clone())),
            _ => None,
        });
        let placed = || {
            let mut placed = pointer
                .snaps
                .iter()
                .filter(|placed| is_a_place(&placed.spec));
            let first = placed.next()?;
            let at = self.table_layout.sheet(first.sheet) + first.at;
            Some((at, first.words.clone()))
        };
        if let Some((place, words)) = point.or_else(placed) {
            return Some((place[axis], words));
        }
        let origin = self.sheet_origin()[axis];
        let step = grid_step(self.camera.scale);
        Some((origin + rounded(table[axis] - origin, step), String::new()))
    }

    /// Outcome of dropping a dragged guide.
    fn dropped(&mut self, drag: &GuideDrag, evaluation: &Evaluation) -> Outcome {
        let place = drag.place.as_ref().map(|(at, _)| *at);
        let old = drag.id.and_then(|id| evaluation.pattern().guide(id));
        let planned = match (drag.id, place) {
            (None, None) => return Outcome::default(),
            (Some(id), None) => Ok((vec![Edit::Remove(id.into())], "Remove guide", id)),
            (Some(_), Some(at)) if old.is_some_and(|old| old.at == at) => {
                return Outcome::default();
            }
            (Some(id), Some(at)) => {
                let moved = plan::move_guide(evaluation, id, at);
                moved.map(|edits| (edits, "Move guide", id))
            }
            (None, Some(at)) => {
                // Guides become visible when one is dragged out of a ruler.
                self.guides = true;
                let added = plan::add_guide(evaluation, drag.runs, at);
                added.map(|(edits, id)| (edits, "Add guide", id))
            }
        };
        let planned = planned.and_then(|(edits, label, id)| {
            let kept = match place {
                Some(_) => self.kept_places(evaluation)?,
                None => Vec::new(),
            };
            Ok((kept.into_iter().chain(edits).collect(), label, id))
        });
        match planned {
            Ok((edits, label, id)) => Outcome {
                commit: Some((edits, label.into())),
                // With a tool in hand the selection is kept.
                select: (place.is_some() && matches!(self.tool, Tool::Select))
                    .then(|| Selection::one(Item::Guide(id))),
                ..Outcome::default()
            },
            Err(error) => Outcome {
                refusal: Some(error.to_string()),
                ..Outcome::default()
            },
        }
    }

    /// The edits that store the displayed positions of sheets in the document. Guides are placed in
    /// relation to these, so that they must be the same when the document is opened again.
    fn kept_places(&self, evaluation: &Evaluation) -> Result<Vec<Edit>, EditError> {
        let apart = self.table_layout.laid_apart(evaluation.pattern());
        plan::move_sheets(evaluation, &apart)
    }

    /// Guides as drawn, with the dragged one at the place where it would be dropped.
    pub(super) fn drawn_guides(&self) -> Vec<DrawnGuide> {
        let held = self.guide.as_ref();
        let is_held = |guide: &&Guide| held.is_some_and(|drag| drag.id == Some(guide.id));
        let at_rest = self.seen_guides().filter(|guide| !is_held(guide));
        let mut drawn: Vec<DrawnGuide> = at_rest
            .map(|guide| DrawnGuide {
                id: Some(guide.id),
                runs: guide.runs,
                at: guide.at,
            })
            .collect();
        if let Some((runs, at)) = held.and_then(|drag| Some((drag.runs, drag.place.as_ref()?.0))) {
            drawn.push(DrawnGuide { id: None, runs, at });
        }
        drawn
    }

    /// Label of the dragged guide: its position as counted on the rulers, and the part it snaps to.
    pub(super) fn guide_label(&self, evaluation: &Evaluation) -> Option<GuideLabel> {
        let drag = self.guide.as_ref()?;
        let words = match &drag.place {
            None if drag.id.is_some() => "let go to remove the guide".to_owned(),
            None => return None,
            Some((at, words)) => {
                let axis = drag.runs.axis();
                let at = at - self.sheet_origin()[axis];
                let unit = evaluation.pattern().unit;
                let place = number::show(at, Want::Length, unit);
                let told = format!("{} {place}  {words}", ["x", "y"][axis]);
                told.trim_end().to_owned()
            }
        };
        Some(GuideLabel {
            at: drag.pointer,
            words,
        })
    }
}

/// Whether a construction gives one definite point; other constructions give any point along a line.
fn is_a_place(spec: &Spec) -> bool {
    match spec {
        Spec::Point(_) | Spec::New(PointRule::CurveCrossing { .. }) => true,
        Spec::New(PointRule::OnCurve { share, .. }) => *share == Number::Value(0.5),
        _ => false,
    }
}

fn cursor(runs: GuideRun) -> CursorIcon {
    match runs {
        GuideRun::Horizontal => CursorIcon::ResizeVertical,
        GuideRun::Vertical => CursorIcon::ResizeHorizontal,
    }
}
