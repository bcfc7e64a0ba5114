//! Writes what is made of a project: markers, garment, pictures, pieces on paper, a report.
//!
//! # Decided with
//! - [`crate::export_format::ExportFormat`]: files by name;
//! - [`crate::product`], [`toile_interchange::write_glb`], [`toile_interchange::write_obj`]: the garment as
//!   glTF and OBJ: parts, normals, texture coordinates;
//! - [`toile_marker::MarkerFormat`], [`crate::printing::print_pattern`]: markers; pieces;
//! - [`crate::pictures`], [`crate::report::Report`]: pictures, report;
//! - [`crate::scene`] (`state_files`), [`crate::tools::check_ending`]: files of scenes and bodies;
//! - [`toile_interchange::write_all_atomically`]: whole or not at all.
//!
//! By hand: a new file in the window (`app/export_choice.rs`, `GROUPS`) and in crate `cli` (`output.rs`,
//! `meaning`).

use crate::drape::Drape;
use crate::export_format::{Export, ExportFormat};
use crate::fitting::fitting_anywhere;
use crate::journal::{Entry, MAX_COMMANDS};
use crate::journal_files::journal_beside;
use crate::outfit::DraftedPart;
use crate::output::{File, cannot};
use crate::printing::print_bytes;
use crate::product::{garment_glb, garment_obj};
use crate::report::Report;
use crate::stored_marker::stored;
use crate::watcher::{ProgressShare, report_progress};
use crate::write_pattern::{named_files, written};
use crate::{
    Command, Event, Paper, PrintOptions, Project, Session, SessionError, SizeSelection, Watcher,
    WriteOptions, pictures, print_job,
};
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;
use toile_interchange::{
    check_folder, write_all_atomically, write_atomically, write_glb, write_obj,
};
use toile_marker::{FinishedMarker, MarkerFormat, marker_files};

/// Progress of an export (1) when the markers are laid, when the garment hangs, and when its pieces are
/// printed.
const DONE: [f64; 3] = [0.08, 0.9, 0.94];

/// Results that an export writes.
struct Subject {
    formats: Vec<ExportFormat>,
    /// Title of the marker files, and the markers.
    markers: Option<(String, Arc<Vec<FinishedMarker>>)>,
    drape: Option<Arc<Drape>>,
}

impl Export {
    /// Whether the garment is draped for the export. A report covers the garment and the marker that are
    /// exported with it; a report exported alone covers both.
    pub(crate) fn takes_garment(&self) -> bool {
        self.takes(ExportFormat::is_of_garment)
    }

    /// Whether a marker is laid for the export.
    pub fn takes_marker(&self) -> bool {
        self.takes(ExportFormat::is_of_marker)
    }

    /// Refuses a named marker if no format of the export shows a marker.
    fn check_marker(&self) -> Result<(), SessionError> {
        let Some(marker) = self.marker.as_ref().filter(|_| !self.takes_marker()) else {
            return Ok(());
        };
        let names: Vec<&str> = self.formats.iter().map(|format| format.name()).collect();
        let names = match names.is_empty() {
            true => "what has been made".to_owned(),
            false => names.join(", "),
        };
        Err(SessionError::Conflict(format!(
            "marker {marker:?} is asked for, and nothing of it is in {names}: leave --marker out, or give a format \
             that shows it, as in --formats marker-svg"
        )))
    }

    fn takes(&self, is_of: impl Fn(ExportFormat) -> bool) -> bool {
        let formats = &self.formats;
        let shows = |format: &ExportFormat| format.is_of_garment() || format.is_of_marker();
        let is_report_alone = formats.contains(&ExportFormat::Report) && !formats.iter().any(shows);
        is_report_alone || formats.iter().any(|&format| is_of(format))
    }
}

