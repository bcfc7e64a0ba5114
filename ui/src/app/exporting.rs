//! Exports, on a thread of their own.

use super::ToileApp;
use super::dialogs::Dialog;
use super::export_choice::ExportChoice;
use super::garment_pane::ended_words;
use super::job::Job;
use super::notice::Notice;
use egui::Ui;
use std::path::PathBuf;
use toile_session::{Command, Event, ExportFormat, Session};

/// An export in progress.
pub struct Exporting {
    job: Job<Exported>,
    /// The settings, with which the dialog opens again if the export fails.
    choice: ExportChoice,
    is_stopped: bool,
}

/// Result of an export.
struct Exported {
    session: Session,
    events: Vec<Event>,
}

/// Memory of exports while the window is open.
#[derive(Default)]
pub struct ExportMemory {
    /// The last settings, and the pattern file they were for.
    last: Option<(ExportChoice, Option<PathBuf>)>,
    /// Files that this window has written: these are replaced without asking.
    written: Vec<PathBuf>,
}

/// Largest number of files that the message after an export names; of more files it tells the number.
const NAMED: usize = 3;

impl ToileApp {
    pub(crate) fn ask_export(&mut self) {
        let mut choice = self.export_choice();
        if choice.formats.is_empty() {
            let usual = ExportFormat::ALL.into_iter().filter(|f| f.is_usual());
            choice.formats = usual.filter(|f| *f != ExportFormat::Journal).collect();
        }
        self.dialog = Some(Dialog::Export(Box::new(choice)));
    }

    pub(crate) fn ask_export_dxf(&mut self) {
        let choice = ExportChoice {
            formats: vec![ExportFormat::MarkerDxf],
            ..self.export_choice()
        };
        self.dialog = Some(Dialog::Export(Box::new(choice)));
    }

    /// Settings to begin the dialog with: those of the last export, with the marker that is laid now. For
    /// another pattern file than last time the folder is set anew, beside that file.
    fn export_choice(&self) -> ExportChoice {
        let project = self.session.project();
        let last = self.exports.last.as_ref();
        let (kept, of) = last.map_or((None, None), |(kept, of)| (Some(kept), of.as_ref()));
        let mut choice = kept.cloned().unwrap_or_default();
        choice.replaced.clear();
        choice.fault.clear();
        choice.lost.clear();
        if kept.is_none() || of != project.source.as_ref() {
            let source = project.source.as_ref();
            let stem =
                source.and_then(|path| Some(path.file_name()?.to_string_lossy().into_owned()));
            let stem = stem.unwrap_or_else(|| project.pattern.name.clone());
            let stem = stem.split('.').next().unwrap_or("pattern");
            let beside = source.and_then(|path| path.parent()).map(PathBuf::from);
            let folder = beside.unwrap_or_default().join(format!("{stem}-export"));
            choice.folder = folder.display().to_string();
        }
        choice.marker = self.laid_marker();
        choice
    }

    /// Name of the marker on show, or else of the first marker; `None` if no piece is laid on it.
    fn laid_marker(&self) -> Option<String> {
        let marker = self
            .marker_id()
            .and_then(|id| self.base.pattern().marker(id))?;
        (!marker.placements.is_empty()).then(|| marker.name.clone())
    }

    /// Whether this window has written all these files by exports.
    pub(super) fn has_exported(&self, files: &[PathBuf]) -> bool {
        files.iter().all(|file| self.exports.written.contains(file))
    }

    pub(crate) fn is_exporting(&self) -> bool {
        self.exporting.is_some()
    }

    /// Whether an export or a print is in progress.
    pub(super) fn is_writing(&self) -> bool {
        self.is_exporting() || self.printing.is_some()
    }

    pub(super) fn stop_writing(&mut self) {
        self.stop_export();
        self.stop_printing();
    }

    pub(super) fn export(&mut self, choice: ExportChoice) {
        self.notice = Notice::default();
        let source = self.session.project().source.clone();
        self.exports.last = Some((choice.clone(), source));
        let export = Command::Export(choice.export());
        let mut session = self.session.snapshot_to_export();
        self.exporting = Some(Exporting {
            job: Job::start(move |follower| {
                let events = session.execute(export, follower)?;
                Ok(Exported { session, events })
            }),
            choice,
            is_stopped: false,
        });
    }

    /// Reports an export that has ended. After a failure the dialog opens again, with the reason.
    pub(super) fn follow_export(&mut self) {
        let ended = self.exporting.as_ref().and_then(|own| own.job.result());
        let Some(result) = ended else { return };
        let Some(exporting) = self.exporting.take() else {
            return;
        };
        match result {
            Ok(exported) => {
                self.session.adopt_export(exported.session);
                self.notice = self.told_export(&exporting.choice, &exported.events);
            }
            Err(_) if exporting.is_stopped => {
                self.notice = Notice::news("The export was stopped: nothing was written");
            }
            Err(fault) => {
                // The user sees the failure before the window closes.
                (self.closes, self.waits_to_close) = (false, false);
                // If another pattern was opened meanwhile, the settings do not apply to it, and the dialog
                // stays closed.
                let source = &self.session.project().source;
                let last = self.exports.last.as_ref();
                let is_of_pattern = last.is_some_and(|(_, of)| of == source);
                if self.dialog.is_none() && is_of_pattern {
                    let choice = exporting.choice;
                    let fault = fault.clone();
                    self.dialog = Some(Dialog::Export(Box::new(ExportChoice { fault, ..choice })));
                }
                self.notice = Notice::fault(fault);
            }
        }
    }

    /// The message after an export: files written, verdict on the garment, warnings.
    fn told_export(&mut self, choice: &ExportChoice, events: &[Event]) -> Notice {
        let mut words = String::new();
        let mut verdict = None;
        let mut warnings = Vec::new();
        for event in events {
            match event {
                Event::FilesWritten { paths } => {
                    let names = paths.iter().filter_map(|path| path.file_name());
                    let names: Vec<_> = names.map(|name| name.to_string_lossy()).collect();
                    let what = match names.len() {
                        0..=NAMED => names.join(", "),
                        count => format!("{count} files"),
                    };
                    words = format!("Exported {what} to {}", choice.folder.trim());
                    self.exports.written.extend(paths.iter().cloned());
                }
                Event::Draped(drape) => verdict = Some(&drape.verdict),
                Event::Warned { message } => warnings.push(message.clone()),
                _ => {}
            }
        }
        let mut is_sound = warnings.is_empty();
        if let Some(verdict) = verdict {
            is_sound &= verdict.is_sound();
            let hangs = ended_words(verdict, "the garment hangs at rest".to_owned());
            words = format!("{words}; {hangs}");
        }
        for warning in warnings {
            words = format!("{words}; {warning}");
        }
        match is_sound {
            true => Notice::news(words),
            false => Notice::warning(words),
        }
    }

    /// Progress of the export, and the button that stops it.
    pub(super) fn export_progress(&mut self, ui: &mut Ui) {
        let Some(exporting) = &self.exporting else {
            return;
        };
        let stops = ui.button("Stop export").clicked();
        let progress = exporting.job.progress();
        let share = 100.0 * progress.share;
        let words = match exporting.is_stopped {
            true => "Stopping the export\u{2026}".to_owned(),
            false => format!("Exporting: {} {share:.0} %", progress.stage),
        };
        ui.label(words).on_hover_text(progress.detail);
        if stops {
            self.stop_export();
        }
    }

    pub(crate) fn stop_export(&mut self) {
        if let Some(exporting) = &mut self.exporting {
            exporting.is_stopped = true;
            exporting.job.cancel();
        }
    }
}
