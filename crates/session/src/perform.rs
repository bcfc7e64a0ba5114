//! Performs each command on a session.

use crate::bodies::{body_of, description_of, shaped};
use crate::fabrics::chosen;
use crate::fitting::{OpenedProject, document_text, refuse_itself, try_on};
use crate::history::History;
use crate::open::{OpenOptions, open_pattern_from, read_pattern_text};
use crate::outfit::DraftedPart;
use crate::output::cannot;
use crate::watcher::{ProgressShare, report_progress};
use crate::write_pattern::{format_of, write_pattern};
use crate::{
    Assembled, BodyChoice, Command, Event, OtherGarment, PanelOrigin, PastStep, Project, Session,
    SessionError, Watcher, WornGarment, WriteOptions,
};
use std::fmt::Display;
use std::path::Path;
use std::sync::Arc;
use toile_body::{Figure, PrimitiveEdit};
use toile_drape::MAX_LAYER;
use toile_interchange::{FABRIC_WIDTHS, Fitting, write_atomically, write_mannequin};
use toile_measure::Measurements;
use toile_pattern::{Edit, EditError, Pattern, Severity, is_part_name};

/// Largest distance of the origin of panels from the floor, above or below it (m).
const HIGHEST_ORIGIN: f64 = 10.0;

type Outcome = Result<Vec<Event>, SessionError>;

impl Session {
    pub(crate) fn perform(&mut self, command: &Command, watcher: &mut dyn Watcher) -> Outcome {
        match command {
            Command::OpenPattern { path, options } => self.open(path, options, watcher),
            Command::SetOrigin { origin } => self.set_origin(*origin),
            Command::SavePattern { path } => self.save(path, watcher),
            Command::WritePattern { path, options } => self.write(path, options, watcher),
            Command::NewPattern { name } => self.start(name),
            Command::RestorePattern { text, source, past } => {
                self.restore((text, past), source.as_deref())
            }
            Command::Edit { edits, label } => self.edit(edits, label),
            Command::Undo => self.travel(History::undo, "undo", "nothing was changed yet"),
            Command::Redo => self.travel(
                History::redo,
                "redo",
                "nothing was undone since the last change",
            ),
            Command::SetBody {
                figure,
                measurements,
            } => self.set_body(*figure, measurements.as_deref()),
            Command::SetMeasurements {
                figure,
                measurements,
            } => self.set_measurements(*figure, measurements),
            Command::EditBody { edits, label } => self.edit_body(edits, label),
            Command::SaveBody { path } => self.save_body(path, watcher),
            Command::SetSize { size } => self.set_size(size.clone()),
            Command::SetFabric { fabric } => self.set_fabric(fabric.clone()),
            Command::SetWidth { width } => self.set_width(*width),
            Command::SetQuality { quality } => {
                let next = Project {
                    quality: *quality,
                    ..self.project.clone()
                };
                Ok(self.change(next, "Choose quality"))
            }
            Command::SetLayers { layer, others } => self.set_layers(*layer, others),
            Command::Check => self.check(watcher),
            Command::Nest => self.nest(watcher),
            Command::Assemble => self.assemble(watcher),
            Command::Drape { inputs } => self.drape(inputs, watcher),
            Command::Export(export) => self.export(export, watcher),
        }
    }

    /// Replaces the project, as a step of the history.
    fn change(&mut self, next: Project, label: &str) -> Vec<Event> {
        if next == self.project {
            return Vec::new();
        }
        self.history.record(self.project.clone(), label);
        self.replace(next)
    }

    fn replace(&mut self, next: Project) -> Vec<Event> {
        self.derived.follow(&self.project, &next);
        self.project = next;
        self.revision += 1;
        vec![Event::ProjectChanged {
            revision: self.revision,
        }]
    }

    fn travel(
        &mut self,
        step: impl FnOnce(&mut History, &Project) -> Option<Project>,
        action: &'static str,
        hint: &'static str,
    ) -> Outcome {
        let mut next =
            step(&mut self.history, &self.project).ok_or(SessionError::Nothing { action, hint })?;
        // The file of the pattern is not part of the history.
        next.source = self.project.source.clone();
        // An id is never given twice, not even if the part that it was given to was undone.
        let given = self.project.pattern.ids;
        let mut ids = next.pattern.ids;
        ids.next = ids.next.max(given.next);
        if ids != next.pattern.ids {
            Arc::make_mut(&mut next.pattern).ids = ids;
        }
        Ok(self.replace(next))
    }