impl Session {
    /// Writes files into a folder; if one cannot be written, none is. Markers and drape that the files need
    /// are made first.
    pub(crate) fn export(
        &mut self,
        export: &Export,
        watcher: &mut dyn Watcher,
    ) -> Result<Vec<Event>, SessionError> {
        // Checked before minutes are spent on the drape.
        export.check_marker()?;
        check_folder(&export.dir)?;
        let (mut events, files) = self.export_files(export, watcher)?;
        write_all_atomically(&export.dir, &files)?;
        // The files are on the disk: a request to stop comes too late and is ignored.
        let _ = report_progress(watcher, "writing", 1.0, "");
        let paths = files.iter().map(|(name, _)| export.dir.join(name));
        events.push(Event::FilesWritten {
            paths: paths.collect(),
        });
        Ok(events)
    }

    /// The files of an export, each with its name and content; nothing is written.
    ///
    /// # Errors
    /// The garment or a marker cannot be made, or a format cannot hold it.
    pub fn export_files(
        &mut self,
        export: &Export,
        watcher: &mut dyn Watcher,
    ) -> Result<(Vec<Event>, Vec<File>), SessionError> {
        let start = Instant::now();
        export.check_marker()?;
        let mut events = Vec::new();
        let subject = self.subject(export, (watcher, &mut events))?;
        let mut files = Vec::new();
        self.pieces(&subject, (watcher, &mut events), &mut files)?;
        let mut part = ProgressShare::new(watcher, DONE[2], 1.0);
        self.files(&subject, (&mut part, &mut events), &mut files)?;
        if subject.formats.contains(&ExportFormat::Journal) {
            self.record(export, start, &mut files)?;
            if !self.journal.is_whole() {
                events.push(Event::Warned {
                    message: format!(
                        "journal.jsonl was left out: it would need the first of more than \
                         {MAX_COMMANDS} commands, which are no longer kept; save the pattern, open it \
                         and export from there"
                    ),
                });
            }
        }
        Ok((events, files))
    }

    /// Makes the markers and the drape that the export needs.
    fn subject(
        &mut self,
        export: &Export,
        (watcher, events): (&mut dyn Watcher, &mut Vec<Event>),
    ) -> Result<Subject, SessionError> {
        let derived = &self.derived;
        if export.formats.is_empty() {
            let (markers, drape) = (derived.finished_markers.clone(), derived.drape.clone());
            if markers.is_none() && drape.is_none() {
                return Err(SessionError::Nothing {
                    action: "export",
                    hint: "lay the pieces out or drape the garment first",
                });
            }
            let name = self.marker_title();
            let usual = ExportFormat::ALL.into_iter();
            return Ok(Subject {
                formats: usual.filter(|format| format.is_usual()).collect(),
                markers: markers.map(|markers| (name, markers)),
                drape,
            });
        }
        let mut subject = Subject {
            formats: export.formats.clone(),
            markers: None,
            drape: None,
        };
        if export.takes_marker() {
            let mut part = ProgressShare::new(watcher, 0.0, DONE[0]);
            let markers = match &export.marker {
                Some(name) => {
                    let marker = self.project.pattern.marker_named(name);
                    let kept = marker.and_then(|marker| self.kept_by(marker));
                    events.extend(Event::warnings(kept.as_slice()));
                    let (name, markers, other_sizes) = stored(self, name)?;
                    events.extend(Event::warnings(other_sizes.as_slice()));
                    for finished in &markers {
                        events.push(Event::Nested(finished.summary()));
                        events.extend(Event::warnings(&finished.faults()));
                    }
                    (name, Arc::new(markers))
                }
                None => {
                    events.extend(self.nest(&mut part)?);
                    let markers = self.derived.finished_markers(&self.project, &mut part)?;
                    (self.marker_title(), markers)
                }
            };
            subject.markers = Some(markers);
        }
        if export.takes_garment() {
            let mut part = ProgressShare::new(watcher, DONE[0], DONE[1]);
            // A garment that was draped already is exported as the user pulled it.
            let inputs = self
                .derived
                .drape
                .as_ref()
                .map(|drape| drape.inputs.clone());
            events.extend(self.drape(&inputs.unwrap_or_default(), &mut part)?);
            subject.drape = self.derived.drape.clone();
        }
        Ok(subject)
    }

