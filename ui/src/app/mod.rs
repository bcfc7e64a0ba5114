//! The window: its contents, and one frame of it.
//!
//! # Decided with
//! - [`toile_session::Session`]: the document and all that is derived;
//! - [`crate::app::command_table`], [`crate::app::perform`]: commands of the window, and what they do;
//! - [`crate::app::ToileApp::refresh`], [`crate::app::ToileApp::handle_events`]: what follows on a change,
//!   and on events; checks wait for the end of a drag;
//! - [`crate::app::ToileApp::list_findings`] (`findings.rs`): faults of the pattern;
//! - [`crate::app::background_work::BackgroundWork`], [`crate::app::job::Job`]: work on other threads;
//! - [`crate::app::ToileApp::keep_unsaved`], [`crate::app::ToileApp::ask_recover`] (`welcome.rs`): state kept
//!   for recovery; offered after a crash;
//! - [`crate::app::preferences::Preferences`], [`crate::app::panes::Panes`]: settings that stay; what is on
//!   show;
//! - [`crate::app::arrange`], [`crate::app::sewing`], [`crate::app::files`]: parts copied and lined up;
//!   seams; files.
//!
//! By hand: events that are told by a message, in `handle_events`.

mod answer;
mod arrange;
mod background_work;
mod bars;
pub mod command;
pub mod command_table;
mod dialogs;
pub(crate) mod document_commands;
mod drape_views;
mod export_choice;
mod exporting;
mod file_choice;
mod files;
mod findings;
mod foreign_file;
mod garment_pane;
mod grading;
mod job;
mod layout;
mod marker_cloth;
mod marker_drop;
mod marker_laying;
mod marker_pane;
mod marker_rules;
mod notice;
mod pacing;
mod palette;
pub mod panes;
mod pattern_cards;
mod perform;
mod pick_file;
mod preferences;
mod print_choice;
mod printing;
mod region;
mod save_choice;
mod saving;
mod sewing;
pub(crate) mod tab;
mod tool_bar;
pub(crate) mod tool_commands;
mod tool_icons;
mod welcome;
mod words;

use crate::canvas::selection::Selection;
use crate::fields::TypedTexts;
use crate::gpu::solid::first_frame;
use crate::theme;
use crate::tools::{Event as ToolEvent, Tool};
use crate::views::garment::GarmentView;
use crate::views::marker::MarkerView;
use crate::views::pattern::PatternView;
use background_work::{BackgroundWork, WorkEvent};
use command_table::KeysTaken;
use dialogs::Dialog;
use eframe::egui_wgpu::RenderState;
use egui::Ui;
use exporting::{ExportMemory, Exporting};
use foreign_file::ForeignFile;
use marker_pane::{SearchChoice, Searching};
use notice::Notice;
use panes::{InspectorPlace, Panes, Tables};
use preferences::Preferences;
use printing::Printing;
use region::RegionChoice;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use toile_pattern::plan::Fragment;
use toile_pattern::{Code, Diagnostic, Evaluation};
use toile_session::{
    Abandoned, Command, Event, FoundInFile, Project, Recovery, Session, Silent, abandoned,
};

/// Time between frames while something moves by itself.
const FRAME: Duration = Duration::from_millis(33);
/// The window: a view of the document. Only the session changes the document.
pub struct ToileApp {
    pub(crate) session: Session,
    /// The evaluated pattern without the gesture that is being previewed.
    pub(crate) base: Arc<Evaluation>,
    pub(crate) findings: Arc<Vec<Diagnostic>>,
    pub(crate) view: PatternView,
    pub(crate) stage: GarmentView,
    pub(crate) marker_view: MarkerView,
    pub(crate) searching: Option<Searching>,
    pub(crate) search_choice: SearchChoice,
    pub(crate) background_work: BackgroundWork,
    pub(crate) printing: Option<Printing>,
    pub(crate) region: RegionChoice,
    pub(crate) exporting: Option<Exporting>,
    /// Whether the window closes once files are written.
    pub(crate) waits_to_close: bool,
    pub(crate) exports: ExportMemory,
    /// The parts copied last, if the clipboard still holds them.
    pub(crate) copied: Option<Fragment>,
    pub(crate) wants_clipboard: bool,
    pub(crate) notice: Notice,
    pub(crate) dialog: Option<Dialog>,
    /// Whether a menu or drop-down list was open at the start of the frame.
    pub(crate) menu_is_open: bool,
    /// Whether a field had the keyboard focus at the end of the last frame: then Escape goes to that field.
    field_had_keys: bool,
    pub(crate) tables: Tables,
    pub(crate) typed: TypedTexts,
    pub(crate) panes: Panes,
    /// Whether the tables stood beside the pattern in the last frame.
    pub(crate) tables_are_beside: bool,
    /// The selection at the moment when the drawing tool was taken in hand: the inspector does not describe
    /// this selection while the tool is used.
    pub(crate) selected_before: Option<Selection>,
    pub(crate) inspector: InspectorPlace,
    /// The file of another program that the pattern was read from, while the bar about it stands.
    pub(crate) foreign: Option<ForeignFile>,
    /// What reading the pattern's file found out, until the bar about it is made.
    file_read: Option<FoundInFile>,
    /// Reason why the requested file could not be opened.
    pub(crate) refusal: Option<String>,
    pub(crate) closes: bool,
    /// Revision of the project for which the user agreed to close the window.
    closes_at: u64,
    pub(crate) wants_theme: bool,
    /// A requested change of the scale of the interface; `Some(None)` asks for the usual scale.
    pub(crate) wants_scale: Option<Option<f32>>,
    pub(crate) preferences: Preferences,
    recovery: Option<Recovery>,
    /// Documents left by a crash, to be offered.
    pub(crate) abandoned: Vec<Abandoned>,
    /// Pictures on the first page.
    pattern_cards: pattern_cards::PatternCards,
    /// The job that saves the picture of the draped garment.
    drape_view: Option<job::Job<()>>,
    /// The project that was last handed to the recovery file.
    kept: Option<Project>,
    pub(crate) revision: Option<u64>,
    octave: i32,
    checked: Option<u64>,
    title: String,
}

