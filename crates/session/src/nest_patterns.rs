//! Markers of several patterns and sizes laid together, and solutions of published nesting instances.

use crate::input::read_file;
use crate::open::read_input;
use crate::output::{File, cannot, file_name};
use crate::sizes::selected;
use crate::tools::{project_of, sound_draft};
use crate::watched_search::lay_watched;
use crate::watcher::report_progress;
use crate::{MarkerSummary, NestOptions, Project, SessionError, Watcher};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use toile_interchange::{
    ExpectedKind, MarkerSettings, is_jagua_instance, read_jagua, read_marker_settings,
    write_all_atomically, write_jagua,
};
use toile_marker::{FinishedMarker, Garments, MarkerError, MarkerFormat, marker_files};
use toile_nesting::{Budget, Control, Placement, Progress, judge, make_marker};
use toile_pattern::{ClothSettings, Draft, Pattern};

/// A pattern drafted in a size, and how often it is cut.
pub(crate) struct Drafted {
    pattern: Arc<Pattern>,
    draft: Draft,
    count: u32,
    label: Option<String>,
}

impl Drafted {
    /// The garments to cut.
    pub fn garments(&self) -> Garments<'_> {
        Garments {
            pattern: &self.pattern,
            draft: &self.draft,
            count: self.count,
            label: self.label.as_deref(),
        }
    }
}

/// Drafts of all patterns in all sizes, their names, and notes on parts that were left out or are
/// missing.
pub(crate) struct DraftedPatterns {
    pub drafts: Vec<Drafted>,
    pub names: Vec<String>,
    pub notes: Vec<String>,
}

/// Drafts patterns in the sizes asked for, else in the size stored in each file, with the fabric and
/// the width stored there.
pub(crate) fn drafts_of(
    patterns: &[PathBuf],
    options: &NestOptions,
) -> Result<DraftedPatterns, SessionError> {
    let mut notes = Vec::new();
    let mut projects = Vec::new();
    for path in patterns {
        let (opened, found) = project_of(path, None)?;
        let note = |note| format!("{}: {note}", path.display());
        notes.extend(found.into_iter().map(note));
        projects.push(opened);
    }
    let drafted = drafts_of_projects(&projects, options)?;
    Ok(DraftedPatterns { notes, ..drafted })
}

/// Drafts of projects in the sizes asked for, else in the size of each, with its fabric and its width.
fn drafts_of_projects(
    projects: &[Project],
    options: &NestOptions,
) -> Result<DraftedPatterns, SessionError> {
    let mut drafts = Vec::new();
    let mut names = Vec::new();
    let mut known: Vec<String> = Vec::new();
    for opened in projects {
        let sizes = selected(&options.sizes, &opened.pattern)?;
        let several = sizes.len() > 1;
        let mut own_name: Option<String> = None;
        for (size, count) in sizes {
            let size = size.or_else(|| opened.size.clone());
            let project = Project {
                size: size.clone(),
                ..opened.clone()
            };
            project.check_size()?;
            let size = size.as_deref();
            let mut draft = sound_draft(&project)?;
            if let Some(width) = project.width {
                draft.fabrics.iter_mut().for_each(|f| f.width = width);
            }
            let name = own_name.get_or_insert_with(|| another(&project.pattern.name, &known));
            names.push(match (size, several || count > 1) {
                (Some(size), true) => format!("{name} {count} x {size}"),
                _ => project.titled(name),
            });
            known.push(name.clone());
            drafts.push(Drafted {
                pattern: project.pattern.clone(),
                draft,
                count,
                label: label_of(
                    (projects.len() > 1).then_some(name.as_str()),
                    size.filter(|_| several),
                ),
            });
        }
    }
    Ok(DraftedPatterns {
        drafts,
        names,
        notes: Vec::new(),
    })
}

/// A name that is not taken yet: a second pattern of the same name gets the number 2.
fn another(name: &str, known: &[String]) -> String {
    let mut number = 1;
    let mut own = name.to_owned();
    while known.contains(&own) {
        number += 1;
        own = format!("{name} ({number})");
    }
    own
}

/// Label on the pieces of one pattern and size, if several patterns or sizes are laid together.
fn label_of(pattern: Option<&str>, size: Option<&str>) -> Option<String> {
    let parts: Vec<&str> = pattern.into_iter().chain(size).collect();
    (!parts.is_empty()).then(|| parts.join(" "))
}

