//! The inspector: the selected part, with its name and numbers, each a value or a formula.
//!
//! # Decided with
//! - [`crate::inspector::steps`], [`crate::inspector::several`], [`crate::inspector::arcs`]: operations;
//!   several parts; arcs;
//! - [`crate::inspector::press_words::press_words`], [`crate::inspector::guide_place`]: which way something
//!   is pressed; guides;
//! - [`toile_pattern::plan::numbers_of`], [`toile_pattern::plan::set_number`]: which numbers a part has; how
//!   they are set;
//! - [`crate::fields::TypedTexts`], [`toile_pattern::plan::read_number`]: what is typed;
//! - [`crate::tables`]: numbers of tables;
//! - [`crate::app::ToileApp::worn_choice`], [`crate::app::ToileApp::corner_choice`]: part of the body;
//!   corners of the cut line, by hand.

mod arcs;
mod guide_place;
mod mark_words;
mod press_words;
mod several;
mod steps;

use crate::app::ToileApp;
use crate::app::panes::InspectorPlace;
use crate::canvas::selection::Item;
use crate::fields::{Beside, Entered, choice, labelled};
use crate::theme::{self, Palette};
use crate::tools::{Tool, finished_words, number};
use crate::views::pattern::INSPECTOR_ROOM;
use egui::{Rect, RichText, Ui, Vec2, vec2};
use std::sync::Arc;
use toile_pattern::plan::{self, NumberEntry};
use toile_pattern::{
    Corner, CurveId, Edit, EditError, Entity, MitreLimit, NotchKind, Number, Panel, PanelId,
    PartId, Want,
};

/// Width of the inspector without its frame (pixels).
const WIDTH: f32 = INSPECTOR_ROOM - FRAME - 2.0 * MARGIN;
/// Distance of the inspector from the edge of the table (pixels).
const MARGIN: f32 = 10.0;
/// Width of the inspector's frame, both sides together (pixels).
const FRAME: f32 = 14.0;
/// Least width and height of the table at which the inspector is shown (pixels).
const MIN_TABLE_SIZE: Vec2 = vec2(WIDTH + 2.0 * MARGIN, 140.0);

/// Rectangle on the table for the inspector, at the right or at the left.
fn inspector_place(table: Rect, left: bool) -> Rect {
    let size = vec2(WIDTH + FRAME, table.height() - 2.0 * MARGIN);
    let at = match left {
        // Beside the ruler.
        true => table.left_top() + vec2(3.0 * MARGIN, 3.0 * MARGIN),
        false => table.right_top() + vec2(-size.x - MARGIN, 3.0 * MARGIN),
    };
    Rect::from_min_size(at, size - vec2(0.0, 2.0 * MARGIN))
}

impl ToileApp {
    /// Shows the selection in the upper right corner of the table, or in the left one if the inspector
    /// would cover the selected part; nothing if nothing is selected. It is hidden while a drawing tool
    /// is used, until the tool has made something.
    pub(crate) fn show_inspector(&mut self, ui: &mut Ui, table: Rect) {
        let items = self.view.selection.items().to_vec();
        let draws = matches!(self.view.tool, Tool::Slots(_));
        let is_known = self.selected_before.as_ref() == Some(&self.view.selection);
        let is_away = draws && (is_known || self.view.is_busy());
        let has_room = table.size().min(MIN_TABLE_SIZE) == MIN_TABLE_SIZE;
        if items.is_empty() || is_away || !has_room {
            return;
        }
        let corners = [false, true].map(|left| inspector_place(table, left));
        let covers = |left: bool| {
            let place = corners[usize::from(left)];
            self.view.selection_is_in(table, place)
        };
        // A new selection is shown on the right if possible. From then on the inspector stays in its corner
        // while it covers no selected part there, so that no field moves under the user's hands.
        let is_told = self.inspector.told == self.view.selection;
        let here = is_told && self.inspector.is_left;
        self.inspector = InspectorPlace {
            told: self.view.selection.clone(),
            is_left: here != (covers(here) && !covers(!here)),
        };
        let place = corners[usize::from(self.inspector.is_left)];
        let frame = egui::Frame::popup(ui.style());
        let area = egui::Area::new(egui::Id::unique("inspector"))
            .order(egui::Order::Middle)
            .fixed_pos(place.min)
            .default_size(place.size())
            .fade_in(false)
            .constrain_to(table);
        area.show(ui.ctx(), |ui| {
            frame.show(ui, |ui| {
                ui.set_width(WIDTH);
                // The rows may grow later.
                ui.set_max_height(place.height());
                let rows = egui::ScrollArea::vertical()
                    .auto_shrink([false, true])
                    .max_height(place.height() - 2.0 * MARGIN);
                rows.show(ui, |ui| match items[..] {
                    [item] => self.inspect(ui, item),
                    _ => self.inspect_several(ui, &items),
                });
            });
        });
    }

