//! The pane with the garment on the mannequin.

use super::ToileApp;
use super::background_work::{GarmentStatus, Moment};
use super::tool_commands::{DRAPE, PAUSE, STOP};
use crate::theme::{self, Palette};
use egui::{
    Align, Button, ComboBox, Label, Layout, Panel, Rect, RichText, Ui, UiBuilder, pos2, vec2,
};
use toile_session::{Command, Quality, Stage, Verdict};

/// Height of the strip of buttons above the view (pixels).
const STRIP: f32 = 38.0;

impl ToileApp {
    pub(crate) fn garment_side(&mut self, ui: &mut Ui) {
        // Changes of this frame are followed before the view is drawn: cloth is never shown on a body for
        // which it was not made.
        self.background_work.follow(&self.session);
        self.background_work.follow_body(&self.session);
        Panel::top("drape")
            .frame(theme::bar(ui.ctx()))
            .resizable(false)
            .exact_size(STRIP)
            .show(ui, |ui| self.drape_strip(ui));
        if self.lays_loop() {
            Panel::top("region")
                .frame(theme::bar(ui.ctx()))
                .resizable(false)
                .show(ui, |ui| self.region_bar(ui));
        }
        let view = ui.available_rect_before_wrap();
        let empty = match self.background_work.is_making_body() {
            true => "Making the mannequin\u{2026}",
            false => "No mannequin yet",
        };
        self.stage
            .set_out_of_date(self.background_work.is_out_of_date());
        // A loop is laid on the present body.
        self.stage.hides_body = self.background_work.is_on_another_body() && !self.lays_loop();
        self.stage.show(ui, empty);
        if !self.lays_loop() {
            self.drape_progress(ui, view);
        }
    }

    pub(crate) fn drape_strip(&mut self, ui: &mut Ui) {
        ui.horizontal_centered(|ui| {
            let palette = Palette::of(ui.ctx());
            let words = RichText::new(DRAPE.name).color(palette.on_accent);
            let button = Button::new(words).fill(palette.accent);
            self.command_widget(ui, &DRAPE, button, None);
            let button = Button::new(PAUSE.name).selected(self.background_work.is_paused());
            self.command_widget(ui, &PAUSE, button, None);
            self.command_button(ui, &STOP);
            self.quality_choice(ui);
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

    /// Shows the progress of the drape at the bottom of the 3D view.
    pub(crate) fn drape_progress(&self, ui: &mut Ui, view: Rect) {
        let share = self
            .background_work
            .moment()
            .map_or(0.0, |moment| moment.share as f32);
        let palette = Palette::of(ui.ctx());
        let words = self.drape_words();
        if words.is_empty() {
            return;
        }
        let bar = Rect::from_min_max(pos2(view.left(), view.bottom() - 4.0), view.max);
        if self.background_work.is_draping() {
            ui.painter().rect_filled(bar, 0.0, palette.rule);
            let done = Rect::from_min_size(bar.min, vec2(bar.width() * share, bar.height()));
            ui.painter().rect_filled(done, 0.0, palette.accent);
        }
        let line = Rect::from_min_max(
            pos2(view.left() + 12.0, view.bottom() - 80.0),
            pos2(view.right() - 12.0, view.bottom() - 12.0),
        );
        let (colour, is_old) = match self.background_work.status() {
            GarmentStatus::OutOfDate(_) | GarmentStatus::NotMade(_) => (palette.warning, true),
            GarmentStatus::AtRest if !self.is_flawless() => (palette.warning, false),
            _ => (palette.ink_soft, false),
        };
        let layout = Layout::bottom_up(Align::Min);
        ui.scope_builder(UiBuilder::new().max_rect(line).layout(layout), |ui| {
            let label = Label::new(RichText::new(words).color(colour));
            // The reason why the garment is out of date may take several lines.
            ui.add(match is_old {
                true => label.wrap(),
                false => label.truncate(),
            });
        });
    }

    /// Whether there are no findings on the garment at rest.
    fn is_flawless(&self) -> bool {
        let verdict = self.background_work.verdict();
        verdict.is_none_or(|verdict| verdict.findings().is_empty())
    }

    fn drape_words(&self) -> String {
        let moment = self.background_work.moment();
        let state = moment.map_or_else(String::new, |moment| moment_words(&moment));
        let rests = moment.is_some_and(|moment| moment.stage == Stage::Finished);
        match self.background_work.status() {
            GarmentStatus::Nothing => String::new(),
            GarmentStatus::Preparing => {
                "Cutting the cloth into triangles and placing it\u{2026}".into()
            }
            GarmentStatus::Moving if rests => "Moving: taking over the change".into(),
            GarmentStatus::Moving => format!("Moving: {state}"),
            GarmentStatus::Held => format!("Paused: {state}"),
            GarmentStatus::Stopped => format!("Stopped: {state}"),
            GarmentStatus::AtRest => match self.background_work.verdict() {
                Some(verdict) => ended_words(&verdict, state),
                None => state,
            },
            GarmentStatus::OutOfDate(why) => format!("Out of date: {why}"),
            GarmentStatus::NotMade(why) => format!("It does not hang: {why}"),
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

/// Message at the end of a drape: `state`, then the headline of the verdict if there is one; only the
/// headline if the verdict is that the result is not what was asked for.
pub(super) fn ended_words(verdict: &Verdict, state: String) -> String {
    let headline = verdict.headline();
    match (headline.is_empty(), verdict.is_sound()) {
        (true, _) => state,
        (_, true) => format!("{state}, {headline}"),
        (_, false) => format!("Not as asked for: {headline}"),
    }
}

fn moment_words(moment: &Moment) -> String {
    let step = moment.step;
    match moment.stage {
        Stage::Sewing => {
            let gap = moment.gap * 1000.0;
            format!("sewing, step {step}, seams up to {gap:.1} mm apart")
        }
        Stage::Swinging => "swinging under its own weight".to_owned(),
        Stage::Settling => {
            let force = match moment.residual {
                unknown if unknown.is_infinite() => return format!("settling, step {step}"),
                many if many >= 1.0 => format!("{many:.0} times the weight"),
                few => format!("{:.2} % of the weight", few * 100.0),
            };
            format!("settling, step {step}, net force {force}")
        }
        Stage::Finished => format!("At rest after {step} steps"),
    }
}