    /// The names of all garments worn.
    fn garment_name(&mut self) -> String {
        worn_name(&self.derived.parts(&self.project))
    }

    /// Title of a marker of the garments worn.
    fn marker_title(&mut self) -> String {
        let name = self.garment_name();
        self.project.titled(&name)
    }

    /// Adds the files of the pieces on paper.
    fn pieces(
        &self,
        subject: &Subject,
        (watcher, events): (&mut dyn Watcher, &mut Vec<Event>),
        files: &mut Vec<File>,
    ) -> Result<(), SessionError> {
        let written = [
            (ExportFormat::PiecesPdf, Paper::A4),
            (ExportFormat::PiecesSvg, Paper::Page),
        ];
        for (format, paper) in written {
            if !subject.formats.contains(&format) {
                continue;
            }
            let size = self.project.size.as_deref();
            let options = PrintOptions {
                sizes: size.map_or(SizeSelection::Base, SizeSelection::one),
                paper,
                ..PrintOptions::default()
            };
            let mut part = ProgressShare::new(watcher, DONE[1], DONE[2]);
            let (job, printed) = print_job(&self.project, &options, &mut part)?;
            let mut notes = printed.notes;
            let is_svg = format == ExportFormat::PiecesSvg;
            let bytes = print_bytes(&job, is_svg, &mut notes);
            files.push((format.file().into(), bytes.map_err(cannot(format.file()))?));
            events.extend(Event::warnings(&notes));
        }
        Ok(())
    }

    /// Adds the files of markers and garment, and the report on them.
    fn files(
        &mut self,
        subject: &Subject,
        (watcher, events): (&mut dyn Watcher, &mut Vec<Event>),
        files: &mut Vec<File>,
    ) -> Result<(), SessionError> {
        let derived = &mut self.derived;
        let parts = derived.parts(&self.project);
        let mut report = Report::new(&self.project, &parts);
        let found = parts.iter().flat_map(|part| part.diagnostics.iter());
        report.add_warnings(found.map(ToString::to_string));
        if let Some((name, markers)) = &subject.markers {
            report_progress(watcher, "writing", 0.0, "marker")?;
            let formats = subject.formats.iter();
            let formats: Vec<MarkerFormat> = formats.filter_map(|f| f.of_marker()).collect();
            let lost = marker_files((name, &formats), markers, files)?;
            events.extend(Event::warnings(&lost.concat()));
            report.add_markers(markers);
        }
        if let Some(drape) = &subject.drape {
            garment_files(drape, &subject.formats, files)?;
            report_progress(watcher, "writing", 0.2, "pictures")?;
            self.picture_files(drape, &subject.formats, (watcher, files))?;
            report.add_drape(&self.project, drape);
            report.add_warnings(self.derived.assembly_notes.iter().cloned());
            report.add_warnings(drape.warnings.iter().cloned());
        }
        self.pattern_files(&subject.formats, events, files)?;
        report_progress(watcher, "writing", 0.95, "report")?;
        if subject.formats.contains(&ExportFormat::Report) {
            files.push(("report.json".into(), report.to_json().into_bytes()));
        }
        Ok(())
    }

    /// Adds the pattern in the formats of other programs, in all sizes where one file holds them.
    fn pattern_files(
        &self,
        formats: &[ExportFormat],
        events: &mut Vec<Event>,
        files: &mut Vec<File>,
    ) -> Result<(), SessionError> {
        for export in formats {
            let Some(format) = export.of_pattern() else {
                continue;
            };
            let sizes = WriteOptions::whole(format, &self.project.pattern).sizes();
            let fitting = fitting_anywhere(&self.project).map_err(cannot(export.file()))?;
            let writing = written(&self.project, format, sizes.as_ref(), &fitting)?;
            for (name, bytes) in named_files(export.file(), format, &writing) {
                files.push((name, bytes.to_vec()));
            }
            let title = format.title();
            let lost = writing.losses.iter();
            let lost = lost.map(|loss| format!("{title} leaves out: {loss}"));
            events.extend(Event::warnings(&lost.collect::<Vec<_>>()));
        }
        Ok(())
    }

