//! The inspector's field for the place of a guide, counted as the rulers count.

use crate::app::ToileApp;
use crate::canvas::selection::Item;
use crate::fields::{Beside, Entered, labelled};
use crate::tools::number;
use egui::{Id, Ui};
use toile_geometry::Vec2;
use toile_pattern::{GuideId, GuideRun, Number, Want, plan};

/// Steps per metre in which positions of guides are shown (1/m): nanometres, because finer digits come from
/// rounding errors in sums.
const SHOWN: f64 = 1e9;

impl ToileApp {
    /// Shows the field for the position of a guide.
    pub(crate) fn guide_place(&mut self, ui: &mut Ui, id: GuideId) {
        let Some(guide) = self.base.pattern().guide(id).cloned() else {
            return;
        };
        let label = match guide.runs {
            GuideRun::Horizontal => "Place on the left ruler",
            GuideRun::Vertical => "Place on the top ruler",
        };
        let origin = self.view.sheet_origin()[guide.runs.axis()];
        let exact = guide.at - origin;
        let shown = (exact * SHOWN).round() / SHOWN;
        let at = if shown.is_finite() { shown } else { exact };
        let base = self.base.clone();
        let unit = base.pattern().unit;
        let value = |text: &str| -> Result<f64, String> {
            let found = number::parse(text, Want::Length, &base)?;
            base.number_or_fault(&found, Want::Length)
        };
        let told = |text: &str| -> Result<String, String> {
            let value = value(text)?;
            Ok(format!("= {}", number::show(value, Want::Length, unit)))
        };
        let shown = plan::number_shown(&base, &Number::Value(at), Want::Length);
        let field = place_field(id);
        let entered = labelled(ui, label, |ui, label| {
            self.typed
                .number_field(ui, (field, label), (&shown, &Beside::default()), told)
        });
        self.typed.show_proposals(ui, field, &self.base);
        if let Entered::Text(text) = entered {
            let planned = value(&text).and_then(|at| {
                let edits = plan::move_guide(&base, id, origin + at);
                edits.map_err(|error| error.to_string())
            });
            match planned {
                Ok(edits) => {
                    self.edit(Ok(edits), "Move guide");
                }
                Err(fault) => self.typed.refuse(field, text, fault),
            }
        }
    }

    /// Moves the focus to the position field of the selected guide.
    pub(crate) fn ask_guide_place(&self, ui: &Ui) {
        if let Some(Item::Guide(id)) = self.view.selection.single() {
            ui.memory_mut(|memory| memory.request_focus(place_field(id)));
            ui.ctx().request_repaint();
        }
    }

    /// Shows or hides guides; hidden guides are deselected.
    pub(crate) fn toggle_guides(&mut self) {
        self.panes.guides = !self.panes.guides;
        if !self.panes.guides {
            let items = self.view.selection.items().iter().copied();
            let kept = items.filter(|item| !matches!(item, Item::Guide(_)));
            self.view.selection = kept.collect();
        }
    }

    /// Moves a guide by the arrow keys; `way` is a vector on the table (m).
    pub(crate) fn nudge_guide(&mut self, id: GuideId, way: Vec2) {
        let Some(guide) = self.base.pattern().guide(id) else {
            return;
        };
        let by = way[guide.runs.axis()];
        if by != 0.0 {
            let moved = plan::move_guide(&self.base, id, guide.at + by);
            self.edit(moved, "Move guide");
        }
    }

    pub(crate) fn has_guides(&self) -> bool {
        !self.session.project().pattern.guides.is_empty()
    }

    pub(crate) fn remove_guides(&mut self) {
        let edits = plan::remove_guides(&self.base);
        self.edit(Ok(edits), "Remove all guides");
    }
}

fn place_field(id: GuideId) -> Id {
    Id::unique(("guide place", id))
}
