//! Writes all files of a project.

use crate::derived::Derived;
use crate::drape::Drape;
use crate::outfit::DraftedPart;
use crate::product::{garment_glb, garment_obj};
use crate::report::Report;
use crate::watcher::report_progress;
use crate::{Command, Project, SessionError, Watcher, pictures};
use std::path::Path;
use toile_interchange::{FormatError, write_glb, write_obj};
use toile_marker::{MarkerFormat, marker_files};

/// A file to write: its name and its content.
pub(crate) type File = (String, Vec<u8>);

/// Every file of what has been made: markers, garment, pictures, report.
pub(crate) fn files(
    project: &Project,
    derived: &mut Derived,
    watcher: &mut dyn Watcher,
) -> Result<Vec<File>, SessionError> {
    if derived.finished_markers.is_none() && derived.drape.is_none() {
        return Err(SessionError::Nothing {
            action: "export",
            hint: "lay the pieces out or drape the garment first",
        });
    }
    let parts = derived.parts(project);
    let mut report = Report::new(project, &parts);
    let found = parts.iter().flat_map(|part| part.diagnostics.iter());
    report.add_warnings(found.map(ToString::to_string));
    let mut files = Vec::new();
    if let Some(finished_markers) = &derived.finished_markers {
        report_progress(watcher, "writing", 0.0, "marker")?;
        let formats = [MarkerFormat::Svg, MarkerFormat::Json];
        marker_files((&worn_name(&parts), &formats), finished_markers, &mut files)?;
        report.add_markers(finished_markers);
    }
    if let Some(drape) = derived.drape.clone() {
        garment_files(&drape, &mut files)?;
        report_progress(watcher, "writing", 0.2, "pictures")?;
        let mannequin = derived.mannequin(project)?;
        let title = picture_title(project, &worn_name(&parts));
        let picture = pictures::drape_png(&drape, mannequin.skin(), &title)?;
        files.push(("drape.png".into(), picture));
        report_progress(watcher, "writing", 0.6, "pictures")?;
        let picture = pictures::fit_png(&drape, mannequin.skin(), &title)?;
        files.push(("fit.png".into(), picture));
        report.add_drape(project, &drape);
        report.add_warnings(derived.assembly_notes.iter().cloned());
        report.add_warnings(drape.warnings.iter().cloned());
    }
    report_progress(watcher, "writing", 0.95, "report")?;
    files.push(("report.json".into(), report.to_json().into_bytes()));
    Ok(files)
}

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

/// A name as one of a file: letters and digits of any language, `-`, `_` and `.` but at its start.
pub(crate) fn file_name(name: &str) -> String {
    let plain = |(k, c): (usize, char)| {
        let keeps = c.is_alphanumeric() || "-_".contains(c) || (c == '.' && k > 0);
        if keeps { c } else { '_' }
    };
    name.chars().enumerate().map(plain).collect()
}

fn garment_files(drape: &Drape, files: &mut Vec<File>) -> Result<(), SessionError> {
    let glb = write_glb(&garment_glb(drape)).map_err(cannot("garment.glb"))?;
    let obj = write_obj(&garment_obj(drape)).map_err(cannot("garment.obj"))?;
    files.push(("garment.glb".into(), glb));
    files.push(("garment.obj".into(), obj.into_bytes()));
    for (name, obj) in drape.part_files() {
        let text = write_obj(&obj).map_err(cannot("a layer"))?;
        files.push((name, text.into_bytes()));
    }
    Ok(())
}

pub(crate) fn cannot(file: &'static str) -> impl Fn(FormatError) -> SessionError {
    move |error| SessionError::Write { file, error }
}

/// A command as it is written beside what it made: a place to write to is named by the file name alone, so that the
/// journal does not depend on where it lies.
pub(crate) fn portable(mut command: Command) -> Command {
    let is_folder = matches!(command, Command::Export { .. });
    if let Some(output) = command.output_mut() {
        match output.file_name() {
            _ if is_folder => *output = ".".into(),
            Some(name) => *output = name.into(),
            None => {}
        }
    }
    command
}

/// The commands with everything that is written going into one folder.
pub(crate) fn redirected(commands: &[Command], folder: &Path) -> Vec<Command> {
    let mut commands: Vec<Command> = commands.iter().cloned().map(portable).collect();
    for command in &mut commands {
        let is_folder = matches!(command, Command::Export { .. });
        if let Some(output) = command.output_mut() {
            *output = match is_folder {
                true => folder.to_owned(),
                false => folder.join(&*output),
            };
        }
    }
    commands
}