    /// The number that applies if an edge has none of its own, in words: the panel's number of the same
    /// label.
    fn of_panel(&self, panel: PanelId, left_out: &NumberEntry) -> String {
        let entries = plan::numbers_of(&self.base, panel.into());
        let same = entries.iter().find(|entry| entry.label == left_out.label);
        let number = same.and_then(|entry| entry.number.as_ref());
        let value = number.and_then(|n| self.base.number(n, left_out.want));
        value.map_or_else(String::new, |value| {
            let unit = self.base.pattern().unit;
            let value = number::show(value, left_out.want, unit);
            format!("{value}, as the panel")
        })
    }

    fn name_field(&mut self, ui: &mut Ui, item: Item) {
        if let Some(name) = name_of(self.base.pattern(), item.part()) {
            let id = egui::Id::unique(("name", item));
            let entered = labelled(ui, "Name", |ui, label| {
                let nothing = |_: &str| Ok(String::new());
                self.typed.field(ui, (id, label), &name, nothing)
            });
            if let Entered::Text(text) = entered {
                let planned = plan::rename(&self.base, item.part(), &text);
                self.enter(planned, "Rename", (id, text));
            }
        }
    }

    fn inspect(&mut self, ui: &mut Ui, item: Item) {
        let pattern = self.base.pattern().clone();
        let Some(words) = item.words(&pattern) else {
            return;
        };
        theme::title(ui, &words);
        let soft = Palette::of(ui.ctx()).ink_soft;
        if let Some(words) = self.measured(item) {
            ui.label(RichText::new(words).color(soft));
        }
        let seams = self.seam_words(item);
        if !seams.is_empty() {
            ui.label(RichText::new(seams).color(soft));
        }
        self.name_field(ui, item);
        let entries = arcs::numbers_of(&self.base, item.part());
        for (k, entry) in entries.iter().enumerate() {
            // Numbers that have the same name, such as the positions of several cuts, get a running number.
            let is_same = |other: &&NumberEntry| other.label == entry.label;
            let known = mark_words::label(&self.base, entry);
            let label = match entries.iter().filter(is_same).count() {
                1 => known,
                _ if known != entry.label => known,
                _ => {
                    let before = entries[..k].iter().filter(is_same).count();
                    format!("{} {}", entry.label, before + 1)
                }
            };
            let hint = match item {
                Item::Edge(panel, _) => self.of_panel(panel, entry),
                _ => String::new(),
            };
            self.named_number_field(ui, entry, (&label, hint));
        }
        match item {
            Item::Panel(panel) => {
                self.panel_choices(ui, panel);
                self.panel_steps(ui, panel);
            }
            Item::Operation(panel, step) => self.step_choices(ui, panel, step),
            Item::Edge(panel, edge) => {
                self.corner_choice(ui, panel, edge);
                self.curve_numbers(ui, (panel, edge));
            }
            Item::Curve(curve) => {
                self.radius_field(ui, curve);
                self.handle_numbers(ui, curve);
            }
            Item::Notch(panel, notch) => self.notch_choice(ui, panel, notch),
            Item::Seam(seam) => self.seam_joints(ui, seam),
            Item::Guide(guide) => self.guide_place(ui, guide),
            _ => {}
        }
    }