    fn open(&mut self, path: &Path, options: &OpenOptions, watcher: &mut dyn Watcher) -> Outcome {
        report_progress(watcher, "reading", 0.0, &path.display().to_string())?;
        let OpenedProject {
            project,
            notes,
            found,
        } = Project::open_from(path, self.origin, options)?;
        let mut events = self.begin(project);
        self.saved = self.project.clone();
        events.push(Event::FileRead(found));
        events.extend(notes.iter().map(|note| Event::Warned {
            message: format!("{}: {note}", path.display()),
        }));
        Ok(events)
    }

    /// Begins a project with an empty pattern that has a sheet to draw on and a fabric to cut from.
    fn start(&mut self, name: &str) -> Outcome {
        if !is_part_name(name) {
            return Err(EditError::Name(name.to_owned()).into());
        }
        let events = self.begin(Project {
            pattern: Arc::new(Pattern::blank(name)),
            ..Project::default()
        });
        self.saved = self.project.clone();
        Ok(events)
    }

    /// Restores a pattern that is in no file, with the steps that led to it as far back as they can be read.
    fn restore(&mut self, (text, past): (&str, &[PastStep]), source: Option<&Path>) -> Outcome {
        let (next, fitting, notes) = self.restored((text, None), source)?;
        let mut worn = (fitting, next.clone());
        let mut events = self.begin(next);
        let mut steps = Vec::new();
        let mut after = text.to_owned();
        for step in past {
            let Some(before) = step.text_before(&after) else {
                break;
            };
            let Ok((project, fitting, _)) = self.restored((&before, Some(&worn)), source) else {
                break;
            };
            worn = (fitting, project.clone());
            steps.push((project, &step.label));
            after = before;
        }
        for (project, label) in steps.into_iter().rev() {
            self.history.record(project, label);
        }
        self.saved = Project::default();
        events.extend(Event::warnings(&notes));
        Ok(events)
    }

    /// Reads a pattern that is in no file as a project in the present quality; also returns its fitting, and
    /// notes. `beside` is the state that followed this one, with its fitting: if its fitting and sizes are
    /// the same, files of the fitting are not read again.
    fn restored(
        &self,
        (text, beside): (&str, Option<&(Fitting, Project)>),
        source: Option<&Path>,
    ) -> Result<(Project, Fitting, Vec<String>), SessionError> {
        let opened = read_pattern_text(text).map_err(|error| SessionError::Format {
            path: source.unwrap_or(Path::new("recovered pattern")).to_owned(),
            error,
        })?;
        let pattern = Arc::new(opened.pattern);
        if let Some((fitting, project)) = beside
            && *fitting == opened.fitting
            && project.pattern.sizes == pattern.sizes
        {
            let next = Project {
                pattern,
                ..project.clone()
            };
            return Ok((next, opened.fitting, Vec::new()));
        }
        let mut next = Project {
            pattern,
            source: source.map(Path::to_owned),
            quality: self.project.quality,
            ..Project::default()
        };
        let notes = try_on(&mut next, opened.fitting.clone(), self.origin);
        Ok((next, opened.fitting, notes))
    }

    /// Replaces the project by another document, in the present quality, with a history of its own.
    fn begin(&mut self, next: Project) -> Vec<Event> {
        let next = Project {
            quality: self.project.quality,
            ..next
        };
        self.history = std::mem::take(&mut self.history).begun_anew();
        let mut events = vec![Event::PatternOpened];
        events.extend(self.replace(next));
        events
    }

    fn save(&mut self, path: &Path, watcher: &mut dyn Watcher) -> Outcome {
        report_progress(watcher, "writing", 0.0, &path.display().to_string())?;
        let text = document_text(&self.project, Some(path)).map_err(cannot("the pattern"))?;
        write_atomically(path, text.as_bytes())?;
        // The file of a pattern is not part of the pattern: saving is no step of the history.
        self.project.source = Some(path.to_owned());
        self.saved = self.project.clone();
        let mut events = vec![Event::FilesWritten {
            paths: vec![path.to_owned()],
        }];
        if matches!(self.project.body, BodyChoice::Shaped { path: None, .. }) {
            events.push(Event::Warned {
                message:
                    "the edited mannequin is in no file, so that the pattern cannot name it: save \
                          the body, then the pattern again"
                        .to_owned(),
            });
        }
        Ok(events)
    }

    fn write(&self, path: &Path, options: &WriteOptions, watcher: &mut dyn Watcher) -> Outcome {
        report_progress(watcher, "writing", 0.0, &path.display().to_string())?;
        let format = format_of(path, options.format)?;
        let sizes = options.sizes();
        let written = write_pattern(&self.project, path, format, sizes.as_ref())?;
        let title = format.title();
        let lost = written.losses.iter();
        let lost = lost.map(|loss| format!("{title} leaves out: {loss}"));
        let mut events = vec![Event::FilesWritten {
            paths: written.files,
        }];
        events.extend(Event::warnings(&lost.collect::<Vec<_>>()));
        Ok(events)
    }

