//! The window: what it holds, and one frame of it.

use crate::command::UiCommand;
use crate::drawing::Drawing;
use crate::making::{Making, News};
use crate::notice::Notice;
use crate::solid::first_frame;
use crate::stage_view::StageView;
use crate::table_view::{TableAction, TableView};
use crate::theme;
use eframe::egui_wgpu::RenderState;
use egui::{Panel, Ui};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use toile_pattern::Diagnostic;
use toile_session::{Command, Event, Project, Session, Silent};

/// Time between frames while something runs by itself.
const FRAME: Duration = Duration::from_millis(33);
/// Share of the window's width the 3D view begins with.
const STAGE_SHARE: f32 = 0.42;
/// Most of the window's width that the 3D view may take.
const STAGE_MOST: f32 = 0.6;

/// The window. Documents are decided on by the session alone; this holds what is seen of them.
pub struct ToileApp {
    pub(crate) session: Session,
    pub(crate) drawing: Arc<Drawing>,
    pub(crate) findings: Arc<Vec<Diagnostic>>,
    pub(crate) table: TableView,
    pub(crate) stage: StageView,
    pub(crate) making: Making,
    pub(crate) notice: Notice,
    /// Why the file that was asked for is not open.
    pub(crate) refusal: Option<String>,
    pub(crate) shows_findings: bool,
    pub(crate) asks_to_close: bool,
    pub(crate) closes: bool,
    revision: Option<u64>,
    checked: Option<u64>,
    body_of: Option<Project>,
    title: String,
}

impl ToileApp {
    /// A window with a pattern in it, if the file can be opened; else with a message why not.
    /// Without a graphics card the 3D view says so, and all else works.
    pub fn new(context: &egui::Context, state: Option<&RenderState>, file: Option<&Path>) -> Self {
        theme::apply(context);
        let mut app = Self {
            session: Session::new(),
            drawing: Arc::default(),
            findings: Arc::default(),
            table: TableView::default(),
            stage: StageView::new(state),
            making: Making::default(),
            notice: Notice::default(),
            refusal: None,
            shows_findings: false,
            asks_to_close: false,
            closes: false,
            revision: None,
            checked: None,
            body_of: None,
            title: String::new(),
        };
        if let Some(file) = file {
            app.open(file);
        }
        app
    }

    /// The session: the document and everything derived from it.
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// What is found wrong with the pattern.
    pub fn findings(&self) -> &[Diagnostic] {
        &self.findings
    }

    /// The pattern view.
    pub fn table(&self) -> &TableView {
        &self.table
    }

    /// The 3D view.
    pub fn stage(&self) -> &StageView {
        &self.stage
    }

    /// Opens a pattern in place of the present one.
    pub fn open(&mut self, path: &Path) {
        let command = Command::OpenPattern {
            path: path.to_owned(),
        };
        if !self.execute(command) && self.drawing.panels.is_empty() {
            self.refusal = Some(self.notice.text.clone());
            self.notice = Notice::default();
        }
    }

    /// Gives a command to the session; says whether it was done. What came of it is shown.
    pub(crate) fn execute(&mut self, command: Command) -> bool {
        match self.session.execute(command, &mut Silent) {
            Ok(events) => {
                self.hear(&events);
                true
            }
            Err(error) => {
                self.notice = Notice::fault(error.to_string());
                false
            }
        }
    }

    pub(crate) fn hear(&mut self, events: &[Event]) {
        let opened = events.contains(&Event::PatternOpened);
        if !events.is_empty() {
            self.notice = Notice::default();
        }
        self.refresh();
        if opened {
            self.refusal = None;
            self.table.opened(&self.drawing);
            self.making.clear();
            self.stage.clear_garment();
        }
        for event in events {
            match event {
                Event::Warned { message } => self.notice = Notice::warning(message),
                Event::FilesWritten { paths } => {
                    let names: Vec<_> = paths.iter().map(|p| p.display().to_string()).collect();
                    self.notice = Notice::news(format!("Saved {}", names.join(", ")));
                }
                _ => {}
            }
        }
    }

    /// Follows the session to its present revision.
    pub(crate) fn refresh(&mut self) {
        if self.revision != Some(self.session.revision()) {
            self.revision = Some(self.session.revision());
            let draft = self.session.draft();
            let evaluation = self.session.evaluation();
            self.drawing = Arc::new(Drawing::new(&evaluation, &draft));
            self.table.changed(&self.drawing);
            self.follow_body();
        }
        // Checks may take longer than a frame: they wait until a drag is over.
        if self.checked != self.revision && !self.session.is_previewing() {
            self.checked = self.revision;
            self.findings = self.session.diagnostics();
        }
    }

    /// Has another mannequin made when the wearer is another.
    fn follow_body(&mut self) {
        let project = self.session.project();
        let same = self
            .body_of
            .as_ref()
            .is_some_and(|of| of.figure() == project.figure() && of.wearer() == project.wearer());
        if !same {
            self.body_of = Some(project.clone());
            self.making.start_body(&self.session);
        }
    }

