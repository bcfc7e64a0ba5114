//! The session: the project, what is derived from it, its history and its journal.

use crate::derived::Derived;
use crate::drape::Drape;
use crate::fitting::{document_text, files_to_try_on};
use crate::history::{History, HistoryStep};
use crate::input::is_pipe;
use crate::journal::Journal;
use crate::output::cannot;
use crate::product::garment_obj;
use crate::sizes::{SizedDiagnostic, sized_diagnostics, sizes_to_check};
use crate::timing::Timing;
use crate::watcher::ProgressShare;
use crate::{
    Command, DrapeResult, Draped, Event, GarmentJob, PanelOrigin, Project, SessionError, Watcher,
};
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;
use toile_body::Mannequin;
use toile_interchange::ObjMesh;
use toile_pattern::{Diagnostic, Draft, Edit, Evaluation, SizeSelection};

/// Edits that are shown and not committed yet.
#[derive(Clone)]
pub(crate) struct Gesture {
    /// The project before the gesture.
    pub base: Project,
    /// Values derived from that project.
    pub derived: Derived,
    pub edits: Vec<Edit>,
}

/// The application without a window.
#[derive(Default)]
pub struct Session {
    pub(crate) project: Project,
    pub(crate) revision: u64,
    pub(crate) history: History,
    pub(crate) journal: Journal,
    pub(crate) derived: Derived,
    pub(crate) gesture: Option<Gesture>,
    /// The project as it was last read from or saved to its file.
    pub(crate) saved: Project,
    pub(crate) timing: Timing,
    /// The point of the body that the panels of opened files are placed round.
    pub(crate) origin: PanelOrigin,
}

impl Session {
    /// A session with an empty project.
    pub fn new() -> Self {
        Self::default()
    }

    /// A session of a project that was opened.
    pub fn of(project: Project) -> Self {
        Self {
            saved: project.clone(),
            project,
            ..Self::default()
        }
    }

    /// The project.
    pub fn project(&self) -> &Project {
        &self.project
    }

    /// Number of the project's present state. It only grows.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Label of the step that Undo would undo.
    pub fn can_undo(&self) -> Option<&str> {
        self.history.can_undo()
    }

    /// Label of the step that Redo would redo.
    pub fn can_redo(&self) -> Option<&str> {
        self.history.can_redo()
    }

    /// Labels of the steps that can be undone, the oldest first.
    pub fn past(&self) -> Vec<&str> {
        self.history.past().collect()
    }

    /// The last steps that can be undone, the newest first, to be kept by
    /// [`Recovery::keep`](crate::Recovery::keep).
    pub fn steps_to_keep(&self) -> Vec<HistoryStep> {
        self.history.to_keep()
    }

    /// Labels of the steps that can be redone, the next first.
    pub fn future(&self) -> Vec<&str> {
        self.history.future().collect()
    }

    /// The commands that were done, in order: all, or the latest thousand.
    pub fn journal(&self) -> Vec<Command> {
        self.journal.commands()
    }

    /// Whether the pattern, or how its garment is tried on, has changes that are in no file.
    pub fn is_unsaved(&self) -> bool {
        !self.saved.says_the_same(&self.project)
    }

    /// Evaluation of all values of the pattern in the project's size.
    pub fn evaluation(&mut self) -> Arc<Evaluation> {
        self.derived.evaluation(&self.project)
    }

    /// The pattern drafted to the project's size, in its fabric.
    pub fn draft(&mut self) -> Arc<Draft> {
        self.derived.draft(&self.project)
    }

    /// Everything found wrong with the pattern.
    pub fn diagnostics(&mut self) -> Arc<Vec<Diagnostic>> {
        self.derived.diagnostics(&self.project)
    }

    /// Everything found wrong with the pattern in the sizes asked for. Without `sizes`, in the size that was
    /// chosen for the project, else in all sizes, or as drafted to the body if a body was chosen.
    ///
    /// # Errors
    /// A size that the pattern does not have.
    pub fn diagnostics_by_size(
        &self,
        sizes: Option<&SizeSelection>,
    ) -> Result<Vec<SizedDiagnostic>, SessionError> {
        let usual = sizes_to_check(&self.project);
        sized_diagnostics(&self.project, sizes.unwrap_or(&usual))
    }

    /// The mannequin of the project's wearer.
    ///
    /// # Errors
    /// Measurements no body can have.
    pub fn mannequin(&mut self) -> Result<Arc<Mannequin>, SessionError> {
        self.derived.mannequin(&self.project)
    }