    fn edit(&mut self, edits: &[Edit], label: &str) -> Outcome {
        let next = self.project.edited(edits)?;
        Ok(self.change(next, label))
    }

    fn set_body(&mut self, figure: Option<Figure>, measurements: Option<&Path>) -> Outcome {
        let mut notes = Vec::new();
        let body = match (figure, measurements) {
            (None, None) => BodyChoice::OfPattern,
            (Some(figure), None) => BodyChoice::Sample(figure),
            (figure, Some(path)) => {
                let (body, found) = body_of(figure, path)?;
                notes = found;
                body
            }
        };
        let next = Project {
            body,
            ..self.project.clone()
        };
        let mut events = self.change(next, "Choose body");
        events.extend(Event::warnings(&notes));
        Ok(events)
    }

    fn set_measurements(&mut self, figure: Option<Figure>, measurements: &Measurements) -> Outcome {
        if let Some((name, value)) = measurements.impossible() {
            return Err(SessionError::Measurement {
                name: name.to_owned(),
                value,
            });
        }
        let next = Project {
            body: BodyChoice::Measured {
                figure: figure.unwrap_or_else(|| self.project.figure()),
                path: None,
                measurements: Arc::new(measurements.clone()),
            },
            ..self.project.clone()
        };
        Ok(self.change(next, "Set measurements"))
    }

    fn edit_body(&mut self, edits: &[PrimitiveEdit], label: &str) -> Outcome {
        let edited = description_of(&self.project).edited(edits)?;
        let next = Project {
            body: shaped(edited, None)?,
            ..self.project.clone()
        };
        Ok(self.change(next, label))
    }

    fn save_body(&mut self, path: &Path, watcher: &mut dyn Watcher) -> Outcome {
        report_progress(watcher, "writing", 0.0, &path.display().to_string())?;
        let text =
            write_mannequin(&description_of(&self.project)).map_err(cannot("the mannequin"))?;
        write_atomically(path, text.as_bytes())?;
        // Like the file of a pattern, the file of an edited body is not part of the history.
        if let BodyChoice::Shaped {
            path: kept @ None, ..
        } = &mut self.project.body
        {
            *kept = Some(path.to_owned());
        }
        Ok(vec![Event::FilesWritten {
            paths: vec![path.to_owned()],
        }])
    }

    fn set_size(&mut self, size: Option<String>) -> Outcome {
        let next = Project {
            size,
            ..self.project.clone()
        };
        next.check_size()?;
        Ok(self.change(next, "Choose size"))
    }

    fn set_fabric(&mut self, fabric: Option<String>) -> Outcome {
        let (fabric, notes) = match &fabric {
            Some(asked) => {
                let (choice, notes) = chosen(&self.project.pattern, asked)?;
                (Some(choice), notes)
            }
            None => (None, Vec::new()),
        };
        let next = Project {
            fabric,
            ..self.project.clone()
        };
        let warned = notes.into_iter().map(|message| Event::Warned { message });
        let mut events: Vec<Event> = warned.collect();
        events.extend(self.change(next, "Choose fabric"));
        events.extend(Event::warnings(&self.kept_by_markers()));
        Ok(events)
    }

    fn set_width(&mut self, width: Option<f64>) -> Outcome {
        if let Some(value) = width
            && !FABRIC_WIDTHS.contains(&value)
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
        let mut events = self.change(next, "Choose fabric width");
        events.extend(Event::warnings(&self.kept_by_markers()));
        Ok(events)
    }

    fn set_layers(&mut self, layer: u16, others: &[OtherGarment]) -> Outcome {
        let mut worn = Vec::new();
        let mut notes = Vec::new();
        for other in others {
            let mut worn_now = self.project.others.iter();
            let known = worn_now.find(|worn| worn.source == other.path);
            let pattern = match (self.opened_to_wear(&other.path, &mut notes), known) {
                (Ok(pattern), _) => Some(pattern),
                // A garment worn already stays as it was opened, and one that was missing stays named.
                (Err(error), Some(known)) => {
                    if known.pattern.is_some() {
                        notes.push(format!("{error}; it is worn as it was when it was opened"));
                    }
                    known.pattern.clone()
                }
                (Err(error), None) => return Err(error),
            };
            worn.push(WornGarment {
                pattern,
                source: other.path.clone(),
                layer: other.layer,
            });
        }
        let layers = worn.iter().map(|garment| garment.layer);
        if let Some(wrong) = layers.chain([layer]).find(|&layer| layer > MAX_LAYER) {
            return Err(SessionError::Number {
                what: "the layer of a garment",
                value: f64::from(wrong),
                hint: "give a number from 0 to 999",
            });
        }
        let next = Project {
            layer,
            others: worn,
            ..self.project.clone()
        };
        next.check_size()?;
        let mut events = self.change(next, "Choose layers");
        events.extend(Event::warnings(&notes));
        Ok(events)
    }