/// Startup arguments of a window.
#[derive(Default)]
pub struct Beginning {
    /// The pattern to open.
    pub file: Option<PathBuf>,
    /// The user's folder for settings and recovery files; with `None` nothing is stored.
    pub folder: Option<PathBuf>,
}

impl ToileApp {
    /// A window that shows the given pattern, or a message if the file cannot be opened. Without a graphics
    /// card the 3D view shows a message, and all else works.
    pub fn new(context: &egui::Context, state: Option<&RenderState>, beginning: Beginning) -> Self {
        theme::apply(context);
        context.add_plugin(pacing::Pacing::default());
        let preferences = Preferences::read(beginning.folder.as_deref());
        preferences.apply(context);
        let mut app = Self {
            session: Session::new(),
            base: Arc::default(),
            findings: Arc::default(),
            view: PatternView::default(),
            stage: GarmentView::new(state),
            marker_view: MarkerView::default(),
            searching: None,
            search_choice: SearchChoice::default(),
            background_work: BackgroundWork::default(),
            printing: None,
            region: RegionChoice::default(),
            exporting: None,
            waits_to_close: false,
            exports: ExportMemory::default(),
            copied: None,
            wants_clipboard: false,
            notice: Notice::default(),
            dialog: None,
            menu_is_open: false,
            field_had_keys: false,
            tables: Tables::default(),
            typed: TypedTexts::default(),
            panes: preferences.panes,
            tables_are_beside: false,
            selected_before: None,
            inspector: InspectorPlace::default(),
            foreign: None,
            file_read: None,
            refusal: None,
            closes: false,
            closes_at: 0,
            wants_theme: false,
            wants_scale: None,
            preferences,
            recovery: None,
            abandoned: Vec::new(),
            pattern_cards: Default::default(),
            drape_view: None,
            kept: None,
            revision: None,
            octave: 0,
            checked: None,
            title: String::new(),
        };
        if let Some(folder) = &beginning.folder {
            app.begin_recovery(&folder.join("recovery"));
        }
        if let Some(file) = &beginning.file {
            app.open(file);
        }
        app
    }

    /// Looks for documents left by a crash, and saves unsaved work for recovery from now on.
    fn begin_recovery(&mut self, folder: &Path) {
        let found = abandoned(folder).and_then(|found| {
            self.abandoned = found;
            Recovery::start(folder)
        });
        match found {
            Ok(recovery) => self.recovery = Some(recovery),
            Err(error) => {
                self.notice = Notice::warning(format!(
                    "{}: {error}: unsaved work will not survive a crash; save often",
                    folder.display()
                ));
            }
        }
        if !self.abandoned.is_empty() {
            self.dialog = Some(Dialog::Recover);
        }
    }

    /// The session: the document and everything derived from it.
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// Findings on the pattern.
    pub fn findings(&self) -> &[Diagnostic] {
        &self.findings
    }

    /// The pattern view.
    pub fn view(&self) -> &PatternView {
        &self.view
    }

    /// The marker view.
    pub fn marker_view(&self) -> &MarkerView {
        &self.marker_view
    }

    /// The 3D view.
    pub fn stage(&self) -> &GarmentView {
        &self.stage
    }