    /// Measurements of a part as drawn, in words.
    fn measured(&self, item: Item) -> Option<String> {
        let unit = self.base.pattern().unit;
        let length = |length: f64| number::show(length, Want::Length, unit);
        match item {
            Item::Point(id) => {
                let at = self.base.point(id)?;
                Some(format!("x {}   y {}", length(at.x), length(at.y)))
            }
            Item::Curve(id) => Some(format!("{} long", length(self.base.curve(id)?.length()))),
            Item::Edge(panel, edge) => {
                let shape = self.view.scene.panel_scene(panel)?;
                let edge = shape.shape.edge_shape(edge)?;
                Some(format!("{} long", length(edge.length)))
            }
            Item::Panel(panel) => {
                let size = self.view.scene.panel_scene(panel)?.bounds();
                let size = size.max - size.min;
                Some(format!("{} x {}", length(size.x), length(size.y)))
            }
            Item::Seam(id) => {
                let mut seams = self.view.scene.seams.iter();
                let lengths = seams.find(|seam| seam.id == id)?.lengths;
                Some(format!("{} to {}", length(lengths[0]), length(lengths[1])))
            }
            Item::Operation(panel, step) => finished_words(&self.base, panel, step),
            _ => None,
        }
    }

    /// Shows the field of a number, with its value while a formula is typed, and the error in it.
    pub(crate) fn number_field(&mut self, ui: &mut Ui, entry: &NumberEntry) {
        self.named_number_field(ui, entry, (entry.label, String::new()));
    }

    /// Shows the field of a number under the label and with the hint of `told`; the hint is the default
    /// that applies while the field is empty.
    fn named_number_field(&mut self, ui: &mut Ui, entry: &NumberEntry, told: (&str, String)) {
        let (label, hint) = told;
        labelled(ui, label, |ui, label| {
            let value = self.value_of(entry).unwrap_or_default();
            self.number_text_field(ui, entry, (label, &Beside { hint, value }));
        });
        self.typed
            .show_proposals(ui, number_field_id(entry), &self.base);
    }

    /// Shows fields for the numbers of all handles of a curve, so that the handles need not be selected one
    /// by one.
    pub(crate) fn handle_numbers(&mut self, ui: &mut Ui, curve: CurveId) {
        let handles = match self.view.scene.curve(curve) {
            Some((_, curve)) => curve.handles.clone(),
            None => return,
        };
        for (k, [at, handle]) in handles.into_iter().enumerate() {
            let Some((_, point)) = self.base.pattern().point(at) else {
                continue;
            };
            let side = match k {
                0 | 1 => "at",
                _ if k % 2 == 0 => "before",
                _ => "after",
            };
            let of = format!("of handle {side} {}", point.name);
            for entry in plan::numbers_of(&self.base, handle.into()) {
                let label = format!("{} {of}", entry.label);
                self.named_number_field(ui, &entry, (&label, String::new()));
            }
        }
    }

    /// Value to show beside a number that is a formula or a share of an edge; `None` if the text in the
    /// field is the value itself.
    fn value_of(&self, entry: &NumberEntry) -> Option<String> {
        if let Some(words) = mark_words::distance(&self.base, entry) {
            return Some(format!("= {words}"));
        }
        let number = entry.number.as_ref().filter(|n| n.as_formula().is_some())?;
        let value = self.base.number(number, entry.want)?;
        let unit = self.base.pattern().unit;
        Some(format!("= {}", number::show(value, entry.want, unit)))
    }

    /// The field of a number without its label; `beside` is shown next to its text.
    pub(crate) fn number_text_field(
        &mut self,
        ui: &mut Ui,
        entry: &NumberEntry,
        (label, beside): (egui::Id, &Beside),
    ) {
        let id = number_field_id(entry);
        let shown = entry.number.as_ref().map_or_else(String::new, |number| {
            plan::number_shown(&self.base, number, entry.want)
        });
        let base = self.base.clone();
        let want = entry.want;
        let unit = base.pattern().unit;
        let value = |text: &str| -> Result<String, String> {
            let found = number::parse(text, want, &base)?;
            let value = base.number_or_fault(&found, want)?;
            // A number of unspecified kind is shown in the kind that its formula gives.
            let told = match want {
                Want::Any => base.kind(&found),
                want => want,
            };
            Ok(format!("= {}", number::show(value, told, unit)))
        };
        let shown = (&*shown, beside);
        let entered = self.typed.number_field(ui, (id, label), shown, value);
        if let Entered::Text(text) = entered {
            let planned = match text.is_empty() {
                true => plan::clear_number(&self.base, &entry.place).map_err(|e| e.to_string()),
                false => number::parse(&text, want, &self.base).and_then(|number: Number| {
                    let kept = arcs::kept(&self.base, entry, number);
                    let edits = kept.and_then(|n| plan::set_number(&self.base, &entry.place, n));
                    edits.map_err(|error| error.to_string())
                }),
            };
            match planned {
                Ok(edits) => {
                    self.edit(Ok(edits), &format!("Set {}", entry.label));
                }
                Err(fault) => self.typed.refuse(id, text, fault),
            }
        }
    }

