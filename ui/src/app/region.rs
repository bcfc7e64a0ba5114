//! A panel from a region of the mannequin: places are clicked round it in the 3D view, the region is flattened on a thread of
//! its own, and the panel joins the pattern.

use super::ToileApp;
use super::job::Job;
use super::notice::Notice;
use crate::fields::text_field;
use crate::theme::Palette;
use crate::tools::number;
use crate::views::laid_loop::LaidLoop;
use egui::{DragValue, Label, RichText, Ui};
use toile_pattern::{Evaluation, Fabric, Ids, Number, Want, plan};
use toile_session::{FlatSurface, FlattenOptions, SkinLoop, Watcher};

/// Width of the field for the ease (pixels).
const FIELD: f32 = 60.0;
/// Largest stretch that can be asked for (%).
const MAX_STRETCH: f64 = 50.0;
/// Most darts that can be asked for.
const MAX_DARTS: usize = 20;
/// Name of the panel; where it is taken, the pattern gives another.
const NAME: &str = "region";

/// What is asked of the panel, and the work on it.
pub struct RegionChoice {
    /// Distance of the panel from the skin, as typed.
    ease: String,
    /// Largest stretch of the cloth on 99 % of the area (%).
    stretch: f64,
    darts: usize,
    job: Option<Job<FlatSurface>>,
    /// Whether the loop begins once the mannequin is made.
    waits: bool,
}

impl Default for RegionChoice {
    fn default() -> Self {
        Self {
            ease: "10mm".to_owned(),
            stretch: 2.0,
            darts: 2,
            job: None,
            waits: false,
        }
    }
}

impl RegionChoice {
    /// Whether a panel is being made, or a loop waits for the mannequin.
    pub fn is_busy(&self) -> bool {
        self.job.is_some() || self.waits
    }
}

impl ToileApp {
    /// Whether a loop is laid on the mannequin.
    pub(crate) fn lays_loop(&self) -> bool {
        self.stage.laid.is_some()
    }

    /// Begins a loop on the mannequin, or ends it.
    pub(crate) fn toggle_loop(&mut self) {
        if self.lays_loop() {
            return self.leave_loop();
        }
        self.panes.garment = true;
        self.region.waits = self.background_work.is_making_body();
        if self.region.waits {
            self.notice = Notice::news("The mannequin is being made\u{2026}");
            return;
        }
        match self.session.mannequin() {
            Ok(mannequin) => {
                self.stage.set_body(mannequin.skin());
                self.stage.laid = Some(LaidLoop::new(SkinLoop::new(mannequin)));
                self.notice = Notice::news(
                    "Click places on the mannequin round a region; drag turns it. Enter makes the panel, Esc leaves",
                );
            }
            Err(error) => self.notice = Notice::fault(error.to_string()),
        }
    }

    /// Ends the loop, and the work on its panel; the garment is shown again.
    pub(crate) fn leave_loop(&mut self) {
        self.end_loop();
        self.notice = Notice::default();
    }

    pub(super) fn end_loop(&mut self) {
        self.stage.laid = None;
        self.region.job = None;
        self.region.waits = false;
    }