    fn opened_to_wear(
        &self,
        path: &Path,
        notes: &mut Vec<String>,
    ) -> Result<Arc<Pattern>, SessionError> {
        refuse_itself(&self.project, path)?;
        let opened = open_pattern_from(path, self.origin, &OpenOptions::default())?.reading;
        let note = |note: &String| format!("{}: {note}", path.display());
        notes.extend(opened.words().iter().map(note));
        Ok(Arc::new(opened.pattern))
    }

    fn set_origin(&mut self, origin: PanelOrigin) -> Outcome {
        if let PanelOrigin::Height(value) = origin
            && (value.is_nan() || value.abs() > HIGHEST_ORIGIN)
        {
            return Err(SessionError::Number {
                what: "the height of the origin of the panels [m]",
                value,
                hint: "give a height within 10 m of the floor",
            });
        }
        self.origin = origin;
        Ok(Vec::new())
    }

    fn check(&mut self, watcher: &mut dyn Watcher) -> Outcome {
        report_progress(watcher, "checking", 0.0, "")?;
        let parts = self.derived.parts(&self.project);
        let own = self.diagnostics_by_size(None)?;
        let mut found = [0; 2];
        let mut notes = Vec::new();
        let mut tell = |part: &DraftedPart, severity: Severity, words: &dyn Display| {
            found[0] += usize::from(severity == Severity::Error);
            found[1] += usize::from(severity == Severity::Warning);
            let name = match &part.source {
                Some(path) => path.display().to_string(),
                None => part.name.clone(),
            };
            notes.push(format!("{name}: {words}"));
        };
        for (k, part) in parts.iter().enumerate() {
            match k {
                0 => own
                    .iter()
                    .for_each(|sized| tell(part, sized.diagnostic.severity, sized)),
                _ => part
                    .diagnostics
                    .iter()
                    .for_each(|d| tell(part, d.severity, d)),
            }
        }
        let mut events = vec![Event::Checked {
            errors: found[0],
            warnings: found[1],
        }];
        events.extend(Event::warnings(&notes));
        Ok(events)
    }

    pub(crate) fn nest(&mut self, watcher: &mut dyn Watcher) -> Outcome {
        let finished_markers = self.derived.finished_markers(&self.project, watcher)?;
        let mut events = Vec::new();
        for finished in finished_markers.iter() {
            events.push(Event::Nested(finished.summary()));
            events.extend(
                finished
                    .marker
                    .unplaced
                    .iter()
                    .map(|unplaced| Event::Warned {
                        message: format!(
                            "piece {:?}: {}",
                            finished.items[unplaced.item].name, unplaced.reason
                        ),
                    }),
            );
        }
        Ok(events)
    }

    fn assemble(&mut self, watcher: &mut dyn Watcher) -> Outcome {
        report_progress(watcher, "making the mannequin", 0.0, "")?;
        self.derived.mannequin(&self.project)?;
        report_progress(watcher, "meshing", 0.5, "")?;
        let garment = self.derived.outfit(&self.project)?.garment.clone();
        report_progress(watcher, "meshing", 1.0, "")?;
        let mut events = vec![Event::Assembled(Assembled {
            panels: garment.panels.len(),
            vertices: garment.positions.len(),
            triangles: garment.triangles.len(),
            stitches: garment.stitches.len(),
        })];
        events.extend(Event::warnings(&self.derived.assembly_notes));
        Ok(events)
    }

    pub(crate) fn drape(
        &mut self,
        inputs: &[toile_drape::Input],
        watcher: &mut dyn Watcher,
    ) -> Outcome {
        let mut events = Vec::new();
        let mut from = 0.0;
        if !self.derived.has_outfit() {
            from = 0.05;
            events = self.assemble(&mut ProgressShare::new(watcher, 0.0, from))?;
        }
        let mut part = ProgressShare::new(watcher, from, 1.0);
        let drape = self.derived.drape(&self.project, inputs, &mut part)?;
        events.extend(drape.events());
        Ok(events)
    }
}