    /// Makes the edits of an entered text; if they were refused, keeps the text in its field with the
    /// error.
    pub(crate) fn enter(
        &mut self,
        planned: Result<Vec<Edit>, EditError>,
        label: &str,
        (id, text): (egui::Id, String),
    ) {
        match planned {
            Ok(edits) => {
                self.edit(Ok(edits), label);
            }
            Err(error) => self.typed.refuse(id, text, error.to_string()),
        }
    }

    fn panel_choices(&mut self, ui: &mut Ui, id: PanelId) {
        let pattern = self.base.pattern().clone();
        let Some(panel) = pattern.panel(id) else {
            return;
        };
        let mut changed: Panel = (**panel).clone();
        labelled(ui, "Cut", |ui, label| {
            let field = egui::DragValue::new(&mut changed.cut.quantity).range(0..=99);
            let pairs = ui.horizontal(|ui| {
                ui.add(field.update_while_editing(false)).labelled_by(label);
                ui.checkbox(&mut changed.cut.mirrored, "in mirrored pairs")
            });
            let pairs = pairs.inner;
            if pairs.changed() && changed.cut.mirrored {
                changed.cut.quantity = changed.cut.quantity.next_multiple_of(2).max(2);
            }
        });
        let fabrics = pattern.fabrics.iter();
        let fabrics: Vec<_> = fabrics.map(|fabric| (fabric.id, &*fabric.name)).collect();
        choice(ui, "Fabric", &fabrics, &mut changed.fabric);
        if let Some(cut_from) = self.session.project().garment_cloth().fabric {
            labelled(ui, "Cut from", |ui, label| {
                let told = "The whole garment is: F4, Garment cut from";
                ui.label(&cut_from.name)
                    .labelled_by(label)
                    .on_hover_text(told);
            });
        }
        self.worn_choice(ui, &mut changed);
        if changed != **panel {
            let label = match changed.cut == panel.cut {
                true => "Change panel",
                false => "Change cut",
            };
            let put = Edit::Put(Entity::Panel(Arc::new(changed)));
            self.edit(Ok(vec![put]), label);
        }
    }

    fn worn_choice(&mut self, ui: &mut Ui, panel: &mut Panel) {
        use toile_pattern::{BodyPart, Facing, WornRule};
        let (mut part, mut facing, level) = match &panel.worn {
            WornRule::Wrapped {
                part,
                facing,
                level,
            } => (Some(*part), *facing, level.clone()),
            _ => (None, Facing::Front, None),
        };
        let before = (part, facing);
        let parts = [
            (None, "found by the program"),
            (Some(BodyPart::Trunk), "trunk"),
            (Some(BodyPart::Head), "head"),
            (Some(BodyPart::LeftArm), "left arm"),
            (Some(BodyPart::RightArm), "right arm"),
            (Some(BodyPart::LeftLeg), "left leg"),
            (Some(BodyPart::RightLeg), "right leg"),
        ];
        choice(ui, "Worn on", &parts, &mut part);
        if part.is_some() {
            let sides = [
                (Facing::Front, "front"),
                (Facing::Back, "back"),
                (Facing::Left, "left"),
                (Facing::Right, "right"),
                (Facing::Around, "all round"),
                (Facing::Over, "over it"),
            ];
            choice(ui, "Side", &sides, &mut facing);
        }
        if (part, facing) != before {
            panel.worn = match part {
                None => WornRule::Automatic,
                Some(part) => WornRule::Wrapped {
                    part,
                    facing,
                    level,
                },
            };
        }
    }