    /// The garment ready to be sewn and draped.
    ///
    /// # Errors
    /// A pattern or measurements from which no garment can be made.
    pub fn garment_setup(&mut self) -> Result<GarmentJob, SessionError> {
        let job = self.derived.job(&self.project)?;
        Ok(GarmentJob {
            revision: self.revision,
            ..job
        })
    }

    /// The drape of the present project, if it was made.
    pub(crate) fn present_drape(&self) -> Option<Arc<Drape>> {
        self.derived.drape.clone()
    }

    /// The drape of the present project in a few numbers, if it was made.
    pub fn draped(&self) -> Option<Draped> {
        self.derived.drape.as_ref().map(|drape| drape.summary())
    }

    /// The mesh of the present project's garment as it hangs, if it was draped: welded, one group for each panel,
    /// texture coordinates in the planes of the pieces (m).
    pub fn draped_mesh(&self) -> Option<ObjMesh> {
        self.derived.drape.as_ref().map(|drape| garment_obj(drape))
    }

    /// Adopts a drape that ran live, as if it had been made by a command: it is recorded in the journal, and
    /// later exports show it. The result is discarded, and `None` is returned, if it was made from another
    /// revision of the project, or while a gesture is previewed.
    pub fn adopt_drape(&mut self, result: DrapeResult) -> Option<Vec<Event>> {
        if self.gesture.is_some() || result.revision() != self.revision {
            return None;
        }
        self.journal.push(Command::Drape {
            inputs: result.inputs().to_vec(),
        });
        self.timing.add_seconds("drape", result.seconds);
        let events = result.drape.events();
        self.derived.drape = Some(result.drape);
        Some(events)
    }

    /// Executes a command and records it in the journal. A gesture that is being previewed is
    /// cancelled.
    ///
    /// # Errors
    /// The reason why it was not done; the project is then unchanged.
    pub fn execute(
        &mut self,
        command: Command,
        watcher: &mut dyn Watcher,
    ) -> Result<Vec<Event>, SessionError> {
        self.cancel();
        let start = Instant::now();
        if matches!(command, Command::OpenPattern { .. }) {
            self.timing.restart();
        }
        let name: &str = (&command).into();
        tracing::info!(command = name, "command begins");
        let events = self.perform(&command, watcher)?;
        tracing::info!(
            command = name,
            seconds = start.elapsed().as_secs_f64(),
            "command done"
        );
        if let Some(stage) = command.stage() {
            self.timing.add(stage, start);
        }
        let more = match matches!(
            command,
            Command::OpenPattern { .. } | Command::RestorePattern { .. }
        ) {
            true => {
                let read = events.iter().filter_map(Event::file_read);
                let read = read.flat_map(|found| found.companions.clone());
                read.chain(files_to_try_on(&self.project)).collect()
            }
            false => Vec::new(),
        };
        self.journal.push_with(self.lasting(command)?, &more);
        Ok(events)
    }

    /// The command in a form that can be executed again: the content of a pattern that came through a pipe is
    /// stored in it.
    fn lasting(&self, command: Command) -> Result<Command, SessionError> {
        if let Command::OpenPattern { path, .. } = &command
            && is_pipe(path)
        {
            return Ok(Command::RestorePattern {
                text: document_text(&self.project, None).map_err(cannot("journal.jsonl"))?,
                source: None,
                past: Vec::new(),
            });
        }
        Ok(command)
    }

    /// Executes several commands; progress runs once from 0 to 1 over all of them.
    ///
    /// # Errors
    /// The error of the first command that was not done; those before it stay done.
    pub fn execute_all(
        &mut self,
        commands: &[Command],
        watcher: &mut dyn Watcher,
    ) -> Result<Vec<Event>, SessionError> {
        let total: f64 = commands.iter().map(Command::weight).sum();
        let mut done = 0.0;
        let mut events = Vec::new();
        for command in commands {
            let next = done + command.weight();
            let mut part = ProgressShare::new(watcher, done / total, next / total);
            events.extend(self.execute(command.clone(), &mut part)?);
            done = next;
        }
        Ok(events)
    }

    /// Executes the commands of a journal in a new session and writes all their output into one folder. Apart
    /// from `timing.json`, the files have the same bytes as those of the first execution.
    ///
    /// # Errors
    /// The error of the first command that was not done.
    pub fn replay(
        commands: &[Command],
        folder: &Path,
        watcher: &mut dyn Watcher,
    ) -> Result<(Self, Vec<Event>), SessionError> {
        let mut session = Self::new();
        let commands = crate::output::redirected(commands, folder);
        let events = session.execute_all(&commands, watcher)?;
        Ok((session, events))
    }
}