/// A copy of a piece as it is laid on a marker: turned over along the warp if it is mirrored, its grain turned
/// from the warp, then shifted.
#[derive(Clone, Debug, PartialEq)]
pub struct LaidCopy {
    /// Number of the marker, from 0.
    pub marker: usize,
    /// Name of the piece.
    pub piece: String,
    /// Number of the copy, from 0.
    pub copy: u32,
    /// Angle from the warp to the grain of the piece (rad).
    pub turn: f64,
    /// Whether the copy lies face down.
    pub mirrored: bool,
    /// Shift after the turn (m).
    pub translation: [f64; 2],
    /// Cut line as it is laid, x along the warp (m).
    pub outline: Vec<[f64; 2]>,
}

/// Markers of the pieces of one or more patterns laid together.
#[derive(Clone, Debug)]
pub struct LaidPatterns {
    /// Names of the patterns with their sizes, as the title of the markers.
    pub title: String,
    /// The markers, one for each fabric and roll.
    pub markers: Vec<FinishedMarker>,
    /// Notes on parts of files that were left out or are missing.
    pub notes: Vec<String>,
}

impl LaidPatterns {
    fn of(
        drafted: DraftedPatterns,
        options: &NestOptions,
        watcher: &mut dyn Watcher,
    ) -> Result<Self, SessionError> {
        let garments: Vec<Garments<'_>> = drafted.drafts.iter().map(|d| d.garments()).collect();
        Ok(Self {
            markers: lay_watched(&garments, options, watcher)?,
            title: drafted.names.join(" + "),
            notes: drafted.notes,
        })
    }

    /// Summaries of the markers.
    pub fn summaries(&self) -> Vec<MarkerSummary> {
        self.markers.iter().map(FinishedMarker::summary).collect()
    }

    /// Every copy that was laid.
    pub fn copies(&self) -> Vec<LaidCopy> {
        let of_marker = |(number, finished): (usize, &FinishedMarker)| {
            let copy = |placement: &Placement| {
                let item = &finished.items[placement.item];
                let laid = placement.pose(item).lay(&item.outline);
                LaidCopy {
                    marker: number,
                    piece: item.name.clone(),
                    copy: placement.copy,
                    turn: placement.turn,
                    mirrored: placement.mirrored,
                    translation: placement.translation.into(),
                    outline: laid.outer.iter().map(|&point| point.into()).collect(),
                }
            };
            let copies = finished.marker.placements.iter().map(copy);
            copies.collect::<Vec<LaidCopy>>()
        };
        self.markers
            .iter()
            .enumerate()
            .flat_map(of_marker)
            .collect()
    }

    /// Length of fabric of all markers together (m).
    pub fn length(&self) -> f64 {
        self.markers.iter().map(|laid| laid.marker.length).sum()
    }

    /// Area of the pieces divided by the area of fabric between the end margins, over all markers (1).
    pub fn efficiency(&self) -> f64 {
        if let [laid] = &self.markers[..] {
            return laid.marker.efficiency;
        }
        let (mut pieces, mut fabric) = (0.0, 0.0);
        for laid in self
            .markers
            .iter()
            .filter(|laid| laid.marker.efficiency > 0.0)
        {
            let area = laid.cut_area();
            pieces += area;
            fabric += area / laid.marker.efficiency;
        }
        if fabric > 0.0 { pieces / fabric } else { 0.0 }
    }

    /// The files of the markers in formats, and for each marker what a format could not hold.
    ///
    /// # Errors
    /// A marker that a format cannot hold.
    pub fn files(
        &self,
        formats: &[MarkerFormat],
    ) -> Result<(Vec<File>, Vec<Vec<String>>), SessionError> {
        let mut files = Vec::new();
        let lost = marker_files((&self.title, formats), &self.markers, &mut files)?;
        Ok((files, lost))
    }
}

/// Lays the pieces of projects together.
///
/// # Errors
/// A pattern has faults, or cannot be laid.
pub fn lay_projects(
    projects: &[Project],
    options: &NestOptions,
    watcher: &mut dyn Watcher,
) -> Result<LaidPatterns, SessionError> {
    LaidPatterns::of(drafts_of_projects(projects, options)?, options, watcher)
}