    fn corner_choice(&mut self, ui: &mut Ui, panel: PanelId, id: toile_pattern::EdgeId) {
        let pattern = self.base.pattern().clone();
        // Edges of a part of a split panel belong to the panel that was split.
        let owner = pattern.owner_of(panel, id.into());
        let Some((panel, edge)) = owner.and_then(|owner| Some((owner.id, owner.edge(id)?))) else {
            return;
        };
        let choices = [
            (Corner::Mitre, "mitre"),
            (Corner::Bevel, "bevel"),
            (Corner::Square, "square"),
            (Corner::Extended, "seam lines extended"),
            (Corner::Mirrored, "mirrored, as a hem"),
        ];
        let mut corner = edge.corner;
        choice(ui, "Corner of allowance", &choices, &mut corner.kind);
        mitre_limit(ui, &mut corner.limit);
        ui.checkbox(&mut corner.meant, "Kink is meant")
            .on_hover_text(
                "No finding tells that the line turns here where it goes on across a seam",
            );
        if corner != edge.corner {
            let edits = self.changed_panel(panel, |panel| {
                let edges = panel.lines.iter_mut().flat_map(|line| &mut line.edges);
                for edge in edges.filter(|edge| edge.id == id) {
                    edge.corner = corner;
                }
            });
            self.edit(edits, "Change corner");
        }
    }

    fn notch_choice(&mut self, ui: &mut Ui, panel: PanelId, id: toile_pattern::NotchId) {
        let pattern = self.base.pattern().clone();
        let owner = pattern.owner_of(panel, id.into());
        let Some((panel, notch)) = owner.and_then(|owner| Some((owner.id, owner.notch(id)?)))
        else {
            return;
        };
        let kinds = [
            (NotchKind::Slit, "slit"),
            (NotchKind::V, "V"),
            (NotchKind::Castle, "castle"),
            (NotchKind::T, "T"),
            (NotchKind::Check, "check"),
        ];
        let mut kind = notch.kind;
        choice(ui, "Shape", &kinds, &mut kind);
        if kind != notch.kind {
            self.edit(
                plan::set_notch_kind(&self.base, (panel, id), kind),
                "Change notch",
            );
        }
    }
}

/// Id of the field of a number.
pub(crate) fn number_field_id(entry: &NumberEntry) -> egui::Id {
    egui::Id::unique(("number", &entry.place))
}

/// Name of a part; `None` if it has no name.
fn name_of(pattern: &toile_pattern::Pattern, part: PartId) -> Option<String> {
    Some(match part {
        PartId::Point(id) => pattern.point(id)?.1.name.clone(),
        PartId::Curve(id) => {
            let mut sheets = pattern.sheets.iter();
            sheets.find_map(|sheet| sheet.curve(id))?.name.clone()
        }
        PartId::Panel(id) => pattern.panel(id)?.name.clone(),
        PartId::Seam(id) => pattern.seam(id)?.name.clone(),
        PartId::Sheet(id) => pattern.sheet(id)?.name.clone(),
        PartId::Edge(id) => {
            let mut panels = pattern.panels.iter();
            panels.find_map(|panel| panel.edge(id))?.name.clone()
        }
        PartId::Line(id) => {
            let mut lines = pattern.panels.iter().flat_map(|panel| &panel.lines);
            lines.find(|line| line.id == id)?.name.clone()
        }
        PartId::Notch(id) => {
            let mut notches = pattern.panels.iter().flat_map(|panel| &panel.notches);
            notches.find(|notch| notch.id == id)?.name.clone()
        }
        PartId::Operation(id) => {
            let mut steps = pattern.panels.iter().flat_map(|panel| &panel.operations);
            steps.find(|step| step.id == id)?.name.clone()
        }
        _ => return None,
    })
}

/// Shows the choice of the mitre limit at a corner: a multiple of the allowance's width, or no limit.
fn mitre_limit(ui: &mut Ui, limit: &mut MitreLimit) {
    let mut is_limited = *limit != MitreLimit::None;
    let mut widths = match *limit {
        MitreLimit::Widths(widths) => widths,
        MitreLimit::None => MitreLimit::USUAL,
    };
    ui.horizontal(|ui| {
        ui.checkbox(&mut is_limited, "Cut off beyond")
            .on_hover_text("Off: the cut lines run on until they meet, however sharp the corner");
        let [least, most] = MitreLimit::RANGE;
        let field = egui::DragValue::new(&mut widths)
            .range(least..=most)
            .speed(0.1)
            .max_decimals(2)
            .suffix(" widths")
            .update_while_editing(false);
        let field = ui.add_enabled(is_limited, field);
        field.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::SpinButton, is_limited, "Limit of the corner")
        });
    });
    *limit = match is_limited {
        true => MitreLimit::Widths(widths),
        false => MitreLimit::None,
    };
}