    /// The evaluated pattern without the gesture that is being previewed.
    pub fn base(&self) -> &Evaluation {
        &self.base
    }

    /// Reason why the last request failed.
    pub fn fault(&self) -> Option<&str> {
        self.notice.is_fault().then_some(&*self.notice.text)
    }

    /// Gives an event to the tool in hand, as the canvas does.
    pub fn give(&mut self, event: &ToolEvent) {
        let outcome = self.view.step(event, &self.base);
        self.follow_outcome(outcome);
    }

    /// Gives a command to the session, and shows the result; returns whether it succeeded.
    pub fn execute(&mut self, command: Command) -> bool {
        match self.session.execute(command, &mut Silent) {
            Ok(events) => {
                self.forget_fault();
                self.handle_events(&events);
                true
            }
            Err(error) => {
                self.notice = Notice::fault(error.to_string());
                self.refresh();
                false
            }
        }
    }

    /// Clears the message of an earlier failure, once something has succeeded.
    pub(crate) fn forget_fault(&mut self) {
        if self.notice.is_fault() {
            self.notice = Notice::default();
        }
    }

    /// Performs a command of the window.
    pub(crate) fn command(&mut self, command: &command::UiCommand) {
        self.forget_fault();
        (command.does)(self);
    }

    /// Applies events of the session to the window: notices, views, the garment.
    pub(crate) fn handle_events(&mut self, events: &[Event]) {
        let opened = events.contains(&Event::PatternOpened);
        if opened {
            self.foreign = None;
            self.file_read = events.iter().find_map(Event::file_read).cloned();
            self.tables.wearer.forget();
        }
        if !events.is_empty() {
            self.notice = Notice::default();
        }
        self.refresh();
        if opened {
            self.refusal = None;
            self.view.opened(&self.base.pattern().clone());
            self.tables.forget_typed();
            self.end_loop();
            self.background_work.clear();
            self.stage.clear_garment();
            if let Some(path) = self.session.project().source.clone() {
                self.preferences.opened(&path);
            }
        }
        for event in events {
            if let Event::FilesWritten { paths } = event {
                let names: Vec<_> = paths.iter().map(|p| p.display().to_string()).collect();
                self.notice = Notice::news(format!("Saved {}", names.join(", ")));
                if let Some(path) = self.session.project().source.clone() {
                    self.preferences.opened(&path);
                }
            }
        }
        let warned = events.iter().filter_map(|event| match event {
            Event::Warned { message } => Some(&**message),
            _ => None,
        });
        let warned: Vec<&str> = warned.collect();
        if !warned.is_empty() {
            self.notice = Notice::warning(warned.join("; "));
        }
    }

    /// Brings the window up to the present revision of the session, and to the present enlargement.
    pub(crate) fn refresh(&mut self) {
        let octave = self.view.camera.octave();
        let is_new = self.revision != Some(self.session.revision());
        if is_new || octave != self.octave {
            self.revision = Some(self.session.revision());
            self.octave = octave;
            let draft = self.session.draft();
            let evaluation = self.session.evaluation();
            let previews = self.session.is_previewing();
            self.view.follow(&evaluation, &draft, previews);
            if !previews {
                self.base = evaluation;
                if is_new && self.view.grading.is_some() {
                    self.view.grading = Some(self.graded());
                }
                self.follow_marker();
            }
        }
        // Checks may take longer than a frame: they wait until a gesture is over.
        if self.checked != self.revision && !self.session.is_previewing() {
            self.checked = self.revision;
            let mut found = self.session.diagnostics();
            if self.base.pattern().seams.is_empty() {
                // While there is no seam at all, a piece without seams is no mistake.
                Arc::make_mut(&mut found).retain(|found| found.code != Code::NotSewn);
            }
            let before = std::mem::replace(&mut self.findings, found);
            self.mark_findings();
            self.tell_new_fault(&before);
        }
        self.keep_unsaved();
    }

    /// Saves the unsaved state of the document for recovery.
    fn keep_unsaved(&mut self) {
        let Some(recovery) = &self.recovery else {
            return;
        };
        let project = self.session.project();
        let is_kept = |kept: &Project| kept.says_the_same(project);
        if self.session.is_unsaved() {
            if !self.kept.as_ref().is_some_and(is_kept) {
                recovery.keep(project, self.session.steps_to_keep());
                self.kept = Some(project.clone());
            }
        } else if self.kept.take().is_some() {
            recovery.clear();
        }
        if let Some(words) = recovery.failure() {
            self.notice = Notice::warning(format!(
                "unsaved work cannot be kept for recovery: {words}; save often"
            ));
        }
    }

    /// Discards the recovery file: the unsaved changes were given up.
    fn forget_recovery(&mut self) {
        if let Some(recovery) = &self.recovery {
            recovery.clear();
        }
    }

