//! Toolbar, strips over both views, status line.

use crate::app::ToileApp;
use crate::command::UiCommand;
use crate::making::Moment;
use crate::notice::Tone;
use crate::selection::{Selection, centimetres};
use crate::space::PanelPoint;
use crate::theme;
use egui::{Align, Button, Color32, ComboBox, DragValue, Layout, Rect, RichText, Ui, pos2, vec2};
use toile_pattern::{Diagnostic, Place, Severity};
use toile_session::{Command, Quality, Stage};

/// Height of the strips over both views [logical pixels].
pub const STRIP: f32 = 42.0;
/// Most that a coordinate can be typed as [cm]: five metres, longer than any panel.
const REACH: f64 = 500.0;

impl ToileApp {
    pub(crate) fn toolbar(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            self.buttons(ui, &[UiCommand::Save]);
            ui.separator();
            self.history_buttons(ui);
            ui.separator();
            self.buttons(ui, &[UiCommand::AddPoint, UiCommand::DeletePoint]);
            ui.separator();
            self.buttons(
                ui,
                &[UiCommand::FitPattern, UiCommand::ZoomOut, UiCommand::ZoomIn],
            );
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                self.size_choice(ui);
            });
        });
    }

    fn buttons(&mut self, ui: &mut Ui, commands: &[UiCommand]) {
        for command in commands {
            if command.button(ui, self.can(*command)) {
                self.run(*command);
            }
        }
    }

    fn history_buttons(&mut self, ui: &mut Ui) {
        let steps = [
            (UiCommand::Undo, self.session.can_undo()),
            (UiCommand::Redo, self.session.can_redo()),
        ];
        let mut asked = None;
        for (command, step) in steps {
            let tip = match step {
                Some(step) => format!("{}: {step}", command.tooltip()),
                None => command.tooltip().to_owned(),
            };
            let button = Button::new(command.label());
            if command.show(ui, step.is_some(), button, &tip) {
                asked = Some(command);
            }
        }
        if let Some(command) = asked {
            self.run(command);
        }
    }

    fn size_choice(&mut self, ui: &mut Ui) {
        let project = self.session.project();
        if project.pattern.sizes.is_empty() {
            return;
        }
        let names: Vec<String> = project
            .pattern
            .sizes
            .iter()
            .map(|s| s.name.clone())
            .collect();
        let base = project.pattern.base().map(|size| size.name.clone());
        let mut chosen = project
            .size
            .clone()
            .or(base)
            .unwrap_or_else(|| names[0].clone());
        let before = chosen.clone();
        // Right to left: the label comes after its choice to stand before it.
        let choice = ComboBox::from_id_salt("size")
            .selected_text(&chosen)
            .width(70.0)
            .show_ui(ui, |ui| {
                for name in names {
                    let words = name.clone();
                    ui.selectable_value(&mut chosen, name, words);
                }
            })
            .response;
        let label = ui.label("Size").id;
        choice.labelled_by(label);
        if chosen != before {
            self.execute(Command::SetSize { size: Some(chosen) });
        }
    }

    pub(crate) fn selection_strip(&mut self, ui: &mut Ui) {
        let part = self.table.selection;
        ui.horizontal_centered(|ui| match part {
            Selection::Nothing if self.drawing.panels.is_empty() => {}
            Selection::Nothing => {
                ui.add(
                    egui::Label::new(
                        RichText::new(
                            "Drag a point to move it. Double-click an edge to add a point.",
                        )
                        .color(theme::INK_SOFT),
                    )
                    .truncate(),
                );
            }
            Selection::Point(..) => self.point_fields(ui),
            Selection::Edge(panel, edge) => {
                ui.label(RichText::new(part.words(&self.drawing)).strong());
                let drawn = self.drawing.panel(panel).and_then(|p| p.edge(edge));
                if let Some(edge) = drawn {
                    ui.label(centimetres(edge.length));
                }
                let seams = RichText::new(part.seam_words(&self.drawing)).color(theme::INK_SOFT);
                ui.add(egui::Label::new(seams).truncate());
            }
        });
    }

    fn point_fields(&mut self, ui: &mut Ui) {
        let Selection::Point(panel, point) = self.table.selection else {
            return;
        };
        let Some(at) = self
            .drawing
            .panel(panel)
            .and_then(|panel| panel.point(point))
            .map(|point| point.at.0)
        else {
            return;
        };
        ui.label(RichText::new(self.table.selection.words(&self.drawing)).strong());
        ui.add_space(8.0);
        let mut wanted = at;
        let (mut dragged, mut dropped) = (false, false);
        for (name, value) in ["x", "y"].into_iter().zip(wanted.iter_mut()) {
            let label = ui.label(name).id;
            let mut shown = *value * 100.0;
            let field = DragValue::new(&mut shown)
                .suffix(" cm")
                .speed(0.05)
                .range(-REACH..=REACH)
                .fixed_decimals(2)
                .update_while_editing(false);
            let response = ui.add(field).labelled_by(label);
            if response.changed() {
                *value = shown / 100.0;
            }
            dragged |= response.dragged();
            dropped |= response.drag_stopped();
        }
        if wanted != at {
            self.show_moved((panel, point), PanelPoint(wanted));
        }
        if dropped || wanted != at && !dragged {
            self.commit("Move point");
        }
    }

    pub(crate) fn drape_strip(&mut self, ui: &mut Ui) {
        ui.horizontal_centered(|ui| {
            let enabled = self.can(UiCommand::Drape);
            let words = RichText::new(UiCommand::Drape.label()).color(Color32::WHITE);
            let button = Button::new(words).fill(theme::ACCENT);
            if UiCommand::Drape.show(ui, enabled, button, UiCommand::Drape.tooltip()) {
                self.run(UiCommand::Drape);
            }
            let held = self.making.is_paused();
            let button = Button::new(UiCommand::Pause.label()).selected(held);
            let enabled = self.can(UiCommand::Pause);
            if UiCommand::Pause.show(ui, enabled, button, UiCommand::Pause.tooltip()) {
                self.run(UiCommand::Pause);
            }
            self.buttons(ui, &[UiCommand::Stop]);
            self.quality_choice(ui);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                self.buttons(
                    ui,
                    &[
                        UiCommand::SideView,
                        UiCommand::BackView,
                        UiCommand::FrontView,
                    ],
                );
            });
        });
    }

    fn quality_choice(&mut self, ui: &mut Ui) {
        let before = self.session.project().quality;
        let mut chosen = before;
        let label = ui.label("Cloth").id;
        let response = ComboBox::from_id_salt("quality")
            .selected_text(quality_words(before))
            .width(80.0)
            .show_ui(ui, |ui| {
                for quality in [Quality::Preview, Quality::Fit, Quality::Final] {
                    ui.selectable_value(&mut chosen, quality, quality_words(quality));
                }
            })
            .response;
        let response = response.labelled_by(label);
        response.on_hover_text("How finely the cloth is meshed and how long it settles");
        if chosen != before {
            self.execute(Command::SetQuality { quality: chosen });
        }
    }

    /// What the drape is doing, over the lower end of the 3D view.
    pub(crate) fn drape_progress(&self, ui: &mut Ui, view: Rect) {
        let share = self
            .making
            .moment()
            .map_or(0.0, |moment| moment.share as f32);
        let words = self.drape_words();
        if words.is_empty() {
            return;
        }
        let bar = Rect::from_min_max(pos2(view.left(), view.bottom() - 4.0), view.max);
        if self.making.is_draping() {
            ui.painter().rect_filled(bar, 0.0, theme::RULE);
            let done = Rect::from_min_size(bar.min, vec2(bar.width() * share, bar.height()));
            ui.painter().rect_filled(done, 0.0, theme::ACCENT);
        }
        let line = Rect::from_min_max(
            pos2(view.left() + 12.0, view.bottom() - 34.0),
            pos2(view.right() - 12.0, view.bottom() - 10.0),
        );
        ui.scope_builder(egui::UiBuilder::new().max_rect(line), |ui| {
            let words = RichText::new(words).color(theme::INK_SOFT);
            ui.add(egui::Label::new(words).truncate());
        });
    }

    fn drape_words(&self) -> String {
        if self.making.is_preparing() {
            return "Cutting the cloth into triangles and placing it\u{2026}".into();
        }
        let Some(moment) = self.making.moment() else {
            return String::new();
        };
        let state = moment_words(&moment);
        let current = self.making.revision() == Some(self.session.revision());
        match () {
            () if !current => format!("The pattern has changed: drape it again. {state}"),
            () if self.making.is_paused() => format!("{state}. Paused"),
            () if !self.making.is_draping() && moment.stage != Stage::Finished => {
                format!("{state}. Stopped")
            }
            () => state,
        }
    }

    pub(crate) fn status(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                self.findings_button(ui);
                if let Some(at) = self.table.pointer {
                    let [x, y] = [at.0.x, at.0.y].map(|v| v * 100.0);
                    let words = format!("x {x:.1} cm   y {y:.1} cm");
                    ui.label(RichText::new(words).color(theme::INK_SOFT));
                }
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    let (words, colour) = self.status_words();
                    let words = RichText::new(words).color(colour);
                    let label = ui.add(egui::Label::new(words).truncate());
                    label.on_hover_ui(|ui| {
                        ui.label(self.status_words().0);
                    });
                });
            });
        });
    }

    /// The latest message; else the part under the pointer; else the worst finding.
    fn status_words(&self) -> (String, Color32) {
        if !self.notice.text.is_empty() {
            let colour = match self.notice.tone {
                Tone::News => theme::INK,
                Tone::Warning => theme::WARNING,
                Tone::Fault => theme::FAULT,
            };
            return (self.notice.text.clone(), colour);
        }
        let hover = self.table.hover;
        if hover != Selection::Nothing && !self.table.dragging() {
            let mut words = hover.words(&self.drawing);
            if let Selection::Edge(panel, edge) = hover {
                let drawn = self.drawing.panel(panel).and_then(|p| p.edge(edge));
                let length = drawn.map_or(String::new(), |edge| centimetres(edge.length));
                words = format!("{words}, {length}, {}", hover.seam_words(&self.drawing));
            }
            return (words, theme::INK);
        }
        // The first of the worst.
        let worst = self.findings.iter().rev().max_by_key(|f| f.severity);
        match worst {
            Some(found) if found.severity > Severity::Note => {
                (found.to_string(), finding_colour(found))
            }
            _ => (String::new(), theme::INK),
        }
    }

    fn findings_button(&mut self, ui: &mut Ui) {
        if self.drawing.panels.is_empty() && self.findings.is_empty() {
            return;
        }
        let count = |severity| {
            self.findings
                .iter()
                .filter(|f| f.severity == severity)
                .count()
        };
        let (faults, warnings) = (count(Severity::Error), count(Severity::Warning));
        let several = |count: usize, word: &str| match count {
            1 => format!("1 {word}"),
            _ => format!("{count} {word}s"),
        };
        let (words, colour) = match (faults, warnings) {
            (0, 0) => ("No faults".to_owned(), theme::ACCENT),
            (0, w) => (several(w, "warning"), theme::WARNING),
            (f, 0) => (several(f, "fault"), theme::FAULT),
            (f, w) => (
                format!("{}, {}", several(f, "fault"), several(w, "warning")),
                theme::FAULT,
            ),
        };
        let button = Button::new(RichText::new(words).color(colour)).selected(self.shows_findings);
        let tip = "List what is found wrong with the pattern";
        if ui.add(button).on_hover_text(tip).clicked() {
            self.shows_findings = !self.shows_findings;
        }
    }

    pub(crate) fn list_findings(&mut self, ui: &mut Ui) {
        let findings = self.findings.clone();
        let mut chosen = None;
        egui::ScrollArea::vertical()
            .auto_shrink([false, false])
            .show(ui, |ui| {
                if findings.is_empty() {
                    ui.label("Nothing is wrong with this pattern.");
                }
                for found in findings.iter() {
                    let words = RichText::new(found.to_string()).color(finding_colour(found));
                    if ui.add(Button::new(words).frame(false).wrap()).clicked() {
                        chosen = Some(found.place.clone());
                    }
                }
            });
        if let Some(part) = chosen.and_then(|place| self.part_at(&place)) {
            self.table.selection = part;
        }
    }

    /// The part of the drawing that a finding is about.
    fn part_at(&self, place: &Place) -> Option<Selection> {
        match *place {
            Place::Point(point) => {
                let mut panels = self.drawing.panels.iter();
                let owner = panels.find(|panel| panel.point(point).is_some())?;
                Some(Selection::Point(owner.id, point))
            }
            Place::Edge(panel, edge) => Some(Selection::Edge(panel, edge)),
            Place::Seam(id) => {
                let seam = self.drawing.seams.iter().find(|seam| seam.id == id)?;
                let mut stretches = seam.stretches.iter();
                stretches.find_map(|s| Some(Selection::Edge(s.panel, s.edge?)))
            }
            _ => None,
        }
    }
}

fn quality_words(quality: Quality) -> &'static str {
    match quality {
        Quality::Preview => "coarse",
        Quality::Fit => "medium",
        Quality::Final => "fine",
    }
}

fn finding_colour(found: &Diagnostic) -> Color32 {
    match found.severity {
        Severity::Note => theme::INK,
        Severity::Warning => theme::WARNING,
        Severity::Error => theme::FAULT,
    }
}

fn moment_words(moment: &Moment) -> String {
    let step = moment.step;
    match moment.stage {
        Stage::Sewing => {
            let gap = moment.gap * 1000.0;
            format!("Sewing, step {step}: seams up to {gap:.1} mm apart")
        }
        Stage::Swinging => "Swinging under its own weight".to_owned(),
        Stage::Settling => {
            let force = match moment.residual {
                many if many >= 1.0 => format!("{many:.0} times the weight"),
                few => format!("{:.2} % of the weight", few * 100.0),
            };
            format!("Settling, step {step}: net force {force}")
        }
        Stage::Finished => format!("At rest after {step} steps"),
    }
}
