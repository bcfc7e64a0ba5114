//! The inspector's list of a panel's operations: their order and settings.

use super::press_words::press_words;
use crate::app::ToileApp;
use crate::canvas::selection::{Item, Selection};
use crate::fields::choice;
use crate::theme;
use egui::{Button, Ui};
use std::sync::Arc;
use toile_pattern::plan;
use toile_pattern::{
    Bridge, OperationId, OperationKind, PanelId, PleatKind, Pressed, Side, Turned,
};

impl ToileApp {
    /// Shows the operations of a panel in their order: a click selects one, and buttons move it earlier or
    /// later.
    pub(crate) fn panel_steps(&mut self, ui: &mut Ui, id: PanelId) {
        let pattern = self.base.pattern().clone();
        let steps = pattern.panel(id).map_or(&[][..], |panel| &panel.operations);
        if steps.is_empty() {
            return;
        }
        theme::title(ui, "Steps, in order");
        let mut chosen = None;
        let mut moved = None;
        for (k, step) in steps.iter().enumerate() {
            ui.horizontal(|ui| {
                let name = format!("{}. {}", k + 1, step.name);
                let button = ui.add(Button::new(&name).frame_when_inactive(false));
                if button.on_hover_text("Select the step").clicked() {
                    chosen = Some(step.id);
                }
                for (sign, words, to, possible) in [
                    ("earlier", "Earlier", k.wrapping_sub(1), k > 0),
                    ("later", "Later", k + 1, k + 1 < steps.len()),
                ] {
                    let label = format!("{words}: {}", step.name);
                    let button = ui.add_enabled(possible, Button::new(sign).small());
                    button.widget_info(|| {
                        egui::WidgetInfo::labeled(egui::Role::Button, possible, &label)
                    });
                    if button
                        .on_hover_text(format!("{words} than it is done now"))
                        .clicked()
                    {
                        moved = Some((step.id, to));
                    }
                }
            });
        }
        if let Some(step) = chosen {
            self.view.select(Selection::one(Item::Operation(id, step)));
        }
        if let Some((step, to)) = moved {
            self.edit(
                plan::move_operation(&self.base, (id, step), to),
                "Change order of steps",
            );
        }
    }

    /// Shows the choices of an operation, if it has any.
    pub(crate) fn step_choices(&mut self, ui: &mut Ui, panel: PanelId, id: OperationId) {
        let pattern = self.base.pattern().clone();
        let Some(owner) = pattern.owner_of(panel, id.into()) else {
            return;
        };
        let Some(step) = owner.operations.iter().find(|step| step.id == id) else {
            return;
        };
        let mut kind = step.kind.clone();
        let sides = press_words(self.view.scene.panel_scene(panel), step);
        kind_choices(ui, &mut kind, sides);
        let mut meant = step.meant;
        if matches!(
            kind,
            OperationKind::Dart { trued: false, .. } | OperationKind::Pivot { .. }
        ) {
            ui.checkbox(&mut meant, "Kink is meant")
                .on_hover_text("No finding tells that the edge turns across the closed mouth");
        }
        if meant != step.meant {
            let edits = self.changed_panel(owner.id, |panel| {
                for step in panel.operations.iter_mut().filter(|step| step.id == id) {
                    Arc::make_mut(step).meant = meant;
                }
            });
            self.edit(edits, "Change step");
        }
        if kind != step.kind {
            let owner = owner.id;
            self.edit(
                plan::set_operation(&self.base, (owner, id), kind),
                "Change step",
            );
        }
    }
}

/// Shows the choices for a kind of operation; `first` and `second` name the pressing directions.
fn kind_choices(ui: &mut Ui, kind: &mut OperationKind, [first, second]: [&str; 2]) {
    let legs = [(Pressed::Before, first), (Pressed::After, second)];
    match kind {
        OperationKind::Dart {
            pressed,
            trued,
            keeps_length,
            ..
        } => {
            choice(ui, "Pressed", &legs, pressed);
            ui.checkbox(trued, "True the edge").on_hover_text(
                "The edge is redrawn so that it runs on smoothly across the mouth once the dart is closed",
            );
            let keeps = ui.add_enabled(
                *trued,
                egui::Checkbox::new(keeps_length, "Keep the finished length"),
            );
            keeps.on_hover_text(
                "The mouth is narrower by what truing takes from the edge: the dart takes just its width",
            );
        }
        OperationKind::Pivot {
            turned, pressed, ..
        } => {
            let parts = [
                (Turned::FromDart, "from the dart to the new mouth"),
                (Turned::ToDart, "from the new mouth to the dart"),
            ];
            choice(ui, "Part that is turned", &parts, turned);
            choice(ui, "Pressed", &legs, pressed);
        }
        OperationKind::Spread { bridge, .. } => {
            let ways = [(Bridge::Straight, "straight"), (Bridge::Smooth, "smooth")];
            choice(ui, "Line across openings", &ways, bridge);
        }
        OperationKind::Pleat {
            kind,
            pressed,
            trued,
            ..
        } => {
            let kinds = [
                (PleatKind::Knife, "knife"),
                (PleatKind::Box, "box"),
                (PleatKind::Inverted, "inverted"),
            ];
            choice(ui, "Pleat", &kinds, kind);
            if *kind == PleatKind::Knife {
                let sides = [(Side::Left, first), (Side::Right, second)];
                choice(ui, "Pressed", &sides, pressed);
            }
            ui.checkbox(trued, "True the edge").on_hover_text(
                "What lies under is cut along the edge that it lies on when it is folded, else straight across",
            );
        }
        OperationKind::Diamond { .. }
        | OperationKind::Fold { .. }
        | OperationKind::Split { .. }
        | OperationKind::Insert { .. } => {}
    }
}