    /// Whether the pattern has changes that are in no file.
    pub fn is_unsaved(&self) -> bool {
        self.session.is_unsaved()
    }

    /// Whether text is typed into a field.
    pub(crate) fn types(&self, context: &egui::Context) -> bool {
        context.text_edit_focused()
    }

    fn take_news(&mut self) {
        for news in self.background_work.news(&mut self.session) {
            match news {
                WorkEvent::Body => {
                    if let Ok(mannequin) = self.session.mannequin() {
                        self.stage.set_body(mannequin.skin());
                    }
                }
                WorkEvent::Undressed => self.stage.clear_garment(),
                WorkEvent::Begun(job) => {
                    if let Some(skin) = job.setup.colliders.first() {
                        self.stage.set_body(skin.mesh());
                    }
                    self.stage.set_frame(first_frame(&job));
                }
                WorkEvent::Frame(frame) => self.stage.set_frame(frame),
                WorkEvent::Finished(events) => {
                    self.keep_drape_view();
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
                WorkEvent::Warned(words) => self.notice = Notice::warning(words.join("; ")),
                WorkEvent::Failed(words) => self.notice = Notice::fault(words),
            }
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
        let on_marker = context.memory(|memory| memory.has_focus(MarkerView::id()));
        let typing =
            self.types(&context) || self.view.is_typing() || self.dialog.is_some() || on_marker;
        // During a gesture of a tool the canvas takes Escape, to go back one step; while a menu is open
        // Escape closes it; in a field it reverts the typed text.
        self.menu_is_open = egui::Popup::is_any_open(&context);
        let keys = KeysTaken {
            typing,
            text: self.types(&context),
            empty: crate::tables::is_empty_field(&context),
            tool: self.view.tool.takes_keys(),
            walks: matches!(self.view.tool, Tool::Walk),
            escape: self.menu_is_open || self.view.is_busy() || self.field_had_keys,
            modal: self.dialog.is_some(),
        };
        let pressed = command_table::pressed(&context, keys);
        for command in pressed.commands {
            if (command.when)(self) {
                self.command(command);
            }
        }
        if let Some(command) = pressed.held {
            self.notice = Notice::fault(format!(
                "{}: its key is for the pattern alone while a tool is in hand. Home shows everything, \
                 Esc puts the tool down",
                command.name
            ));
        }
        self.take_picked_colour(&context);
        self.nudge(&context);
        self.take_clipboard(&context);
        self.take_news();
        self.follow_printing();
        self.follow_export();
        self.follow_search();
        self.follow_region();
        self.refresh();
        self.name_window(&context);
        if std::mem::take(&mut self.wants_theme) {
            self.preferences.change_theme(&context);
        }
        if let Some(step) = self.wants_scale.take() {
            self.preferences.change_scale(&context, step);
        }
        self.parts(ui);
        self.preferences.set_shows(self.panes);
        self.preferences.note_window(&context);
        self.show_dialog(&context);
        self.guard_closing(&context);
        self.field_had_keys = self.types(&context);
        let works = self.printing.is_some()
            || self.is_exporting()
            || self.searching.is_some()
            || self.region.is_busy();
        if self.background_work.is_busy() || works {
            context.request_repaint_after(FRAME);
        }
    }

    pub(super) fn pattern_side(&mut self, ui: &mut Ui) {
        let seen = |app: &Self| {
            let hover = app.view.hover.map(|hit| hit.item);
            (app.view.selection.clone(), hover, app.session.revision())
        };
        let before = seen(self);
        let base = self.base.clone();
        self.view.allowances = self.panes.allowances;
        self.view.rulers = self.panes.rulers;
        self.view.guides = self.panes.guides;
        self.view.is_covered = self.dialog.is_some() || self.menu_is_open;
        let canvas = ui.available_rect_before_wrap();
        // The inspector comes before the canvas: a click on a part may insert the part's length into a
        // number that is being typed there.
        self.show_inspector(ui, canvas);
        self.view.click_is_taken |= self.typed.took_click();
        for outcome in self.view.show(ui, &base) {
            self.follow_outcome(outcome);
        }
        // Guides become visible when one is dragged out of a ruler.
        self.panes.guides = self.view.guides;
        if std::mem::take(&mut self.view.asks_guide_place) {
            self.ask_guide_place(ui);
        }
        self.canvas_menu();
        if seen(self) != before {
            // The bars were drawn before this change: another frame is needed.
            ui.ctx().request_repaint();
        }
    }
}

impl eframe::App for ToileApp {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.show(ui);
    }

    fn on_exit(&mut self) {
        self.preferences.write_window();
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }
}