    /// Writes the garment as it was last draped, on its body, as a PNG of a size (pixels).
    ///
    /// # Errors
    /// The garment was not draped since its last change, or the file cannot be written.
    pub fn write_drape_view(&mut self, path: &Path, size: [usize; 2]) -> Result<(), SessionError> {
        let drape = self.derived.drape.clone().ok_or(SessionError::Nothing {
            action: "draw",
            hint: "drape the garment first",
        })?;
        let mannequin = self.derived.mannequin(&self.project)?;
        let picture = pictures::drape_view_png(&drape, mannequin.skin(), size)?;
        Ok(write_atomically(path, &picture)?)
    }

    fn picture_files(
        &mut self,
        drape: &Drape,
        formats: &[ExportFormat],
        (watcher, files): (&mut dyn Watcher, &mut Vec<File>),
    ) -> Result<(), SessionError> {
        let wanted = |format| formats.contains(&format);
        if !wanted(ExportFormat::Drape) && !wanted(ExportFormat::Fit) {
            return Ok(());
        }
        let mannequin = self.derived.mannequin(&self.project)?;
        let name = self.garment_name();
        let title = picture_title(&self.project, &name);
        if wanted(ExportFormat::Drape) {
            let picture = pictures::drape_png(drape, mannequin.skin(), &title)?;
            files.push(("drape.png".into(), picture));
        }
        report_progress(watcher, "writing", 0.6, "pictures")?;
        if wanted(ExportFormat::Fit) {
            let picture = pictures::fit_png(drape, mannequin.skin(), &title)?;
            files.push(("fit.png".into(), picture));
        }
        Ok(())
    }

    /// Adds the journal, if all its commands are kept, and the time that the commands took.
    fn record(
        &self,
        export: &Export,
        start: Instant,
        files: &mut Vec<File>,
    ) -> Result<(), SessionError> {
        if self.journal.is_whole() {
            let entry = Entry {
                command: Command::Export(export.clone()),
                files: Vec::new(),
            };
            let entries = self.journal.entries().chain([&entry]);
            let text = journal_beside(entries, &export.dir)?;
            files.push(("journal.jsonl".into(), text.into_bytes()));
        }
        let mut timing = self.timing.clone();
        timing.add("export", start);
        files.push(("timing.json".into(), timing.to_json().into_bytes()));
        Ok(())
    }
}

/// Title of a picture: a name with the size.
fn picture_title(project: &Project, name: &str) -> String {
    match project.size_name() {
        Some(size) => format!("{name}, size {size}"),
        None => name.to_owned(),
    }
}

/// The names of all garments worn.
fn worn_name(parts: &[DraftedPart]) -> String {
    let names: Vec<&str> = parts.iter().map(|part| &*part.name).collect();
    names.join(" + ")
}

fn garment_files(
    drape: &Drape,
    formats: &[ExportFormat],
    files: &mut Vec<File>,
) -> Result<(), SessionError> {
    if formats.contains(&ExportFormat::Glb) {
        let glb = write_glb(&garment_glb(drape)).map_err(cannot("garment.glb"))?;
        files.push(("garment.glb".into(), glb));
    }
    if !formats.contains(&ExportFormat::Obj) {
        return Ok(());
    }
    let obj = write_obj(&garment_obj(drape)).map_err(cannot("garment.obj"))?;
    files.push(("garment.obj".into(), obj.into_bytes()));
    for (name, obj) in drape.part_files() {
        let text = write_obj(&obj).map_err(cannot("a layer"))?;
        files.push((name, text.into_bytes()));
    }
    Ok(())
}