    /// Whether the pattern has changes that are in no file.
    pub fn is_unsaved(&self) -> bool {
        self.session.is_unsaved()
    }

    fn take_news(&mut self) {
        for news in self.making.news(&mut self.session) {
            match news {
                News::Body => {
                    if let Ok(mannequin) = self.session.mannequin() {
                        self.stage.set_body(mannequin.skin());
                    }
                }
                News::Begun(job) => {
                    self.stage.set_garment(&job);
                    self.stage.set_frame(&first_frame(&job));
                }
                News::Frame(frame) => self.stage.set_frame(&frame),
                News::Finished(events) => {
                    let warned = events.into_iter().filter_map(|event| match event {
                        Event::Warned { message } => Some(message),
                        _ => None,
                    });
                    let warned: Vec<String> = warned.collect();
                    self.notice = match warned.is_empty() {
                        true => Notice::news("The garment hangs at rest"),
                        false => Notice::warning(warned.join("; ")),
                    };
                }
                News::Failed(words) => self.notice = Notice::fault(words),
            }
        }
    }

    fn take_files(&mut self, context: &egui::Context) {
        let dropped = context.input(|input| {
            let files = input.raw.dropped_files.iter();
            files.map(|file| file.path().to_owned()).next_back()
        });
        match dropped {
            Some(path) if !self.is_unsaved() => self.open(&path),
            Some(_) => {
                self.notice = Notice::fault(
                    "The pattern has changes that are not saved: save it, or undo them, \
                     then drop the file again",
                );
            }
            None => {}
        }
    }

    fn name_window(&mut self, context: &egui::Context) {
        let name = &self.session.project().pattern.name;
        let mark = if self.is_unsaved() { " \u{2022}" } else { "" };
        let title = match name.is_empty() {
            true => "Toile".to_owned(),
            false => format!("{name}{mark} \u{2013} Toile"),
        };
        if title != self.title {
            self.title.clone_from(&title);
            context.send_viewport_cmd(egui::ViewportCommand::Title(title));
        }
    }

    /// One frame of the window.
    pub fn show(&mut self, ui: &mut Ui) {
        let context = ui.ctx().clone();
        self.take_files(&context);
        for command in UiCommand::pressed(&context) {
            if self.can(command) {
                self.run(command);
            }
        }
        self.nudge(&context);
        self.take_news();
        self.refresh();
        self.name_window(&context);
        Panel::top("toolbar")
            .frame(theme::bar())
            .resizable(false)
            .show(ui, |ui| self.toolbar(ui));
        Panel::bottom("status")
            .frame(theme::bar())
            .resizable(false)
            .show(ui, |ui| self.status(ui));
        if self.shows_findings {
            Panel::bottom("findings")
                .frame(theme::bar())
                .default_size(150.0)
                .resizable(true)
                .show(ui, |ui| self.list_findings(ui));
        }
        let width = ui.available_width();
        Panel::right("stage")
            .frame(egui::Frame::new())
            .resizable(true)
            .default_size(width * STAGE_SHARE)
            .size_range(240.0..=(width * STAGE_MOST).max(240.0))
            .show(ui, |ui| self.stage_side(ui));
        egui::CentralPanel::default()
            .frame(egui::Frame::new())
            .show(ui, |ui| self.table_side(ui));
        self.guard_closing(&context);
        if self.making.is_busy() {
            context.request_repaint_after(FRAME);
        }
    }

    fn table_side(&mut self, ui: &mut Ui) {
        Panel::top("selection")
            .frame(theme::bar())
            .resizable(false)
            .exact_size(crate::bars::STRIP)
            .show(ui, |ui| self.selection_strip(ui));
        let drawing = self.drawing.clone();
        let view = ui.available_rect_before_wrap();
        let seen = |app: &Self| (app.table.selection, app.table.hover, app.session.revision());
        let before = seen(self);
        for action in self.table.show(ui, &drawing) {
            self.act(action);
        }
        if seen(self) != before {
            // The bars were drawn before this was known.
            ui.ctx().request_repaint();
        }
        if drawing.panels.is_empty() {
            self.no_pattern(ui, view);
        }
    }

    fn stage_side(&mut self, ui: &mut Ui) {
        Panel::top("drape")
            .frame(theme::bar())
            .resizable(false)
            .exact_size(crate::bars::STRIP)
            .show(ui, |ui| self.drape_strip(ui));
        let view = ui.available_rect_before_wrap();
        let empty = match self.making.is_making_body() {
            true => "Making the mannequin\u{2026}",
            false => "No mannequin yet",
        };
        self.stage.show(ui, empty);
        self.drape_progress(ui, view);
    }

    fn act(&mut self, action: TableAction) {
        match action {
            TableAction::Move { panel, point, to } => self.show_moved((panel, point), to),
            TableAction::Drop => self.commit("Move point"),
            TableAction::Split { panel, edge, near } => self.split((panel, edge), Some(near)),
        }
    }
}

impl eframe::App for ToileApp {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.show(ui);
    }

    fn clear_color(&self, _visuals: &egui::Visuals) -> [f32; 4] {
        theme::BAR.to_normalized_gamma_f32()
    }
}
