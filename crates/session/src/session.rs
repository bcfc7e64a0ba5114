//! The session: the project, what is derived from it, its history and its journal.

use crate::derived::{Derived, fabric_named};
use crate::history::History;
use crate::open::open_pattern;
use crate::watcher::{Part, tell};
use crate::{Assembled, BodyChoice, Command, Event, GarmentJob, Project, SessionError, Watcher};
use std::path::Path;
use std::sync::Arc;
use toile_body::{Figure, Mannequin};
use toile_pattern::{Diagnostic, Draft, Edit, Severity};

/// The application without a window.
#[derive(Default)]
pub struct Session {
    project: Project,
    revision: u64,
    history: History,
    journal: Vec<Command>,
    derived: Derived,
}

impl Session {
    /// A session with an empty project.
    pub fn new() -> Self {
        Self::default()
    }

    /// The project.
    pub fn project(&self) -> &Project {
        &self.project
    }

    /// Number of the project's present state. It only grows.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Label of the step that Undo would take back.
    pub fn can_undo(&self) -> Option<&str> {
        self.history.can_undo()
    }

    /// Label of the step that Redo would do again.
    pub fn can_redo(&self) -> Option<&str> {
        self.history.can_redo()
    }

    /// Every command that was done, in order.
    pub fn journal(&self) -> &[Command] {
        &self.journal
    }

    /// The pattern drafted to the project's size, in its fabric.
    pub fn draft(&mut self) -> Arc<Draft> {
        self.derived.drafted(&self.project).0
    }

