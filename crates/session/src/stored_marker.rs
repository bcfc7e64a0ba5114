//! A marker of a pattern file: searched for and stored in the file, or written as it is stored.

use crate::input::is_pipe;
use crate::markers::{other_sizes_words, there_are};
use crate::output::File;
use crate::watched_search::watched;
use crate::{
    Command, Format, MarkerFormat, MarkerSummary, Session, SessionError, Silent, Watcher,
    open_pattern,
};
use std::path::{Path, PathBuf};
use toile_interchange::write_all_atomically;
use toile_marker::{FinishedMarker, Start, marker_files};
use toile_nesting::Search;
use toile_pattern::{MarkerId, Pattern};

/// A task for a marker of a pattern file.
#[derive(Clone, Debug)]
pub struct MarkerJob {
    /// Name of the marker.
    pub name: String,
    /// Search whose result is stored in the file; `None` leaves the marker as it is stored.
    pub search: Option<(Start, Search)>,
    /// Files to write.
    pub formats: Vec<MarkerFormat>,
}

/// Searches for the layout of a marker of a pattern file, stores the placements in the file, and writes the
/// marker. Returns a summary of each roll that the marker is laid on, with notes on the faults that keep it
/// from being cut, and the files written, the pattern's first if it was stored.
///
/// # Errors
/// The pattern cannot be read, is not in Toile's format or has parts that would be lost in storing;
/// it has no such marker; the marker cannot be laid; a file cannot be written. The pattern file then
/// holds a whole marker, the old one or the new one.
pub fn nest_marker(
    path: &Path,
    job: &MarkerJob,
    (folder, watcher): (&Path, &mut dyn Watcher),
) -> Result<(Vec<MarkerSummary>, Vec<PathBuf>), SessionError> {
    let opened = open_pattern(path)?;
    let pattern = &opened.pattern;
    let id = marker_named(pattern, &job.name)?;
    if job.search.is_some() && is_pipe(path) {
        return Err(SessionError::Conflict(
            "a pattern that came through a pipe has no file to store the marker in: save it first, or lay the marker \
             with --stored as it is"
                .to_owned(),
        ));
    }
    if job.search.is_some() {
        refuse_loss(path, (opened.format, &opened.notes))?;
    }
    let mut session = Session::new();
    let path = path.to_owned();
    session.execute(Command::open(path.clone()), &mut Silent)?;
    let mut paths = Vec::new();
    let mut notes: Vec<Vec<String>> = Vec::new();
    if let Some(how) = job.search {
        let search = session.marker_search(id)?;
        let found = watched(watcher, |follow| search.run(how, follow))?;
        let found_notes = found.found.summaries.iter().map(|own| own.notes.clone());
        notes.extend(found_notes);
        if session.adopt_marker(found)?.is_none() {
            let what = "the marker changed while it was searched for; search again";
            return Err(SessionError::Conflict(what.to_owned()));
        }
        let save = Command::SavePattern { path: path.clone() };
        session.execute(save, &mut Silent)?;
        paths.push(path);
    }
    let (mut summaries, files) = written(&mut session, &job.name, &job.formats)?;
    for (summary, notes) in summaries.iter_mut().zip(notes) {
        for note in notes {
            if !summary.notes.contains(&note) {
                summary.notes.push(note);
            }
        }
    }
    write_all_atomically(folder, &files)?;
    paths.extend(files.iter().map(|(name, _)| folder.join(name)));
    Ok((summaries, paths))
}

/// A stored marker of a session's pattern: the title of its files, its layout on each roll, and a note if it
/// is of other sizes than the garment.
pub(crate) fn stored(
    session: &mut Session,
    name: &str,
) -> Result<(String, Vec<FinishedMarker>, Option<String>), SessionError> {
    let laid = session.marker(marker_named(&session.project().pattern, name)?)?;
    let project = session.project();
    let pattern = &project.pattern;
    let marker = laid.marker();
    let name = format!("{}, {}", pattern.name, marker.name);
    let name = match &marker.order[..] {
        [only] if only.size.is_none() && only.quantity == 1 => project.titled(&name),
        order => {
            let sizes = order.iter().filter_map(|ordered| {
                let size = pattern.sizes.iter();
                let mut size = size.filter(|size| Some(size.id) == ordered.size);
                let whose = match ordered.size {
                    Some(_) => Some(size.next()?.name.clone()),
                    None => project.made_words(),
                };
                Some(match whose {
                    Some(whose) => format!(", {} x {whose}", ordered.quantity),
                    None => String::new(),
                })
            });
            name + &sizes.collect::<String>()
        }
    };
    let other_sizes = other_sizes_words(project, marker);
    let other_sizes = other_sizes.map(|words| format!("marker {:?} {words}", marker.name));
    Ok((name, laid.finished_rolls(), other_sizes))
}

fn marker_named(pattern: &Pattern, name: &str) -> Result<MarkerId, SessionError> {
    let found = pattern.marker_named(name).map(|marker| marker.id);
    found.ok_or_else(|| SessionError::Unknown {
        kind: "marker",
        name: name.to_owned(),
        hint: there_are(pattern.markers.iter().map(|m| m.name.clone()).collect()),
    })
}

/// A stored marker as files, with a summary of each of its rolls.
fn written(
    session: &mut Session,
    marker: &str,
    formats: &[MarkerFormat],
) -> Result<(Vec<MarkerSummary>, Vec<File>), SessionError> {
    let (name, finished_markers, other_sizes) = stored(session, marker)?;
    let mut files = Vec::new();
    let lost = marker_files((&name, formats), &finished_markers, &mut files)?;
    let mut other_sizes = other_sizes.into_iter();
    let summaries = finished_markers.iter().zip(lost).map(|(finished, lost)| {
        let mut summary = finished.summary();
        // The note is given once, on the first roll.
        summary.notes.extend(other_sizes.by_ref());
        summary.notes.extend(finished.faults());
        summary.notes.extend(lost);
        summary
    });
    Ok((summaries.collect(), files))
}

/// Refuses to store a marker in a file with parts that this program does not know: the whole file is written
/// anew, and these parts would be lost.
fn refuse_loss(path: &Path, (format, notes): (Format, &[String])) -> Result<(), SessionError> {
    if format != Format::Native {
        return Err(SessionError::Conflict(format!(
            "{}: markers are stored in Toile's own format; convert the pattern first, as in `toile convert PATTERN NAME.toile.json`",
            path.display()
        )));
    }
    match notes.first() {
        None => Ok(()),
        Some(note) => Err(SessionError::Conflict(format!(
            "{}: storing the marker would lose what this program does not know: {note}",
            path.display()
        ))),
    }
}