/// Lays the pieces of one or more patterns together and writes the markers. Returns a summary of
/// each marker and the files written.
///
/// # Errors
/// A pattern cannot be read or laid, or a file cannot be written.
pub fn nest_patterns(
    patterns: &[PathBuf],
    options: &NestOptions,
    (folder, watcher): (&Path, &mut dyn Watcher),
) -> Result<(Vec<MarkerSummary>, Vec<PathBuf>), SessionError> {
    let laid = LaidPatterns::of(drafts_of(patterns, options)?, options, watcher)?;
    let (files, lost) = laid.files(&options.formats)?;
    let LaidPatterns { markers, notes, .. } = laid;
    write_all_atomically(folder, &files)?;
    let paths = files.iter().map(|(name, _)| folder.join(name)).collect();
    let mut summary: Vec<MarkerSummary> = markers.iter().map(|l| l.summary()).collect();
    for (summary, lost) in summary.iter_mut().zip(lost) {
        summary.notes.extend(lost);
    }
    if let Some(first) = summary.first_mut() {
        first.notes.splice(0..0, notes);
    }
    Ok((summary, paths))
}

/// Reads a file of marker settings.
///
/// # Errors
/// The file cannot be read, or does not hold marker settings.
pub fn open_marker_settings(path: &Path) -> Result<MarkerSettings, SessionError> {
    read_marker_settings(&read_input(path, ExpectedKind::MarkerSettings)?).map_err(|error| {
        SessionError::Format {
            path: path.to_owned(),
            error,
        }
    })
}

/// Whether a file is a nesting instance rather than a pattern.
pub fn is_nesting_instance(path: &Path) -> bool {
    let bytes = read_file(path).unwrap_or_default();
    std::str::from_utf8(&bytes).is_ok_and(is_jagua_instance)
}

/// Lays the items of an instance and writes the solution in the instance's own format, as
/// `NAME.json`. Returns a summary, notes and the file written.
///
/// # Errors
/// The instance cannot be read or laid, an option does not apply (all but budget, seed, threads and
/// tilt), or the file cannot be written.
pub fn nest_instance(
    path: &Path,
    options: &NestOptions,
    (folder, watcher): (&Path, &mut dyn Watcher),
) -> Result<(MarkerSummary, Vec<String>, PathBuf), SessionError> {
    let started = std::time::Instant::now();
    let text = read_input(path, ExpectedKind::NestingInstance)?;
    let mut instance = read_jagua(&text).map_err(|error| SessionError::Format {
        path: path.to_owned(),
        error,
    })?;
    let plain = NestOptions {
        cloth: ClothSettings {
            tilt: options.cloth.tilt,
            ..ClothSettings::default()
        },
        keep_best: options.keep_best,
        budget: options.budget,
        seed: options.seed,
        islands: options.islands,
        threads: options.threads,
        ..NestOptions::default()
    };
    if *options != plain {
        return Err(SessionError::Conflict(format!(
            "{}: an instance has its own strip and items; give only --time, --evaluations, --seed, --islands, --threads, --tilt and --out",
            path.display()
        )));
    }
    for item in &mut instance.items {
        item.allowed.tilt = options.cloth.tilt.unwrap_or(0.0);
    }
    let cancel = watcher.stop_flag().unwrap_or_default();
    let scale = instance.scale;
    let mut follow = |progress: Progress| {
        let detail = match progress.length.is_finite() {
            true => format!("length {:.1}", progress.length / scale),
            false => "making ready".to_owned(),
        };
        if report_progress(watcher, "laying out", progress.done, &detail).is_err() {
            cancel.store(true, Ordering::Relaxed);
        }
    };
    let mut control = Control {
        progress: &mut follow,
        cancel: &cancel,
    };
    let (items, strip) = (&instance.items, &instance.strip);
    let made = make_marker(items, strip, options.search(), &mut control);
    // Messages show lengths in millimetres. Lengths are scaled so that the numbers shown are those of the
    // instance.
    let marker = made.map_err(|error| MarkerError::from(error.scaled(1e-3 / scale)))?;
    if cancel.load(Ordering::Relaxed) && !options.keep_best {
        return Err(SessionError::Cancelled);
    }
    let verdict = judge(items, strip, &marker);
    let seconds = match options.budget {
        Budget::Seconds(_) => Some(started.elapsed().as_secs_f64()),
        Budget::Evaluations(_) => None,
    };
    let text = write_jagua(&instance, &marker, seconds).map_err(cannot("the solution"))?;
    let name = file_name(&instance.name);
    let file = (format!("{name}.json"), text.into_bytes());
    write_all_atomically(folder, std::slice::from_ref(&file))?;
    let summary = MarkerSummary {
        fabric: instance.name.clone(),
        pieces: marker.placements.len(),
        unplaced: marker.unplaced.len(),
        length: marker.length / scale,
        width: strip.width / scale,
        yardage: marker.length / scale,
        efficiency: marker.efficiency,
        utilisation: marker.utilisation,
        sound: verdict.is_sound(),
        ..MarkerSummary::default()
    };
    Ok((summary, instance.notes, folder.join(file.0)))
}