    /// Everything found wrong with the pattern.
    pub fn diagnostics(&mut self) -> Arc<Vec<Diagnostic>> {
        self.derived.drafted(&self.project).1
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
    /// A pattern or measurements nothing can be made from.
    pub fn garment_setup(&mut self) -> Result<GarmentJob, SessionError> {
        self.derived.job(&self.project)
    }

    /// Does one command and notes it in the journal.
    ///
    /// # Errors
    /// Why it was not done; the project is then unchanged.
    pub fn execute(
        &mut self,
        command: Command,
        watcher: &mut dyn Watcher,
    ) -> Result<Vec<Event>, SessionError> {
        let events = self.perform(&command, watcher)?;
        self.journal.push(command);
        Ok(events)
    }

    /// Does several commands; progress runs once from 0 to 1 over all of them.
    ///
    /// # Errors
    /// That of the first command that was not done; those before it stay done.
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
            let mut part = Part::new(watcher, done / total, next / total);
            events.extend(self.execute(command.clone(), &mut part)?);
            done = next;
        }
        Ok(events)
    }

    /// Does the commands of a journal in a new session.
    ///
    /// # Errors
    /// That of the first command that was not done.
    pub fn replay(commands: &[Command], watcher: &mut dyn Watcher) -> Result<Self, SessionError> {
        let mut session = Self::new();
        session.execute_all(commands, watcher)?;
        Ok(session)
    }

    fn perform(
        &mut self,
        command: &Command,
        watcher: &mut dyn Watcher,
    ) -> Result<Vec<Event>, SessionError> {
        match command {
            Command::OpenPattern { path } => self.open(path, watcher),
            Command::Edit { edits, label, drag } => self.edit(edits, label, *drag),
            Command::Undo => self.travel(
                |history, now| history.undo(now),
                SessionError::Nothing {
                    action: "undo",
                    hint: "nothing was changed yet",
                },
            ),
            Command::Redo => self.travel(
                |history, now| history.redo(now),
                SessionError::Nothing {
                    action: "redo",
                    hint: "nothing was undone since the last change",
                },
            ),
            Command::SetBody {
                figure,
                measurements,
            } => self.set_body(*figure, measurements.as_deref()),
            Command::SetSize { size } => self.set_size(size.clone()),
            Command::SetFabric { fabric } => self.set_fabric(fabric.clone()),
            Command::SetWidth { width } => self.set_width(*width),
            Command::SetQuality { quality } => {
                let next = Project {
                    quality: *quality,
                    ..self.project.clone()
                };
                Ok(self.change(next, "Choose quality", None))
            }
            Command::Check => {
                tell(watcher, "checking", 0.0, "")?;
                Ok(self.check())
            }
            Command::Assemble => self.assemble(watcher),
            Command::SavePattern { .. }
            | Command::Nest
            | Command::Drape
            | Command::Export { .. } => Err(SessionError::Nothing {
                action: "do yet",
                hint: "wait for the next version",
            }),
        }
    }

    /// Puts another project in place of the present one, as a step of the history.
    fn change(&mut self, next: Project, label: &str, drag: Option<u64>) -> Vec<Event> {
        if next == self.project {
            return Vec::new();
        }
        let before = std::mem::replace(&mut self.project, next);
        self.history.record(before, label, drag);
        self.changed()
    }

    fn changed(&mut self) -> Vec<Event> {
        self.revision += 1;
        self.derived.forget();
        vec![Event::ProjectChanged {
            revision: self.revision,
        }]
    }

    fn travel(
        &mut self,
        step: impl FnOnce(&mut History, &Project) -> Option<Project>,
        refusal: SessionError,
    ) -> Result<Vec<Event>, SessionError> {
        self.project = step(&mut self.history, &self.project).ok_or(refusal)?;
        Ok(self.changed())
    }

    fn open(&mut self, path: &Path, watcher: &mut dyn Watcher) -> Result<Vec<Event>, SessionError> {
        tell(watcher, "reading", 0.0, &path.display().to_string())?;
        let opened = open_pattern(path)?;
        self.project = Project {
            pattern: Arc::new(opened.pattern),
            source: Some(path.to_owned()),
            quality: self.project.quality,
            ..Project::default()
        };
        self.history = History::default();
        let mut events = vec![Event::PatternOpened];
        events.extend(self.changed());
        events.extend(opened.notes.iter().map(|note| Event::Warned {
            message: format!("{}: {note}", path.display()),
        }));
        Ok(events)
    }

    fn edit(
        &mut self,
        edits: &[Edit],
        label: &str,
        drag: Option<u64>,
    ) -> Result<Vec<Event>, SessionError> {
        let mut pattern = (*self.project.pattern).clone();
        for edit in edits {
            pattern.apply(edit.clone())?;
        }
        let next = Project {
            pattern: Arc::new(pattern),
            ..self.project.clone()
        };
        Ok(self.change(next, label, drag))
    }

    fn set_body(
        &mut self,
        figure: Option<Figure>,
        measurements: Option<&Path>,
    ) -> Result<Vec<Event>, SessionError> {
        let body = match (figure, measurements) {
            (None, None) => BodyChoice::OfPattern,
            (Some(figure), None) => BodyChoice::Sample(figure),
            (_, Some(path)) => {
                return Err(SessionError::Unknown {
                    kind: "measurement file",
                    name: path.display().to_string(),
                    hint: "choose woman, man or mean".into(),
                });
            }
        };
        let next = Project {
            body,
            ..self.project.clone()
        };
        Ok(self.change(next, "Choose body", None))
    }

    fn set_size(&mut self, size: Option<String>) -> Result<Vec<Event>, SessionError> {
        let pattern = &self.project.pattern;
        if let Some(name) = &size
            && pattern.size(name).is_none()
        {
            let names: Vec<&str> = pattern.sizes.iter().map(|s| &*s.name).collect();
            return Err(SessionError::Unknown {
                kind: "size",
                name: name.clone(),
                hint: match names.is_empty() {
                    true => "the pattern has no table of sizes: leave the size out".into(),
                    false => format!("choose one of {}", names.join(", ")),
                },
            });
        }
        let next = Project {
            size,
            ..self.project.clone()
        };
        Ok(self.change(next, "Choose size", None))
    }

    fn set_fabric(&mut self, fabric: Option<String>) -> Result<Vec<Event>, SessionError> {
        if let Some(name) = &fabric
            && fabric_named(&self.project, name).is_none()
        {
            let own = self.project.pattern.fabrics.iter().map(|f| &*f.name);
            let mut names: Vec<&str> = own.chain(["jersey", "poplin"]).collect();
            names.sort_unstable();
            names.dedup();
            return Err(SessionError::Unknown {
                kind: "fabric",
                name: name.clone(),
                hint: format!("choose one of {}", names.join(", ")),
            });
        }
        let next = Project {
            fabric,
            ..self.project.clone()
        };
        Ok(self.change(next, "Choose fabric", None))
    }

    fn set_width(&mut self, width: Option<f64>) -> Result<Vec<Event>, SessionError> {
        if let Some(value) = width
            && !(0.05..=20.0).contains(&value)
        {
            return Err(SessionError::Number {
                what: "the width of the fabric [m]",
                value,
                hint: "give a width from 5 cm to 20 m",
            });
        }
        let next = Project {
            width,
            ..self.project.clone()
        };
        Ok(self.change(next, "Choose fabric width", None))
    }

    fn check(&mut self) -> Vec<Event> {
        let diagnostics = self.diagnostics();
        let count = |severity| {
            diagnostics
                .iter()
                .filter(|d| d.severity == severity)
                .count()
        };
        let mut events = vec![Event::Checked {
            errors: count(Severity::Error),
            warnings: count(Severity::Warning),
        }];
        events.extend(diagnostics.iter().map(|diagnostic| Event::Warned {
            message: diagnostic.to_string(),
        }));
        events
    }

    fn assemble(&mut self, watcher: &mut dyn Watcher) -> Result<Vec<Event>, SessionError> {
        tell(watcher, "meshing", 0.0, "")?;
        self.derived.mannequin(&self.project)?;
        tell(watcher, "meshing", 0.4, "mannequin made")?;
        let garment = self.derived.garment(&self.project)?;
        Ok(vec![Event::Assembled(Assembled {
            panels: garment.panels.len(),
            vertices: garment.positions.len(),
            triangles: garment.triangles.len(),
            stitches: garment.stitches.len(),
        })])
    }
}