    /// Shows what is asked of the panel, and its buttons.
    pub(super) fn region_bar(&mut self, ui: &mut Ui) {
        let Some(laid) = &self.stage.laid else { return };
        let count = laid.skin.places().len();
        let is_whole = laid.skin.is_whole();
        let is_busy = self.region.is_busy();
        let (mut takes_back, mut makes, mut leaves) = (false, false, false);
        let mut entered = false;
        ui.horizontal_wrapped(|ui| {
            let palette = Palette::of(ui.ctx());
            let label = ui.label("Ease").id;
            let id = egui::Id::unique("ease of the region");
            let field = ui.scope(|ui| {
                ui.set_max_width(FIELD);
                text_field(ui, id, &mut self.region.ease)
            });
            let field = field.inner.labelled_by(label);
            field.on_hover_text("Distance of the panel from the skin");
            let label = ui.label("Stretch").id;
            let field = DragValue::new(&mut self.region.stretch)
                .range(0.1..=MAX_STRETCH)
                .speed(0.05)
                .suffix(" %");
            let field = ui.add(field).labelled_by(label);
            field.on_hover_text(
                "Largest stretch of the cloth, either way, on 99 % of the area; darts are cut where it is more",
            );
            let label = ui.label("Darts").id;
            let field = DragValue::new(&mut self.region.darts)
                .range(0..=MAX_DARTS)
                .speed(0.05);
            ui.add(field)
                .labelled_by(label)
                .on_hover_text("Most darts of the panel");
            let back = egui::Button::new("Take back");
            takes_back = ui.add_enabled(count > 0 && !is_busy, back).clicked();
            let words = RichText::new("Make the panel").color(palette.on_accent);
            let make = egui::Button::new(words).fill(palette.accent);
            let make = ui.add_enabled(is_whole && !is_busy, make);
            let make = make.on_disabled_hover_text("Click three places or more on the mannequin first");
            makes = make.clicked();
            leaves = ui.button("Leave").clicked();
            let words = match is_busy {
                true => "Flattening\u{2026}".to_owned(),
                false if count == 1 => "1 place".to_owned(),
                false => format!("{count} places"),
            };
            ui.add(Label::new(RichText::new(words).color(palette.ink_soft)).extend());
            let types = ui.ctx().egui_wants_keyboard_input();
            entered = !types && ui.input(|input| input.key_pressed(egui::Key::Enter));
        });
        if takes_back && let Some(laid) = &mut self.stage.laid {
            laid.skin.take_back();
            laid.changed(Palette::of(ui.ctx()));
        }
        let is_covered = self.dialog.is_some() || self.menu_is_open || self.view.is_busy();
        if makes || (entered && is_whole && !is_busy && !is_covered) {
            self.make_region();
        }
        if leaves {
            self.leave_loop();
        }
    }

    /// Begins to flatten the region inside the loop.
    fn make_region(&mut self) {
        let Some(laid) = &mut self.stage.laid else {
            return;
        };
        let ease = match number::parse(&self.region.ease, Want::Length, &self.base) {
            Ok(Number::Value(ease)) => ease,
            Ok(_) => return self.say_fault("Ease: type a length, as in 10mm".to_owned()),
            Err(fault) => {
                return self.say_fault(format!("Ease: {fault}"));
            }
        };
        let options = FlattenOptions {
            strain: self.region.stretch / 100.0,
            darts: self.region.darts,
            ease,
            ..FlattenOptions::default()
        };
        let fabric = match self.base.pattern().fabrics.first() {
            Some(fabric) => (**fabric).clone(),
            None => Fabric::poplin(Ids::default().take()),
        };
        let skin = laid.skin.clone();
        laid.is_held = true;
        self.notice = Notice::default();
        self.region.job = Some(Job::start(move |follower| {
            skin.flatten(fabric, (NAME, &options), follower.stop_flag())
        }));
    }

    /// Takes a flattened region over into the pattern.
    pub(super) fn follow_region(&mut self) {
        if let Some(words) = self.stage.take_refusal() {
            self.say_fault(words);
        }
        if self.region.waits && !self.background_work.is_making_body() {
            self.toggle_loop();
        }
        let Some(laid) = &mut self.stage.laid else {
            // The loop was that of another body.
            self.region.job = None;
            return;
        };
        let Some(result) = self.region.job.as_ref().and_then(Job::result) else {
            return;
        };
        self.region.job = None;
        laid.is_held = false;
        let flat = match result {
            Ok(flat) => flat,
            Err(words) => return self.say_fault(words),
        };
        let made = Evaluation::new(&flat.pattern, self.session.project().drafted_to());
        let at = self.place_beside();
        let pasted = plan::insert_pattern(&self.base, &made, at);
        self.take_pasted(pasted, "Make panel of a region");
        self.view.fit();
        if self.notice.is_fault() {
            return;
        }
        if let Some(laid) = &mut self.stage.laid {
            laid.show_strain(&flat);
        }
        let report = &flat.report;
        let darts = match report.darts.len() {
            0 => "no dart".to_owned(),
            1 => "1 dart".to_owned(),
            count => format!("{count} darts"),
        };
        let words = format!(
            "Made a panel of {:.0} cm\u{b2} with {darts}; the cloth stretches or is pressed by up to {:.1} % on 99 % of it",
            1e4 * report.panel_area_m2,
            100.0 * report.stretch_99
        );
        self.notice = match report.notes.is_empty() {
            true => Notice::news(words),
            false => Notice::warning(format!("{words}; {}", report.notes.join("; "))),
        };
    }
}
